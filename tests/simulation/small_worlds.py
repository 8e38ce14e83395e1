"""Small homes and programs for tests: one written by hand, and as many random ones as wanted."""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator

from hypothesis import strategies as st

from hearth.kb.loading.load import default
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.vocabulary import STATES
from hearth.simulation.actions.registry import ACTIONS

CATALOG: dict[str, tuple[str, ...]] = {
    "apple": ("GRABBABLE", "EATABLE", "CUTTABLE"),
    "basket_for_clothes": ("GRABBABLE", "CONTAINERS", "CAN_OPEN"),
    "bed": ("LIEABLE", "SITTABLE", "SURFACES", "MOVABLE"),
    "bench": ("SITTABLE", "LIEABLE", "SURFACES"),
    "book": ("GRABBABLE", "READABLE", "CAN_OPEN", "LOOKABLE"),
    "chair": ("SITTABLE", "GRABBABLE", "SURFACES"),
    "child": ("PERSON",),
    "coffe_maker": ("HAS_SWITCH", "HAS_PLUG", "CAN_OPEN", "CONTAINERS"),
    "computer": ("HAS_SWITCH", "HAS_PLUG", "LOOKABLE"),
    "cup": ("GRABBABLE", "RECIPIENT", "POURABLE"),
    "curtain": ("CAN_OPEN",),
    "desk": ("SURFACES", "MOVABLE"),
    "face": ("BODY_PART",),
    "fridge": ("CAN_OPEN", "CONTAINERS", "HAS_SWITCH", "HAS_PLUG"),
    "hands_both": ("BODY_PART",),
    "keyboard": ("GRABBABLE", "HAS_PLUG"),
    "knife": ("GRABBABLE",),
    "plate": ("GRABBABLE", "RECIPIENT", "SURFACES"),
    "shirt": ("GRABBABLE", "CLOTHES", "HANGABLE"),
    "soap": ("GRABBABLE", "CREAM"),
    "table": ("SURFACES", "MOVABLE"),
    "television": ("HAS_SWITCH", "HAS_PLUG", "LOOKABLE"),
    "water": ("DRINKABLE", "POURABLE"),
    "window": (),
}
ROOMS = ("kitchen", "bedroom", "bathroom", "living_room")
FURNITURE = frozenset({"bed", "bench", "chair", "desk", "table"})
USUAL = ("Walk", "Find", "Grab", "Grab", "Open", "Close", "PutBack", "PutIn", "PutObjBack", "Sit", "StandUp", "TurnTo")
"""Actions that lead somewhere: drawn as often as all others together."""


def node(
    node_id: int, name: str, category: str = "", properties: Iterable[str] = (), states: Iterable[str] = ()
) -> Node:
    """A node; what is left out follows from its name."""
    if not category:
        category = "Rooms" if name in ROOMS else "Furniture" if name in FURNITURE else "Props"
        category = {"character": "Characters", "door": "Doors"}.get(name, category)
    return Node(node_id, name, category, tuple(properties) or CATALOG.get(name, ()), tuple(states))


def random_graph(rng: random.Random, things: int = 12, characters: int = 1) -> EnvironmentGraph:
    """A home that need not make sense: relations join anything, states may be missing."""
    nodes = [node(i + 1, name) for i, name in enumerate(ROOMS[: rng.randint(1, 4)])]
    rooms = [n.id for n in nodes]
    for _ in range(characters):
        states = rng.choice([(), (), ("SITTING",), ("LYING",)])
        nodes.append(node(len(nodes) + 1, "character", states=states, properties=("PERSON",)))
    for _ in range(rng.randint(0, 2)):
        nodes.append(node(len(nodes) + 1, "door", properties=("CAN_OPEN",), states=_random_states(rng)))
    for _ in range(rng.randint(2, things)):
        nodes.append(node(len(nodes) + 1, rng.choice(sorted(CATALOG)), states=_random_states(rng)))
    return EnvironmentGraph(tuple(nodes), tuple(_random_edges(rng, nodes, rooms)))


def _random_states(rng: random.Random) -> tuple[str, ...]:
    return tuple(STATES[pair + rng.randint(0, 1)] for pair in (0, 2, 4, 6) if rng.random() < 0.8)


def _random_edges(rng: random.Random, nodes: list[Node], rooms: list[int]) -> Iterator[Edge]:
    ids = [n.id for n in nodes]
    for n in nodes:
        if n.class_name == "door":
            yield from (Edge(n.id, "BETWEEN", room) for room in rng.sample(rooms, min(2, len(rooms))))
        elif n.id not in rooms and rng.random() < 0.9:
            yield Edge(n.id, "INSIDE", rng.choice(rooms))
    for _ in range(rng.randint(0, 3 * len(ids))):
        a, b = rng.choice(ids), rng.choice(ids)
        relation = rng.choice(("ON", "INSIDE", "CLOSE", "CLOSE", "FACING"))
        if a == b or (relation in ("ON", "INSIDE") and a in rooms):
            continue
        yield Edge(a, relation, b)
        if relation == "CLOSE":
            yield Edge(b, relation, a)


def random_step(rng: random.Random, graph: EnvironmentGraph, agent: int = 0, actions: Iterable[str] = ACTIONS) -> Step:
    """Any of some actions, of anything."""
    name = rng.choice(USUAL) if rng.random() < 0.5 else rng.choice(sorted(actions))
    return bound_step(name, [rng.choice(graph.nodes) for _ in range(arity(name))], agent)


def arity(action: str) -> int:
    """Return the number of objects that an action takes."""
    return default().actions[action].arity


def bound_step(action: str, things: Iterable[Node], agent: int = 0) -> Step:
    """An instruction about these nodes."""
    return Step(action, tuple(ObjectRef(n.class_name, 1, n.id) for n in things), agent)


def random_program(rng: random.Random, graph: EnvironmentGraph, steps: int = 12) -> Program:
    """A program of that many steps, most of which cannot be done."""
    return Program("", "", tuple(random_step(rng, graph) for _ in range(steps)))


graphs = st.integers(0, 1 << 32).map(lambda seed: random_graph(random.Random(seed)))
"""Random homes; they do not shrink, but programs in them do."""


@st.composite
def homes_and_steps(draw: st.DrawFn, characters: int = 1) -> tuple[EnvironmentGraph, list[Step]]:
    """A home and steps about its nodes."""
    seed = draw(st.integers(0, 1 << 32))
    graph = random_graph(random.Random(seed), characters=characters)
    things = st.sampled_from(graph.nodes)
    steps = []
    for name in draw(st.lists(st.sampled_from((*USUAL * 3, *sorted(ACTIONS))), max_size=25)):
        refs = [draw(things) for _ in range(arity(name))]
        steps.append(bound_step(name, refs, draw(st.integers(0, characters - 1)) if characters > 1 else 0))
    return graph, steps
