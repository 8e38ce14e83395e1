"""Worlds of a few things, written in lines: `20 fridge CLOSED inside 1` is node 20, closed, inside node 1."""

from __future__ import annotations

from hearth.kb.loading.load import default
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.syntax import parse_program
from hearth.schemas.vocabulary import STATE_ID
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

RELATIONS = {
    "on": "ON",
    "inside": "INSIDE",
    "close": "CLOSE",
    "facing": "FACING",
    "between": "BETWEEN",
    "right": "HOLDS_RH",
    "left": "HOLDS_LH",
}

ROOMS = """
1 kitchen
2 bedroom
10 character inside 1
"""
"""Two rooms without doors, the character in the first."""


def small_world(text: str) -> World:
    """The world of these lines."""
    nodes, edges = [], []
    for line in text.split("\n"):
        words = line.split()
        if words:
            nodes.append(_node(int(words[0]), words[1], [word for word in words[2:] if word in STATE_ID]))
            edges.extend(_edges(int(words[0]), [word for word in words[2:] if word not in STATE_ID]))
    return World.start(Home.from_graph(EnvironmentGraph(tuple(nodes), tuple(edges)), "small", default()))


def _node(number: int, name: str, states: list[str]) -> Node:
    if name == "character":
        return Node(number, name, "Characters", (), tuple(states))
    thing = default().object_class(name)
    return Node(number, name, thing.category, tuple(sorted(thing.properties)), tuple(states))


def _edges(number: int, words: list[str]) -> list[Edge]:
    found, relation = [], ""
    for word in words:
        if word in RELATIONS:
            relation = RELATIONS[word]
            continue
        found.append(Edge(number, relation, int(word)))
        if relation in ("ON", "INSIDE", "HOLDS_RH", "HOLDS_LH") and int(word) > 10:
            found.append(Edge(number, "CLOSE", int(word)))
    return found


def steps_of(text: str):
    """A program of these lines, objects bound as `(1.20)`."""
    program, faults = parse_program("Title\n\n\n" + text)
    assert not faults
    return program
