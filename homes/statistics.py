"""Figures of homes beside each other: room sizes, things, degrees, relations (thesis table 5.1)."""

from collections import Counter
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
"""What every designed home has, each as alternatives of classes that are all there (thesis 2.3)."""


def lacking(graph: EnvironmentGraph) -> tuple[str, ...]:
    """What of `REQUIRED` a home has not; of a desk with a computer, the computer is ON the desk."""
    classes = {node.class_name for node in graph.nodes}
    named = {node.id: node.class_name for node in graph.nodes}
    on = {(named[e.source], named[e.target]) for e in graph.edges if e.relation == "ON"}

    def has(choice: tuple[str, ...]) -> bool:
        return choice[0] in classes if len(choice) == 1 else (choice[1], choice[0]) in on

    return tuple(name for name, choices in REQUIRED.items() if not any(map(has, choices)))


def of_home(graph: EnvironmentGraph, knowledge: Knowledge) -> dict[str, Any]:
    """One home's figures: counts, `degrees` of all nodes, `areas` of its rooms in square metres where known."""
    edges = edge_set(graph.edges)
    degrees: Counter[int] = Counter()
    for source, _, target in edges:
        degrees[source] += 1
        degrees[target] += 1
    rooms = [node for node in graph.nodes if node.category == ROOM_CATEGORY]
    return {
        "rooms": len(rooms),
        "nodes": len(graph.nodes),
        "edges": len(edges),
        "objects": sum(node.category not in PLAIN for node in graph.nodes),
        "classes": len({node.class_name for node in graph.nodes}),
        "relations": Counter(relation for _, relation, _ in edges),
        "degrees": [degrees[node.id] for node in graph.nodes],
        "areas": [room.box.size[0] * room.box.size[2] for room in rooms if room.box is not None],
        "sound": not lint(graph, knowledge),
        "lacks": lacking(graph),
    }


def of_homes(graphs: Iterable[EnvironmentGraph], knowledge: Knowledge) -> dict[str, Any]:
    """A collection's figures, each the mean over its homes unless its name says otherwise; empty for no homes."""
    homes = [of_home(graph, knowledge) for graph in graphs]
    if not homes:
        return {}

    def mean(values: Iterable[float], digits: int = 1) -> float | None:
        found = list(values)
        return round(fmean(found), digits) if found else None

    degrees = sorted(degree for home in homes for degree in home["degrees"])
    areas = [area for home in homes for area in home["areas"]]
    return {
        "homes": len(homes),
        "pass lint": sum(home["sound"] for home in homes),
        "have the furniture of the thesis": sum(not home["lacks"] for home in homes),
        "rooms": mean(home["rooms"] for home in homes),
        "fewest rooms": min(home["rooms"] for home in homes),
        "most rooms": max(home["rooms"] for home in homes),
        "room area, m2": mean(areas),
        "smallest room, m2": round(min(areas), 1) if areas else None,
        "largest room, m2": round(max(areas), 1) if areas else None,
        "nodes": mean(home["nodes"] for home in homes),
        "objects": mean(home["objects"] for home in homes),
        "objects a room": mean(home["objects"] / max(1, home["rooms"]) for home in homes),
        "classes": mean(home["classes"] for home in homes),
        "edges": mean(home["edges"] for home in homes),
        "edges a node": mean((home["edges"] / max(1, home["nodes"]) for home in homes), 2),
        "least edges a node": round(min(home["edges"] / max(1, home["nodes"]) for home in homes), 2),
        "most edges a node": round(max(home["edges"] / max(1, home["nodes"]) for home in homes), 2),
        "median degree": round(median(degrees)),
        "95th percentile of degrees": degrees[int(0.95 * (len(degrees) - 1))],
        **{f"{name} a node": mean((h["relations"][name] / max(1, h["nodes"]) for h in homes), 2) for name in SHOWN},
    }


def beside(figures: dict[str, Any], theirs: dict[str, Any] | None) -> float | None:
    """By how many per cent homes have more edges than others would have at the same nodes; None without others."""
    if not theirs:
        return None
    more = float(figures["edges a node"]) / float(theirs["edges a node"]) - 1
    return round(100 * more, 1)
