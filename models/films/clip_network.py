"""A network that names the instruction of a clip: frames by convolutions, their order by a relation of four frames.

As the thesis's Temporal Relation Network with relations of four frames (4.3.3), on colours (table 4.3 b).
"""

from itertools import pairwise

import torch
from torch import Tensor, nn
from torch.nn import functional

RELATED = 4
"""Frames of a relation."""


class FrameNetwork(nn.Module):
    """One frame as a vector.

    Args:
        width: of the result.
    """

    def __init__(self, width: int) -> None:
        super().__init__()
        sizes = (3, 32, 64, 96, 96)
        self.layers = nn.ModuleList(
            nn.Conv2d(one, other, 5 if number == 0 else 3, stride=2, padding=2 if number == 0 else 1)
            for number, (one, other) in enumerate(pairwise(sizes))
        )
        self.norms = nn.ModuleList(nn.GroupNorm(8, size) for size in sizes[1:])
        self.whole = nn.Linear(sizes[-1] * 12, width)

    def forward(self, frames: Tensor) -> Tensor:
        """Map (N, H, W, 3) colours from 0 to 255 to (N, width)."""
        found = frames.permute(0, 3, 1, 2).float() / 128 - 1  # (N, 3, H, W)
        for layer, norm in zip(self.layers, self.norms, strict=True):
            found = functional.relu(norm(layer(found)))
        return functional.relu(self.whole(functional.adaptive_avg_pool2d(found, (3, 4)).flatten(1)))


class ClipNetwork(nn.Module):
    """Logarithms of the probabilities of action, first and second object of a clip.

    Args:
        width: as of `FrameNetwork`.
        actions, objects: how many there are; `objects` with none.
        dropout: share of numbers left out in training.
    """

    def __init__(self, width: int, actions: int, objects: int, dropout: float) -> None:
        super().__init__()
        self.frame = FrameNetwork(width)
        self.relation = nn.Sequential(
            nn.Dropout(dropout), nn.Linear(RELATED * width, 2 * width), nn.ReLU(), nn.Dropout(dropout)
        )
        self.heads = nn.ModuleList(nn.Linear(2 * width, count) for count in (actions, objects, objects))

    def forward(self, pictures: Tensor) -> list[Tensor]:
        """Map (N, 4, H, W, 3) colours, in the order of time to (N, actions), (N, objects), (N, objects)."""
        count = len(pictures)
        frames = self.frame(pictures.flatten(0, 1)).reshape(count, -1)  # (N, 4 * width)
        related = self.relation(frames)
        return [head(related).log_softmax(-1) for head in self.heads]


def loss_of(found: list[Tensor], wanted: Tensor, weights: list[Tensor]) -> Tensor:
    """Return the mean negative log probability of the true classes, weighted; (N, 3) `wanted` has numbers from 0."""
    parts = [
        functional.nll_loss(scores, wanted[:, place], weight)
        for place, (scores, weight) in enumerate(zip(found, weights, strict=True))
    ]
    return torch.stack(parts).sum()
