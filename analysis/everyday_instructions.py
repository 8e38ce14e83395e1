"""Everyday instructions with goals: how many a model reaches, in homes in which they do not hold at the start.

A row has an `instruction`, `wordings` of the same, `homes` in which it can be done, and a `goal` (see
`simulation.goal_text`). Each is asked in three of its homes, by action set 3. So that doing nothing does not win,
the goal is undone in the home first: a door that is to be closed is opened, and a thing that is to lie somewhere is
moved.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

from hearth.challenges.household_definition import home_named
from hearth.challenges.household_starts import undone
from hearth.grounding.environments.default_state import Base, prepared
from hearth.kb.action_sets import LATEST
from hearth.kb.loading.load import default
from hearth.models.prediction_stages import show_reading, show_text
from hearth.models.protocols import Trained
from hearth.models.reading.program_writing import repeats
from hearth.models.reading.reader import Reader
from hearth.schemas.goals import Goal
from hearth.schemas.literals import AGENT, Literal, Name
from hearth.schemas.program import Program
from hearth.schemas.rng import rng
from hearth.schemas.vocabulary import OPPOSITE
from hearth.simulation.engine import Execution, run
from hearth.simulation.goal_text import read_goal
from hearth.simulation.goal_trace import acts
from hearth.simulation.goals import Progress
from hearth.simulation.rules import CONSEQUENCES
from hearth.simulation.world.edit import edit
from hearth.simulation.world.world import World

HOMES = 3
"""Homes in which an instruction is tried."""

ANY = ("birch", "maple", "willow")
"""Homes for instructions that none can do."""


class Row(NamedTuple):
    """An instruction.

    Attributes:
        id: unique.
        instruction: as a person says it.
        wordings: the same in other words.
        homes: in which it can be done.
        goal: as text; "" where no home can do it.
    """

    id: str
    instruction: str
    wordings: tuple[str, ...]
    homes: tuple[str, ...]
    goal: str


class Tried(NamedTuple):
    """An instruction in a home.

    Attributes:
        row: the instruction.
        text: its words.
        home: where.
        steps: of the program.
        reached: whether the goal holds at the end.
        runs: whether there is a program that runs.
        repeats: whether it repeats itself.
        held: whether the goal held at the start.
        seconds: that the answer took.
        note: why there is no program.
    """

    row: Row
    text: str
    home: str
    steps: tuple[str, ...]
    reached: bool
    runs: bool
    repeats: bool
    held: bool
    seconds: float
    note: str = ""


def rows_of(path: Path) -> list[Row]:
    """Return the instructions of a file of JSON lines."""
    found = []
    for line in path.read_text(encoding="utf-8").splitlines():
        given: dict[str, Any] = json.loads(line)
        found.append(
            Row(given["id"], given["instruction"], tuple(given.get("wordings") or ()), tuple(given["homes"] or ANY),
                given.get("goal") or "")
        )  # fmt: skip
    return found


def start_without(goal: Goal, home: str, seed: str) -> World:
    """Return a home in action set 3 in which as little of a goal holds as can be."""
    base = prepared(home_named(home, default().of_set(LATEST)))
    world = base.start
    chooser = rng(0, "everyday", seed, home)
    facts = dict.fromkeys(each for each in _facts(goal, world) if not _is_undone_by(each, goal, world))
    wanted = Goal(tuple((literal, 1) for literal in facts))
    for literal, _ in wanted:
        world = _without(world, base, literal, wanted, chooser)
    return world


def _is_undone_by(fact: Literal[Name], goal: Goal, world: World) -> bool:
    """Return whether a goal wants an act that ends a state, too: what is opened and closed is closed at the start."""
    known = world.home.knowledge
    for literal, _ in goal.literals():
        made = known.state_of(literal.name) if acts(literal, world.home) else literal.name
        if literal.terms == fact.terms and made and OPPOSITE.get(fact.name) == made:
            return True
    return False


def _facts(goal: Goal, world: World) -> Iterator[Literal[Name]]:
    """Yield the states and relations that a goal wants; none that it wants not to be, and none of variables."""
    for literal, _ in goal:
        is_fact = not literal.negated and not acts(literal, world.home)
        if is_fact and not any(str(term).startswith("?") for term in literal.terms):
            yield literal
    for part in goal.parts:
        if part.join != "not":
            for inner in part.goals:
                yield from _facts(inner, world)


def _without(world: World, base: Base, literal: Literal[Name], goal: Goal, chooser: Any) -> World:
    if AGENT in literal.terms:
        return _elsewhere(world, literal) if literal.name == "INSIDE" else world
    try:
        found = undone(world, base, literal, goal, chooser)
    except KeyError:  # a state without an opposite, which nothing has at the start
        return world
    return found if found is not None else world


def _elsewhere(world: World, literal: Literal[Name]) -> World:
    """Return the world with its agent in another room than the goal wants."""
    if not Progress.at(Goal.of(literal), world).satisfied:
        return world
    home = world.home
    rooms = [home.ids[i] for i in range(len(home)) if home.rooms >> i & 1 and home.classes[i] != literal.terms[1]]
    moved = edit(world, place={home.ids[world.agents[0].index]: ("INSIDE", rooms[0])}, check=False) if rooms else world
    return moved if isinstance(moved, World) else world


Asked = Callable[[str, World], tuple[Execution | None, str]]
"""An answer to a text in a world: its run, and why there is none."""


def asking(trained: Trained) -> Asked:
    """Return how a model answers a text in a world."""

    def asked(text: str, world: World) -> tuple[Execution | None, str]:
        shown = show_reading(trained, text, world) if isinstance(trained, Reader) else show_text(trained, text, world)
        execution = shown.completion.execution
        if shown.failure is not None or not execution.program.steps:
            return None, shown.failure.message() if shown.failure else ""
        return execution, "; ".join(shown.unread)

    return asked


def tried(row: Row, text: str, home: str, asked: Asked) -> Tried:
    """Return how an instruction goes in a home."""
    from hearth.schemas.syntax import print_step

    known = home_named(home, default().of_set(LATEST))
    goal = read_goal(row.goal, known) if row.goal else Goal()
    world = start_without(goal, home, row.id)
    held = bool(row.goal) and Progress.of(goal, run(world, Program(steps=()), CONSEQUENCES)).satisfied
    start = perf_counter()
    execution, note = asked(text, world)
    seconds = perf_counter() - start
    if execution is None:
        return Tried(row, text, home, (), False, False, False, held, seconds, note)
    steps = execution.program.steps
    reached = bool(row.goal) and Progress.of(goal, run(world, execution.program, CONSEQUENCES)).satisfied
    printed = tuple(map(print_step, steps))
    return Tried(row, text, home, printed, reached, execution.executable, repeats(steps), held, seconds, note)


def homes_for(row: Row, seed: int = 0) -> tuple[str, ...]:
    """Return the homes in which an instruction is tried."""
    chosen = rng(seed, "everyday homes", row.id).sample(row.homes, min(HOMES, len(row.homes)))
    return tuple(sorted(chosen))


class Figures(NamedTuple):
    """The figures of some instructions; shares are from 0 to 1.

    Attributes:
        asked: instructions.
        tried: pairs of instruction and home.
        reached: share of the pairs in which the goal is reached.
        reached_everywhere: share of the instructions reached in all of their homes.
        runs: share of the pairs with a program that runs.
        repeats: pairs whose program repeats itself.
        held: pairs in which the goal held at the start.
        reached_by_nothing: share of the pairs that doing nothing reaches.
        milliseconds: the median of an answer.
        slowest: milliseconds of the slowest answer but one in a hundred.
    """

    asked: int
    tried: int
    reached: float
    reached_everywhere: float
    runs: float
    repeats: int
    held: int
    reached_by_nothing: float
    milliseconds: float
    slowest: float


def figures(found: Sequence[Tried]) -> Figures:
    """Return the figures of some tries."""
    texts: dict[str, list[bool]] = {}
    for each in found:
        texts.setdefault(each.text, []).append(each.reached)
    times = sorted(each.seconds * 1000 for each in found)
    number = max(len(found), 1)
    held = sum(each.held for each in found)
    return Figures(
        len(texts), len(found), sum(each.reached for each in found) / number,
        sum(map(all, texts.values())) / max(len(texts), 1), sum(each.runs for each in found) / number,
        sum(each.repeats for each in found), held, held / number, times[len(times) // 2],
        times[(len(times) * 99) // 100],
    )  # fmt: skip
