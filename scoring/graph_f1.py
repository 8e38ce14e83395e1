"""F1 over final graphs: whether a prediction leaves the home as the reference does (thesis 5.6.1, A.3)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Set
from dataclasses import dataclass
from typing import Literal, get_args

from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.program import Program
from hearth.scoring import row_match
from hearth.scoring.alignment import LIMIT, PERFECT, Pair, Problem
from hearth.scoring.counts import NOTHING, Match, Matches, Prf
from hearth.scoring.signature import signature
from hearth.scoring.views import View, view_of
from hearth.simulation.world import World

MatchBy = Literal["none", "swap1", "best"]
"""How instances of a class may stand for each other; see `score`."""

Scope = Literal["either", "own"]
"""Whose objects a graph's tuples are about: those of either program, or those of its own."""

MATCHES: tuple[MatchBy, ...] = get_args(MatchBy)
SCOPES: tuple[Scope, ...] = get_args(Scope)

Final = EnvironmentGraph | World


@dataclass(frozen=True, slots=True)
class GraphScore:
    """Precision, recall and F1 of a final graph.

    Attributes:
        states: over state tuples, (object, state).
        relations: over relation tuples, (relation, from, to).
        both: over the two together.
        exact: whether no other assignment of instances could score higher; False says that `both` is a lower bound.
        assigned: (reference node, predicted node) where one object stood for another.
    """

    states: Prf
    relations: Prf
    both: Prf
    exact: bool = True
    assigned: tuple[Pair, ...] = ()

    @classmethod
    def of(cls, matches: Matches, exact: bool = True, assigned: tuple[Pair, ...] = ()) -> GraphScore:
        """The score of counted matches."""
        states, relations = matches
        return cls(states.prf(), relations.prf(), (states + relations).prf(), exact, assigned)


FAILED = GraphScore(NOTHING, NOTHING, NOTHING)
"""The score of a prediction that is missing, does not parse or does not run."""


def f1_signature(match: MatchBy = "best", scope: Scope = "either") -> str:
    """The signature of a score by this module."""
    return signature("f1", match=match, scope=scope, empty=1)


def named(program: Program) -> frozenset[int]:
    """The nodes that a bound program names."""
    return frozenset(ref.node for step in program.steps for ref in step.objects if ref.node is not None)


def score(
    predicted: Final | View,
    reference: Final | View,
    named_predicted: Iterable[int],
    named_reference: Iterable[int],
    *,
    match: MatchBy = "best",
    scope: Scope = "either",
) -> GraphScore:
    """Compare the final graph of a prediction with the reference's.

    Only tuples with an end in a named object or a character count. Rooms and doors are no such objects, but an object's
    relation to its room counts. With scope `either`, named objects are those of either program, in both graphs; with
    `own`, each graph's tuples are about its own program's objects.

    Matching: `none` compares ids. `swap1`, as published, takes the best over asking about another instance of its class
    in place of one of the reference's objects (one object at a time, ids still compared); with scope `own` it gives the
    numbers of tables 5.2 to 5.5. `best` takes the best over all alignments of the two graphs (see
    `hearth.scoring.alignment`); it does not depend on which ids the instances of a class have.

    Empty sets: when neither graph has a tuple of a kind they agree, and all three numbers are 1; when only one has, 0.

    Args:
        predicted: the graph or world after the predicted program.
        reference: the graph or world after the reference program, in the same environment.
        named_predicted: the nodes the predicted program names; ids that are not in the graph are passed over.
        named_reference: likewise.
        match: how instances may stand for each other.
        scope: whose objects are looked at.
    """
    a, b = _view(predicted), _view(reference)
    ours, theirs = _scored(a, named_predicted), _scored(b, named_reference)
    if match == "swap1":
        return _swap1(a, b, ours, theirs, scope)
    by_id = _by_id(predicted, reference, ours | theirs) if scope == "either" else None
    if by_id is None:
        about = (ours | theirs, ours | theirs) if scope == "either" else (ours, theirs)
        by_id = _compare(_tuples(a, about[0]), _tuples(b, about[1]))
    if match == "none" or by_id.rank() == PERFECT:
        return GraphScore.of(by_id)
    best = Problem(a, b, ours, theirs, either=scope == "either").best(LIMIT)
    return GraphScore.of(best.matches, best.exact, best.pairs)


def _by_id(predicted: Final | View, reference: Final | View, about: Set[int]) -> Matches | None:
    """What two worlds of one home share, ids compared, from their rows; None where only tuples can tell."""
    if isinstance(predicted, World) and isinstance(reference, World) and row_match.comparable(predicted, reference):
        return row_match.matches(predicted, reference, about)
    return None


def _swap1(a: View, b: View, ours: Set[int], theirs: Set[int], scope: Scope) -> GraphScore:
    mine = _tuples(a, ours | theirs if scope == "either" else ours)
    found: list[tuple[Matches, tuple[Pair, ...]]] = []
    for pair, asked in _substitutes(b, theirs):
        about = asked | ours if scope == "either" else asked
        found.append((_compare(mine, _tuples(b, about)), pair))
    matches, pair = max(found, key=lambda scored: scored[0].published_rank())
    return GraphScore.of(matches, assigned=pair)


def _substitutes(reference: View, objects: Set[int]) -> Iterator[tuple[tuple[Pair, ...], Set[int]]]:
    """The reference's objects, then with each replaced by every other instance of its class."""
    yield (), objects
    for node in sorted(objects):
        for other in reference.nodes.instances[reference.nodes.classes[node]]:
            if other != node:
                yield ((node, other),), objects - {node} | {other}


def _view(final: Final | View) -> View:
    return view_of(final) if isinstance(final, EnvironmentGraph | World) else final


def _scored(view: View, nodes: Iterable[int]) -> frozenset[int]:
    known = view.nodes
    return frozenset(i for i in nodes if i in known.classes and i not in known.left_out and i not in known.characters)


Tuples = tuple[frozenset[object], frozenset[object]]


def _tuples(view: View, about: Set[int]) -> Tuples:
    nodes = about | view.nodes.characters
    return frozenset(view.states(nodes)), frozenset(view.edges(nodes))


def _compare(predicted: Tuples, reference: Tuples) -> Matches:
    states, relations = (Match(len(a & b), len(a), len(b)) for a, b in zip(predicted, reference, strict=True))
    return Matches(states, relations)
