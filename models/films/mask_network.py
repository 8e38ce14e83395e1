"""A small network with dilated convolutions that predicts the class of each pixel of a picture (thesis 4.3.3).

Its layers see a picture whole, at half and at a quarter of its size. Those in the middle are dilated, and know the mean
of the picture, which identifies the room. Their output is brought back to the whole size, where most things that are
grabbed are a few pixels.
"""

import torch
from torch import Tensor, nn
from torch.nn import functional

DILATIONS = (1, 2, 4, 8, 1)
"""Dilations of the layers in the middle."""

GROUPS = 8
"""Groups of numbers that are normed together; every width is a multiple."""

LARGE, MEDIUM = 24, 48
"""Numbers for a pixel at the whole size and at half of it."""


def _layer(one: int, other: int, size: int = 3, *, stride: int = 1, dilation: int = 1) -> nn.Sequential:
    """Return a convolution that keeps the middle of the picture, its norm and a ReLU."""
    fill = dilation * (size // 2)
    convolution = nn.Conv2d(one, other, size, stride=stride, padding=fill, dilation=dilation, bias=False)
    return nn.Sequential(convolution, nn.GroupNorm(GROUPS, other), nn.ReLU())


class MaskNetwork(nn.Module):
    """Scores of classes for each pixel.

    Args:
        classes: numbers of the palette, 0 included.
        width: numbers for a pixel in the middle, a multiple of 8.
    """

    def __init__(self, classes: int, width: int) -> None:
        super().__init__()
        self.large = _layer(3, LARGE, 5)
        self.medium = nn.Sequential(_layer(LARGE, MEDIUM, stride=2), _layer(MEDIUM, MEDIUM))
        self.small = _layer(MEDIUM, width, stride=2)
        self.room = nn.Linear(width, width)
        self.middle = nn.ModuleList(_layer(width, width, dilation=dilation) for dilation in DILATIONS)
        self.to_medium = _layer(width + MEDIUM, MEDIUM)
        self.to_large = _layer(MEDIUM + LARGE, LARGE)
        self.scores = nn.Conv2d(LARGE, classes, 1)

    def forward(self, pictures: Tensor) -> Tensor:
        """Map (B, H, W, 3) colours from 0 to 255 to (B, classes, H, W)."""
        large = self.large(pictures.permute(0, 3, 1, 2).float() / 128 - 1)
        medium = self.medium(large)
        found = self.small(medium)
        found = found + self.room(found.mean((2, 3)))[:, :, None, None]
        for layer in self.middle:
            found = found + layer(found)
        found = self.to_medium(torch.cat((_enlarged(found, medium), medium), 1))
        found = self.to_large(torch.cat((_enlarged(found, large), large), 1))
        scores: Tensor = self.scores(found)
        return scores


def _enlarged(small: Tensor, large: Tensor) -> Tensor:
    """Return (B, C, h, w) as large as another."""
    return functional.interpolate(small, large.shape[-2:], mode="bilinear", align_corners=False)
