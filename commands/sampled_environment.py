"""`environment sample`: samples one environment."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn

from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.literals import Literal, Name
from hearth.schemas.numbers import number_of

if TYPE_CHECKING:
    from hearth.grounding.environments.sampling import Size
    from hearth.schemas.goals import Goal
    from hearth.schemas.program import Program
    from hearth.simulation.world.home import Home
    from hearth.simulation.world.world import World

_FORM = "write RELATION(class, class) or STATE(class), with a count if more than one is wanted: ON(plate, table): 3"
_GOAL = re.compile(r"\s*(\w+)\s*\(\s*([\w:]+)\s*(?:,\s*([\w:]+)\s*)?\)\s*(?::\s*(\d+)\s*)?")


class Drawn(NamedTuple):
    """A start, with `objects` and `conditions` of a program, or a `goal` with its progress."""

    world: World
    facts: dict[str, Any]


def draw(program: Program | None, goals: Sequence[str], home: Home, seed: int, nodes: int | None) -> Drawn:
    """An environment for a program, for a goal, or for neither.

    Raises:
        HearthError: both are given, a goal can't be read, or the home has none.
    """
    from hearth.grounding.environments.sampling import Size

    if program is not None and goals:
        _refuse("both a program and a goal are given", "give one of them")
    size = Size() if nodes is None else Size.about(nodes)
    return _for_goal(read(goals), home, seed, size) if program is None else _for_program(program, home, seed, size)


def _for_program(program: Program, home: Home, seed: int, size: Size) -> Drawn:
    from hearth.grounding.environments.sampling import sample

    found = sample(program, home, seed, program.title, size=size)
    if isinstance(found, Failure):
        raise _failed(found)
    environment, _ = found
    objects = {ref.key: ref.node for ref in environment.program.objects()}
    return Drawn(environment.world, {
        "objects": [{"object": f"{name} ({number})", "node": node} for (name, number), node in objects.items()],
        "conditions": [{"step": c.step + 1, "condition": str(c), "needed": c.hard} for c in environment.conditions],
    })  # fmt: skip


def _for_goal(goal: Goal, home: Home, seed: int, size: Size) -> Drawn:
    from hearth.grounding.environments.for_goals import sample_for_goal

    found = sample_for_goal(goal, home, seed, size=size)
    if isinstance(found, Failure):
        raise _failed(found)
    environment, progress = found
    rows = [{"predicate": str(predicate), "wanted": wanted, "met": met}
            for (predicate, wanted), met in zip(goal, progress.counts, strict=True)]  # fmt: skip
    return Drawn(environment.world, {"goal": rows})


def read(goals: Sequence[str]) -> Goal:
    """A goal from text: `ON(plate, kitchen_table): 3`, `CLEAN(stove)`, `HOLDS(agent, book)`.

    Raises:
        HearthError: SYNTAX.
    """
    from hearth.schemas.goals import Goal

    return Goal(tuple(_counted(text) for text in goals))


def _counted(text: str) -> tuple[Literal[Name], int]:
    found = _GOAL.fullmatch(text)
    if found is None:
        _refuse(f"`{text}` is not a goal", _FORM)
    name, subject, target, count = found.groups()
    number = number_of(count or "1")
    if number is None:
        _refuse(f"`{count[:20]}` is not a count", _FORM)
    terms = (subject,) if target is None else (subject, target)
    return Literal(name.upper(), tuple(map(_word, terms))), number


def _word(text: str) -> str | int:
    number = number_of(text)
    return text if number is None else number


def _failed(failure: Failure) -> HearthError:
    hint = "another home, fewer of them, or another goal"
    message = failure.message()
    if not failure.action:
        message = f"{', '.join(failure.names)}: expected {failure.expected}, found {failure.actual}"
    return HearthError(Diagnostic(failure.code, message, suggestion=hint))


def _refuse(message: str, hint: str) -> NoReturn:
    raise HearthError.of(Code.SYNTAX, message, suggestion=hint)
