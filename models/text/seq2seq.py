"""Words to steps by an LSTM with attention (thesis 4.3, figure 4-2), trained by maximum likelihood.

The words go through an LSTM of 100; at each step the decoder, another LSTM of 100, gets the vector of the step before
and the words it attended to, attends again (eq. 4.4, 4.5), and scores steps (eq. 4.3): those of a closed list, as the
thesis does, or composed of an action and its objects.
"""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import nn

from hearth.models.text.text_batches import InputBatch


class Memory(NamedTuple):
    """Encoded texts, each repeated for as many programs as are written for it.

    Attributes:
        states: (B, L, H) of the encoder.
        keys: (B, L, H) the encoder's part of eq. 4.4, computed once.
        mask: (B, L) bool, whether there is a word.
        mentioned: (B, L, C) see `InputBatch`.
    """

    states: torch.Tensor
    keys: torch.Tensor
    mask: torch.Tensor
    mentioned: torch.Tensor

    def rows(self, chosen: torch.Tensor) -> Memory:
        """Return some of the texts."""
        return Memory(*(part[chosen] for part in self))


WAYS = 2, "two directions share it"
"""The number that the hidden state is a multiple of, and the reason."""

State = tuple[torch.Tensor, ...]
"""The state of a decoder after the programs so far; the rows of each tensor are the programs."""


def word_embedding(vectors: torch.Tensor) -> nn.Embedding:
    """Words as vectors that begin as (V, W) given ones; number 0, no word, stays 0."""
    return nn.Embedding.from_pretrained(vectors.clone(), freeze=False, padding_idx=0)


def both_ways(lstm: nn.LSTM, inputs: torch.Tensor, lengths: torch.Tensor) -> torch.Tensor:
    """Return the outputs of a one-layer bidirectional LSTM for padded sequences; 0 past their ends.

    The same as of packed sequences, in a third of the time: each direction is one call, the second on sequences that
    were turned round within their lengths.

    Args:
        lstm: with `batch_first`.
        inputs: (B, L, W).
        lengths: (B,) on the same device.

    Returns:
        (B, L, H), first the forward states.
    """
    place = torch.arange(inputs.shape[1], device=inputs.device).expand(len(inputs), -1)  # (B, L)
    real = place < lengths[:, None]
    turned = torch.where(real, lengths[:, None] - 1 - place, place)[..., None]
    weights, of_turned = lstm.all_weights
    forward = _one_way(inputs, weights)
    backward = _one_way(inputs.take_along_dim(turned, 1), of_turned).take_along_dim(turned, 1)
    states = torch.cat((forward, backward), -1)
    return states * real[..., None]


def _one_way(inputs: torch.Tensor, weights: list[torch.Tensor]) -> torch.Tensor:
    """Return (B, L, H / 2) the states of one direction, from the first place on.

    It has no dropout, so that training says nothing but whether there will be gradients: a GPU refuses those of
    `training=False`, and policy gradient has them with the network in `eval` mode.
    """
    begin = inputs.new_zeros(1, len(inputs), weights[1].shape[1])
    train = torch.is_grad_enabled()
    states: torch.Tensor = torch.lstm(inputs, (begin, begin), weights, True, 1, 0.0, train, False, True)[0]
    return states


class Seq2SeqBody(nn.Module):
    """The encoder, and the decoder without its head; `features` is the size of the head's input."""

    def __init__(self, words: nn.Module, width: int, hidden: int, size: int, dropout: float) -> None:
        """`words` makes of a batch's inputs (B, L, width) vectors, such as `word_embedding`."""
        super().__init__()
        self.words = words
        self.encoder = nn.LSTM(width, hidden // 2, batch_first=True, bidirectional=True)
        self.cell = nn.LSTMCell(size + hidden, hidden)
        self.bridge = nn.Linear(hidden, 2 * hidden)
        self.of_decoder = nn.Linear(hidden, hidden)
        self.of_encoder = nn.Linear(hidden, hidden, bias=False)
        self.v = nn.Linear(hidden, 1, bias=False)
        self.dropout = nn.Dropout(dropout)
        self.features = 2 * hidden

    def encode(self, batch: InputBatch) -> Memory:
        """Read texts: a text's code depends on no other text."""
        words = self.dropout(self.words(batch.inputs))  # (B, L, W)
        states = self.dropout(both_ways(self.encoder, words, batch.lengths.to(words.device)))  # (B, L, H)
        return Memory(states, self.of_encoder(states), batch.mask, batch.mentioned)

    def start(self, memory: Memory) -> State:
        """Return the state before the first step: from the mean of the words; nothing attended to."""
        weights = memory.mask[..., None].to(memory.states.dtype)
        mean = (memory.states * weights).sum(1) / weights.sum(1)  # (B, H)
        hidden, cell = self.bridge(mean).tanh().chunk(2, -1)
        return hidden, cell, torch.zeros_like(mean)

    def step(self, memory: Memory, state: State, previous: torch.Tensor) -> tuple[State, torch.Tensor, torch.Tensor]:
        """One step on, from (B, E), the vectors of the steps before.

        Returns:
            The state, (B, 2 H) features of h^t and x_t^att, and (B, L) the attention.
        """
        hidden, cell, attended = state
        hidden, cell = self.cell(torch.cat((previous, attended), -1), (hidden, cell))
        energy = self.v((self.of_decoder(hidden)[:, None] + memory.keys).tanh())[..., 0]  # (B, L), eq. 4.4
        attention = energy.masked_fill(~memory.mask, -torch.inf).softmax(-1)
        attended = torch.einsum("bl,blh->bh", attention, memory.states)  # eq. 4.5
        return (hidden, cell, attended), torch.cat((hidden, attended), -1), attention

    def unroll(self, memory: Memory, previous: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """Return all steps of known programs: (B, T, E), the vectors of the steps before each.

        Returns:
            (B, T, 2 H) features and (B, T, L) attention.
        """
        state, found = self.start(memory), []
        for place in range(previous.shape[1]):
            state, features, attention = self.step(memory, state, previous[:, place])
            found.append((features, attention))
        return torch.stack([each[0] for each in found], 1), torch.stack([each[1] for each in found], 1)
