"""F1 over final graphs: whether a prediction leaves the home as the reference does (thesis 5.6.1, A.3)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Set
from dataclasses import dataclass
from typing import Literal, get_args

from hearth.schemas.program import Program
from hearth.scoring.metrics.alignment import LIMIT, PERFECT, Pair, Problem
from hearth.scoring.metrics.final_graph import Final, View, views_of
from hearth.scoring.metrics.precision_recall import NOTHING, Match, Matches, Prf
from hearth.scoring.signature import signature
from hearth.simulation.world.bits import indices

MatchBy = Literal["none", "swap1", "best"]
"""Assignment of instances of a class; see `score`."""

Scope = Literal["either", "own"]
"""The objects whose tuples count in a graph: those of either program, or those of the graph's own."""

MATCHES: tuple[MatchBy, ...] = get_args(MatchBy)
SCOPES: tuple[Scope, ...] = get_args(Scope)

MATCH: MatchBy = "swap1"
SCOPE: Scope = "own"
"""The published reading: with scope `either`, a program that changes nothing shares most tuples with its reference."""


@dataclass(frozen=True, slots=True)
class GraphScore:
    """Precision, recall and F1 of a final graph.

    Attributes:
        states: over state tuples, (object, state).
        relations: over relation tuples, (relation, from, to).
        both: over the two together.
        exact: whether the assignment of instances is optimal; if False, `both` is a lower bound.
        assigned: (reference node, predicted node) of instances with different ids.
    """

    states: Prf
    relations: Prf
    both: Prf
    exact: bool = True
    assigned: tuple[Pair, ...] = ()

    @classmethod
    def of(cls, matches: Matches, exact: bool = True, assigned: tuple[Pair, ...] = ()) -> GraphScore:
        """Return the score of counted matches."""
        states, relations = matches
        return cls(states.prf(), relations.prf(), (states + relations).prf(), exact, assigned)


FAILED = GraphScore(NOTHING, NOTHING, NOTHING)
"""The score of a prediction that is missing, does not parse or does not run."""


def f1_signature(match: MatchBy = MATCH, scope: Scope = SCOPE) -> str:
    """Return the signature of a score by this module."""
    return signature("f1", match=match, scope=scope, empty=1)


def written_f1_signature(match: MatchBy = MATCH, scope: Scope = SCOPE) -> str:
    """Return the signature of a score by this module that is 0 for a program without steps."""
    return signature("f1", 2, match=match, scope=scope, empty=1, no_steps=0)


def named(program: Program) -> frozenset[int]:
    """Return the nodes that a bound program names."""
    return frozenset(ref.node for step in program.steps for ref in step.objects if ref.node is not None)


def score(
    predicted: Final,
    reference: Final,
    named_predicted: Iterable[int],
    named_reference: Iterable[int],
    *,
    match: MatchBy = MATCH,
    scope: Scope = SCOPE,
) -> GraphScore:
    """Compare the final graph of a prediction with the reference's (thesis 5.6.1, A.3).

    Only tuples with an end in a named object or a character count. Rooms and doors are not named objects, but an
    object's relation to its room counts. With scope `either`, named objects are those of either program, in both
    graphs; with `own`, each graph's named objects are those of its own program.

    Matching: `none` compares ids. `swap1`, as published, is the best over replacing one of the reference's objects by
    another instance of its class (one object at a time, ids still compared). With scope `own`, `swap1` gives the
    numbers of tables 5.2 to 5.5, and almost 0 to an empty program. The rest is the character's place, .1 or so where
    the reference stays in the room in which it begins. `best` is the best over all alignments of the two graphs (see
    `hearth.scoring.metrics.alignment`); it does not depend on the ids of instances.

    Empty sets: if neither graph has a tuple of a kind, all three numbers are 1; if only one graph has, 0.

    Args:
        predicted: the graph or world after the predicted program.
        reference: the graph or world after the reference program, in the same environment.
        named_predicted: the nodes that the predicted program names; ids outside the graph are ignored.
        named_reference: likewise.
        match: assignment of instances.
        scope: the objects that count.

    Examples:
        >>> from hearth.scoring.metrics import graph_f1
        >>> found = graph_f1.score(world, execution.final, [fridge], [fridge])
        >>> round(found.states.f1, 2), round(found.relations.f1, 2)
        (0.75, 0.89)
    """
    a, b = views_of(predicted, reference)
    ours, theirs = a.nodes.scored(named_predicted), b.nodes.scored(named_reference)
    if match == "swap1":
        return _swap1(a, b, ours, theirs, scope)
    by_id = _compared(a, b, *((ours | theirs,) * 2 if scope == "either" else (ours, theirs)))
    if match == "none" or by_id.rank() == PERFECT:
        return GraphScore.of(by_id)
    best = Problem(a, b, ours, theirs, either=scope == "either").best(LIMIT)
    return GraphScore.of(best.matches, best.exact, best.pairs)


def _swap1(a: View, b: View, ours: Set[int], theirs: Set[int], scope: Scope) -> GraphScore:
    mine = ours | theirs if scope == "either" else ours
    found: list[tuple[Matches, tuple[Pair, ...]]] = []
    for pair, asked in _substitutes(b, theirs):
        found.append((_compared(a, b, mine, asked | ours if scope == "either" else asked), pair))
        if found[0][0].rank() == PERFECT:
            break
    matches, pair = max(found, key=lambda scored: scored[0].published_rank())
    return GraphScore.of(matches, assigned=pair)


def _substitutes(reference: View, objects: Set[int]) -> Iterator[tuple[tuple[Pair, ...], Set[int]]]:
    """Yield the reference's objects, then variants with one object replaced by another instance of its class."""
    yield (), objects
    for node in sorted(objects):
        for other in reference.nodes.instances[reference.nodes.classes[node]]:
            if other != node:
                yield ((node, other),), objects - {node} | {other}


def _compared(a: View, b: View, ours: Set[int], theirs: Set[int]) -> Matches:
    """Return the matches of two graphs by id: of tuples about some nodes of each, and about the characters."""
    mine, yours = a.mask(ours | a.nodes.characters), b.mask(theirs | b.nodes.characters)
    found = (a, b, mine, yours), (a, a, mine, mine), (b, b, yours, yours)
    states = (sum(len(x.states(i) & y.states(i)) for i in indices(one & other)) for x, y, one, other in found)
    return Matches(Match(*states), Match(*(_shared(*each) for each in found)))


def _shared(a: View, b: View, ours: int, theirs: int) -> int:
    """Return the number of common edges with an end in the first graph's nodes and one in the second's."""
    every, same = ours | theirs, ours & theirs
    found = 0
    for i in indices(every):
        if same >> i & 1:
            # An edge from another of these nodes is counted there, as outgoing.
            out, into = -1, ~every
        else:
            out, into = theirs if ours >> i & 1 else ours, 0
        there = b.rows(i)
        for direction, row in a.rows(i).items():
            found += (row & there.get(direction, 0) & (out if direction[1] else into)).bit_count()
    return found
