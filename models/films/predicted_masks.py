"""Films as a network predicts their masks: they stand where true masks would."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from hearth.models.films.mask_model import TrainedMaskModel


class PredictedMasks(Sequence[NDArray[np.uint16]]):
    """The predicted masks of films, made when they are first asked for.

    Args:
        films: their colours.
        network: that predicts.
    """

    def __init__(self, films: Sequence[NDArray[Any]], network: TrainedMaskModel) -> None:
        self.films, self.network = films, network
        self.made: dict[int, NDArray[np.uint16]] = {}

    def __len__(self) -> int:
        return len(self.films)

    @overload
    def __getitem__(self, number: int) -> NDArray[np.uint16]: ...
    @overload
    def __getitem__(self, number: slice) -> Sequence[NDArray[np.uint16]]: ...
    def __getitem__(self, number: int | slice) -> NDArray[np.uint16] | Sequence[NDArray[np.uint16]]:
        if isinstance(number, slice):
            return PredictedMasks(self.films[number], self.network)
        if number not in self.made:
            self.made[number] = self.network.masks(self.films[number])
        return self.made[number]
