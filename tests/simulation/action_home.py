"""A home by hand with something for each executed action, steps in it as words, and what they change as words."""

from __future__ import annotations

from small_worlds import bound_step, node

from hearth.kb.loading.load import default
from hearth.schemas.graph import Edge, EnvironmentGraph
from hearth.simulation.engine import act
from hearth.simulation.rules import DEFAULT
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

THINGS = {
    "kitchen": ((), "", ""),
    "bedroom": ((), "", ""),
    "character": (("PERSON",), "", "INSIDE kitchen"),
    "table": (("SURFACES",), "", "INSIDE kitchen"),
    "cup": (("GRABBABLE", "RECIPIENT", "POURABLE"), "DIRTY", "INSIDE kitchen, ON table, CLOSE table"),
    "knife": (("GRABBABLE",), "", "INSIDE kitchen, ON table"),
    "plate": (("GRABBABLE", "SURFACES"), "", "INSIDE kitchen, ON table"),
    "apple": (("GRABBABLE", "EATABLE", "CUTTABLE"), "", "INSIDE kitchen, ON plate"),
    "bread": (("EATABLE",), "", "INSIDE kitchen"),
    "fridge": (("CAN_OPEN", "CONTAINERS", "HAS_SWITCH"), "CLOSED OFF", "INSIDE kitchen"),
    "juice": (("GRABBABLE", "DRINKABLE", "POURABLE"), "", "INSIDE kitchen, INSIDE fridge, CLOSE fridge"),
    "box": (("CAN_OPEN",), "", "INSIDE kitchen"),
    "toaster": (("CAN_OPEN", "HAS_SWITCH", "HAS_PLUG"), "CLOSED ON PLUGGED_IN", "INSIDE kitchen"),
    "lamp": (("HAS_SWITCH", "HAS_PLUG"), "OFF PLUGGED_OUT", "INSIDE kitchen"),
    "water": (("POURABLE",), "", "INSIDE kitchen"),
    "sponge": (("GRABBABLE", "MOVABLE"), "", "INSIDE kitchen"),
    "keyboard": (("GRABBABLE",), "", "INSIDE kitchen"),
    "window": ((), "OPEN", "INSIDE kitchen"),
    "face": (("BODY_PART",), "", "INSIDE kitchen"),
    "man": (("PERSON",), "", "INSIDE kitchen"),
    "bed": (("LIEABLE", "SITTABLE"), "", "INSIDE bedroom"),
    "chair": (("SITTABLE", "GRABBABLE"), "", "INSIDE bedroom, FACING television"),
    "bench": (("LIEABLE", "SITTABLE"), "", "INSIDE bedroom"),
    "book": (("GRABBABLE", "READABLE"), "", "INSIDE bedroom, ON bench"),
    "dress": (("GRABBABLE", "CLOTHES"), "", "INSIDE bedroom, ON bench"),
    "television": (("HAS_SWITCH", "LOOKABLE"), "OFF", "INSIDE bedroom"),
    "picture": (("LOOKABLE",), "", "INSIDE bedroom, CLOSE chair"),
    "moon": (("LOOKABLE", "GRABBABLE"), "", ""),
    "door": (("CAN_OPEN",), "OPEN", "BETWEEN kitchen, BETWEEN bedroom"),
}
IDS = {name: number + 1 for number, name in enumerate(THINGS)}
NODES = {
    name: node(IDS[name], name, properties=properties, states=states.split())
    for name, (properties, states, _) in THINGS.items()
}


def home() -> Home:
    """The home of these things."""
    edges = []
    for name, (_, _, relations) in THINGS.items():
        for relation, other in (r.split() for r in relations.split(", ") if r):
            edges.append(Edge(IDS[name], relation, IDS[other]))
            if relation == "CLOSE":
                edges.append(Edge(IDS[other], relation, IDS[name]))
    return Home.from_graph(EnvironmentGraph(tuple(NODES.values()), tuple(edges)), "", default())


def step(text: str):
    """`PutBack cup table` as an instruction about their nodes."""
    action, *names = text.split()
    return bound_step(action, [NODES[name] for name in names])


def after(*texts: str, rules=DEFAULT) -> World:
    """The world after steps that must succeed; `; ` parts several in one text."""
    world = World.start(home())
    for text in (part for several in texts for part in several.split("; ") if part):
        result = act(world, step(text), rules)
        assert isinstance(result, World), (text, result)
        world = result
    return world


def said(change) -> set[str]:
    """A change in words: `+cup ON table`, `-lamp OFF`; the one direction of CLOSE that goes out from the character."""
    names = {number: name for name, number in IDS.items()}
    edges = {("+", e) for e in change.added} | {("-", e) for e in change.removed}
    words = {f"{sign}{names[e.source]} {e.relation} {names[e.target]}" for sign, e in edges if _once(e)}
    words |= {f"+{names[i]} {state}" for i, state in change.set_states}
    return words | {f"-{names[i]} {state}" for i, state in change.cleared_states}


def _once(edge: Edge) -> bool:
    me = IDS["character"]
    return edge.relation != "CLOSE" or edge.source == me or (edge.target != me and edge.source < edge.target)
