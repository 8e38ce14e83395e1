"""`environment sample`: samples one environment."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from hearth.commands.inputs import read_goals
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failure_words import in_program, sentence
from hearth.schemas.failures import Code, Failure

if TYPE_CHECKING:
    from hearth.grounding.environments.sampling import Size
    from hearth.schemas.goals import Goal
    from hearth.schemas.program import Program
    from hearth.simulation.world.home import Home
    from hearth.simulation.world.world import World


class Drawn(NamedTuple):
    """A start, with `objects` and `conditions` of a program, or a `goal` with its progress."""

    world: World
    facts: dict[str, Any]


def draw(program: Program | None, goals: Sequence[str], home: Home, seed: int, nodes: int | None) -> Drawn:
    """Return an environment for a program, for a goal, or for neither.

    Raises:
        HearthError: both are given, a goal can't be read, or the home has none.
    """
    from hearth.grounding.environments.sampling import Size

    if program is not None and goals:
        raise HearthError.of(Code.SYNTAX, "both a program and a goal are given", suggestion="give one of them")
    size = Size() if nodes is None else Size.about(nodes)
    if program is not None:
        return _for_program(program, home, seed, size)
    return _for_goal(read_goals(goals, home), home, seed, size)


def _for_program(program: Program, home: Home, seed: int, size: Size) -> Drawn:
    from hearth.grounding.environments.sampling import sample

    found = sample(program, home, seed, program.title, size=size)
    if isinstance(found, Failure):
        raise _failed(found, in_program(found, program, code=False))
    environment, _ = found
    objects = {ref.key: ref.node for ref in environment.program.objects()}
    return Drawn(environment.world, {
        "objects": [{"object": f"{name} ({number})", "node": node} for (name, number), node in objects.items()],
        "conditions": [{"step": c.step + 1, "condition": str(c), "needed": c.hard} for c in environment.conditions],
    })  # fmt: skip


def _for_goal(goal: Goal, home: Home, seed: int, size: Size) -> Drawn:
    from hearth.grounding.environments.goal_environments import sample_for_goal

    found = sample_for_goal(goal, home, seed, size=size)
    if isinstance(found, Failure):
        raise _failed(found, sentence(found, code=False))
    environment, progress = found
    rows = [{"predicate": str(predicate), "wanted": wanted, "met": met}
            for (predicate, wanted), met in zip(goal, progress.counts, strict=True)]  # fmt: skip
    rows += [{"predicate": str(part), "wanted": 1, "met": int(has)}
             for part, has in zip(goal.parts, progress.has, strict=True)]  # fmt: skip
    return Drawn(environment.world, {"goal": rows})


def _failed(failure: Failure, message: str) -> HearthError:
    hint = "another home, fewer of them, or another goal"
    return HearthError(Diagnostic(failure.code, message, suggestion=hint))
