"""The goal that an execution achieves, which others are asked to reach (thesis 6.3, tables B.1, C.2)."""

from collections import Counter
from collections.abc import Iterable, Iterator

from hearth.schemas.goals import Goal
from hearth.schemas.graph import Edge
from hearth.schemas.literals import AGENT, HANDS, HOLDS, Literal, Name
from hearth.schemas.vocabulary import EVERY_STATE
from hearth.scoring.metrics.final_graph import nodes_of
from hearth.simulation.processes import as_wide_as
from hearth.simulation.world.bits import indices
from hearth.simulation.world.moved_edges import INSIDE, NOTHING, ON
from hearth.simulation.world.world import World

LASTING = ("ON", "INSIDE", *HANDS)
"""Relations of goals made from an execution; CLOSE and FACING describe only the character's position."""


def goal_of(start: World, final: World) -> Goal:
    """Return the achievements of an execution as class literals: states set, and objects put ON, INSIDE or in a hand.

    Literals that held at the start, and INSIDE a room, do not count. Both worlds are of one home; of action set 3 all
    states count, those that a process brings about (HOT) and those of things that are GONE too.
    """
    start = as_wide_as(start, final)
    nodes = nodes_of(final.home)
    counts: Counter[Literal[Name]] = Counter()

    def name(node: int) -> str:
        return AGENT if node in nodes.characters else nodes.classes[node]

    entered, added = _achieved(start, final)
    for node, state in entered:
        counts[Literal(state, (name(node),))] += 1
    met: dict[Literal[Name], set[tuple[int, ...]]] = {}
    for source, relation, target in added:
        if target not in nodes.left_out:
            literal = Literal(HOLDS if relation in HANDS else relation, (name(source), name(target)))
            met.setdefault(literal, set()).add((source, target) if source in nodes.characters else (source,))
    counts.update({literal: len(found) for literal, found in met.items()})
    return Goal.of(*sorted(counts.items(), key=lambda item: str(item[0])))


def _achieved(start: World, final: World) -> tuple[Iterable[tuple[int, str]], Iterable[Edge]]:
    """Return the added states and the added lasting edges."""
    if start.home is final.home and start.moved is NOTHING and len(final.agents) == 1 and not final.home.others:
        return _states_set(start, final), _lasting(start, final)
    change = final.changes(start)
    return change.set_states, [edge for edge in change.added if edge.relation in LASTING]


def _states_set(start: World, final: World) -> Iterator[tuple[int, str]]:
    ids = final.home.ids
    for name, before, after in zip(EVERY_STATE, start.states, final.states, strict=False):
        yield from ((ids[i], name) for i in indices(after & ~before))


def _lasting(start: World, final: World) -> Iterator[Edge]:
    """Yield the added lasting edges, as in `World.changes`; only `extra` rows of moved objects are read."""
    home = final.home
    ids = home.ids
    for key, row in final.moved.extra.items():
        i, kind = divmod(key, 8)
        if kind in (ON, INSIDE):
            before = home.on[i] if kind == ON else home.inside[i]
            relation = "ON" if kind == ON else "INSIDE"
            yield from (Edge(ids[i], relation, ids[j]) for j in indices(row & ~before))
    old, new = start.agents[0], final.agents[0]
    me = ids[new.index]
    out = (("ON", old.on, new.on), ("INSIDE", old.inside, new.inside))
    for relation, before, after in (*out, (HANDS[0], old.right, new.right), (HANDS[1], old.left, new.left)):
        yield from (Edge(me, relation, ids[j]) for j in indices(after & ~before))
    for relation, before, after in (("ON", old.worn, new.worn), ("INSIDE", old.contents, new.contents)):
        yield from (Edge(ids[j], relation, me) for j in indices(after & ~before & ~new.bit))
