"""A classifier's probabilities for each clip of a film: the input of the encoder over clips."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hearth.models.films.film_prediction import cut
from hearth.models.films.mask_clip_model import Scored, TrainedSeenModel
from hearth.models.films.object_class_properties import PLACES, ClassTable


@dataclass(frozen=True, slots=True)
class ClipProbabilities:
    """Probabilities of actions and objects in each of N parts of a film.

    Attributes:
        actions: (N, A) of each action of the classifier.
        objects: (N, 2, rows) of each class as a first and a second object, whatever the action is; rows as in its
            table, row 0 is nothing.
        lengths: (N,) clips of each part.
    """

    actions: NDArray[np.float32]
    objects: NDArray[np.float32]
    lengths: NDArray[np.float32]

    def __len__(self) -> int:
        return len(self.actions)

    def part(self, which: NDArray[np.int64]) -> ClipProbabilities:
        """Return some of the parts."""
        return ClipProbabilities(self.actions[which], self.objects[which], self.lengths[which])

    def merged(self) -> ClipProbabilities:
        """Clips in a row that are taken for the same as one, by their means.

        A step has some five clips, and a decoder that finds the same in a third as many places learns from fewer films.
        """
        named = np.column_stack((self.actions.argmax(1), self.objects.argmax(2)))  # (N, 3)
        starts = np.flatnonzero(np.append(True, (named[1:] != named[:-1]).any(1)))
        ends = np.append(starts[1:], len(named))
        means = [[each[one:other].mean(0) for one, other in zip(starts, ends, strict=True)]
                 for each in (self.actions, self.objects)]  # fmt: skip
        lengths = np.add.reduceat(self.lengths, starts)
        return ClipProbabilities(np.stack(means[0]), np.stack(means[1]), lengths)


def of_film(trained: TrainedSeenModel, masks: NDArray[np.uint16]) -> ClipProbabilities:
    """Return a classifier's probabilities for a film, cut into clips at fixed times; clips alike in a row are one.

    Args:
        trained: the classifier.
        masks: (T, H, W) class numbers of the film.

    Raises:
        HearthError: BAD_ARGUMENT, if the film is shorter than a clip.
    """
    (found,) = trained.scored(cut(masks))
    return of_scores(found, trained.table).merged()


def of_scores(found: Scored, table: ClassTable) -> ClipProbabilities:
    """Return the probabilities of each clip, of objects over all actions.

    Those of actions that take none are row 0's.
    """
    actions = np.exp(found.actions)  # (N, A)
    count = np.array(table.objects)
    objects = []
    for place in range(PLACES):
        takes = actions * (count > place)  # (N, A)
        each = np.einsum("na,nar->nr", takes, np.exp(found.objects[:, place]))
        each[:, 0] = 1 - takes.sum(1)
        objects.append(each)
    return ClipProbabilities(actions, np.stack(objects, 1).astype(np.float32), np.ones(len(actions), np.float32))
