"""The network that infers goals: an LSTM over the places of each thing, a transformer over things, sums.

The thesis's network (figure B-6) has a transformer over the things of a moment, an LSTM over time, and 30 classifiers
over their mean, and so learns which predicates go together: two activities at once defeat it (.68 and .64). This one
asks of each thing whether it counts, and adds up.
"""

import torch
from torch import Tensor, nn

from hearth.models.watching.demonstration_batches import Packed
from hearth.models.watching.object_sightings import Layout

LEAST = 1e-4
"""Probability of any number of things, whatever the network says."""


class ThingNetwork(nn.Module):
    """A network that predicts how often each predicate is wanted.

    Args:
        layout: of P predicates.
        width: of the LSTM and of the transformer.
        layers: of the transformer.
        heads: of its attention.
        most: the greatest count.
        dropout: of the transformer.
    """

    cells: Tensor
    possible: Tensor

    def __init__(
        self, layout: Layout, width: int = 128, layers: int = 1, heads: int = 4, most: int = 8, dropout: float = 0.1
    ) -> None:
        super().__init__()
        self.most = most
        self.kind = nn.Embedding(layout.kinds + 1, 32, padding_idx=0)
        self.place = nn.Embedding(layout.places + 1, 32, padding_idx=0)
        self.over_time = nn.LSTM(66, width, batch_first=True)
        layer = nn.TransformerEncoderLayer(width, heads, 2 * width, dropout, batch_first=True, norm_first=True)
        self.over_things = nn.TransformerEncoder(layer, layers, enable_nested_tensor=False)
        self.counts_for = nn.Linear(width, layout.places)
        nn.init.zeros_(self.counts_for.weight)
        nn.init.zeros_(self.counts_for.bias)
        possible = torch.zeros(layout.kinds + 1, layout.places, dtype=torch.bool)
        possible[:, 0] = True  # a thing may count for nothing
        for kind, place in layout.cells:
            possible[kind + 1, place] = True
        self.register_buffer("possible", possible, persistent=False)
        self.register_buffer("cells", torch.tensor(layout.cells), persistent=False)

    def things(self, batch: Packed) -> Tensor:
        """Return the probability that each thing counts for each place, (D, T, places); the first is for none."""
        kinds, places = torch.as_tensor(batch.kinds), torch.as_tensor(batch.places)
        times = torch.as_tensor(batch.times)
        since = torch.diff(times, dim=2, prepend=times[:, :, :1])
        kind = self.kind(kinds)[:, :, None].expand(-1, -1, places.shape[2], -1)
        steps = torch.cat([self.place(places), kind, times[..., None], since[..., None]], 3)  # (D, T, E, 66)
        states, _ = self.over_time(steps.flatten(0, 1))  # (D * T, E, width)
        last = (places > 0).sum(2).clamp(min=1).flatten() - 1
        thing = states[torch.arange(len(states)), last].unflatten(0, kinds.shape)  # (D, T, width)
        nothing = kinds == 0
        nothing = nothing & ~nothing.all(1, keepdim=True)  # attention needs something to attend to
        thing = self.over_things(thing, src_key_padding_mask=nothing)
        scores = self.counts_for(thing).masked_fill(~self.possible[kinds], -torch.inf)
        return scores.softmax(2)

    def forward(self, batch: Packed) -> Tensor:
        """Return the logarithms of the probabilities of each predicate's counts, (D, P, most + 1).

        Things are independent.
        """
        kinds = torch.as_tensor(batch.kinds)
        chance = self.things(batch)[:, :, self.cells[:, 1]]  # (D, T, P)
        chance = chance * (kinds[:, :, None] == self.cells[:, 0] + 1)
        found = torch.zeros(len(kinds), len(self.cells), self.most + 1)
        found[:, :, 0] = 1
        for number in range(kinds.shape[1]):
            one = chance[:, number, :, None]
            more = torch.cat([torch.zeros_like(found[:, :, :1]), found[:, :, :-1]], 2)
            found = found * (1 - one) + more * one
        return ((1 - LEAST) * found + LEAST / (self.most + 1)).log()


def loss_of(network: nn.Module, batch: Packed) -> Tensor:
    """Return the mean of minus the logarithm of the probability of goals, their predicates being independent."""
    found: Tensor = network(batch)
    wanted = torch.as_tensor(batch.counts).clamp(max=found.shape[2] - 1)
    return -found.gather(2, wanted[:, :, None]).sum((1, 2)).mean()
