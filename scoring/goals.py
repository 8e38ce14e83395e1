"""Goal satisfaction: whether a final graph is as it was wanted (thesis 6.3, tables B.1, C.2)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from hearth.schemas.goals import Goal, Predicate
from hearth.schemas.graph import Edge, EnvironmentGraph
from hearth.schemas.vocabulary import STATES
from hearth.scoring.signature import signature
from hearth.scoring.views import View, view_of
from hearth.simulation.bits import indices
from hearth.simulation.moved import INSIDE, NOTHING, ON
from hearth.simulation.world import World

SIGNATURE = signature("goal", level="program", empty=1)

AGENT = "agent"
HOLDS = "HOLDS"
HANDS = ("HOLDS_RH", "HOLDS_LH")
LASTING = ("ON", "INSIDE", *HANDS)
"""Relations that a goal made from an execution is about; CLOSE and FACING say only where the character stood."""


@dataclass(frozen=True, slots=True)
class Satisfaction:
    """How much of a goal holds.

    Attributes:
        counts: of each predicate: how many distinct subjects satisfy it, and how many are wanted.
    """

    counts: tuple[tuple[Predicate, int, int], ...]

    @property
    def satisfied(self) -> bool:
        """Whether every count is reached; a goal without predicates is."""
        return all(found >= wanted for _, found, wanted in self.counts)

    @property
    def fraction(self) -> float:
        """How much of what is wanted is found, from 0 to 1; 1 for a goal without predicates."""
        wanted = sum(count for _, _, count in self.counts)
        return sum(min(found, count) for _, found, count in self.counts) / wanted if wanted else 1.0

    @property
    def unmet(self) -> tuple[tuple[Predicate, int], ...]:
        """What is missing, and how often."""
        return tuple((predicate, wanted - found) for predicate, found, wanted in self.counts if found < wanted)


def satisfaction(goal: Goal, final: EnvironmentGraph | World) -> Satisfaction:
    """Count how many distinct subjects satisfy each predicate of a goal.

    A subject or target is a class name (any instance), a node id, `agent` (any character) or `agent:1` (the second by
    id). HOLDS is either hand.
    """
    view = view_of(final)
    return Satisfaction(tuple((predicate, len(_subjects(predicate, view)), wanted) for predicate, wanted in goal))


def goal_of(start: World, final: World) -> Goal:
    """What an execution achieved, said of classes: states it set, and things it put ON, INSIDE or in a hand.

    Being in a room is not counted, nor what was true at the start. Both worlds are of one home.
    """
    nodes = view_of(final).nodes
    counts: Counter[Predicate] = Counter()

    def name(node: int) -> str:
        return AGENT if node in nodes.characters else nodes.classes[node]

    entered, added = _achieved(start, final)
    for node, state in entered:
        counts[Predicate(state, name(node))] += 1
    subjects: dict[Predicate, set[int]] = {}
    for edge in added:
        if edge.target not in nodes.left_out:
            subjects.setdefault(_as_predicate(edge, name(edge.source), name(edge.target)), set()).add(_counted(edge))
    counts.update({predicate: len(found) for predicate, found in subjects.items()})
    return Goal.of(*sorted(counts.items(), key=lambda item: str(item[0])))


def _achieved(start: World, final: World) -> tuple[Iterable[tuple[int, str]], Iterable[Edge]]:
    """The states that came and the lasting edges that were added."""
    if start.home is final.home and start.moved is NOTHING and len(final.agents) == 1 and not final.home.others:
        return _states_set(start, final), _lasting(start, final)
    change = final.changes(start)
    return change.set_states, [edge for edge in change.added if edge.relation in LASTING]


def _states_set(start: World, final: World) -> Iterator[tuple[int, str]]:
    ids = final.home.ids
    for name, before, after in zip(STATES, start.states, final.states, strict=True):
        yield from ((ids[i], name) for i in indices(after & ~before))


def _lasting(start: World, final: World) -> Iterator[Edge]:
    """As `World.changes` tells them; what moved is a world's `extra` rows, and what else is near it is not read."""
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


def _as_predicate(edge: Edge, source: str, target: str) -> Predicate:
    """A character's holding counts the things held, so these stand first."""
    return Predicate(HOLDS, source, target) if edge.relation in HANDS else Predicate(edge.relation, source, target)


def _counted(edge: Edge) -> int:
    return edge.target if edge.relation in HANDS else edge.source


def _subjects(predicate: Predicate, view: View) -> set[int]:
    """The distinct nodes that satisfy a predicate: of HOLDS the things held, else the subjects."""
    subjects = _nodes(predicate.subject, view)
    if predicate.target is None:
        return {node for node in subjects if predicate.name in view.states(node)}
    targets = _nodes(predicate.target, view)
    relations = HANDS if predicate.name == HOLDS else (predicate.name,)
    edges = (Edge(node, name, other) for name in relations for node in subjects for other in view.targets(node, name))
    return {_counted(edge) for edge in edges if edge.target in targets}


def _nodes(term: str | int, view: View) -> frozenset[int]:
    if isinstance(term, int):
        return frozenset({term}) & view.nodes.classes.keys()
    name, _, number = term.partition(":")
    if name != AGENT:
        return frozenset(view.nodes.instances.get(term, ()))
    agents = sorted(view.nodes.characters)
    return frozenset(agents[int(number) : int(number) + 1] if number.isdecimal() else agents)
