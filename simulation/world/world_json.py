"""A world in the middle of an execution as JSON and back, with nothing lost.

The graph is the release's own format, so that other tools read it; a removed thing has no box in it. Three keys hold
what a graph cannot express: `memories` has the origins of grabbed things, `poses` the characters' places and strides,
and `ticks`, in worlds of action set 3, the rows in which processes count, each as ids of nodes.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import from_release, to_release
from hearth.simulation.world.action_set_3_states import counts_of, is_wide, with_counts
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.home import Home
from hearth.simulation.world.moved_edges import CLOSE, INSIDE, ON
from hearth.simulation.world.pose import Pose
from hearth.simulation.world.world import World

_KINDS = {ON: "ON", INSIDE: "INSIDE", CLOSE: "CLOSE"}
_NUMBERS = {name: kind for kind, name in _KINDS.items()}


def export(world: World) -> dict[str, Any]:
    """Return the world as a JSON-able mapping.

    `home`, `graph`, `memories`, `poses` where characters have places, and `ticks` in worlds of action set 3.
    """
    graph = world.graph()
    moved = world.moved.on | world.moved.inside
    nodes = (replace(n, box=None) if moved >> world.home.index[n.id] & 1 else n for n in graph.nodes)
    graph = replace(graph, nodes=tuple(nodes))
    return {"home": world.home.name, "graph": to_release(graph), **private(world)}


def private(world: World) -> dict[str, Any]:
    """Return the parts that a graph cannot hold, by node ids: `memories`, and `poses` and `ticks` if there are any."""
    ids = world.home.ids
    memories = [
        {"agent": ids[agent.index], "thing": ids[thing], "place": ids[place], "relation": _KINDS[kind]}
        for agent in world.agents
        for thing, place, kind in agent.origins
    ]
    poses = [
        {"agent": ids[agent.index], **agent.pose._asdict(), "stride": agent.stride}
        for agent in world.agents
        if agent.pose is not None
    ]
    found: dict[str, Any] = {"memories": memories, "poses": poses} if poses else {"memories": memories}
    if is_wide(world):
        found["ticks"] = [[ids[i] for i in indices(row)] for row in counts_of(world)]
    return found


def restore(data: Mapping[str, Any], knowledge: Knowledge) -> World:
    """Return the world that was exported; a plain scene graph under `graph` will do.

    Raises:
        HearthError: BAD_GRAPH: it is not an exported world, or a memory names a node that the graph lacks.
    """
    try:
        home = Home.from_graph(from_release(data["graph"]), str(data.get("home", "")), knowledge)
        return with_private(World.start(home), data)
    except (KeyError, TypeError, AttributeError, ValueError) as error:
        message = f"not an exported world: {type(error).__name__} {error}"
        raise HearthError.of(
            Code.BAD_GRAPH, message, suggestion="it needs `graph`, and `memories` of nodes in it"
        ) from error


def with_private(world: World, data: Mapping[str, Any]) -> World:
    """Return the world with the memories and poses that `private` gave.

    Raises:
        KeyError, TypeError, AttributeError, ValueError: it is nothing of the kind, or names a node that there is not.
    """
    by_agent: dict[int, list[tuple[int, int, int]]] = {}
    index = world.home.index
    for memory in data.get("memories", ()):
        entry = (index[memory["thing"]], index[memory["place"]], _NUMBERS[memory["relation"]])
        by_agent.setdefault(index[memory["agent"]], []).append(entry)
    places = {index[each["agent"]]: _place(each) for each in data.get("poses", ())}
    agents = (agent._replace(origins=tuple(by_agent.get(agent.index, ()))) for agent in world.agents)
    placed = (agent._replace(**places.get(agent.index, {})) for agent in agents)
    states = world.states
    if "ticks" in data:
        states = with_counts(world, tuple(mask_of(index[node] for node in row) for row in data["ticks"]))
    return World(world.home, states, tuple(placed), world.moved)


def _place(given: Mapping[str, Any]) -> dict[str, Any]:
    x, z, yaw, stride = (float(given[name]) for name in ("x", "z", "yaw", "stride"))
    return {"pose": Pose(x, z, yaw), "stride": stride}
