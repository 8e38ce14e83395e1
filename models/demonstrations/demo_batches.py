"""Demonstrations and their steps as tensors."""

from collections.abc import Sequence
from random import Random
from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor

from hearth.models.demonstrations.frame_network import FrameBatch
from hearth.models.demonstrations.mask_classes import MaskClasses
from hearth.models.demonstrations.overhead_features import Above

Numbers = tuple[int, int, int]


class Done(NamedTuple):
    """The steps before each picture of a demonstration, for training alone.

    Attributes:
        kept: whether the sketch keeps the step; None at the start.
        steps: the step's action and classes; 0 for names that the vocabulary lacks, and at the start.
    """

    kept: tuple[bool | None, ...]
    steps: tuple[Numbers, ...]


class DoneBatch(NamedTuple):
    """The steps of B demonstrations.

    Attributes:
        real: (B, L) bool, whether a step is before the picture.
        kept: (B, L) float.
        steps: (B, L, 3) int64.
    """

    real: Tensor
    kept: Tensor
    steps: Tensor


def frame_batch(
    given: Sequence[Above], known: MaskClasses, device: torch.device, noise: Random | None = None
) -> FrameBatch:
    """Demonstrations as a batch; turned and mirrored, if a generator is given: a home has no side that is up."""
    turned = [each if noise is None else turn(each, noise.randrange(8)) for each in given]
    longest = max(each.length for each in turned)
    classes, numbers, people, masks, colours = (
        torch.from_numpy(np.stack([_filled(each[place], longest) for each in turned])) for place in range(5)
    )
    rows = torch.from_numpy(known.rows)
    return FrameBatch(
        rows[classes.long()].to(device), numbers.to(device), people.to(device), rows[masks.long()].to(device),
        (colours.permute(0, 1, 4, 2, 3).float() / 255 - 0.5).to(device), torch.tensor([each.length for each in turned]),
    )  # fmt: skip


def _filled(array: np.ndarray, longest: int) -> np.ndarray:
    found = np.zeros((longest, *array.shape[1:]), array.dtype)
    found[: len(array)] = array
    return found


def turn(seen: Above, way: int) -> Above:
    """Return a demonstration seen from another side: one of eight, of which pictures that are not square have four.

    Args:
        seen: the demonstration.
        way: quarters to turn, from 0 to 3; 4 more to mirror it as well.
    """
    height, width = seen.masks.shape[1:3]
    quarters, mirrored = way % 4, way >= 4
    quarters -= quarters % 2 if height != width else 0
    masks, colours, numbers = seen.masks, seen.colours, seen.numbers.copy()
    if mirrored:
        masks, colours = masks[:, :, ::-1], colours[:, :, ::-1]
        numbers[..., 3] *= -1
    for _ in range(quarters):
        numbers[..., 3], numbers[..., 4] = numbers[..., 4].copy(), -numbers[..., 3]
    masks, colours = np.rot90(masks, quarters, (1, 2)), np.rot90(colours, quarters, (1, 2))
    return seen._replace(numbers=numbers, masks=np.ascontiguousarray(masks), colours=np.ascontiguousarray(colours))


def done_batch(given: Sequence[Done], device: torch.device) -> DoneBatch:
    """Return the steps of some demonstrations, padded to the longest of them."""
    longest = max(len(each.kept) for each in given)
    real, kept = torch.zeros(len(given), longest, dtype=torch.bool), torch.zeros(len(given), longest)
    steps = torch.zeros(len(given), longest, 3, dtype=torch.int64)
    for row, each in enumerate(given):
        count = len(each.kept)
        real[row, :count] = torch.tensor([keeps is not None for keeps in each.kept])
        kept[row, :count] = torch.tensor([float(bool(keeps)) for keeps in each.kept])
        steps[row, :count] = torch.tensor(each.steps)
    return DoneBatch(real.to(device), kept.to(device), steps.to(device))
