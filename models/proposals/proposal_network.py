"""The goal proposal network (thesis C.3.2, figure C-2): how often each predicate of the goal is wanted."""

import torch
from torch import Tensor, nn


class ProposalNetwork(nn.Module):
    """A network from the increase of each predicate's count since the start to the wanted counts.

    Each increase, a one-hot vector, goes through one layer of d units; all of them together through an MLP to h units
    for each predicate of goals; those through an MLP to the counts. Only predicates that goals have are predicted: the
    others are never wanted.
    """

    def __init__(self, inputs: int, outputs: int, counts: int, d: int, h: int) -> None:
        super().__init__()
        self.outputs, self.h = outputs, h
        self.rows = nn.Embedding(counts, d)  # of a one-hot vector, a layer is a table
        self.whole = nn.Sequential(nn.ReLU(), nn.Linear(inputs * d, h), nn.ReLU(), nn.Linear(h, outputs * h), nn.ReLU())
        each = [layer for _ in range(3) for layer in (nn.Linear(h, h), nn.ReLU())]
        self.each = nn.Sequential(*each, nn.Linear(h, counts))

    def forward(self, increases: Tensor) -> Tensor:
        """Logarithms of probabilities (B, P, c) of the counts, from increases (B, p) below c."""
        rows = self.rows(increases).flatten(1)
        found = self.each(self.whole(rows).view(-1, self.outputs, self.h))
        return torch.log_softmax(found, dim=-1)
