"""`play`: an episode in a home, by people, programs in any language, or nobody."""

from __future__ import annotations

import sys
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import typer

from hearth.commands import output
from hearth.commands.inputs import read_goals, read_home, read_knowledge
from hearth.commands.shared_options import LanguageOptions
from hearth.commands.time_limits import ANSWER_WITHIN
from hearth.schemas.terminal import shown_line

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from hearth.agents.protocol import Agent
    from hearth.challenges.agent_channels import Channel
    from hearth.challenges.episode_loop import Played
    from hearth.llm.language_settings import Asking, Means
    from hearth.schemas.goals import Goal
    from hearth.simulation.rules import Rules
    from hearth.simulation.world.world import World

TEXT, WAIT, LISTEN, STDIO = "text", "wait", "listen", "stdio"
"""Agents that are not commands: the terminal, none, a program that connects to a port, and this command's parent."""


def play(
    home: str = "",
    goal: list[str] | None = None,
    task: str = "",
    agent: list[str] | None = None,
    text: bool = False,
    actions: str = "",
    full: bool = False,
    messages: bool = False,
    images: bool = False,
    models: LanguageOptions = LanguageOptions(),
    ticks: int = 250,
    within: float = ANSWER_WITHIN,
    form: str = "graph",
    graph: Path | None = None,
    homes: Path | None = None,
    kb: Path | None = None,
    seed: int = 0,
    out: Path | None = None,
    transcript: Path | None = None,
    as_json: bool = False,
) -> None:
    """Play an episode in a home until a goal is reached, with agents of any kind.

    An agent is a command that reads and writes lines of JSON, `text` (you, at this terminal: `help`), `listen` or
    `listen:PORT` (a program that connects to that port of this machine), `stdio` (the program that runs this command),
    a language model (llm:MODEL@URL), or `wait`. Agents that are not named wait. docs/examples/agents.md describes the
    messages. The status is 1 if the goal is not reached.

    \b
    Examples:
      hearth play maple --goal "HOLDS(agent, milk)" --text
      hearth play maple --goal "HOLDS(agent, milk)" --agent 0="node docs/examples/agent.js" --out episode.jsonl
      hearth play maple --goal "HOLDS(agent, milk)" --agent 0=llm:smollm2
      hearth play --task household-train-00001 --text
      hearth replay episode.jsonl
    """
    seats = _seats([*([f"0={TEXT}"] if text else []), *(agent or ())])
    quiet = _is_quiet(seats, as_json)
    if form not in FORMS:
        raise typer.BadParameter(f"`{form[:60]}` is not a form: {', '.join(FORMS)}")
    asked = _asked(models, seats, out, within, images)
    known = read_knowledge(kb)
    scene = (
        _task_scene(task, home, goal, known) if task else _home_scene(home, goal, graph, homes, known, len(seats), seed)
    )
    if scene.instruction and not quiet:
        output.note(f"{task}: {scene.instruction}")
    with ExitStack() as stack:
        how = _How(ticks, within, form, messages, asked, as_json, _transcript(transcript, stack), scene.instruction)
        playing = [_agent(seat, how, stack) for seat in seats]
        played = _play(scene, playing, seed, how, _actions(actions or scene.actions, known), not full)
        for each in playing:
            if (end := getattr(each, "end", None)) is not None:
                end(played.success, played.ticks)
    if out is not None:
        _write(out, played)
    if not quiet:
        _print(_result(scene.home, played, seats, playing, out), as_json)
    output.status(not played.success, strict=True)


class _Seat(NamedTuple):
    """An agent as the command line names it."""

    number: int
    spec: str


class _How(NamedTuple):
    """The settings that all agents share."""

    ticks: int
    within: float
    form: str
    messages: bool
    asked: tuple[Asking, Means] | None
    as_json: bool
    keep: Callable[[Mapping[str, Any]], None]
    instruction: str = ""


PLAYED = "played"
"""The group of the actions of challenges."""

MODEL = "llm:"
"""The beginning of a language model's name."""

MOST_AGENTS = 16

FORMS = {"graph": ("graph",), "text": ("text",), "both": ("graph", "text")}
"""The values of `--form`, and the parts of an observation that programs are then sent."""


def _seats(given: list[str]) -> list[_Seat]:
    """Return the agents by number; those between that are not named wait."""
    found: dict[int, str] = {}
    for each in given:
        number, equals, spec = each.partition("=")
        if not (equals and number.isdecimal() and int(number) < MOST_AGENTS and spec.strip()):
            raise typer.BadParameter(f"`{each[:60]}` is not N=AGENT, as in 0=text; N is below {MOST_AGENTS}")
        if int(number) in found:
            raise typer.BadParameter(f"agent {int(number)} is given twice")
        found[int(number)] = spec.strip()
    for one in (TEXT, STDIO):
        if list(found.values()).count(one) > 1:
            raise typer.BadParameter(f"there is one terminal: only one agent can be `{one}`")
    return [_Seat(number, found.get(number, WAIT)) for number in range(max(found, default=0) + 1)]


def _is_quiet(seats: list[_Seat], as_json: bool) -> bool:
    """Return whether an agent has the standard output to itself.

    Raises:
        typer.BadParameter: it has, and something else is to be printed there.
    """
    specs = {seat.spec for seat in seats}
    if STDIO in specs and (as_json or TEXT in specs):
        raise typer.BadParameter("`stdio` has the standard output to itself: leave out --json and `text`")
    return STDIO in specs


def _agent(seat: _Seat, how: _How, stack: ExitStack) -> Agent:
    from hearth.challenges.wire_protocol import WireAgent
    from hearth.envs.terminal_agent import TerminalAgent

    if seat.spec == TEXT:
        return TerminalAgent(_asked_at_terminal(how.as_json), how.keep, how.messages, how.instruction)
    if seat.spec == WAIT:
        return Waiting()
    if seat.spec.startswith(MODEL):
        return _model(seat, how)
    return WireAgent(_channel(seat, how, stack), how.within, FORMS[how.form], how.ticks, how.keep, how.messages)


def _asked(
    models: LanguageOptions, seats: list[_Seat], out: Path | None, within: float, images: bool
) -> tuple[Asking, Means] | None:
    """Return what language models are asked, and the means; None where none plays. A request may take `within`."""
    from dataclasses import replace

    from hearth.challenges.language_agents import need_models

    names = [seat.spec for seat in seats if seat.spec.startswith(MODEL)]
    need_models(names, "local", given=models.given or images)
    if not names:
        return None
    asking, means = models.settings(out, names, *(["images"] if images else ()))
    its_own = any(each.startswith("seconds=") for each in models.llm or ())
    return asking, means if its_own else replace(means, seconds=within)


def _model(seat: _Seat, how: _How) -> Agent:
    """Return an agent that a language model decides for: the first acts, the second helps."""
    from hearth.challenges.language_agents import need_model, player_of

    if seat.number > 1:
        raise typer.BadParameter(f"agent {seat.number} is a language model; only agents 0 and 1 can be")
    need_model(seat.spec)
    assert how.asked is not None
    instruction = "" if seat.number else how.instruction
    return player_of(seat.spec, *how.asked, instruction, how.messages, seat.number)


class Waiting:
    """An agent that does nothing."""

    def reset(self, *_: object) -> None:
        """Begin an episode."""

    def act(self, *_: object) -> None:
        """Wait."""


def _channel(seat: _Seat, how: _How, stack: ExitStack) -> Channel:
    import shlex

    from hearth.challenges.agent_channels import Listener, ProcessChannel, StandardChannel

    if seat.spec == STDIO:
        return StandardChannel()
    kind, _, port = seat.spec.partition(":")
    if kind == LISTEN and (port.isdecimal() or seat.spec == LISTEN):
        listener = Listener(int(port or 0))
        stack.callback(listener.close)
        output.note(f"Agent {seat.number}: waiting for a connection to 127.0.0.1:{listener.port}")
        channel: Channel = listener.accept(max(60.0, how.within))
    else:
        try:
            argv = shlex.split(seat.spec)
        except ValueError as error:
            raise typer.BadParameter(f"the command of agent {seat.number} can't be read: {error}") from None
        channel = ProcessChannel(argv)
    stack.callback(channel.close)
    return channel


def _asked_at_terminal(as_json: bool) -> Callable[[str], str]:
    def ask(prompt: str) -> str:
        stream = sys.stderr if as_json else sys.stdout
        output.line(f"{prompt}> ", end="", file=stream, flush=True)
        line = sys.stdin.readline()
        if not line:
            raise EOFError
        return line

    return ask


def _transcript(path: Path | None, stack: ExitStack) -> Callable[[Mapping[str, Any]], None]:
    from hearth.envs.agent_answers import keep_nothing

    if path is None:
        return keep_nothing
    import orjson

    file = stack.enter_context(path.open("wb"))

    def keep(row: Mapping[str, Any]) -> None:
        file.write(shown_line(orjson.dumps(row, option=orjson.OPT_APPEND_NEWLINE)))
        file.flush()

    return keep


def _actions(given: str, known: Any) -> list[str] | None:
    if not given:
        return None
    found: list[str] = []
    for name in map(str.strip, given.split(",")):
        action = known.action(name)
        if action is None and name != PLAYED:
            raise typer.BadParameter(f"no action is called `{name[:60]}`")
        found += known.group(PLAYED) if action is None else [action.name]
    return found


def _play(scene: _Scene, agents: list[Agent], seed: int, how: _How, actions: list[str] | None, partial: bool) -> Played:
    from hearth.challenges.episode_loop import Player
    from hearth.challenges.episode_loop import play as run

    return run(
        scene.world,
        scene.goal,
        [Player(agent, scene.goal) for agent in agents],
        seed,
        actions=actions,
        partial=partial,
        limit=how.ticks,
        rules=scene.rules,
        messages=how.messages,
    )


class _Scene(NamedTuple):
    """The start of an episode.

    Attributes:
        home: its name.
        world: in which it starts.
        goal: that ends it.
        rules: of actions.
        actions: the allowed ones, as `--actions` names them; "" for all.
        instruction: of a task.
    """

    home: str
    world: World
    goal: Goal
    rules: Rules
    actions: str = ""
    instruction: str = ""


def _home_scene(
    home: str, goal: list[str] | None, graph: Path | None, homes: Path | None, known: Any, agents: int, seed: int
) -> _Scene:
    """Return a home as it is, and the goals of the command line."""
    from hearth.envs.session import need_something_to_do
    from hearth.simulation.env import Env
    from hearth.simulation.rules import DEFAULT

    if not (home or graph) or not goal:
        raise typer.BadParameter("name a home and a --goal, or a --task")
    place = read_home(home, graph, homes, known)
    wanted = read_goals(goal, place)
    need_something_to_do(wanted)
    env = Env()
    env.reset(place, agents, seed)
    return _Scene(home, env.world, wanted, DEFAULT)


def _task_scene(task_id: str, home: str, goal: list[str] | None, known: Any) -> _Scene:
    """Return the start of a task of `household`."""
    from hearth.challenges.household import household_task
    from hearth.challenges.household_definition import RULES

    if home or goal:
        raise typer.BadParameter("a task has its home and its goal: leave out HOME and --goal")
    task = household_task(task_id, knowledge=known)
    return _Scene(task.home, task.start(known), task.goal, RULES, PLAYED, task.instruction)


def _write(out: Path, played: Played) -> None:
    from hearth.simulation.episode import Episode
    from hearth.simulation.episode_files import write

    write(out, [Episode.of(played.env, played.said)])


def _result(home: str, played: Played, seats: list[_Seat], agents: list[Agent], out: Path | None) -> dict[str, Any]:
    last = played.progress[-1]
    return {
        "home": home,
        "reached": played.success,
        "fraction": last.fraction,
        "unmet": str(last.unmet()),
        "lost": [str(part) for part, lost in zip(last.goal.parts, last.lost, strict=False) if lost],
        "ticks": played.ticks,
        "agents": [
            {"agent": seat.number, "is": seat.spec, "faults": [f.as_json() for f in getattr(agent, "faults", ())]}
            for seat, agent in zip(seats, agents, strict=True)
        ],
        "file": out,
    }


def _print(result: dict[str, Any], as_json: bool) -> None:
    if as_json:
        output.emit(result)
        return
    ticks = output.counted(result["ticks"], "tick")
    output.line(f"Goal: {'reached' if result['reached'] else 'not reached'} after {ticks}.")
    if not result["reached"]:
        output.line(f"Unmet: {output.shown(result['unmet'])}.")
    for part in result["lost"]:
        output.line(f"Broken, so that the goal could not be reached any longer: {output.shown(part)}.")
    faults = [{"agent": each["agent"], **fault} for each in result["agents"] for fault in each["faults"]]
    output.records(faults[:20], "Answers that could not be used:")
    if faults[20:]:
        output.line(f"... and {len(faults) - 20} more; --json has all")
