"""The possible instructions of a film's clips: each that some clip makes probable, scored in every clip."""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from hearth.models.films.clip_data import Instruction
from hearth.models.films.film_programs import Moves, Scores
from hearth.models.films.object_class_properties import ClassTable
from hearth.models.films.step_order import START, StepOrder

OF_A_CLIP = 8
"""Instructions that a clip adds."""

TRUST = 0.5
"""Factor of logarithms: neighboring clips share frames, and networks are surer than they are right."""

OBJECTS = 4
"""Objects of an action that are tried."""


class Reading(NamedTuple):
    """The possible instructions of a film's clips.

    Attributes:
        instructions: sorted.
        scores: (N, I) logarithms of their probabilities in each clip.
    """

    instructions: tuple[Instruction, ...]
    scores: Scores

    def moves(self, order: StepOrder, trust: float = 1.0) -> Moves:
        """Return the costs of changing from one instruction to another, by the order of steps in programs.

        The last row has the costs of the first instruction.
        """
        return -trust * order.logs([*self.instructions, START], self.instructions)


def reading(actions: Scores, objects: Scores, table: ClassTable, trust: float = TRUST) -> Reading:
    """Return the reading of a film.

    Args:
        actions: (N, A) logarithms of the probabilities of actions in its clips.
        objects: (N, 2, A, rows) of their objects.
        table: of the classes.
        trust: see `TRUST`.
    """
    found = sorted({each for clip in zip(actions, objects, strict=True) for each in _probable(*clip, table)})
    rows = np.array(found, np.int64).reshape(-1, 3)
    scores = actions[:, rows[:, 0]].copy()
    for place in (0, 1):
        has = rows[:, 1 + place] > 0
        scores[:, has] += objects[:, place][:, rows[has, 0], rows[has, 1 + place]]
    names = [_instruction(row, table) for row in found]
    order = sorted(range(len(names)), key=names.__getitem__)
    return Reading(tuple(names[number] for number in order), trust * scores[:, order])


def _probable(actions: Scores, objects: Scores, table: ClassTable) -> Iterable[tuple[int, int, int]]:
    """Return the most probable instructions of a clip."""
    found = sorted(_options(actions, objects, table), key=lambda option: (-option[0], option[1]))
    return [option for _, option in found[:OF_A_CLIP]]


def _options(actions: Scores, objects: Scores, table: ClassTable) -> Iterator[tuple[float, tuple[int, int, int]]]:
    for action, count in enumerate(table.objects):
        best = [np.argsort(-objects[place, action], kind="stable")[:OBJECTS].tolist() for place in range(count)]
        for first in best[0] if count else [0]:
            for second in best[1] if count > 1 else [0]:
                if count > 1 and first == second:
                    continue
                worth = actions[action]
                worth += objects[0, action, first] if count else 0
                worth += objects[1, action, second] if count > 1 else 0
                yield float(worth), (action, first, second)


def _instruction(row: Sequence[int], table: ClassTable) -> Instruction:
    return Instruction(table.actions[row[0]], tuple(table.names[number - 1] for number in row[1:] if number > 0))
