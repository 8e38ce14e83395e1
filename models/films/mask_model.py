"""Class masks of pictures: a network learns them from the coloured films of a dataset of clips (thesis 4.3.3)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from random import Random
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch.nn import functional

from hearth.datasets.dataset import Dataset
from hearth.models.checkpoint import Checkpoint
from hearth.models.checkpoint_weights import filled
from hearth.models.devices import device, moved, place_of
from hearth.models.films.clip_data import Clips, OfFilms
from hearth.models.films.film_arrays import COLOURS, MASKS
from hearth.models.films.mask_network import GROUPS, MaskNetwork
from hearth.models.interface import Settings, Training
from hearth.models.text_examples import facts_of
from hearth.models.training import Task, train
from hearth.storage.parallel import Seen, unseen

NAME = "masks"
"""Name of the model's checkpoints."""

AT_ONCE = 16
"""Pictures that are read at once."""

MOST_CLASSES = 255
"""Classes that a palette has numbers for, without 0."""

CHECKED = 12
"""Frames of a validation film from one that is compared to the next one."""

RAREST = 1e-4
"""The share of pixels from which on a class does not count more for being rare."""


class Frames:
    """Frames of coloured films: their pictures and masks.

    Args:
        dataset: with clips.
        part: of the clips.
        every: frames from one that is taken to the next one.
        films: at most; 0 for all.
    """

    def __init__(self, dataset: Dataset, part: str, every: int, films: int = 0) -> None:
        coloured = Clips.of(dataset, part, films, array=COLOURS)
        masks = Clips.of(dataset, part, films, array=MASKS, coloured=True)
        self.pictures = np.concatenate([film[::every] for film in coloured.films])
        self.masks = np.concatenate([film[::every] for film in masks.films])

    def __len__(self) -> int:
        return len(self.pictures)


@dataclass(frozen=True, slots=True)
class MaskModel(Settings):
    """Settings of the network.

    Attributes:
        width: numbers for a pixel in the middle of the network.
        batch: pictures in a batch.
        frames: pictures of an epoch, drawn from all; 0 for all.
        every: frames from one that is learned from to the next one: neighbours are alike.
        balance: the power of a class's share of pixels by which its loss is divided.
        light: how much brighter or darker, as a share, pictures are made in training; their colours change by a third.
        films: of training, at most; 0 for all.
    """

    width: int = 64
    batch: int = 8
    frames: int = 800
    every: int = 3
    balance: float = 0.5
    light: float = 0.3
    films: int = 0

    def fitting(self) -> None:
        """Check that the norms divide the width."""
        self.multiple("width", GROUPS, "the groups of its norms")

    def fit(self, dataset: Dataset, how: Training, seen: Seen = unseen) -> TrainedMaskModel:
        """Train on coloured films of `train`; the mean IoU of those of `validation` decides when to stop."""
        learned = Frames(dataset, "train", self.every, self.films)
        checked = Frames(dataset, "validation", CHECKED)
        classes, weights = self._classes(learned.masks)
        torch.manual_seed(how.seed)
        model = TrainedMaskModel(self, classes, self.network(classes).to(device()))
        place = place_of(model.network)
        weights = weights.to(place)
        wanted, compared = model.palette[learned.masks], model.palette[checked.masks]

        def batches(random: Random) -> Iterator[tuple[torch.Tensor, torch.Tensor]]:
            count = min(self.frames or len(learned), len(learned))
            order = random.sample(range(len(learned)), count)
            for start in range(0, count, self.batch):
                which = order[start : start + self.batch]
                mirror = 1 if random.random() < 0.5 else -1
                pictures, masks = learned.pictures[which][:, :, ::mirror], wanted[which][:, :, ::mirror]
                yield self._lit(pictures, random), torch.from_numpy(masks.copy())

        def loss(batch: tuple[torch.Tensor, torch.Tensor]) -> torch.Tensor:
            pictures, masks = moved(batch, place)
            return functional.cross_entropy(model.network(pictures), masks.long(), weights)

        def validate() -> float:
            found = np.concatenate([*model.numbers(checked.pictures)])
            return mean_iou(compared, found, len(classes) + 1)

        task = Task(model.network, batches, loss, validate, [asdict(self), len(learned), facts_of(dataset)["digest"]])
        model.facts.update({"pictures": len(learned), "seed": how.seed, **train(task, how, seen).record()})
        return model

    def _lit(self, pictures: NDArray[np.uint8], random: Random) -> torch.Tensor:
        """Return (B, H, W, 3) pictures in another light, each in one of its own."""
        draw = np.random.Generator(np.random.PCG64(random.getrandbits(64)))
        bright = 1 + self.light * draw.uniform(-1, 1, (len(pictures), 1, 1, 1))
        tint = 1 + self.light / 3 * draw.uniform(-1, 1, (len(pictures), 1, 1, 3))
        return torch.from_numpy(np.minimum(pictures * (bright * tint).astype(np.float32), 255))

    def _classes(self, masks: NDArray[np.uint16]) -> tuple[tuple[int, ...], torch.Tensor]:
        """Return the classes that are learned, the commonest first, and the weights of the palette's numbers."""
        counts = np.zeros(np.iinfo(masks.dtype).max + 1, np.int64)
        for frame in masks:  # of all at once numpy would make a copy of eight bytes a pixel
            counts += np.bincount(frame.ravel(), minlength=len(counts))
        common = [number for number in np.argsort(-counts, kind="stable").tolist() if number and counts[number]]
        classes = tuple(common[:MOST_CLASSES])
        shares = np.maximum(counts[[0, *classes]] / masks.size, RAREST)
        return classes, torch.tensor(shares**-self.balance, dtype=torch.float32)

    def network(self, classes: Sequence[int]) -> MaskNetwork:
        """Return the network, with random weights."""
        return MaskNetwork(len(classes) + 1, self.width)

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> TrainedMaskModel:
        """Return the model of a checkpoint."""
        settings, classes = cls.of(checkpoint.settings), read_classes(checkpoint.content)
        network = filled(lambda: settings.network(classes), checkpoint.weights).to(device())
        return TrainedMaskModel(settings, classes, network, dict(checkpoint.trained))


def read_classes(content: Mapping[str, Any]) -> tuple[int, ...]:
    """Return the classes of a checkpoint, which may be a stranger's.

    Raises:
        KeyError: they lack.
        ValueError: they are no classes.
    """
    found = tuple(content["classes"])
    if not all(type(number) is int and 0 < number < 1 << 16 for number in found):
        raise ValueError("a class is not a number of masks")
    if not 0 < len({*found}) == len(found) <= MOST_CLASSES:
        raise ValueError(f"{len(found)} classes, not 1 to {MOST_CLASSES} different ones")
    return found


def mean_iou(wanted: NDArray[np.uint8], found: NDArray[np.uint8], classes: int) -> float:
    """Return the mean intersection over union of the classes that occur."""
    pairs = np.bincount(wanted.ravel().astype(np.int64) * classes + found.ravel(), minlength=classes * classes)
    table = pairs.reshape(classes, classes)
    both, one, other = table.diagonal(), table.sum(1), table.sum(0)
    there = one > 0
    return float((both[there] / (one + other - both)[there]).mean()) if there.any() else 0.0


@dataclass(frozen=True)
class TrainedMaskModel(OfFilms):
    """A trained network.

    Attributes:
        settings: see `MaskModel`.
        classes: the classes of the palette's numbers from 1; 0 is the background.
        network: with its weights.
        facts: of its training.
    """

    name = NAME

    settings: MaskModel
    classes: tuple[int, ...]
    network: MaskNetwork
    facts: dict[str, Any] = field(default_factory=dict)

    @property
    def palette(self) -> NDArray[np.uint8]:
        """Return (65536,) the number of each class; 0 for those that are not learned."""
        found = np.zeros(1 << 16, np.uint8)
        found[list(self.classes)] = np.arange(1, len(self.classes) + 1, dtype=np.uint8)
        return found

    def masks(self, pictures: NDArray[np.uint8]) -> NDArray[np.uint16]:
        """Map (T, H, W, 3) colours to (T, H, W) class numbers as true masks have them."""
        classes = np.array([0, *self.classes], np.uint16)
        found: NDArray[np.uint16] = classes[np.concatenate([*self.numbers(pictures)])]
        return found

    def numbers(self, pictures: NDArray[np.uint8]) -> Iterator[NDArray[np.uint8]]:
        """Map (T, H, W, 3) colours to the palette's numbers, `AT_ONCE` frames at a time."""
        self.network.eval()
        place = place_of(self.network)
        for start in range(0, len(pictures), AT_ONCE):
            with torch.no_grad():
                scores = self.network(torch.from_numpy(pictures[start : start + AT_ONCE].copy()).to(place))
                found = scores.argmax(1).to(torch.uint8).cpu().numpy()
            yield found

    def checkpoint(self) -> Checkpoint:
        """Return all that `restored` needs."""
        weights = {name: value.cpu().numpy() for name, value in self.network.state_dict().items()}
        return Checkpoint(NAME, asdict(self.settings), {"classes": [*self.classes]}, weights, self.facts)
