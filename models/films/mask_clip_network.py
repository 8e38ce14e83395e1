"""A network that names the instruction of a clip by the features of each class, and points at the objects.

The network can name a class that was never an object in training. It knows such a class by its properties and by its
behavior near the person. Classes that no frame shows are named from a list.
"""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import Tensor, nn
from torch.nn import functional

from hearth.models.films.mask_features import NUMBERS, PEOPLE
from hearth.models.films.object_class_properties import PLACES

FRAMES = 9
LOOKED_AT = slice(0, FRAMES, 2)
"""Frames in which the network reads the area around the person: all frames would take twice as long."""

HEADS = 4
"""Heads of the attention among classes."""

CHANNELS = (10, 24, 32)
"""Channels of a class and of the convolutions around the person."""

NEAR = 48
"""Numbers in the vector of the area around the person in a frame."""

NEVER = -12.0
"""Logarithm of how improbable an object is that the action does not afford."""

MIRRORED = (2, 6, 10)
"""Numbers of a class that change their sign in a mirror."""


class SeenBatch(NamedTuple):
    """Clips as tensors; see `SeenClips`."""

    classes: Tensor  # (B, K) long
    numbers: Tensor  # (B, K, T, NUMBERS)
    people: Tensor  # (B, T, PEOPLE)
    crops: Tensor  # (B, FRAMES, CROP, CROP) long

    def mirrored(self, which: Tensor) -> SeenBatch:
        """Return the batch with some clips, (B,) of bool, left and right exchanged."""
        signs = torch.ones(NUMBERS, device=which.device)
        signs[list(MIRRORED)] = -1
        numbers = torch.where(which[:, None, None, None], self.numbers * signs, self.numbers)
        seen = self.people[..., :1]
        swapped = torch.cat((seen, -self.people[..., 2:3], -self.people[..., 1:2], self.people[..., 3:5],
                             -self.people[..., 5:6], self.people[..., 6:]), -1)  # fmt: skip
        people = torch.where(which[:, None, None], swapped, self.people)
        crops = torch.where(which[:, None, None, None], self.crops.flip(-1), self.crops)
        return SeenBatch(self.classes, numbers, people, crops)


class PersonNetwork(nn.Module):
    """The network over the person in a clip and the area around the person.

    Args:
        traits: of a class.
        times: frames that are looked at, with those of the context.
        width: of the result.
        dropout: share of numbers left out in training.
    """

    def __init__(self, traits: int, times: int, width: int, dropout: float) -> None:
        super().__init__()
        zero, one, other = CHANNELS
        self.colour = nn.Linear(traits, zero)
        self.near = nn.Sequential(
            nn.Conv2d(zero, one, 5, stride=2, padding=2), nn.ReLU(), nn.Conv2d(one, other, 3, stride=2, padding=1),
            nn.ReLU(), nn.Flatten(), nn.Dropout(dropout), nn.Linear(other * 25, NEAR),
        )  # fmt: skip
        looked_at = len(range(FRAMES)[LOOKED_AT])
        self.time = nn.Sequential(nn.Linear(looked_at * NEAR + times * PEOPLE, 2 * width), nn.ReLU(),
                                  nn.Dropout(dropout), nn.Linear(2 * width, width))  # fmt: skip

    def forward(self, people: Tensor, crops: Tensor, traits: Tensor) -> Tensor:
        """Map (B, T, PEOPLE), (B, FRAMES, CROP, CROP) and (rows, traits) to (B, width)."""
        seen = crops[:, LOOKED_AT]
        planes = self.colour(traits)[seen].permute(0, 1, 4, 2, 3)  # (B, looked at, zero, CROP, CROP)
        near = self.near(planes.flatten(0, 1)).unflatten(0, seen.shape[:2])
        return self.time(torch.cat((near.flatten(1), people.flatten(1)), -1))


class SeenNetwork(nn.Module):
    """Logarithms of the probabilities of a clip's action, and of its objects for each action.

    Args:
        traits: (rows, traits) of the classes.
        afforded: (actions, 2, rows) whether an action's object may be of a class.
        named: (rows,) whether a class can be named although it is not seen.
        times: frames that are looked at, with those of the context.
        width, layers: of the transformer over the classes that are seen.
        vector: numbers that are learned for a class.
        dropout: share of numbers left out in training.
        unnamed: share of classes whose learned numbers are left out in training, so that new ones can be understood.
    """

    def __init__(
        self, traits: Tensor, afforded: Tensor, named: Tensor, times: int, width: int, layers: int, vector: int,
        dropout: float, unnamed: float,
    ) -> None:  # fmt: skip
        super().__init__()
        self.unnamed = unnamed
        self.register_buffer("traits", traits, persistent=False)
        self.register_buffer("never", torch.where(afforded, 0.0, NEVER), persistent=False)
        self.register_buffer("named", named, persistent=False)
        rows, actions = len(traits), len(afforded)
        self.vector = nn.Embedding(rows, vector)
        nn.init.normal_(self.vector.weight, std=0.1)
        self.token = nn.Linear(times * NUMBERS + traits.shape[1] + vector, width)
        self.person = PersonNetwork(traits.shape[1], times, width, dropout)
        layer = nn.TransformerEncoderLayer(width, HEADS, 2 * width, dropout, batch_first=True, norm_first=True)
        self.body = nn.TransformerEncoder(layer, layers, nn.LayerNorm(width), enable_nested_tensor=False)
        self.action = nn.Linear(width, actions)
        nn.init.zeros_(self.action.weight)
        nn.init.zeros_(self.action.bias)
        self.asked = nn.ModuleList(nn.Embedding(actions, width) for _ in range(PLACES))
        self.pointed = nn.ModuleList(nn.Linear(width, width) for _ in range(PLACES))
        self.worth = nn.ModuleList(nn.Linear(width, 1) for _ in range(PLACES))
        self.listed = nn.ModuleList(nn.Linear(width, rows) for _ in range(PLACES))

    def read(self, batch: SeenBatch) -> tuple[Tensor, Tensor]:
        """Return (B, width) the clip and (B, K, width) its classes."""
        vectors = self.vector(batch.classes)
        if self.training:
            vectors = vectors * (torch.rand(*batch.classes.shape, 1, device=vectors.device) >= self.unnamed)
        found = torch.cat((batch.numbers.flatten(2), self.traits[batch.classes], vectors), -1)
        person = self.person(batch.people, batch.crops, self.traits)
        tokens = torch.cat((person[:, None], self.token(found)), 1)
        empty = functional.pad(batch.classes == 0, (1, 0))
        read = self.body(tokens, src_key_padding_mask=empty)
        return read[:, 0], read[:, 1:]

    def actions(self, clip: Tensor) -> Tensor:
        """Map (B, width) to (B, actions)."""
        return self.action(clip).log_softmax(-1)

    def objects(self, batch: SeenBatch, clip: Tensor, classes: Tensor, action: Tensor, place: int) -> Tensor:
        """Return (B, A, rows) of an action's first or second object, for (B, A) actions."""
        asked = self.asked[place](action)  # (B, A, width)
        points = torch.tanh(self.pointed[place](classes)[:, None] + (asked + clip[:, None])[:, :, None])
        points = self.worth[place](points).squeeze(-1)  # (B, A, K)
        listed = self.listed[place](clip[:, None] + asked).masked_fill(~self.named, -1e4)  # (B, A, rows)
        where = batch.classes[:, None].expand_as(points)
        found = listed.scatter(2, where, points)
        found = torch.cat((torch.full_like(found[..., :1], -1e4), found[..., 1:]), -1)
        return (found + self.never[action, place]).log_softmax(-1)


def loss_of(network: SeenNetwork, batch: SeenBatch, wanted: Tensor, weights: Tensor) -> Tensor:
    """Return the loss of the actions, and of their objects given the actions.

    Args:
        network: that is trained.
        batch: of B clips.
        wanted: (B, 3) numbers of action and objects; 0 where there is none.
        weights: (B, 2) of each clip's action and objects.
    """
    clip, classes = network.read(batch)
    right = network.actions(clip).gather(1, wanted[:, :1])[:, 0]
    loss = -(right * weights[:, 0]).mean()
    for place in range(PLACES):
        some = wanted[:, 1 + place] > 0
        if some.any():
            part = SeenBatch(*(each[some] for each in batch))
            scores = network.objects(part, clip[some], classes[some], wanted[some, :1], place)[:, 0]
            right = scores.gather(1, wanted[some, 1 + place, None])[:, 0].clamp(min=-30)
            loss = loss - (right * weights[some, 1]).sum() / len(wanted)
    return loss
