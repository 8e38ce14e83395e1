"""A network that writes programs: a body that reads words, and a head that scores steps; its loss, and its decoding."""

from __future__ import annotations

from typing import NamedTuple

import torch
from torch import nn
from torch.nn import functional

from hearth.models.text.seq2seq import Memory, State
from hearth.models.text.step_heads import NEVER, ClosedHead, ComposedHead, Context, StepEmbedding
from hearth.models.text.text_batches import InputBatch, StepBatch

Numbers = tuple[tuple[int, int, int], ...]


class Draft(NamedTuple):
    """N programs that are being written.

    Attributes:
        memory: of their texts.
        state: of the decoder.
        last: (N, 3) the step before; (beginning, 0, 0) at first.
        used: (N, C) how often each class is in the program.
    """

    memory: Memory
    state: State
    last: torch.Tensor
    used: torch.Tensor

    def rows(self, chosen: torch.Tensor) -> Draft:
        """Return some of the programs."""
        return Draft(
            self.memory.rows(chosen), tuple(part[chosen] for part in self.state), self.last[chosen], self.used[chosen]
        )


class Writer(nn.Module):
    """A body and a head.

    A body reads texts (`encode`), and decodes: `start`, `step` and `unroll`, as those of `Seq2SeqBody`; `features` is
    the size of the head's input.
    """

    def __init__(
        self, body: nn.Module, embedding: StepEmbedding, head: ComposedHead | ClosedHead, dropout: float
    ) -> None:
        super().__init__()
        self.dropout = nn.Dropout(dropout)
        self.body, self.embedding, self.head = body, embedding, head
        self.classes = embedding.classes.num_embeddings
        self.beginning = embedding.actions.num_embeddings - 1

    @property
    def device(self) -> torch.device:
        """Return where its weights are."""
        return self.embedding.actions.weight.device

    def log_probabilities(self, texts: InputBatch, programs: StepBatch) -> torch.Tensor:
        """Return (B, T) the logarithm of the probability of each step, given the true steps before; 0 past the end."""
        memory = self.body.encode(texts)
        shifted = functional.pad(programs.steps[:, :-1], (0, 0, 1, 0))  # (B, T, 3)
        shifted[:, 0, 0] = self.beginning
        features, attention = self.body.unroll(memory, self.embedding(shifted))
        one_hot = functional.one_hot(shifted[..., 1:], self.classes).sum(2)  # (B, T, C)
        used = one_hot.cumsum(1).to(features.dtype)
        used[..., 0] = 0
        real = programs.weights > 0  # (B, T)
        attended = attention @ memory.mentioned  # (B, T, C)
        mentioned = memory.mentioned.amax(1)[real.nonzero()[:, 0]]  # (N, C)
        context = Context(self.dropout(features[real]), attended[real], mentioned, used[real], shifted[real][:, 1])
        found = self.head.log_probability(context, programs.steps[real])
        return torch.zeros_like(programs.weights).masked_scatter(real, found)

    def loss(self, texts: InputBatch, programs: StepBatch) -> torch.Tensor:
        """Return the mean over steps of minus the logarithm of the probability."""
        return -self.log_probabilities(texts, programs).sum() / programs.weights.sum()

    def begin(self, texts: InputBatch) -> Draft:
        """Programs without steps, one for each text."""
        memory = self.body.encode(texts)
        count = len(memory.states)
        last = torch.zeros(count, 3, dtype=torch.int64, device=self.device)
        last[:, 0] = self.beginning
        return Draft(memory, self.body.start(memory), last, torch.zeros(count, self.classes, device=self.device))

    def look(self, draft: Draft) -> tuple[Draft, Context]:
        """Return programs with the decoder one step on, and the head's input for scoring the next step."""
        state, features, attention = self.body.step(draft.memory, draft.state, self.embedding(draft.last))
        mentioned = draft.memory.mentioned
        attended = torch.einsum("nl,nlc->nc", attention, mentioned)
        context = Context(features, attended, mentioned.amax(1), draft.used, draft.last[:, 1])
        return draft._replace(state=state), context

    def write(self, draft: Draft, steps: torch.Tensor) -> Draft:
        """Programs with (N, 3) steps after them."""
        used = draft.used + functional.one_hot(steps[:, 1:], self.classes).sum(1)
        used[:, 0] = 0
        return draft._replace(last=steps, used=used)


def beam(writer: Writer, texts: InputBatch, width: int, longest: int) -> list[Numbers]:
    """Return the best program for each text by beam search: greedy for a width of 1.

    A program's score is the mean logarithm of the probability of its steps, its end included.

    Args:
        writer: in evaluation mode.
        texts: B texts.
        width: programs followed for each text.
        longest: steps at most.
    """
    count, device = len(texts.inputs), writer.device
    draft = writer.begin(texts).rows(torch.arange(count, device=device).repeat_interleave(width))
    totals = torch.full((count, width), NEVER, device=device)
    totals[:, 0] = 0
    written = torch.zeros(count, width, 0, 3, dtype=torch.int64, device=device)
    finished: list[list[tuple[float, Numbers]]] = [[] for _ in range(count)]
    for length in range(1, longest + 2):
        draft, context = writer.look(draft)
        scores, steps = writer.head.best(context, width)  # (B W, K)
        every = (totals.reshape(-1, 1) + scores).reshape(count, -1)  # (B, W K)
        totals, order = every.topk(width)  # (B, W)
        parents = order // scores.shape[1]  # (B, W)
        chosen = steps.reshape(count, -1, 3).gather(1, order[..., None].expand(-1, -1, 3))  # (B, W, 3)
        written = written.gather(1, parents[..., None, None].expand(-1, -1, written.shape[2], 3))
        ends = (chosen[..., 0] == 0) | (length > longest)
        _finish(finished, ends & (totals > NEVER / 2), totals / length, written)
        totals = totals.masked_fill(ends, NEVER)
        if all(len(found) >= width for found in finished) or bool(ends.all()):
            break
        written = torch.cat((written, chosen[:, :, None]), 2)
        rows = (parents + torch.arange(count, device=device)[:, None] * width).reshape(-1)
        draft = writer.write(draft.rows(rows), chosen.reshape(-1, 3))
    return [max(found, key=lambda each: each[0])[1] if found else () for found in finished]


def _finish(
    finished: list[list[tuple[float, Numbers]]], ends: torch.Tensor, scores: torch.Tensor, written: torch.Tensor
) -> None:
    for row, place in ends.nonzero().tolist():
        finished[row].append((float(scores[row, place]), _numbers(written[row, place])))


def _numbers(steps: torch.Tensor) -> Numbers:
    return tuple((action, first, second) for action, first, second in steps.tolist())


def sample(writer: Writer, texts: InputBatch, longest: int, generator: torch.Generator) -> list[Numbers]:
    """Return a program for each text, drawn step by step."""
    draft = writer.begin(texts)
    rows: list[list[tuple[int, int, int]]] = [[] for _ in range(len(texts.inputs))]
    going = list(range(len(rows)))
    for _ in range(longest):
        draft, context = writer.look(draft)
        steps = writer.head.sample(context, generator)
        kept = steps[:, 0] > 0
        going = [row for row, goes in zip(going, kept.tolist(), strict=True) if goes]
        for row, step in zip(going, steps[kept].tolist(), strict=True):
            rows[row].append((step[0], step[1], step[2]))
        if not going:
            break
        draft = writer.write(draft.rows(kept), steps[kept])
    return [tuple(row) for row in rows]
