"""Figures of several homes in comparison: room sizes, things, degrees, relations (thesis table 5.1), places."""

from collections import Counter, defaultdict
from collections.abc import Iterable
from statistics import fmean, median
from typing import Any

from hearth.homes.lint import lint
from hearth.kb.knowledge import Knowledge
from hearth.schemas.graph import EnvironmentGraph, edge_set
from hearth.schemas.vocabulary import ROOM_CATEGORY

SHOWN = ("ON", "INSIDE", "CLOSE", "FACING", "BETWEEN")
PLAIN = frozenset({"Rooms", "Walls", "Floor", "Floors", "Ceiling", "Characters"})
"""Categories that are no objects in a room."""
PART_OF_HOME = PLAIN | {"Doors", "Windows"}
"""Categories without a place that could be another, and that are a place of no interest."""

Places = dict[str, Counter[tuple[str, str]]]
"""By class, the number of times that a thing of it is ON or INSIDE (relation) a thing of a class."""

REQUIRED: dict[str, tuple[tuple[str, ...], ...]] = {
    "dinner or kitchen table": (("table",), ("kitchen_table",), ("dining_table",), ("dinnertable",)),
    "coffee table": (("coffee_table",),),
    "fridge": (("fridge",), ("freezer",)),
    "dishwasher": (("dishwasher",),),
    "stove": (("stove",), ("oven",)),
    "sofa": (("couch",), ("sofa",), ("love_seat",)),
    "bed": (("bed",),),
    "desk with a computer": (("desk", "computer"), ("desk", "laptop")),
}
"""Things that every designed home has, each as alternatives of classes that are all there (thesis 2.3)."""


def lacking(graph: EnvironmentGraph) -> tuple[str, ...]:
    """Return the parts of `REQUIRED` that a home lacks; of a desk with a computer, the computer is ON the desk."""
    classes = {node.class_name for node in graph.nodes}
    named = {node.id: node.class_name for node in graph.nodes}
    on = {(named[e.source], named[e.target]) for e in graph.edges if e.relation == "ON"}

    def has(choice: tuple[str, ...]) -> bool:
        return choice[0] in classes if len(choice) == 1 else (choice[1], choice[0]) in on

    return tuple(name for name, choices in REQUIRED.items() if not any(map(has, choices)))


def of_home(graph: EnvironmentGraph, knowledge: Knowledge) -> dict[str, Any]:
    """One home's figures: counts, `degrees` of all nodes, `areas` of its rooms in square metres where known."""
    edges = edge_set(graph.edges)
    degrees = Counter(end for source, _, target in edges for end in (source, target))
    relations = Counter(relation for _, relation, _ in edges)
    rooms = [node for node in graph.nodes if node.category == ROOM_CATEGORY]
    nodes, objects = len(graph.nodes), sum(node.category not in PLAIN for node in graph.nodes)
    return {
        "rooms": len(rooms),
        "nodes": nodes,
        "objects": objects,
        "objects a room": objects / max(1, len(rooms)),
        "classes": len({node.class_name for node in graph.nodes}),
        "edges": len(edges),
        "edges a node": len(edges) / max(1, nodes),
        **{f"{name} a node": relations[name] / max(1, nodes) for name in SHOWN},
        "degrees": [degrees[node.id] for node in graph.nodes],
        "areas": [room.box.size[0] * room.box.size[2] for room in rooms if room.box is not None],
        "sound": not lint(graph, knowledge),
        "lacks": lacking(graph),
    }


def of_homes(graphs: Iterable[EnvironmentGraph], knowledge: Knowledge) -> dict[str, Any]:
    """Return a collection's figures, each the mean over its homes unless its name says otherwise.

    Empty for no homes.
    """
    homes = [of_home(graph, knowledge) for graph in graphs]
    if not homes:
        return {}
    degrees = sorted(degree for home in homes for degree in home["degrees"])
    areas = [area for home in homes for area in home["areas"]]
    means = ("nodes", "objects", "objects a room", "classes", "edges")
    ratios = ("edges a node", *(f"{name} a node" for name in SHOWN))
    return {
        "homes": len(homes),
        "pass lint": sum(home["sound"] for home in homes),
        "have the furniture of the thesis": sum(not home["lacks"] for home in homes),
        "rooms": round(fmean(home["rooms"] for home in homes), 1),
        "fewest rooms": min(home["rooms"] for home in homes),
        "most rooms": max(home["rooms"] for home in homes),
        "room area, m2": round(fmean(areas), 1) if areas else None,
        "smallest room, m2": round(min(areas), 1) if areas else None,
        "largest room, m2": round(max(areas), 1) if areas else None,
        **{name: round(fmean(home[name] for home in homes), 1) for name in means},
        **{name: round(fmean(home[name] for home in homes), 2) for name in ratios},
        "least edges a node": round(min(home["edges a node"] for home in homes), 2),
        "most edges a node": round(max(home["edges a node"] for home in homes), 2),
        "median degree": round(median(degrees)),
        "95th percentile of degrees": degrees[int(0.95 * (len(degrees) - 1))],
    }


def places(graphs: Iterable[EnvironmentGraph], knowledge: Knowledge) -> Places:
    """Return the supports and containers of the things of some homes, by class; synonyms count as one class."""

    def named(class_name: str) -> str:
        known = knowledge.object_class(class_name)
        return (known.same_as or known.name) if known else class_name

    found: Places = defaultdict(Counter)
    for graph in graphs:
        things = {node.id: named(node.class_name) for node in graph.nodes if node.category not in PART_OF_HOME}
        for source, relation, target in edge_set(graph.edges):
            if relation in ("ON", "INSIDE") and source in things and target in things:
                found[things[source]][relation, things[target]] += 1
    return found


def placement_distance(one: Places, other: Places) -> float | None:
    """Return how differently two collections of homes place the same things: 0 the same, 1 nothing in common.

    The total variation distance of each class's places, weighted by the smaller of its two counts of places; None where
    no class has a place in both.
    """
    counts = {name: (one[name].total(), other[name].total()) for name in one.keys() & other.keys()}
    weights = sum(map(min, counts.values()))
    if not weights:
        return None
    apart = (
        min(mine, theirs) * abs(one[name][place] / mine - other[name][place] / theirs) / 2
        for name, (mine, theirs) in sorted(counts.items())
        for place in sorted(one[name].keys() | other[name].keys())
    )
    return round(sum(apart) / weights, 3)


def beside(figures: dict[str, Any], theirs: dict[str, Any] | None) -> float | None:
    """By how many per cent homes have more edges than others would have at the same nodes; None without others."""
    if not theirs:
        return None
    more = float(figures["edges a node"]) / float(theirs["edges a node"]) - 1
    return round(100 * more, 1)
