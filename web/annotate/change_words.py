"""The changes of a step of a run in everyday words: no ids, no names of relations."""

from collections.abc import Collection, Iterable, Iterator

from hearth.schemas.graph import Edge
from hearth.schemas.graph_change import Change
from hearth.schemas.literals import HANDS
from hearth.schemas.spoken_words import spoken
from hearth.schemas.vocabulary import CHARACTER_CLASS
from hearth.simulation.world.world import World

STATES = {"PLUGGED_IN": "plugged in", "PLUGGED_OUT": "unplugged", "LYING": "lying down"}
"""States whose words are not their names."""

PLACES = {"INSIDE": "in", "ON": "on"}
"""The words of the relations that are named; closeness and facing are not named."""

HELD = dict(zip(HANDS, ("right", "left"), strict=True))


def changed_in_words(change: Change, world: World) -> str:
    """Return the changes in words, "" where only the person's place changed; `world` is the world before."""
    text = "; ".join(dict.fromkeys(_parts(change, world)))
    return text[:1].upper() + text[1:]


def _parts(change: Change, world: World) -> Iterator[str]:
    for node, state in change.set_states:
        yield f"{_name(node, world)} is {STATES.get(state, state.lower())}"
    yield from _places(change.added, world)


def placed_in_words(edges: Iterable[Edge], things: Collection[int], world: World) -> str:
    """Return where things are, in words: "the book is in the bedroom"; "" where no edge has one of them."""
    edges = [edge for edge in edges if (edge.target if edge.relation in HELD else edge.source) in things]
    return "; ".join(dict.fromkeys(_places(edges, world)))


def _places(edges: Iterable[Edge], world: World) -> Iterator[str]:
    for source, relation, target in edges:
        if relation in HELD:
            yield f"{_name(target, world)} is in the {HELD[relation]} hand"
        elif relation in PLACES:
            yield f"{_name(source, world)} is {PLACES[relation]} {_name(target, world)}"


def _name(node: int, world: World) -> str:
    name = world.home.classes[world.home.index[node]]
    return "the person" if name == CHARACTER_CLASS else f"the {spoken(name)}"
