"""Words to steps by an LSTM with attention (thesis 4.3, figure 4-2), trained by maximum likelihood.

The words go through an LSTM of 100; at each step the decoder, another LSTM of 100, gets the vector of the step before
and the words it attended to, attends again (eq. 4.4, 4.5), and scores steps (eq. 4.3): those of a closed list, as the
thesis does, or composed of an action and its objects.
"""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import nn
from torch.nn.utils.rnn import pack_padded_sequence, pad_packed_sequence

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
        """Some of the texts."""
        return Memory(*(part[chosen] for part in self))


State = tuple[torch.Tensor, ...]
"""What a decoder knows of programs so far; the rows of each tensor are the programs."""


def word_embedding(vectors: torch.Tensor) -> nn.Embedding:
    """Words as vectors that begin as (V, W) given ones; number 0, no word, stays 0."""
    return nn.Embedding.from_pretrained(vectors.clone(), freeze=False, padding_idx=0)


class Seq2SeqBody(nn.Module):
    """The encoder, and the decoder without its head; `features` is the size of what it gives to the head."""

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
        """Read texts. Packing keeps the padding out: a text's code depends on no other text."""
        words = self.dropout(self.words(batch.inputs))  # (B, L, W)
        packed = pack_padded_sequence(words, batch.lengths, batch_first=True, enforce_sorted=False)
        states, _ = pad_packed_sequence(self.encoder(packed)[0], batch_first=True)  # (B, L, H)
        states = self.dropout(states)
        return Memory(states, self.of_encoder(states), batch.mask, batch.mentioned)

    def start(self, memory: Memory) -> State:
        """The state before the first step: from the mean of the words; nothing attended to."""
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
        """All steps of known programs: (B, T, E), the vectors of the steps before each.

        Returns:
            (B, T, 2 H) features and (B, T, L) attention.
        """
        state, found = self.start(memory), []
        for place in range(previous.shape[1]):
            state, features, attention = self.step(memory, state, previous[:, place])
            found.append((features, attention))
        return torch.stack([each[0] for each in found], 1), torch.stack([each[1] for each in found], 1)
