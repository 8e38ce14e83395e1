"""The program of a film from its clips: by each clip alone, or with the engine as transition model.

With the engine, each clip gets the possible instruction that best explains it. Every program that is followed runs,
because each step was done in the world that the steps before it made.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.grounding.binding import nearest
from hearth.models.films.clip_data import Instruction
from hearth.models.interface import Steps
from hearth.repair.runnable_predictions import complete
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.simulation.engine import act
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.world import World

Scores = NDArray[np.float32]
"""(N, I) logarithms of how probable each of I instructions is in each of a film's N clips, in order."""

CHANGE = 4.0
"""Cost of predicting another instruction than in the clip before, as a logarithm.

It applies where the order of steps is not known.
"""

UNEXPLAINED = 8.0
"""Cost of leaving a clip unexplained, as a logarithm below the clip's best score."""


class FilmProgram(NamedTuple):
    """The program of a film.

    Attributes:
        steps: in order.
        starts: the number of the clip in which each begins.
    """

    steps: Steps
    starts: tuple[int, ...]


MOST_INSERTED = 3
"""Steps that are inserted before one that could not be done."""

NO_STEPS = FilmProgram((), ())

Moves = NDArray[np.float32]
"""(I + 1, I) costs of going from an instruction to another one; the last row is for the first step."""


@dataclass(frozen=True, slots=True)
class Filter:
    """Settings for following programs through a film.

    Attributes:
        beam: worlds at a time, each with its best program.
        options: instructions that each of them may go on with in a clip.
        repaired: of those options, the first ones may be repaired where they can't be done: steps are inserted.
        inserted: cost of an inserted step, as a logarithm.
    """

    beam: int = 48
    options: int = 24
    repaired: int = 6
    inserted: float = 3.0


def even_moves(count: int, change: float = CHANGE) -> Moves:
    """Return the same cost for every change of `count` instructions; the first is free."""
    moves = np.full((count + 1, count), change, np.float32)
    moves[-1] = 0
    return moves


@dataclass(frozen=True, slots=True)
class _Followed:
    score: float
    world: World
    steps: Steps
    starts: tuple[int, ...]
    last: int
    """Number of the instruction that is being done; -1 before the first."""


def alone(scores: Scores, instructions: Sequence[Instruction]) -> FilmProgram:
    """Return the instruction predicted from each clip alone; a row of clips with the same instruction is one step."""
    return _merged(scores.argmax(1).tolist(), instructions) if len(scores) else NO_STEPS


def described(scores: Scores, instructions: Sequence[Instruction], moves: Moves | None = None) -> FilmProgram:
    """Return the most probable sequence of instructions, each once for the clips in a row that it explains.

    No home is needed.

    Args:
        scores: of the clips.
        instructions: by number.
        moves: costs of changes; by default all the same.
    """
    if not len(scores):
        return NO_STEPS
    logs, costs = _normalised(scores), even_moves(len(instructions)) if moves is None else moves
    change = costs[:-1].copy()
    np.fill_diagonal(change, 0)
    best, back = logs[0] - costs[-1], []
    for row in logs[1:]:
        found = best[:, None] - change  # (I, I) from, to
        back.append(found.argmax(0))
        best = row + found.max(0)
    path = [int(best.argmax())]
    for before in reversed(back):
        path.append(int(before[path[-1]]))
    return _merged(path[::-1], instructions)


def _merged(path: Sequence[int], instructions: Sequence[Instruction]) -> FilmProgram:
    starts = [place for place, number in enumerate(path) if place == 0 or number != path[place - 1]]
    return FilmProgram(tuple(_step(instructions[path[place]]) for place in starts), tuple(starts))


def followed(
    scores: Scores,
    instructions: Sequence[Instruction],
    world: World,
    moves: Moves | None = None,
    how: Filter = Filter(),
    rules: Rules = DEFAULT,
) -> FilmProgram:
    """Return the program that explains a film best among those that run in the world in which it begins.

    In each clip a program goes on with its last instruction, or with another one that can be done then, or after steps
    that a repair inserts; objects are the nearest of their class. Of programs that have come to the same world by the
    same instruction the best is kept.

    Args:
        scores: of the clips.
        instructions: by number.
        world: at the film's start.
        moves: costs of changes; by default all the same.
        how: the search.
        rules: of the engine.
    """
    search = _Search(instructions, even_moves(len(instructions)) if moves is None else moves, how, rules)
    beam = [_Followed(0.0, world, (), (), -1)]
    for place, row in enumerate(_normalised(scores)):
        best: dict[tuple[World, int], _Followed] = {}
        for one in beam:
            for each in search.going_on(one, row, place):
                known = best.get((each.world, each.last))
                if known is None or known.score < each.score:
                    best[each.world, each.last] = each
        beam = sorted(best.values(), key=lambda each: -each.score)[: how.beam]
    return FilmProgram(beam[0].steps, beam[0].starts)


class _Search:
    """The search over continuations of programs; the effect of an instruction in a world is computed once."""

    def __init__(self, instructions: Sequence[Instruction], moves: Moves, how: Filter, rules: Rules) -> None:
        self.instructions, self.moves, self.how, self.rules = instructions, moves, how, rules
        self.after: dict[tuple[World, int, bool], tuple[Steps, World] | None] = {}

    def going_on(self, one: _Followed, row: Scores, place: int) -> Iterator[_Followed]:
        """Yield the ways in which a program explains one more clip."""
        unexplained = float(row.max()) - UNEXPLAINED
        staying = float(row[one.last]) if one.last >= 0 else unexplained
        yield replace(one, score=one.score + max(staying, unexplained))
        worth = row - self.moves[one.last]
        for rank, number in enumerate(np.argsort(-worth, kind="stable")[: self.how.options].tolist()):
            done = self._done(one, number, rank < self.how.repaired) if number != one.last else None
            if done is not None:
                steps, world = done
                score = one.score + float(worth[number]) - self.how.inserted * (len(steps) - 1)
                yield _Followed(score, world, (*one.steps, *steps), (*one.starts, *[place] * len(steps)), number)

    def _done(self, one: _Followed, number: int, may_repair: bool) -> tuple[Steps, World] | None:
        """Return the steps that do an instruction, the last of which it is, and the world after them."""
        key = one.world, number, may_repair
        if key not in self.after:
            program = Program(steps=(_step(self.instructions[number]),))
            (step,) = nearest(program, one.world).apply(program).steps
            bound = all(ref.node is not None for ref in step.objects)
            after = act(one.world, step, self.rules) if bound else None
            if isinstance(after, World):
                self.after[key] = (step,), after
            else:
                self.after[key] = self._repaired(one.world, step) if bound and may_repair else None
        return self.after[key]

    def _repaired(self, world: World, step: Step) -> tuple[Steps, World] | None:
        """Return the steps and the world after insertions before a step; None if steps are needed after it."""
        done = complete((step,), world, world.home.knowledge, self.rules)
        runs = not done.left_out and done.sources[-1:] == (0,) and len(done.sources) <= 1 + MOST_INSERTED
        return (done.execution.program.steps, done.execution.final) if runs else None


def _step(done: Instruction) -> Step:
    return Step(done.action, tuple(ObjectRef(name) for name in done.objects))


def _normalised(scores: Scores) -> Scores:
    """Logarithms of probabilities over the instructions."""
    high = scores.max(1, keepdims=True)
    found: Scores = scores - high - np.log(np.exp(scores - high).sum(1, keepdims=True))
    return found
