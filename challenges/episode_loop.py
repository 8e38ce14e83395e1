"""An episode played by agents: each is asked once a tick, until the goal is reached or the time is over."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from hearth.agents.protocol import Agent, Choice, Resigned
from hearth.challenges.agent_guard import AgentError
from hearth.envs.session import MOST_TICKS
from hearth.schemas.agent_messages import Message
from hearth.schemas.goals import Goal
from hearth.schemas.rng import derive
from hearth.simulation.actions.legal import Legal
from hearth.simulation.env import Env, Tick
from hearth.simulation.goals import Progress
from hearth.simulation.observation.views import View
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.world import World


@dataclass(frozen=True, slots=True)
class Player:
    """An agent in an episode.

    Attributes:
        agent: the agent that decides.
        goal: the goal it is asked to reach; None if it has none.
        partial: whether it sees only the area around it; as the episode has it where None.
    """

    agent: Agent
    goal: Goal | None
    partial: bool | None = None


@dataclass(frozen=True, slots=True)
class Played:
    """An episode as it was played.

    Attributes:
        env: with its ticks.
        progress: of the goal in the real world, at the start and after each tick.
        fault: why an agent could not go on, which ended the episode; None where all could.
        said: the messages of each tick, by number.
    """

    env: Env
    progress: tuple[Progress, ...]
    fault: AgentError | None = None
    said: tuple[Mapping[int, Message], ...] = ()

    @property
    def success(self) -> bool:
        """Return whether the goal was reached."""
        return self.progress[-1].satisfied

    @property
    def ticks(self) -> int:
        """Return how long it took."""
        return len(self.env.ticks)


class Playing:
    """An episode under way: each player's view, tick by tick, and whether it is over.

    Attributes:
        env: with its ticks.
        progress: of the goal in the real world, at the start and after each tick.
        said: the messages of each tick, by number.

    Args:
        start: a world in which character n belongs to player n.
        goal: the goal that ends the episode.
        actions: the allowed actions; all where None.
        partial: for each player, whether it sees only the area around it.
        limit: ticks after which it ends.
        rules: of actions.
        messages: whether agents may say something instead of doing something; it is dropped otherwise.
    """

    def __init__(
        self,
        start: World,
        goal: Goal,
        partial: Sequence[bool],
        *,
        actions: Iterable[str] | None = None,
        limit: int = MOST_TICKS,
        rules: Rules = DEFAULT,
        messages: bool = False,
    ) -> None:
        self.env = Env(rules)
        self.env.restore(start)
        self.progress = [Progress.start(goal, start)]
        self.limit = limit
        self.said: list[Mapping[int, Message]] = []
        self._messages = messages
        self._partial = tuple(partial)
        self._allowed = None if actions is None else frozenset(actions)

    @property
    def over(self) -> bool:
        """Return whether the goal is reached or the time is over."""
        return self.progress[-1].satisfied or len(self.env.ticks) >= self.limit

    def view(self, number: int) -> View:
        """Return a player's current observation."""
        self.env.partial = self._partial[number]
        seen = self.env.observe(number)
        last = self.said[-1] if self.said else {}
        return replace(seen, messages=tuple((n, said) for n, said in last.items() if n != number)) if last else seen

    def legal(self, number: int) -> Legal:
        """Return a player's currently legal actions."""
        self.env.partial = self._partial[number]
        return self.env.legal(number, actions=self._allowed)

    def step(self, chosen: Mapping[int, Choice]) -> Tick:
        """Let each player do one instruction (see `Env.step`), or say something."""
        said = {number: each for number, each in chosen.items() if isinstance(each, Message)}
        done = self.env.step({n: each for n, each in chosen.items() if not isinstance(each, Message)})
        self.said.append(said if self._messages else {})
        tried = [step for number, step in done.instructions.items() if number not in done.failures]
        self.progress.append(self.progress[-1].then(done.before, done.world, tried))
        return done


def play(
    start: World,
    goal: Goal,
    players: Sequence[Player],
    seed: int,
    *,
    actions: Iterable[str] | None = None,
    partial: bool = True,
    limit: int = MOST_TICKS,
    rules: Rules = DEFAULT,
    messages: bool = False,
) -> Played:
    """Let agents act in a world, one instruction each a tick, until a goal is reached or an agent ends it.

    Args:
        start: a world in which character n belongs to player n.
        goal: the goal that ends the episode; progress is counted in the real world only.
        players: the agents that act.
        seed: of the episode; each agent gets one derived from it.
        actions: the allowed actions; all where None.
        partial: whether agents see only the area around them.
        limit: ticks after which it ends.
        rules: of actions.
        messages: whether agents may say something instead of doing something.
    """
    seen = [partial if player.partial is None else player.partial for player in players]
    playing = Playing(start, goal, seen, actions=actions, limit=limit, rules=rules, messages=messages)
    fault = None
    try:
        for number, player in enumerate(players):
            player.agent.reset(playing.view(number), player.goal, derive(seed, "agent", number))
        while not playing.over:
            turns = enumerate(players)
            playing.step(
                {number: player.agent.act(playing.view(number), playing.legal(number)) for number, player in turns}
            )
    except AgentError as found:
        fault = found
    except Resigned:
        pass
    return Played(playing.env, tuple(playing.progress), fault, tuple(playing.said))
