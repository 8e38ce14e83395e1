"""The network from pictures from above to steps (thesis 5.4.3, A.1).

One network reads the colors and one the masks. Their outputs are fused with the features of each class in the masks. A
recurrent network then reads the pictures in order, and the decoder attends to them.

The thesis's network for colours is a ResNet-18 with weights of ImageNet, which are not to be had: ours is small and
learns from nothing but these pictures.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import torch
from torch import Tensor, nn
from torch.nn import functional
from torch.nn.utils.rnn import pack_padded_sequence, pad_packed_sequence

from hearth.models.demonstrations.overhead_features import NUMBERS, PEOPLE
from hearth.models.text.seq2seq import Seq2SeqBody, State

VECTOR = 24
"""Numbers that are learned for a class."""

COLOUR = 8
"""Planes of the masks: each class has a colour, which is learned from its properties."""

SEEN = 64
"""Numbers in the output of a network that reads the area around the person."""

UNNAMED = 0.15
"""The share of classes whose learned numbers are left out in training, so that new ones can be understood."""


class FrameBatch(NamedTuple):
    """B demonstrations of at most L pictures; see `Above`. Classes are numbers of the vocabulary.

    Attributes:
        classes: (B, L, K) int64.
        numbers: (B, L, K, NUMBERS).
        people: (B, L, PEOPLE).
        masks: (B, L, G, G) int64.
        colours: (B, L, 3, S, S), from -0.5 to 0.5.
        lengths: (B,) int64, at least 1, on the processor.
    """

    classes: Tensor
    numbers: Tensor
    people: Tensor
    masks: Tensor
    colours: Tensor
    lengths: Tensor

    @property
    def inputs(self) -> Tensor:
        """Return the tensor whose rows a writer counts as demonstrations."""
        return self.classes

    @property
    def words(self) -> Tensor:
        """Return the same tensor as `inputs`."""
        return self.inputs

    @property
    def mask(self) -> Tensor:
        """Return (B, L) bool: whether there is a picture."""
        device = self.classes.device
        return torch.arange(self.classes.shape[1], device=device) < self.lengths.to(device)[:, None]


class FrameMemory(NamedTuple):
    """Encoded demonstrations, each repeated for as many sketches as are written for it.

    Attributes:
        states: (B, L, H).
        keys: (B, L, H) the encoder's part of the attention, computed once.
        mask: (B, L) bool, whether there is a picture.
        mentioned: (B, L, C) how probable it is that the step is about a class.
        kept: (B, L) logits of whether a sketch keeps the step before the picture.
        done: (B, L, A) scores of that step's action; 0 is none.
        about: (B, L, K) logits of whether that step is about each class that is seen.
    """

    states: Tensor
    keys: Tensor
    mask: Tensor
    mentioned: Tensor
    kept: Tensor
    done: Tensor
    about: Tensor

    def rows(self, chosen: Tensor) -> FrameMemory:
        """Return some of the demonstrations."""
        return FrameMemory(*(part[chosen] for part in self))


def _convolutions(sizes: Sequence[tuple[int, int, int, int]]) -> nn.Sequential:
    """Convolutions with batch normalisation, and 16 places of their result: planes before and after, width, stride."""
    layers = [(nn.Conv2d(one, other, width, stride, width // 2), nn.BatchNorm2d(other), nn.ReLU())
              for one, other, width, stride in sizes]  # fmt: skip
    return nn.Sequential(*(each for layer in layers for each in layer), nn.AdaptiveAvgPool2d(4), nn.Flatten())


class MaskNetwork(nn.Module):
    """The network of table A.1 over masks: three convolutions with batch normalisation, and a layer.

    The first one takes every second pixel: the thesis's takes each, of pictures of 240 by 320.
    """

    def __init__(self, traits: int) -> None:
        super().__init__()
        self.colour = nn.Linear(traits, COLOUR)
        self.layers = _convolutions(((COLOUR, 16, 5, 2), (16, 32, 5, 1), (32, 32, 5, 3)))
        self.last = nn.Linear(32 * 16, SEEN)

    def forward(self, masks: Tensor, traits: Tensor) -> Tensor:
        """Map (N, G, G) classes and (C, traits) to (N, SEEN)."""
        planes = self.colour(traits)[masks].permute(0, 3, 1, 2)
        return functional.relu(self.last(self.layers(planes)))


class ImageNetwork(nn.Module):
    """The network over colours."""

    def __init__(self) -> None:
        super().__init__()
        self.layers = _convolutions(((3, 16, 5, 2), (16, 32, 3, 2), (32, 32, 3, 2)))
        self.last = nn.Linear(32 * 16, SEEN)

    def forward(self, colours: Tensor) -> Tensor:
        """Map (N, 3, S, S) to (N, SEEN)."""
        return functional.relu(self.last(self.layers(colours)))


class FrameBody(Seq2SeqBody):
    """Reads demonstrations, and decodes; see `Writer`.

    Args:
        traits: (C, traits) of the classes; those of no class are 0.
        served: (C, S) numbers of the classes that each may stand for.
        actions: of the vocabulary, and none.
        hidden: numbers in a hidden state.
        size: of the vector of a step.
        dropout: share of numbers left out in training.
        sees: whether it has a network over colors, one over masks, and the features of each class in the masks.
    """

    def __init__(
        self, traits: Tensor, served: Tensor, actions: int, hidden: int, size: int, dropout: float,
        sees: tuple[bool, bool, bool],
    ) -> None:  # fmt: skip
        nn.Module.__init__(self)
        self.register_buffer("traits", traits, persistent=False)
        self.register_buffer("served", served, persistent=False)
        self.image = ImageNetwork() if sees[0] else None
        self.masks = MaskNetwork(traits.shape[1]) if sees[1] else None
        self.facts = sees[2]
        self.vector = nn.Embedding(len(traits), VECTOR)
        self.token = nn.Sequential(nn.Linear(NUMBERS + traits.shape[1] + VECTOR, hidden), nn.ReLU(),
                                   nn.Dropout(dropout), nn.Linear(hidden, hidden), nn.ReLU())  # fmt: skip
        width = (2 * hidden + PEOPLE) * sees[2] + SEEN * (sees[0] + sees[1])
        self.frame = nn.Sequential(nn.Linear(width, hidden), nn.ReLU())
        self.encoder = nn.GRU(hidden, hidden // 2, batch_first=True, bidirectional=True)
        self.about = nn.Sequential(nn.Linear(2 * hidden, hidden), nn.Tanh(), nn.Linear(hidden, 1))
        self.kept, self.done = nn.Linear(hidden, 1), nn.Linear(hidden, actions)
        self.cell = nn.GRUCell(size + hidden, hidden)
        self.bridge = nn.Linear(hidden, hidden)
        self.of_decoder = nn.Linear(hidden, hidden)
        self.of_encoder = nn.Linear(hidden, hidden, bias=False)
        self.v = nn.Linear(hidden, 1, bias=False)
        self.trust = nn.Parameter(torch.tensor([1.0, -2.0]))
        self.dropout = nn.Dropout(dropout)
        self.features = 2 * hidden + 1
        nn.init.normal_(self.vector.weight, std=0.1)

    def encode(self, batch: FrameBatch | FrameMemory) -> FrameMemory:  # type: ignore[override]
        """Read demonstrations, and return a batch that was read already as it is.

        No state depends on another demonstration.
        """
        if isinstance(batch, FrameMemory):
            return batch
        tokens = self._tokens(batch)  # (B, L, K, H)
        frames = self.dropout(self.frame(self._frames(batch, tokens)))
        packed = pack_padded_sequence(frames, batch.lengths, batch_first=True, enforce_sorted=False)
        states, _ = pad_packed_sequence(self.encoder(packed)[0], batch_first=True)  # (B, L, H)
        states = self.dropout(states)
        beside = states[:, :, None].expand(-1, -1, tokens.shape[2], -1)
        about = self.about(torch.cat((tokens, beside), -1))[..., 0]  # (B, L, K)
        about = about.masked_fill(batch.classes == 0, -20.0)
        kept = self.kept(states)[..., 0]
        return FrameMemory(states, self.of_encoder(states), batch.mask, self._mentioned(batch, about), kept,
                           self.done(states), about)  # fmt: skip

    def _tokens(self, batch: FrameBatch) -> Tensor:
        vectors = self.vector(batch.classes)
        if self.training:
            vectors = vectors * (torch.rand(*batch.classes.shape, 1, device=vectors.device) >= UNNAMED)
        found: Tensor = self.token(torch.cat((batch.numbers, self.traits[batch.classes], vectors), -1))
        return found * (batch.classes > 0)[..., None]

    def _frames(self, batch: FrameBatch, tokens: Tensor) -> Tensor:
        """Return (B, L, width) of each picture; networks look at those that there are."""
        parts = []
        if self.facts:
            nearest = batch.numbers[..., :1]
            parts += [tokens.amax(2), (tokens * nearest).sum(2) / (nearest.sum(2) + 1), batch.people]
        real = batch.mask
        if self.image is not None:
            parts.append(_spread(self.image(batch.colours[real]), real))
        if self.masks is not None:
            parts.append(_spread(self.masks(batch.masks[real], self.traits), real))
        return torch.cat(parts, -1)

    def _mentioned(self, batch: FrameBatch, about: Tensor) -> Tensor:
        """Return (B, L, C) for each class the most probable of the seen classes that may stand for it."""
        found = torch.zeros(*about.shape[:2], len(self.traits), device=about.device)
        for place in range(self.served.shape[1]):
            numbers = self.served[:, place][batch.classes]  # (B, L, K)
            weights = about.sigmoid() * (numbers > 0) * (1.0 if place == 0 else 0.5)
            found = found.scatter_reduce(2, numbers, weights, "amax")
        if not self.facts:
            return torch.zeros_like(found)
        return found

    def start(self, memory: FrameMemory) -> State:  # type: ignore[override]
        """Return the state before the first step.

        From the mean of the pictures; nothing attended to, nothing passed.
        """
        weights = memory.mask[..., None].to(memory.states.dtype)
        mean = (memory.states * weights).sum(1) / weights.sum(1)  # (B, H)
        return self.bridge(mean).tanh(), torch.zeros_like(mean), torch.zeros_like(memory.kept)

    def step(  # type: ignore[override]
        self, memory: FrameMemory, state: State, previous: Tensor
    ) -> tuple[State, Tensor, Tensor]:
        """One step on, as of `Seq2SeqBody`. Pictures of steps that are kept attract the attention; those that it has
        passed repel it: the steps of a sketch are in the order of the demonstration."""
        hidden, attended, passed = state
        hidden = self.cell(torch.cat((previous, attended), -1), hidden)
        energy = self.v((self.of_decoder(hidden)[:, None] + memory.keys).tanh())[..., 0]  # (B, L)
        energy = energy + self.trust[0] * functional.logsigmoid(memory.kept) + self.trust[1] * passed
        attention = energy.masked_fill(~memory.mask, -torch.inf).softmax(-1)
        attended = torch.einsum("bl,blh->bh", attention, memory.states)
        left = (memory.kept.sigmoid() * (1 - passed) * memory.mask).sum(-1, keepdim=True)
        passed = torch.maximum(passed, attention.flip(-1).cumsum(-1).flip(-1))
        return (hidden, attended, passed), torch.cat((hidden, attended, left), -1), attention


def _spread(found: Tensor, real: Tensor) -> Tensor:
    """Return (N, F) of the pictures that there are as (B, L, F)."""
    return torch.zeros(*real.shape, found.shape[-1], device=found.device, dtype=found.dtype).masked_scatter(
        real[..., None], found
    )
