"""From the clips of a film to a program: by what each clip looks like alone, or with the engine as transition model.

With the engine the question is which instruction that can be done now explains what is seen: every program that is
followed runs, because each step was done in the world that the steps before it made.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hearth.grounding.binding import nearest
from hearth.models.films.clip_data import Instruction
from hearth.models.interface import Steps
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.simulation.engine import act
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.world import World

Scores = NDArray[np.float32]
"""(N, I) logarithms of how probable each of I instructions is in each of a film's N clips, in order."""

CHANGE = 4.0
"""What it costs, as a logarithm, to take a clip for another instruction than the clip before."""

UNEXPLAINED = 8.0
"""What it costs to leave a clip unexplained, below the best that can be said of it."""


@dataclass(frozen=True, slots=True)
class Filter:
    """How programs are followed through a film.

    Attributes:
        beam: programs at a time.
        options: instructions that each of them may go on with in a clip.
        change: see `CHANGE`.
    """

    beam: int = 8
    options: int = 8
    change: float = CHANGE


@dataclass(frozen=True, slots=True)
class _Followed:
    score: float
    world: World
    steps: Steps
    last: int
    """Number of the instruction that is being done; -1 before the first."""


def described(scores: Scores, instructions: Sequence[Instruction], change: float = CHANGE) -> Steps:
    """The most probable sequence of instructions, each once for the clips in a row that it explains; no home is needed.

    Args:
        scores: of the clips.
        instructions: by number.
        change: see `CHANGE`.
    """
    if not len(scores):
        return ()
    logs = _normalised(scores)
    best, back = logs[0], []
    for row in logs[1:]:
        before = int(best.argmax())
        stays = best >= best[before] - change
        back.append(np.where(stays, np.arange(len(best)), before))
        best = row + np.where(stays, best, best[before] - change)
    path = [int(best.argmax())]
    for row in reversed(back):
        path.append(int(row[path[-1]]))
    path.reverse()
    kept = [number for place, number in enumerate(path) if place == 0 or number != path[place - 1]]
    return tuple(_step(instructions[number]) for number in kept)


def followed(
    scores: Scores,
    instructions: Sequence[Instruction],
    world: World,
    how: Filter = Filter(),
    rules: Rules = DEFAULT,
) -> Steps:
    """The program that explains a film best among those that run in the world in which it begins.

    In each clip a program goes on with its last instruction, or with another one that can be done then; objects are
    the nearest of their class.

    Args:
        scores: of the clips.
        instructions: by number.
        world: at the film's start.
        how: the search.
        rules: of the engine.
    """
    beam = [_Followed(0.0, world, (), -1)]
    for row in _normalised(scores):
        options = np.argsort(-row, kind="stable")[: how.options].tolist()
        found = [each for one in beam for each in _going_on(one, row, options, instructions, how, rules)]
        best: dict[Steps, _Followed] = {}
        for each in found:
            if each.steps not in best or best[each.steps].score < each.score:
                best[each.steps] = each
        beam = sorted(best.values(), key=lambda each: -each.score)[: how.beam]
    return beam[0].steps


def _going_on(
    one: _Followed, row: Scores, options: Sequence[int], instructions: Sequence[Instruction], how: Filter, rules: Rules
) -> list[_Followed]:
    """The ways in which a program explains one more clip."""
    unexplained = float(row.max()) - UNEXPLAINED
    staying = float(row[one.last]) if one.last >= 0 else unexplained
    found = [_Followed(one.score + max(staying, unexplained), one.world, one.steps, one.last)]
    for number in options:
        if number == one.last:
            continue
        program = Program(steps=(_step(instructions[number]),))
        (step,) = nearest(program, one.world).apply(program).steps
        if any(ref.node is None for ref in step.objects):
            continue
        after = act(one.world, step, rules)
        if isinstance(after, World):
            score = one.score + float(row[number]) - how.change
            found.append(_Followed(score, after, (*one.steps, step), number))
    return found


def _step(done: Instruction) -> Step:
    return Step(done.action, tuple(ObjectRef(name) for name in done.objects))


def _normalised(scores: Scores) -> Scores:
    """Logarithms of probabilities over the instructions."""
    high = scores.max(1, keepdims=True)
    found: Scores = scores - high - np.log(np.exp(scores - high).sum(1, keepdims=True))
    return found
