"""What a classifier says of each clip of a film, as probabilities: what the encoder over clips reads."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hearth.models.films.class_table import PLACES, ClassTable
from hearth.models.films.film_shown import cut
from hearth.models.films.seen_model import Scored, TrainedSeenModel


@dataclass(frozen=True, slots=True)
class ClipProbabilities:
    """How probable actions and objects are in each of a film's N clips.

    Attributes:
        actions: (N, A) of each action of the classifier.
        objects: (N, 2, rows) of each class as a first and a second object, whatever the action is; rows as in its
            table, row 0 is nothing.
    """

    actions: NDArray[np.float32]
    objects: NDArray[np.float32]

    def __len__(self) -> int:
        return len(self.actions)

    def part(self, which: NDArray[np.int64]) -> ClipProbabilities:
        """Some of the clips."""
        return ClipProbabilities(self.actions[which], self.objects[which])


def of_film(trained: TrainedSeenModel, masks: NDArray[np.uint16]) -> ClipProbabilities:
    """What a classifier says of a film, cut into clips whatever is done in it.

    Args:
        trained: the classifier.
        masks: (T, H, W) class numbers of the film.

    Raises:
        HearthError: BAD_ARGUMENT, if the film is shorter than a clip.
    """
    (found,) = trained.scored(cut(masks))
    return of_scores(found, trained.table)


def of_scores(found: Scored, table: ClassTable) -> ClipProbabilities:
    """The probabilities of objects over all actions: those of actions that take none are row 0's."""
    actions = np.exp(found.actions)  # (N, A)
    count = np.array(table.objects)
    objects = []
    for place in range(PLACES):
        takes = actions * (count > place)  # (N, A)
        each = np.einsum("na,nar->nr", takes, np.exp(found.objects[:, place]))
        each[:, 0] = 1 - takes.sum(1)
        objects.append(each)
    return ClipProbabilities(actions, np.stack(objects, 1).astype(np.float32))
