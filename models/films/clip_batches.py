"""Films as tensors for an encoder over clips, and the noise that training has."""

from collections.abc import Sequence
from dataclasses import dataclass
from random import Random

import numpy as np
import torch
from numpy.typing import NDArray

from hearth.models.films.clip_probabilities import ClipProbabilities
from hearth.models.films.object_class_properties import ClassTable
from hearth.models.text.step_vocabulary import StepVocabulary
from hearth.models.text.text_batches import InputBatch


@dataclass(frozen=True)
class Doubt:
    """Noise that training adds to films: a classifier is surer of its own training films than of new ones.

    Attributes:
        left_out: share of clips that are left out.
        mistaken: share of clips that get the label of another clip of some film of the batch.
        flattened: probabilities are raised to a power between this one and 1, the same for a film.
    """

    left_out: float = 0.1
    mistaken: float = 0.1
    flattened: float = 0.6


def rows_of(vocabulary: StepVocabulary, table: ClassTable) -> NDArray[np.int64]:
    """Return (C,) the row of a classifier's table for each class of a vocabulary.

    The row is 0 for no object and for classes that the table lacks.
    """
    row = {name: number for number, name in enumerate(table.names, 1)}
    return np.array([0, *(row.get(name, 0) for name in vocabulary.classes)], np.int64)


def traits_of(vocabulary: StepVocabulary, table: ClassTable) -> NDArray[np.float32]:
    """Return (C, traits) the properties of a vocabulary's classes.

    The values are 0 for no object and for classes that the table lacks.
    """
    return table.traits[rows_of(vocabulary, table)]


def clip_batch(
    films: Sequence[ClipProbabilities], rows: NDArray[np.int64], device: torch.device, noise: Random | None = None,
    doubt: Doubt = Doubt(),
) -> InputBatch:  # fmt: skip
    """Films as an encoder reads them.

    Args:
        films: one at least, each of one clip at least.
        rows: see `rows_of`.
        device: of the batch.
        noise: for `doubt`; None for none.
        doubt: see there.
    """
    given = _doubted(films, noise, doubt) if noise is not None else films
    longest, actions = max(map(len, given)), given[0].actions.shape[1]
    inputs = torch.zeros(len(given), longest, actions + 1 + 2 * len(rows))
    mentioned = torch.zeros(len(given), longest, len(rows))
    known = (rows > 0).astype(np.float32)
    for number, film in enumerate(given):
        objects = film.objects[:, :, rows] * known  # (N, 2, C)
        length = np.log(film.lengths)[:, None] / 3  # of a clip 0, of 20 about 1
        found = np.concatenate((film.actions, length, objects[:, 0], objects[:, 1]), 1)
        inputs[number, : len(film)] = torch.from_numpy(found)
        mentioned[number, : len(film)] = torch.from_numpy(objects.sum(1).clip(max=1))
    return InputBatch(inputs.to(device), torch.tensor([*map(len, given)]), mentioned.to(device))


def _doubted(films: Sequence[ClipProbabilities], noise: Random, doubt: Doubt) -> list[ClipProbabilities]:
    draw = np.random.Generator(np.random.PCG64(noise.getrandbits(64)))
    columns = zip(*((each.actions, each.objects, each.lengths) for each in films), strict=True)
    others = ClipProbabilities(*map(np.concatenate, columns))
    found = []
    for film in films:
        kept = np.flatnonzero(draw.random(len(film)) >= doubt.left_out)
        shown = film.part(kept if len(kept) else np.arange(len(film)))
        swapped = draw.random(len(shown)) < doubt.mistaken
        other = others.part(draw.integers(len(others), size=len(shown)))
        power = draw.uniform(doubt.flattened, 1.0)
        actions = np.where(swapped[:, None], other.actions, shown.actions)
        objects = np.where(swapped[:, None, None], other.objects, shown.objects)
        found.append(ClipProbabilities(_flattened(actions, power), _flattened(objects, power), shown.lengths))
    return found


def _flattened(probabilities: NDArray[np.float32], power: float) -> NDArray[np.float32]:
    """Powers of probabilities, of which each row adds up to one again."""
    found = np.clip(probabilities, 0, None) ** power
    flat: NDArray[np.float32] = (found / np.maximum(found.sum(-1, keepdims=True), 1e-9)).astype(np.float32)
    return flat
