"""The networks of Hybrid and HRL (figures B-7, B-8): a transformer over visible nodes, attention by goals, an LSTM.

They differ from the figures in four points. The second choice depends on the first. The LSTM also receives the encoding
of the goal. A part of the goal counts as often as it is missing by belief, not as often as it was wanted at first.
Impossible actions have no probability.
"""

from typing import NamedTuple

import torch
from torch import Tensor, nn

from hearth.models.helping.policy_inputs import FEATURES, KINDS, MOST_CLASSES, Batch

State = tuple[Tensor, Tensor]
"""State of the LSTM."""


class Outlook(NamedTuple):
    """The output of a network for B sequences of T scenes.

    Attributes:
        first: (B, T, A), logarithms of the probabilities of the first choice.
        second: (B, T, A, M), of the second choice, given the first choice.
        value: (B, T), the return that is expected.
        state: of the LSTM after the last scene.
        close: (B, T, N), scores of nodes' being within reach; None where that is not predicted.
    """

    first: Tensor
    second: Tensor
    value: Tensor
    state: State
    close: Tensor | None = None


class SceneEncoder(nn.Module):
    """An encoder of visible nodes, and of a scene as a whole.

    Args:
        width: of every vector.
        heads: of attention.
    """

    def __init__(self, width: int, heads: int) -> None:
        super().__init__()
        self.classes = nn.Embedding(MOST_CLASSES, 64, padding_idx=0)
        self.node = nn.Linear(64 + len(FEATURES), width)
        layer = nn.TransformerEncoderLayer(width, heads, 2 * width, 0.0, batch_first=True, norm_first=True)
        self.together = nn.TransformerEncoder(layer, 1, enable_nested_tensor=False)

    def forward(self, batch: Batch) -> tuple[Tensor, Tensor]:
        """Return vectors of nodes, (B, T, N, width), and their mean, (B, T, width); zeros where there is no scene."""
        at = torch.as_tensor(batch.there)
        classes, features = torch.as_tensor(batch.classes)[at], torch.as_tensor(batch.features)[at]  # (scenes, N)
        nodes = self.node(torch.cat([self.classes(classes), features], -1))
        absent = classes == 0
        absent = absent & ~absent.all(1, keepdim=True)  # attention needs something to attend to
        nodes = self.together(nodes, src_key_padding_mask=absent)
        there = (classes > 0).unsqueeze(-1).to(nodes.dtype)
        context = (nodes * there).sum(1) / there.sum(1).clamp(min=1)
        return _spread(nodes, at), _spread(context, at)


def _spread(found: Tensor, at: Tensor) -> Tensor:
    """Return the values of the existing scenes at their places, with zeros for the others."""
    return found.new_zeros(*at.shape, *found.shape[1:]).index_put((at,), found)


class GoalEncoder(nn.Module):
    """The parts of a goal, summed as often as each is missing (figure B-8)."""

    def __init__(self, things: int, places: int, width: int) -> None:
        super().__init__()
        self.thing = nn.Embedding(things + 1, width, padding_idx=0)
        self.place = nn.Embedding(places + 1, width, padding_idx=0)
        self.part = nn.Linear(2 * width, width)

    def forward(self, wanted: Tensor) -> Tensor:
        """Map (B, T, G, 3) to (B, T, width)."""
        words = torch.cat([self.thing(wanted[..., 0]), self.place(wanted[..., 1])], -1)
        return (torch.relu(self.part(words)) * wanted[..., 2:]).sum(-2)


class Seen(NamedTuple):
    """The common part of both networks for B sequences of T scenes, before they choose.

    Attributes:
        nodes: (B, T, N, width), of each visible node.
        goal: (B, T, width), of the missing parts of the goal.
        latent: (B, T, width), of all that was seen until then.
        state: of the LSTM after the last scene.
    """

    nodes: Tensor
    goal: Tensor
    latent: Tensor
    state: State


class Trunk(nn.Module):
    """Scene, goal and memory, which both networks have, and the expected return.

    Args:
        things, places: how many words there are.
        width: of every vector.
        heads: of attention.
    """

    def __init__(self, things: int, places: int, width: int, heads: int) -> None:
        super().__init__()
        self.encoder = SceneEncoder(width, heads)
        self.goal = GoalEncoder(things, places, width)
        self.memory = nn.LSTM(2 * width, width, batch_first=True)
        self.value = nn.Linear(width, 1)

    def seen(self, batch: Batch, attention: nn.Linear, state: State | None) -> Seen:
        """Remember scenes, with attention to the missing parts of the goal."""
        nodes, context = self.encoder(batch)
        goal = self.goal(torch.as_tensor(batch.wanted))
        context = context * torch.sigmoid(attention(goal))
        latent, state = self.memory(torch.cat([context, goal], -1), state)
        return Seen(nodes, goal, latent, state)


class SubgoalNetwork(Trunk):
    """Chooses the class of things and the place of the next subgoal (figure B-8); arguments as of `Trunk`."""

    def __init__(self, things: int, places: int, width: int = 128, heads: int = 4) -> None:
        super().__init__(things, places, width, heads)
        self.attention = nn.Linear(width, width)
        self.things = nn.Linear(width, things)
        self.places = nn.Linear(width, places)
        self.given = nn.Embedding(things, width)

    def forward(self, batch: Batch, state: State | None = None) -> Outlook:
        """Shapes as in `Outlook`: A things, M places."""
        _, _, latent, state = self.seen(batch, self.attention, state)
        chosen = torch.tanh(latent[:, :, None] + self.given.weight)  # (B, T, things, width)
        first, second = self.things(latent), self.places(chosen)
        return Outlook(first.log_softmax(-1), second.log_softmax(-1), self.value(latent)[..., 0], state)


class ActionNetwork(Trunk):
    """Chooses a kind of action and a visible node for a subgoal (figure B-7); arguments as of `Trunk`."""

    def __init__(self, things: int, places: int, width: int = 128, heads: int = 4) -> None:
        super().__init__(things, places, width, heads)
        self.of_nodes, self.of_context = nn.Linear(width, width), nn.Linear(width, width)
        self.kinds = nn.Linear(width, len(KINDS))
        self.given = nn.Embedding(len(KINDS), width)
        self.asked, self.key = nn.Linear(width, width), nn.Linear(width, width)
        self.near = nn.Linear(width, 1)

    def forward(self, batch: Batch, state: State | None = None) -> Outlook:
        """Shapes as in `Outlook`: A kinds of actions, M nodes."""
        nodes, goal, latent, state = self.seen(batch, self.of_context, state)
        close = self.near(nodes)[..., 0]
        nodes = nodes * torch.sigmoid(self.of_nodes(goal))[:, :, None]
        asked = self.asked(torch.tanh(latent[:, :, None] + self.given.weight))  # (B, T, kinds, width)
        scores = asked @ self.key(nodes).transpose(-1, -2) / asked.shape[-1] ** 0.5
        legal = torch.as_tensor(batch.legal)
        first = _masked(self.kinds(latent), legal.any(-1))
        return Outlook(first, _masked(scores, legal), self.value(latent)[..., 0], state, close)


def _masked(scores: Tensor, allowed: Tensor) -> Tensor:
    """Return the logarithms of probabilities, with next to no probability for forbidden choices."""
    return scores.masked_fill(~allowed, -1e9).log_softmax(-1)
