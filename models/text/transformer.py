"""Words to steps by a small transformer (ours), with the memory and the attention that the heads of the LSTM have.

All steps of a known program are computed at once, which is several times as fast as step by step.
"""

import math

import torch
from torch import nn
from torch.nn import functional

from hearth.models.text.seq2seq import Memory, State
from hearth.models.text.text_batches import InputBatch

HEADS = 4
"""Heads of its attention."""


class TransformerBody(nn.Module):
    """Layers of attention over words, and over steps and words; `features` is the size of the head's input."""

    def __init__(self, words: nn.Module, width: int, hidden: int, size: int, dropout: float, layers: int) -> None:
        """`words` makes of a batch's inputs (B, L, width) vectors."""
        super().__init__()
        heads, inner = HEADS, 2 * hidden
        self.words = words
        self.of_words, self.of_steps = nn.Linear(width, hidden), nn.Linear(size, hidden)
        encoder = nn.TransformerEncoderLayer(hidden, heads, inner, dropout, batch_first=True, norm_first=True)
        decoder = nn.TransformerDecoderLayer(hidden, heads, inner, dropout, batch_first=True, norm_first=True)
        self.encoder = nn.TransformerEncoder(encoder, layers, nn.LayerNorm(hidden), enable_nested_tensor=False)
        self.decoder = nn.TransformerDecoder(decoder, layers, nn.LayerNorm(hidden))
        self.key = nn.Linear(hidden, hidden)
        self.dropout = nn.Dropout(dropout)
        self.features = 2 * hidden

    def encode(self, batch: InputBatch) -> Memory:
        """Read texts; words past the end are never attended to."""
        words = self.of_words(self.words(batch.inputs))  # (B, L, H)
        states = self.encoder(self.dropout(_placed(words)), src_key_padding_mask=~batch.mask)
        return Memory(states, self.key(states), batch.mask, batch.mentioned)

    def start(self, memory: Memory) -> State:
        """Return the state before the first step: (B, 0, H), the steps so far."""
        return (memory.states[:, :0],)

    def step(self, memory: Memory, state: State, previous: torch.Tensor) -> tuple[State, torch.Tensor, torch.Tensor]:
        """One step on, from (B, E); as of `Seq2SeqBody`."""
        steps = torch.cat((state[0], self.of_steps(previous)[:, None]), 1)  # (B, t, H)
        features, attention = self._read(memory, steps)
        return (steps,), features[:, -1], attention[:, -1]

    def unroll(self, memory: Memory, previous: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """Return all steps of known programs; as of `Seq2SeqBody`."""
        return self._read(memory, self.of_steps(previous))

    def _read(self, memory: Memory, steps: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """Map (B, T, H) steps to (B, T, 2 H) features and (B, T, L) attention."""
        later = torch.ones(steps.shape[1], steps.shape[1], dtype=torch.bool, device=steps.device).triu(1)
        found = self.decoder(
            self.dropout(_placed(steps)), memory.states, tgt_mask=later, memory_key_padding_mask=~memory.mask
        )
        energy = found @ memory.keys.transpose(1, 2) / math.sqrt(found.shape[-1])  # (B, T, L)
        attention = energy.masked_fill(~memory.mask[:, None], -torch.inf).softmax(-1)
        return torch.cat((found, attention @ memory.states), -1), attention


def _placed(vectors: torch.Tensor) -> torch.Tensor:
    """Return (B, T, H) vectors with waves of their places added, as in the first transformer."""
    count, size = vectors.shape[1:]
    place = torch.arange(count, device=vectors.device)[:, None]
    rate = torch.exp(torch.arange(0, size, 2, device=vectors.device) * (-math.log(10_000) / size))
    waves = torch.cat(((place * rate).sin(), (place * rate).cos()), -1)[:, :size]  # (T, H)
    return vectors + functional.pad(waves, (0, size - waves.shape[1]))
