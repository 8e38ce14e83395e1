"""A small network with dilated convolutions that predicts the class of each pixel of a picture (thesis 4.3.3).

Its layers see a picture at a quarter of its size, the last at half of it; masks have half of it, too.
"""

from __future__ import annotations

import torch
from torch import Tensor, nn
from torch.nn import functional

DILATIONS = (1, 2, 4, 8, 1)
"""Of the layers in the middle."""

FINE, LAST = 24, 32
"""Numbers for a pixel of the first and of the last layer, at half of the size."""


def _layer(one: int, other: int, size: int = 3, *, stride: int = 1, dilation: int = 1) -> nn.Sequential:
    """A convolution that keeps the middle of the picture, its norm and a ReLU."""
    fill = dilation * (size // 2)
    convolution = nn.Conv2d(one, other, size, stride=stride, padding=fill, dilation=dilation, bias=False)
    return nn.Sequential(convolution, nn.GroupNorm(8, other), nn.ReLU())


class MaskNetwork(nn.Module):
    """Scores of classes for each pixel of half the size.

    Args:
        classes: numbers of the palette, 0 included.
        width: numbers for a pixel in the middle, a multiple of 8.
    """

    def __init__(self, classes: int, width: int) -> None:
        super().__init__()
        self.fine = nn.Sequential(_layer(3, FINE, 5, stride=2), _layer(FINE, FINE))
        self.small = _layer(FINE, width, stride=2)
        self.middle = nn.ModuleList(_layer(width, width, dilation=dilation) for dilation in DILATIONS)
        self.large = _layer(width, LAST, 1)
        self.last = _layer(LAST + FINE, LAST)
        self.scores = nn.Conv2d(LAST, classes, 1)

    def forward(self, pictures: Tensor) -> Tensor:
        """(B, H, W, 3) colours from 0 to 255 -> (B, classes, H / 2, W / 2)."""
        fine = self.fine(pictures.permute(0, 3, 1, 2).float() / 128 - 1)
        found = self.small(fine)
        for layer in self.middle:
            found = found + layer(found)
        large = functional.interpolate(self.large(found), fine.shape[-2:], mode="bilinear", align_corners=False)
        scores: Tensor = self.scores(self.last(torch.cat((large, fine), 1)))
        return scores
