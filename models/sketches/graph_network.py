"""The networks of chapter 5: a graph network over nodes, a sketch encoder, a decoder of steps (eq. 5.4-5.8, table 5.2).

The network chooses the first object, then the action given it, then the second object given both. `change` is the
effect of a step on the states of the character and of its objects: nothing (Graph, Unaries), or a residual, a layer or
a recurrent cell.
"""

from typing import Literal, NamedTuple

import torch
from torch import Tensor, nn
from torch.nn import functional

from hearth.models.sketches.graph_inputs import END, LABELS, NO_NODE, PAD, TYPES, Batch

Change = Literal["none", "residual", "layer", "recurrent"]

SUBJECT, FIRST, SECOND = 0, 1, 2
"""The part of a node in a step (m of eq. 5.8)."""


class Memory(NamedTuple):
    """The state of B programs after some steps.

    Attributes:
        nodes: (B, N, H), states of nodes.
        real: (B, N) bool.
        sketch: (B, D), the encoded sketch.
        hidden: (B, D), of the decoder.
    """

    nodes: Tensor
    real: Tensor
    sketch: Tensor
    hidden: Tensor


class GraphEncoder(nn.Module):
    """A gated graph network with sparse messages (eq. 5.4-5.6).

    Args:
        words: numbers of names.
        size: of a node's state.
        rounds: of messages, K; without any, edges count for nothing.
    """

    def __init__(self, words: int, size: int, rounds: int) -> None:
        super().__init__()
        self.rounds = rounds
        self.names = nn.Embedding(words, size, padding_idx=0)
        self.start = nn.Linear(size + LABELS, size)
        self.message = nn.Linear(size, TYPES * size)
        self.gate = nn.GRUCell(size, size)

    def forward(self, classes: Tensor, labels: Tensor, edges: Tensor) -> Tensor:
        """States of nodes, (B, N, H)."""
        state = torch.tanh(self.start(torch.cat([self.names(classes), labels], -1)))
        flat = state.flatten(0, 1)  # (B * N, H)
        source, kind, target = edges.unbind(1)
        for _ in range(self.rounds):
            messages = self.message(flat).view(len(flat), TYPES, -1)[source, kind]  # (E, H)
            flat = self.gate(torch.zeros_like(flat).index_add(0, target, messages), flat)
        return flat.view_as(state)


class GraphNetwork(nn.Module):
    """A model of table 5.2.

    Args:
        words: numbers of names.
        actions: that may be written.
        size: of a node's state.
        hidden: of the sketch encoder and of the decoder.
        rounds: of messages, K.
        change: see above.
    """

    def __init__(self, words: int, actions: int, size: int, hidden: int, rounds: int, change: Change) -> None:
        super().__init__()
        self.change = change
        self.graph = GraphEncoder(words, size, rounds)
        self.encoder = nn.GRU(3 * size, hidden, batch_first=True)
        self.decoder = nn.GRUCell(3 * size, hidden)
        self.action = nn.Embedding(actions + 1, size)  # the last: before the first step
        self.special = nn.Parameter(torch.randn(2, size) / size**0.5)  # no object, and the end
        self.first = nn.Linear(2 * hidden, size)
        self.second = nn.Linear(2 * hidden + 2 * size, size)
        self.act = nn.Sequential(nn.Linear(2 * hidden + size, hidden), nn.ReLU(), nn.Linear(hidden, actions))
        self.role = nn.Embedding(3, size)
        self.effect = nn.Linear(2 * size, size)
        self.update = nn.Linear(size, size)
        self.layer = nn.Linear(3 * size, size)
        self.cell = nn.GRUCell(2 * size, size)

    def begin(self, batch: Batch) -> Memory:
        """Before the first step."""
        classes, labels, real, edges, sketch, lengths = (torch.as_tensor(column) for column in batch[:6])
        nodes = self.graph(classes, labels, edges)
        named = self.graph.names(sketch).flatten(2)  # (B, S, 3H)
        packed = nn.utils.rnn.pack_padded_sequence(named, lengths.cpu(), batch_first=True, enforce_sorted=False)
        found = self.encoder(packed)[1][0]  # (B, D)
        first = torch.full((len(found),), self.action.num_embeddings - 1)
        start = torch.cat([self.action(first), torch.zeros(len(found), 2 * nodes.shape[2])], 1)
        return Memory(nodes, real, found, self.decoder(start, found))

    def scores_first(self, memory: Memory) -> Tensor:
        """Return the scores of each node, of no object, and of the end, (B, N + 2)."""
        query = self.first(torch.cat([memory.hidden, memory.sketch], 1))  # (B, H)
        nodes = torch.einsum("bnh,bh->bn", memory.nodes, query).masked_fill(~memory.real, -torch.inf)
        return functional.log_softmax(torch.cat([nodes, query @ self.special.T], 1), 1)

    def scores_action(self, memory: Memory, first: Tensor) -> Tensor:
        """Return the scores of each action given the first object, (B, A)."""
        given = torch.cat([memory.hidden, memory.sketch, self._at(memory, first)], 1)
        return functional.log_softmax(self.act(given), 1)

    def scores_second(self, memory: Memory, first: Tensor, action: Tensor) -> Tensor:
        """Return the scores of each node given action and first object, (B, N)."""
        given = [memory.hidden, memory.sketch, self._at(memory, first), self.action(action.clamp(min=0))]
        nodes = torch.einsum("bnh,bh->bn", memory.nodes, self.second(torch.cat(given, 1)))
        return functional.log_softmax(nodes.masked_fill(~memory.real, -torch.inf), 1)

    def after(self, memory: Memory, action: Tensor, first: Tensor, second: Tensor) -> Memory:
        """After a step (eq. 5.8): the states of the character, its first and its second object are changed."""
        embedded = self.action(action.clamp(min=0))
        nodes = memory.nodes
        if self.change != "none":
            subject = torch.zeros_like(first)
            for part, place in ((SUBJECT, subject), (FIRST, first), (SECOND, second)):
                nodes = self._changed(nodes, place, part, embedded)
        memory = memory._replace(nodes=nodes)
        step = torch.cat([embedded, self._at(memory, first), self._at(memory, second)], 1)
        return memory._replace(hidden=self.decoder(step, memory.hidden))

    def _changed(self, nodes: Tensor, place: Tensor, part: int, action: Tensor) -> Tensor:
        rows = torch.arange(len(nodes))
        given = torch.cat([action, self.role(torch.full_like(place, part))], 1)  # (B, 2H)
        old = nodes[rows, place.clamp(min=0)]
        if self.change == "residual":
            new = old + torch.tanh(self.update(old * self.effect(given)))
        elif self.change == "layer":
            new = torch.tanh(self.layer(torch.cat([old, given], 1)))
        else:
            new = self.cell(given, old)
        kept = torch.where((place >= 0)[:, None], new, old)
        return nodes.index_put((rows, place.clamp(min=0)), kept)

    def _at(self, memory: Memory, place: Tensor) -> Tensor:
        """Return the states of nodes at positions, (B, H); that of no object below 0."""
        found = memory.nodes[torch.arange(len(place)), place.clamp(min=0)]
        return torch.where((place >= 0)[:, None], found, self.special[0].expand_as(found))


def loss_of(network: GraphNetwork, batch: Batch) -> Tensor:
    """Return the mean negative logarithm of the probability of each part, given those before it (teacher forcing)."""
    memory, steps = network.begin(batch), torch.as_tensor(batch.steps)
    total, count = torch.zeros(()), 0
    for number in range(steps.shape[1]):
        action, first, second = steps[:, number].unbind(1)
        parts = [
            (network.scores_first(memory), _position(first, memory.nodes.shape[1])),
            (network.scores_action(memory, first), action),
            (network.scores_second(memory, first, action), torch.where(second >= 0, second, PAD)),
        ]
        for scores, wanted in parts:
            known = wanted >= 0
            if known.any():
                total = total - scores[known].gather(1, wanted[known, None]).sum()
                count += int(known.sum())
        memory = network.after(memory, action, first, second)
    return total / max(1, count)


def _position(first: Tensor, nodes: int) -> Tensor:
    """Return the position of a first object among the scores: a node's, that of no object, or that of the end."""
    return torch.where(first == NO_NODE, nodes, torch.where(first == END, nodes + 1, first))
