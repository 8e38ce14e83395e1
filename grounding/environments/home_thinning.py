"""Thinned homes, for environments smaller than a well-stocked home (thesis 5.5.2)."""

from collections import Counter
from random import Random

from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.rng import rng
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World


def superfluous(home: Home, most: int) -> tuple[int, ...]:
    """Ids of small movable things to remove, so that at most `most` nodes are left, if possible; sorted.

    The first to go are the commonest things of a room: a household's twelfth plate is missed less than its only kettle.
    Furniture, supports and containers in use stay.
    """
    chooser = rng(0, "thinned", home.name, most)
    removed = 0
    while len(home) - removed.bit_count() > most:
        going = _movable(home, removed)
        if not going:
            break
        removed |= _chosen(home, going, len(home) - removed.bit_count() - most, chooser)
    return tuple(home.ids[i] for i in indices(removed))


def without(home: Home, removed: tuple[int, ...]) -> Home:
    """Return a home without those nodes, and without their edges."""
    missing = frozenset(removed)
    graph = World.start(home).graph()
    nodes = tuple(node for node in graph.nodes if node.id not in missing)
    edges = tuple(edge for edge in graph.edges if edge.source not in missing and edge.target not in missing)
    return Home.from_graph(EnvironmentGraph(nodes, edges), home.name, home.knowledge)


def _movable(home: Home, removed: int) -> list[int]:
    """Graspable things with nothing left on or in them."""
    graspable = home.properties["GRABBABLE"] & ~home.characters & ~removed
    return [i for i in indices(graspable) if not (home.bears[i] | home.contents[i]) & ~removed]


def _chosen(home: Home, going: list[int], count: int, chooser: Random) -> int:
    """`count` of them, always one of the class most frequent in its room, then in the home; appliances last."""
    chooser.shuffle(going)
    plain = ~home.properties["HAS_PLUG"]
    kinds = {i: (home.direct_room[i], home.classes[i]) for i in going}
    here, everywhere = Counter(kinds.values()), Counter(home.classes[i] for i in going)
    found = 0
    left = list(going)
    for _ in range(min(count, len(going))):
        i = max(left, key=lambda i: (plain >> i & 1, here[kinds[i]], everywhere[home.classes[i]]))
        left.remove(i)
        here[kinds[i]] -= 1
        everywhere[home.classes[i]] -= 1
        found |= 1 << i
    return found
