"""A canonical digest of a world: equal for equal nodes, states, edges, memories and poses, in any `Home` object.

Each fact is hashed for itself and the hashes are added, so that the cost of a world's digest is that of its differences
from its home. The digest finds mistakes and changes; an attacker can make two worlds of one digest.
"""

from collections.abc import Iterable, Iterator
from functools import lru_cache, partial
from hashlib import blake2b
from weakref import WeakKeyDictionary

from hearth.schemas.vocabulary import FURTHER_STATES, STATES
from hearth.simulation.world import edge_rows
from hearth.simulation.world.action_set_3_states import counts_of, is_wide
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.moved_edges import CLOSE
from hearth.simulation.world.world import World
from hearth.simulation.world.world_change import KINDS

_BITS = 512
_HOMES: WeakKeyDictionary[Home, int] = WeakKeyDictionary()


def digest(world: World) -> str:
    """32 hexadecimal digits."""
    home = world.home
    total = _of_home(home) + _sum(_of_characters(world))
    ids = home.ids
    came: set[tuple[object, ...]] = set()
    went: set[tuple[object, ...]] = set()
    for i, kind, now in edge_rows.difference(world):
        before = home.rows[kind][i]
        relation, _, outwards = KINDS[kind]
        for found, mask in ((came, now & ~before), (went, before & ~now)):
            found.update((ids[i], relation, ids[j]) if outwards else (ids[j], relation, ids[i]) for j in indices(mask))
            if kind == CLOSE:
                found.update((ids[j], relation, ids[i]) for j in indices(mask))
    total += _sum(came) - _sum(went)
    for name, before, now in zip(STATES, home.states, world.states, strict=False):
        if before != now:
            total += _states(ids, name, now & ~before) - _states(ids, name, before & ~now)
    if is_wide(world):  # the digest of a home has none of the further states
        total += sum(map(partial(_states, ids), FURTHER_STATES, world.states[len(STATES) :]))
    total += sum(_states(ids, f"ticks {k}", row) for k, row in enumerate(counts_of(world)))
    return blake2b((total % (1 << _BITS)).to_bytes(_BITS // 8, "little"), digest_size=16).hexdigest()


def _of_home(home: Home) -> int:
    try:
        return _HOMES[home]
    except KeyError:
        pass
    nodes = (home.node(i) for i in indices(home.everything))
    facts: list[tuple[object, ...]] = [
        (node.id, node.class_name, node.category, *sorted(node.properties)) for node in nodes
    ]
    facts += [tuple(edge) for edge in home.others]
    facts += [(home.ids[i], "BETWEEN", home.ids[j]) for i in indices(home.doors) for j in indices(home.between[i])]
    total = _sum(facts)
    for i in indices(home.everything):
        for row, (name, _, outwards) in zip(home.rows, KINDS, strict=False):
            total += _edges(home.ids, i, name, row[i]) if outwards else 0
    found = total + sum(_states(home.ids, name, row) for name, row in zip(STATES, home.states, strict=True))
    return _HOMES.setdefault(home, found)


def _of_characters(world: World) -> Iterator[tuple[object, ...]]:
    ids = world.home.ids
    for agent in world.agents:
        me = ids[agent.index]
        for i, relation, j in set(edge_rows.agent_edges(agent)):
            # Two characters that are CLOSE each have the edge; it counts once.
            if world.home.characters >> i & 1 and i != agent.index and relation == "CLOSE":
                continue
            yield ids[i], relation, ids[j]
        for thing, place, kind in agent.origins:
            yield "origin", me, ids[thing], ids[place], kind
        if agent.pose is not None:
            yield "pose", me, *agent.pose, agent.stride


def _edges(ids: list[int], i: int, relation: str, targets: int) -> int:
    return sum(_hash((ids[i], relation, ids[j])) for j in indices(targets))


def _states(ids: list[int], name: str, nodes: int) -> int:
    return sum(_hash((ids[i], name)) for i in indices(nodes))


def _sum(facts: Iterable[tuple[object, ...]]) -> int:
    return sum(map(_hash, facts))


@lru_cache(maxsize=200_000)
def _hash(fact: tuple[object, ...]) -> int:
    return int.from_bytes(blake2b(repr(fact).encode(), digest_size=_BITS // 8).digest(), "little")
