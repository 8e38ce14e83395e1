"""Graphs of environments for graph networks: only nodes that matter to a sketch, with their labels and edges (5.4.1).

Of 450 nodes some 40 matter: the character, the rooms, the candidates of the sketch, the nodes that bear and hold these,
and the nodes on them.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from hearth.datasets.tensors import EDGE_TYPES, INSIDE_ROOM
from hearth.models.interface import Steps
from hearth.models.sketches.name_numbers import Words
from hearth.models.sketches.node_features import Places
from hearth.schemas.vocabulary import RELATION_ID
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.world import World

MOST = 64
"""Nodes of a reduced graph at most."""

LABELS = 12
"""Numbers of a node: ten states, whether it is a room, whether it is the character."""

TYPES = 2 * len(EDGE_TYPES)
"""Types of edges, each relation in both directions; INSIDE a room is a relation of its own."""


class GraphInput(NamedTuple):
    """A graph with N nodes, the character first, and E edges; and a sketch of S steps.

    Attributes:
        nodes: indices in the home.
        classes: (N,) numbers of names.
        labels: (N, LABELS).
        edges: (E, 3): source, type, target, by position.
        sketch: (S, 3): numbers of the names of action and objects.
    """

    nodes: tuple[int, ...]
    classes: np.ndarray
    labels: np.ndarray
    edges: np.ndarray
    sketch: np.ndarray


def graph_input(sketch: Steps, world: World, words: Words, most: int = MOST) -> GraphInput:
    """Return the graph that matters to a sketch, whose nodes are not looked at.

    Args:
        sketch: names alone count.
        world: at the start.
        words: numbers of names.
        most: nodes at most; those that matter most are kept.
    """
    home = world.home
    nodes = _chosen(Places(world, sketch, words), world, most)
    place = {node: n for n, node in enumerate(nodes)}
    me = world.agents[0].index
    labels = [
        [*(float(state >> node & 1) for state in world.states), float(home.rooms >> node & 1), float(node == me)]
        for node in nodes
    ]
    steps = [[words.action(s.action), *[*(words.thing(ref.name) for ref in s.objects), 0, 0][:2]] for s in sketch]
    return GraphInput(
        nodes,
        np.array([words.thing(home.classes[node]) for node in nodes], np.int64),
        np.array(labels, np.float32),
        np.array(_edges(world, place), np.int64).reshape(-1, 3),
        np.array(steps or [[0, 0, 0]], np.int64),
    )


def _chosen(places: Places, world: World, most: int) -> tuple[int, ...]:
    """Return the character, the rooms, then by how much they matter."""
    home = world.home
    meant = [node for nodes in places.candidates.values() for node in nodes]
    around = [
        i for node in meant for i in indices(edge_rows.on(world, node) | edge_rows.inside(world, node) & ~home.rooms)
    ]
    upon = [i for node in meant for i in indices(edge_rows.bearing(world, node))]
    beside = [i for node in meant for i in indices(edge_rows.close(world, node))]
    held = list(indices(world.agents[0].held))
    rest = range(len(home)) if most > MOST else ()
    order = [world.agents[0].index, *indices(home.rooms), *held, *meant, *around, *upon, *indices(home.doors), *beside]
    found = dict.fromkeys(node for node in (*order, *rest) if home.everything >> node & 1)
    return tuple(found)[:most]


def _edges(world: World, place: dict[int, int]) -> list[tuple[int, int, int]]:
    among = mask_of(place)
    pairs = [
        *edge_rows.thing_edges(world, among),
        *(each for agent in world.agents for each in edge_rows.agent_edges(agent)),
    ]
    found = set()
    for source, relation, target in pairs:
        if source in place and target in place:
            room = relation == "INSIDE" and world.home.rooms >> target & 1
            kind = INSIDE_ROOM if room else RELATION_ID[relation]
            found.add((place[source], 2 * kind, place[target]))
            found.add((place[target], 2 * kind + 1, place[source]))
    return sorted(found)


class Batch(NamedTuple):
    """B graphs and sketches, padded to the longest; masks mark the real entries.

    Attributes:
        classes: (B, N). labels: (B, N, LABELS). real: (B, N) bool.
        edges: (E, 3) over B * N nodes.
        sketch: (B, S, 3). lengths: (B,) of sketches.
        steps: (B, T, 3): positions of action, first and second object; see `targets`.
    """

    classes: np.ndarray
    labels: np.ndarray
    real: np.ndarray
    edges: np.ndarray
    sketch: np.ndarray
    lengths: np.ndarray
    steps: np.ndarray


def batched(inputs: Sequence[GraphInput], steps: Sequence[np.ndarray] = ()) -> Batch:
    """Return inputs as one batch, with the steps that are to be predicted, if they are known."""
    count, nodes = len(inputs), max(len(each.nodes) for each in inputs)
    longest = max(len(each.sketch) for each in inputs)
    classes, real = np.zeros((count, nodes), np.int64), np.zeros((count, nodes), bool)
    labels, sketch = np.zeros((count, nodes, LABELS), np.float32), np.zeros((count, longest, 3), np.int64)
    edges = []
    for row, each in enumerate(inputs):
        size = len(each.nodes)
        classes[row, :size], labels[row, :size], real[row, :size] = each.classes, each.labels, True
        sketch[row, : len(each.sketch)] = each.sketch
        edges.append(each.edges + np.array([row * nodes, 0, row * nodes]))
    filled = np.full((count, max((len(each) for each in steps), default=0), 3), PAD, np.int64)
    for row, known in enumerate(steps):
        filled[row, : len(known)] = known
    lengths = np.array([len(each.sketch) for each in inputs])
    return Batch(classes, labels, real, np.concatenate(edges), sketch, lengths, filled)


PAD, NO_NODE, END = -3, -1, -2
"""Numbers in place of a position: nothing to predict; a step without a node in the graph; the program's end.

A step of the second kind has no object, or an object that the graph leaves out.
"""


def targets(steps: Steps, given: GraphInput, world: World, actions: Sequence[str]) -> np.ndarray:
    """Return the steps of a program as positions of action, first and second object, and its end; (T + 1, 3).

    An object that the reduced graph leaves out is PAD: nothing is learned from it.
    """
    place = {node: n for n, node in enumerate(given.nodes)}
    number = {name: n for n, name in enumerate(actions)}
    index = world.home.index
    found = []
    for step in steps:
        nodes = [place.get(index.get(ref.node or 0, -1), PAD) for ref in step.objects]
        first, second = (*nodes, NO_NODE, NO_NODE)[:2]
        found.append((number.get(step.action, PAD), first, second))
    return np.array([*found, (PAD, END, PAD)], np.int64)
