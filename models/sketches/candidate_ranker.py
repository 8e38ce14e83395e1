"""The network that scores candidates: embedded names and numbers of the choice and of each candidate, in two layers."""

from itertools import pairwise

import torch
from torch import Tensor, nn

from hearth.models.decoding.equal_scores import best_places
from hearth.models.sketches.candidate_choices import Packed


class Ranker(nn.Module):
    """Scores of candidates; a softmax over those of one choice gives their probabilities.

    Args:
        words: numbers of names.
        names, numbers: of a choice.
        candidate_names, candidate_numbers: of a candidate.
        width: of an embedding.
        hidden: of the first layer; the second has half of it.
        dropout: of both.
    """

    def __init__(
        self,
        words: int,
        names: int,
        numbers: int,
        candidate_names: int,
        candidate_numbers: int,
        width: int = 16,
        hidden: int = 128,
        dropout: float = 0.1,
    ) -> None:
        super().__init__()
        self.sizes = names, numbers, candidate_names, candidate_numbers
        self.embedding = nn.Embedding(words, width, padding_idx=0)
        nn.init.normal_(self.embedding.weight, std=0.3)
        self.of_choice = nn.Linear((names + 2) * width + numbers, hidden)
        self.of_candidate = nn.Linear(candidate_names * width + candidate_numbers, hidden, bias=False)
        self.product = nn.Linear((names + 2) * width, candidate_names * width, bias=False)
        self.rest = nn.Sequential(
            nn.ReLU(), nn.Dropout(dropout), nn.Linear(hidden, hidden // 2), nn.ReLU(), nn.Linear(hidden // 2, 1)
        )
        nn.init.zeros_(self.rest[-1].weight)
        nn.init.zeros_(self.rest[-1].bias)
        nn.init.zeros_(self.product.weight)

    def forward(self, batch: Packed) -> Tensor:
        """Return the scores of all candidates, (C,)."""
        columns = batch.names, batch.bag, batch.text, batch.candidate_names
        names, bag, text, c_names = (torch.as_tensor(column).long() for column in columns)
        numbers, c_numbers = (torch.as_tensor(column).float() for column in (batch[2], batch[4]))
        counts = torch.as_tensor(batch.starts[1:] - batch.starts[:-1])
        of = torch.repeat_interleave(torch.arange(len(counts)), counts)  # (C,): whose candidate each is
        context = torch.cat(
            [self.embedding(names).flatten(1), self._mean(bag), self._mean(text)], 1
        )  # (D, (k + 2) * width)
        candidate = self.embedding(c_names).flatten(1)  # (C, k' * width)
        hidden = self.of_choice(torch.cat([context, numbers], 1))[of]
        hidden = hidden + self.of_candidate(torch.cat([candidate, c_numbers], 1))  # (C, hidden)
        alike = (self.product(context)[of] * candidate).sum(1)
        return self.rest(hidden).squeeze(1) + alike

    def _mean(self, bag: Tensor) -> Tensor:
        """Return the mean embedding of each bag, (D, width)."""
        return self.embedding(bag).sum(1) / (bag > 0).sum(1, keepdim=True).clamp(min=1)


def log_probabilities(scores: Tensor, starts: Tensor) -> Tensor:
    """Return the logarithms of the probabilities of candidates, (C,): a softmax over those of each choice."""
    counts = starts[1:] - starts[:-1]
    of = torch.repeat_interleave(torch.arange(len(counts)), counts)
    highest = torch.full((len(counts),), -torch.inf).scatter_reduce(0, of, scores.detach(), "amax")
    shifted = scores - highest[of]
    total = torch.zeros(len(counts)).index_add(0, of, shifted.exp())
    return shifted - total.log()[of]


def loss_of(ranker: Ranker, batch: Packed) -> Tensor:
    """Return the mean negative logarithm of the probability of the right candidates."""
    starts = torch.as_tensor(batch.starts)
    return -log_probabilities(ranker(batch), starts)[starts[:-1] + torch.as_tensor(batch.right)].mean()


def best(scores: Tensor, starts: Tensor) -> list[int]:
    """Return the index of the best candidate of each choice; of equal ones the first."""
    found, places = scores.detach().numpy(), starts.tolist()
    return [best_places(found[a:b])[0] for a, b in pairwise(places)]
