"""The MCP server: a session is an episode in text, and programs are checked, run, repaired and planned."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

from mcp.server.mcpserver import Context, MCPServer
from mcp.server.mcpserver.exceptions import ToolError
from mcp.server.transport_security import TransportSecuritySettings
from starlette.types import ASGIApp

from hearth.challenges.text_episode import EpisodeTurn
from hearth.commands import mcp_program_tools as programs
from hearth.commands.mcp_episodes import IDLE_SECONDS, SessionEpisodes
from hearth.commands.mcp_program_tools import CheckResult, KnowledgeResult, PlanResult, RepairResult, RunResult
from hearth.schemas.diagnostics import HearthError
from hearth.version import VERSION
from hearth.web.handler_threads import in_thread
from hearth.web.limits import MOST_BODY, usual_rates
from hearth.web.web_errors import WebError

T = TypeVar("T")

TOOLS = ("home", "observe", "act", "check", "run", "repair", "plan", "knowledge")
"""The tools, in the order in which they are listed."""

INSTRUCTIONS = """A home in which you act by commands in words. Call `home` to begin an episode: it gives your goal,
your observation, and how to write commands. Then call `act` with one command at a time, until `done` is true. `observe`
shows the last observation again. `check`, `run`, `repair` and `plan` are about whole programs, `knowledge` about
objects and actions; an episode does not need them."""

ALONE = "alone"
"""The session of a transport that has one client: standard input and output."""


@dataclass(frozen=True)
class Turn:
    """Your observation after a command, and your progress towards the goal.

    Attributes:
        episode: the name of the episode.
        observation: your goal, the things around you, and commands that make sense now.
        reward: of the last command.
        done: no command can follow.
        won: the goal is reached.
        goal_fraction: the part of the goal that is reached, 0 to 1.
        turn: how many commands were given.
        ticks: how much time has passed.
        fault: why the last command was refused: code, message and remedy.
        instructions: how to write commands; with the first turn alone.
    """

    episode: str
    observation: str
    reward: float
    done: bool
    won: bool
    goal_fraction: float
    turn: int
    ticks: int
    fault: dict[str, str] | None
    instructions: str = ""


class HearthTools:
    """The tools of the server; each public method is one, and its docstring is what clients read.

    Args:
        episodes: of the clients.
        alone: whether the transport has one client.
    """

    def __init__(self, episodes: SessionEpisodes, alone: bool) -> None:
        self._episodes, self._alone = episodes, alone
        self._rates = usual_rates()

    async def home(self, ctx: Context, name: str = "", goal: str = "", seed: int = 0) -> Turn:
        """Begin an episode, in place of the one that you have.

        Give nothing but a seed for a task of the server; or the name of a home (maple, birch, ...) and a goal, such as
        `ON(milk, table)`, `HOLDS(agent, book)` or `INSIDE(apple, fridge)`. Keep `episode` of the answer: give it to
        `observe` and `act` where your client has no session.
        """
        return await self._worked("create", self._begin, self._session(ctx), name, goal, seed)

    async def observe(self, ctx: Context, episode: str = "") -> Turn:
        """See the last observation again: your goal, what is around you, and commands that make sense now."""
        return await self._worked("world", self._observed, self._session(ctx), episode)

    async def act(self, command: str, ctx: Context, episode: str = "") -> Turn:
        """Do one command in the home, such as `Walk kitchen`, `Open fridge 137`, `Grab milk 142`, and see what follows.

        A command that cannot be done is refused: `fault` has the reason and the remedy.
        """
        return await self._worked("world", self._acted, self._session(ctx), episode, command)

    async def check(self, program: str) -> CheckResult:
        """Find the faults of a program: one step a line, `[Walk] <kitchen> (1)`, or a numbered plan in words."""
        return await self._worked("world", programs.check, program)

    async def run(self, program: str, home: str, seed: int = 0) -> RunResult:
        """Run a program in a home as it is, and see the changes of each step, or the step that fails and why."""
        return await self._worked("world", programs.run, program, home, seed)

    async def repair(self, program: str, home: str, seed: int = 0) -> RepairResult:
        """Disturb a home so that a program fails in it, and see how the program is repaired."""
        return await self._worked("world", programs.repair, program, home, seed)

    async def plan(self, home: str, goal: str, seed: int = 0) -> PlanResult:
        """Get commands that reach a goal in a home, from a planner that sees the whole home."""
        return await self._worked("world", programs.plan, home, goal, seed)

    async def knowledge(self, name: str) -> KnowledgeResult:
        """Get the facts about an object (`fridge`) or an action (`Open`): rooms, uses, preconditions, effects."""
        return await self._worked("world", programs.knowledge, name)

    def _session(self, ctx: Context) -> str | None:
        """Return the client's session; None where its transport has none."""
        if self._alone:
            return ALONE
        headers = ctx.headers
        return None if headers is None else headers.get("mcp-session-id")

    async def _worked(self, rate: str, work: Callable[..., T], *given: Any) -> T:
        """Work in a thread, within the limits of a request.

        Raises:
            ToolError: every fault, with its code, its reason and its remedy.
        """
        try:
            self._rates[rate].check("")
            return await in_thread(work, *given)
        except HearthError as error:
            raise ToolError("\n".join(map(str, error.diagnostics[:20]))) from None
        except WebError as error:
            raise ToolError(str(error)) from None

    def _begin(self, session: str | None, home: str, goal: str, seed: int) -> Turn:
        name, instructions, turn = self._episodes.begin(session, home, goal, seed)
        return _shown(name, turn, instructions)

    def _observed(self, session: str | None, name: str) -> Turn:
        with self._episodes.of(session, name) as (found, episode):
            return _shown(found, episode.turn)

    def _acted(self, session: str | None, name: str, command: str) -> Turn:
        with self._episodes.of(session, name) as (found, episode):
            return _shown(found, episode.step(command))


def _shown(name: str, turn: EpisodeTurn, instructions: str = "") -> Turn:
    return Turn(
        name, turn.observation, turn.reward, turn.done, turn.won, turn.goal_fraction, turn.turn, turn.ticks, turn.fault,
        instructions,
    )  # fmt: skip


def mcp_server(
    tasks: str, limit: int, most: int, tools: tuple[str, ...] = TOOLS, *, alone: bool, idle: float = IDLE_SECONDS
) -> Any:
    """Return the server.

    Args:
        tasks: the source of the tasks that `home` draws.
        limit: ticks after which an episode ends.
        most: episodes that may be open at once.
        tools: names of the tools that it has.
        alone: whether it has one client, on standard input and output.
        idle: seconds without a call after which an episode is closed.
    """
    made = MCPServer("hearth", instructions=INSTRUCTIONS, version=VERSION, log_level="WARNING")
    methods = HearthTools(SessionEpisodes(tasks, limit, most, idle), alone)
    for name in TOOLS:
        if name in tools:
            made.add_tool(getattr(methods, name), structured_output=True)
    return made


def http_application(server: Any, most: int) -> ASGIApp:
    """Return the server over HTTP, at `/mcp`; `Host` and `Origin` are checked by the doors before it."""
    return server.streamable_http_app(  # type: ignore[no-any-return]
        streamable_http_path="/mcp",
        json_response=True,
        max_request_body_size=MOST_BODY,
        max_sessions=most,
        session_idle_timeout=IDLE_SECONDS,
        transport_security=TransportSecuritySettings(enable_dns_rebinding_protection=False),
    )
