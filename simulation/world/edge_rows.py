"""Reading the edges of a world as rows of bit sets: the home's, less those removed, plus those added.

All take and give indices and bit sets. Edges between a character and anything stand in the character's `Agent`.
"""

from collections.abc import Iterator

from hearth.schemas.graph import Edge
from hearth.simulation.world.agent import AGENT_IN, AGENT_OUT, Agent
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.moved_edges import BEARS, CLOSE, CONTENTS, FACED, FACING, INSIDE, NOTHING, ON
from hearth.simulation.world.state import WorldState
from hearth.simulation.world.states import CLOSED

Numbered = tuple[int, str, int]


def on(world: WorldState, i: int) -> int:
    """Return the things that i is ON."""
    return _row(world.home.on[i], world.moved.on, world.moved.extra, i, ON)


def bears(world: WorldState, i: int) -> int:
    """Return the things ON i."""
    return _row(world.home.bears[i], world.moved.on, world.moved.extra, i, BEARS)


def inside(world: WorldState, i: int) -> int:
    """Return the things and rooms that i is INSIDE."""
    return _row(world.home.inside[i], world.moved.inside, world.moved.extra, i, INSIDE)


def contents(world: WorldState, i: int) -> int:
    """Return the things INSIDE i."""
    return _row(world.home.contents[i], world.moved.inside, world.moved.extra, i, CONTENTS)


def close(world: WorldState, i: int) -> int:
    """Return the things that i is CLOSE to."""
    return _row(world.home.close[i], world.moved.close, world.moved.extra, i, CLOSE)


def facing(world: WorldState, i: int) -> int:
    """Return the things that i is FACING."""
    return _row(world.home.facing[i], world.moved.facing, world.moved.extra, i, FACING)


def faced(world: WorldState, i: int) -> int:
    """Return the things that are FACING i."""
    return _row(world.home.faced[i], world.moved.facing, world.moved.extra, i, FACED)


_READERS = (on, bears, inside, contents, close, facing, faced)
"""By kind of row (see `moved`), and in the order of `Home.rows`."""


def _row(row: int, removed: int, extra: dict[int, int], i: int, kind: int) -> int:
    if removed:
        row = 0 if removed >> i & 1 else row & ~removed
    return row | extra.get(8 * i + kind, 0)


def is_close(world: WorldState, agent: Agent, i: int) -> bool:
    """Return whether a character is close to i, by its own CLOSE edge or by one hop.

    The hop leads from a node that the character is CLOSE to, to a node CLOSE to that one, or to a node that i is ON.
    """
    mine = agent.close
    if mine >> i & 1:
        return True
    moved = world.moved
    if moved is NOTHING:
        if mine & (world.home.close[i] | world.home.on[i]):
            return True
    elif mine & (close(world, i) | on(world, i)):
        return True
    home = world.home
    if home.characters >> i & 1:
        other = character(world, i)
        if mine & (other.close | other.on):
            return True
    if len(world.agents) == 1 and not mine & agent.bit:
        return False
    return any(mine & other.bit and (other.close | other.worn) >> i & 1 for other in world.agents)


def is_near(world: WorldState, agent: Agent, i: int, near_hands: bool) -> bool:
    """`is_close`; by the rule `near_hands` the character's body parts count only in its own room."""
    if not is_close(world, agent, i):
        return False
    parts = world.home.properties["BODY_PART"] & agent.close if near_hands else 0
    if not parts or agent.close >> i & 1 or room_of(world, i) == agent_room(world, agent):
        return True
    return is_close(world, agent._replace(close=agent.close & ~parts), i)


def is_facing(world: WorldState, agent: Agent, i: int) -> bool:
    """Return whether a character faces i, by its own FACING edge or by one hop."""
    mine = agent.facing
    if mine >> i & 1 or mine & faced(world, i):
        return True
    home = world.home
    if not mine & home.characters and not home.characters >> i & 1:
        return False
    if home.characters >> i & 1 and mine & character(world, i).faced:
        return True
    return any(mine & other.bit and other.facing >> i & 1 for other in world.agents)


def room_of(world: WorldState, i: int) -> int:
    """Index of the room that i is, or is INSIDE directly or through its containers; -1 when there is none.

    Of several rooms the first by id; a cycle of INSIDE is left once it closes.
    """
    home, moved = world.home, world.moved
    room = home.direct_room[i]
    if room == i:
        return room
    # Either end of an edge may have been removed; an edge that came may lead to a room of a lower id.
    if room >= 0 and not (moved.inside >> i | moved.inside >> room) & 1 and 8 * i + INSIDE not in moved.extra:
        return room
    if home.characters >> i & 1:
        return agent_room(world, character(world, i))
    return _search_room(world, containers(world, i), 1 << i)


def agent_room(world: WorldState, agent: Agent) -> int:
    """Index of the room a character is in, or -1."""
    rooms = agent.inside & world.home.rooms
    if rooms:
        return (rooms & -rooms).bit_length() - 1
    return _search_room(world, agent.inside, agent.bit)


def _search_room(world: WorldState, frontier: int, seen: int) -> int:
    rooms = world.home.rooms
    while frontier:
        found = frontier & rooms
        if found:
            return (found & -found).bit_length() - 1
        seen |= frontier
        outer = 0
        for i in indices(frontier):
            outer |= containers(world, i)
        frontier = outer & ~seen
    return -1


def closed_container(world: WorldState, i: int) -> int:
    """Index of a closed thing that hides i, or -1."""
    hiding = containers(world, i) & ~world.home.rooms & world.states[CLOSED]
    return (hiding & -hiding).bit_length() - 1


def character(world: WorldState, i: int) -> Agent:
    """Return the character whose node has that index."""
    for agent in world.agents:
        if agent.index == i:
            return agent
    raise LookupError(i)


def containers(world: WorldState, i: int) -> int:
    """Return the containers of i, characters included, and whether or not it is a character itself."""
    if world.home.characters >> i & 1:
        return character(world, i).inside
    found = inside(world, i)
    for agent in world.agents:
        if agent.contents >> i & 1:
            found |= agent.bit
    return found


def bearing(world: WorldState, i: int) -> int:
    """Everything ON i, characters included, and whether or not it is a character itself."""
    found = character(world, i).worn if world.home.characters >> i & 1 else bears(world, i)
    for agent in world.agents:
        if agent.on >> i & 1:
            found |= agent.bit
    return found


def seats(home: Home) -> int:
    """Return the things to sit or lie on."""
    return home.properties["SITTABLE"] | home.properties["LIEABLE"]


def turned_back(world: WorldState, i: int) -> int:
    """Return the bedding ON i that takes no room there by the rule `made_bed`: the bedding of beds and couches."""
    home = world.home
    return bearing(world, i) & home.bedding if home.properties["LIEABLE"] >> i & 1 else 0


def taking_room(world: WorldState, i: int, made_bed: bool = True) -> int:
    """Return the things ON i that take room from a sitting or lying character, with the rule `made_bed` or without."""
    return bearing(world, i) & ~turned_back(world, i) if made_bed else bearing(world, i)


def held_indices(agent: Agent) -> Iterator[int]:
    """Return the objects that a character holds, right hand first."""
    yield from indices(agent.right)
    yield from indices(agent.left & ~agent.right)


def thing_edges(world: WorldState, among: int = -1) -> Iterator[Numbered]:
    """Every edge between things (of these), as (index, relation, index)."""
    home = world.home
    for i in indices(among & home.everything):
        for relation, row in (
            ("ON", on(world, i)),
            ("INSIDE", inside(world, i)),
            ("CLOSE", close(world, i)),
            ("FACING", facing(world, i)),
            ("BETWEEN", home.between[i]),
        ):
            for j in indices(row & among):
                yield i, relation, j


def agent_edges(agent: Agent) -> Iterator[Numbered]:
    """Every edge of a character, in both directions, as (index, relation, index)."""
    me = agent.index
    for relation, field in AGENT_OUT.items():
        for j in indices(getattr(agent, field)):
            yield me, relation, j
    for relation, field in AGENT_IN.items():
        for j in indices(getattr(agent, field)):
            yield j, relation, me


def edges(world: WorldState, among: int = -1) -> set[Edge]:
    """Every edge (among these nodes), by ids."""
    home = world.home
    ids, index = home.ids, home.index
    found = {Edge(ids[i], relation, ids[j]) for i, relation, j in thing_edges(world, among)}
    for agent in world.agents:
        pairs = ((i, r, j) for i, r, j in agent_edges(agent) if among >> i & 1 and among >> j & 1)
        found.update(Edge(ids[i], relation, ids[j]) for i, relation, j in pairs)
    for source, relation, target in home.others:
        if among >> index[source] & 1 and among >> index[target] & 1:
            found.add(Edge(source, relation, target))
    return found


def difference(world: WorldState) -> frozenset[tuple[int, int, int]]:
    """Rows of things that differ from the home's, as (index, kind, row): equal for equal graphs."""
    moved = world.moved
    if moved is NOTHING:
        return frozenset()
    home = world.home
    found = set()
    pairs = tuple(zip(_READERS, home.rows[:-1], strict=True))
    touched = {key >> 3 for key in moved.extra} | set(indices(moved.on | moved.inside | moved.close | moved.facing))
    for i in touched:
        for kind, (read, before) in enumerate(pairs):
            now = read(world, i)
            if now != before[i]:
                found.add((i, kind, now))
    return frozenset(found)
