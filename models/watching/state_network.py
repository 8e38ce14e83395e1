"""The thesis's network that infers goals (figure B-6): a transformer over the things of a moment, an LSTM over time,
and a classifier for each predicate's count.

`object_network` classifies each thing instead: whether it counts. `challenge learn wah --what goals-moments` trains
this network.
"""

import torch
from torch import Tensor, nn

from hearth.models.watching.demonstration_batches import Packed
from hearth.models.watching.object_sightings import Layout

MOMENTS = 12
"""Moments of a demonstration, at equal distances; the thesis has every tick."""

EMBEDDED = 32

RARE = 4.0
"""Logarithm of how much likelier a predicate is not wanted than wanted once, before anything is learnt."""


class MomentNetwork(nn.Module):
    """A network that predicts how often each predicate is wanted.

    Args:
        layout: of P predicates.
        width: of the transformer and of the LSTM.
        layers: of the transformer.
        heads: of its attention.
        most: the greatest count.
        dropout: of the transformer.
    """

    def __init__(
        self, layout: Layout, width: int = 128, layers: int = 1, heads: int = 4, most: int = 8, dropout: float = 0.1
    ) -> None:
        super().__init__()
        self.most, self.predicates = most, len(layout.cells)
        self.kind = nn.Embedding(layout.kinds + 1, EMBEDDED, padding_idx=0)
        self.place = nn.Embedding(layout.places + 1, EMBEDDED)
        self.thing = nn.Linear(2 * EMBEDDED, width)
        layer = nn.TransformerEncoderLayer(width, heads, 2 * width, dropout, batch_first=True, norm_first=True)
        self.over_things = nn.TransformerEncoder(layer, layers, nn.LayerNorm(width), enable_nested_tensor=False)
        self.over_time = nn.LSTM(width, width, batch_first=True)
        self.count = nn.Linear(width, self.predicates * (most + 1))
        nn.init.zeros_(self.count.weight)
        nn.init.zeros_(self.count.bias)
        # Few predicates are wanted. Were all counts as likely at first, learning that would saturate the LSTM.
        nn.init.constant_(self.count.bias.data.unflatten(0, (self.predicates, most + 1))[:, 0], RARE)

    def forward(self, batch: Packed) -> Tensor:
        """Return the logarithms of the probabilities of each predicate's counts, (D, P, most + 1)."""
        kinds, places = torch.as_tensor(batch.kinds), torch.as_tensor(batch.places)
        there = _places_at(places, torch.as_tensor(batch.times))  # (D, M, T)
        kind = self.kind(kinds)[:, None].expand(-1, MOMENTS, -1, -1)
        things = self.thing(torch.cat([kind, self.place(there)], 3))  # (D, M, T, width)
        nothing = (kinds == 0)[:, None].expand(-1, MOMENTS, -1)
        alone = nothing.all(2, keepdim=True)  # attention needs something to attend to
        seen = self.over_things(things.flatten(0, 1), src_key_padding_mask=(nothing & ~alone).flatten(0, 1))
        weights = (~nothing).float().flatten(0, 1)[..., None]
        mean = (seen * weights).sum(1) / weights.sum(1).clamp(min=1.0)  # (D * M, width)
        states, _ = self.over_time(mean.unflatten(0, (len(kinds), MOMENTS)))
        return self.count(states[:, -1]).unflatten(1, (self.predicates, self.most + 1)).log_softmax(2)


def _places_at(places: Tensor, times: Tensor) -> Tensor:
    """Return the place in which each thing was last seen at each moment, (D, M, T); 0 before it is seen."""
    moments = torch.linspace(0.0, 1.0, MOMENTS)
    before = (times[:, None] <= moments[None, :, None, None] + 1e-6) & (places[:, None] > 0)  # (D, M, T, E)
    last = before.sum(3) - 1
    found = places[:, None].expand(-1, MOMENTS, -1, -1).gather(3, last.clamp(min=0)[..., None])[..., 0]
    return found.masked_fill(last < 0, 0)
