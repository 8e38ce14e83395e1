"""Films as a network predicts their masks: they stand where true masks would."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from hearth.datasets.dataset import Dataset
from hearth.models.films.clip_data import Clips
from hearth.models.films.film_arrays import COLOURS
from hearth.models.films.mask_model import TrainedMaskModel
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


def mask_predictor(model: str) -> TrainedMaskModel:
    """Return a trained network that predicts masks.

    Args:
        model: a checkpoint of `masks`: its folder, or the name of one that comes with Hearth.

    Raises:
        HearthError: the checkpoint is missing; BAD_ARGUMENT, if it is of another model.
    """
    from hearth.models.model_registry import restore

    name, network = restore(model)
    if not isinstance(network, TrainedMaskModel):
        message = f"`{name}` does not predict masks"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="a checkpoint of `masks`")
    return network


def predicted(model: str, dataset: Dataset, part: str, most: int = 0) -> Clips:
    """Return the clips of a part's coloured films as a network predicts their masks.

    Args:
        model: as of `mask_predictor`.
        dataset: with clips.
        part: of the clips.
        most: films, at most; 0 for all.

    Raises:
        HearthError: errors of `mask_predictor` and of `Clips.of`.
    """
    network, clips = mask_predictor(model), Clips.of(dataset, part, most, array=COLOURS)
    return replace(clips, films=PredictedMasks(clips.films, network, keeps=False))


class PredictedMasks(Sequence[NDArray[np.uint16]]):
    """The predicted masks of films, made when they are first asked for.

    Args:
        films: their colours.
        network: that predicts.
        keeps: whether they stay in memory, for several models that look at them; else they are made each time.
    """

    def __init__(self, films: Sequence[NDArray[Any]], network: TrainedMaskModel, keeps: bool = True) -> None:
        self.films, self.network, self.keeps = films, network, keeps
        self.made: dict[int, NDArray[np.uint16]] = {}

    def __len__(self) -> int:
        return len(self.films)

    @overload
    def __getitem__(self, number: int) -> NDArray[np.uint16]: ...
    @overload
    def __getitem__(self, number: slice) -> Sequence[NDArray[np.uint16]]: ...
    def __getitem__(self, number: int | slice) -> NDArray[np.uint16] | Sequence[NDArray[np.uint16]]:
        if isinstance(number, slice):
            return PredictedMasks(self.films[number], self.network, self.keeps)
        if number in self.made:
            return self.made[number]
        masks = self.network.masks(self.films[number])
        if self.keeps:
            self.made[number] = masks
        return masks
