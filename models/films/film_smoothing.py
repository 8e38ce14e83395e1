"""The instruction of each clip of a film, predicted together with all other clips of the film.

How probable each instruction is in each clip given the whole film, by forward and backward sums over the sequences of
which `film_programs.described` finds the most probable (Rabiner 1989).
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Hashable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.models.films.class_accuracy import MEASURED
from hearth.models.films.clip_data import Clips, Instruction
from hearth.models.films.film_programs import Moves, Scores
from hearth.models.films.mask_clip_model import TrainedSeenModel


def named_in_films(trained: TrainedSeenModel, clips: Clips, learned: Sequence[Instruction]) -> list[Instruction]:
    """Return the instruction that each clip is taken for, by the whole film.

    Args:
        trained: the classifier, of single clips.
        clips: in the order of their films.
        learned: the instructions of the training clips, which give the shares of classes.
    """
    worth = ClassWorth.of(learned, 1 - trained.settings.balance)
    found: list[Instruction] = []
    for reading in trained.readings(clips):
        each = posteriors(reading.scores, reading.moves(trained.order))
        gains = worth.gains(each, reading.instructions)
        found += [reading.instructions[number] for number in gains.argmax(1).tolist()]
    return found


def posteriors(scores: Scores, moves: Moves) -> NDArray[np.float64]:
    """Return (N, I) how probable each instruction is in each clip, given all clips of the film.

    Args:
        scores: (N, I) logarithms of how probable each is in a clip alone.
        moves: (I + 1, I) costs of going from one to another, the last row for the first clip; staying is free.
    """
    change = -moves[:-1].astype(np.float64)
    np.fill_diagonal(change, 0)
    before, after = np.empty(scores.shape), np.zeros(scores.shape)  # sums over the past and the future of a clip
    for number, row in enumerate(scores):
        before[number] = row + (_summed(before[number - 1][:, None] + change) if number else -moves[-1])
    for number in range(len(scores) - 2, -1, -1):
        after[number] = _summed((change + scores[number + 1] + after[number + 1]).T)
    whole = before + after
    return np.exp(whole - _summed(whole.T)[:, None])


def _summed(logs: NDArray[np.float64]) -> NDArray[np.float64]:
    """Logarithms of the sums over rows."""
    high = logs.max(0)
    found: NDArray[np.float64] = high + np.log(np.exp(logs - high).sum(0))
    return found


class ClassWorth(NamedTuple):
    """The gain of a right class in each mean accuracy over classes.

    In these means, a class with few clips counts as much as a class with many.

    Attributes:
        counts: for each measured part of an instruction, clips of training of each class, to a power.
        power: of the counts.
    """

    counts: dict[str, Counter[Hashable]]
    power: float

    @classmethod
    def of(cls, learned: Sequence[Instruction], power: float) -> ClassWorth:
        """Return the gains of training clips.

        Args:
            learned: the instructions of these clips.
            power: 1 if probabilities are those of clips; less by the weights that training has already given its loss.
        """
        return cls({name: Counter(map(part, learned)) for name, part in MEASURED.items()}, power)

    def gains(self, probable: NDArray[np.float64], instructions: Sequence[Instruction]) -> NDArray[np.float64]:
        """Return (N, I) the mean accuracy that naming each instruction may be expected to add, up to a factor.

        Args:
            probable: (N, I) probabilities of instructions in clips.
            instructions: by number.
        """
        gains = np.zeros(probable.shape)
        for name, part in MEASURED.items():
            alike: defaultdict[Hashable, list[int]] = defaultdict(list)
            for number, each in enumerate(instructions):
                alike[part(each)].append(number)
            counts, total = self.counts[name], self.counts[name].total()
            for label, numbers in alike.items():
                share = (counts[label] + 1) / total  # a class that training lacks is as rare as one clip
                right = probable[:, numbers].sum(1, keepdims=True)
                gains[:, numbers] += right / share**self.power / len(counts)
        return gains
