"""Alignment of a prediction's objects with the reference's; instances of a class are interchangeable.

An alignment maps every object that either program names to a distinct counterpart of its class in the other graph.
Aligned objects, rooms, doors and characters are identified individually; all other objects by class only, so that
scores do not depend on the ids of instances.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from itertools import combinations, permutations, product

from hearth.schemas.graph import Edge
from hearth.scoring.metrics.final_graph import Label, View
from hearth.scoring.metrics.precision_recall import Match, Matches, matched, shared
from hearth.simulation.world.bits import indices

Tuples = Counter[object]

LIMIT = 1_000
"""Number of alignments up to which all are tried; beyond, a search gives a lower bound of the best score."""

ROUNDS = 20
"""Greatest number of improvements from one start of a search."""

Pair = tuple[int | None, int | None]
"""A reference node and its counterpart; None if the other graph has no instance left."""

PERFECT = (1.0, 2.0)
"""The rank of a perfect match."""


@dataclass(frozen=True, slots=True)
class Best:
    """The best alignment found.

    Attributes:
        matches: its counts.
        pairs: (reference node, predicted node) with different ids.
        exact: whether it is the optimum; else the best of a search, a lower bound.
    """

    matches: Matches
    pairs: tuple[Pair, ...]
    exact: bool


class Problem:
    """A predicted and a reference graph with the objects that each program names.

    Args:
        predicted, reference: the final graphs.
        named_predicted, named_reference: node ids, without rooms, doors and characters.
        either: whether tuples of both programs' objects count in both graphs, or in each graph those of its own.
    """

    def __init__(
        self, predicted: View, reference: View, named_predicted: Set[int], named_reference: Set[int], either: bool
    ) -> None:
        self.groups = _groups(predicted, reference, named_predicted, named_reference)
        ours = {node for group in self.groups for node in group.predicted}
        theirs = {node for group in self.groups for node in group.reference}
        self.predicted = _Side(predicted, named_predicted, ours, either)
        self.reference = _Side(reference, named_reference, theirs, either)
        self._pairs: dict[Pair, tuple[int, ...]] = {}
        self._fixed = _matches(self.predicted.fixed, self.reference.fixed)

    def best(self, limit: int = LIMIT) -> Best:
        """Return the best alignment, of all where there are at most `limit`."""
        count = math.prod(group.count() for group in self.groups)
        exact = count <= limit
        found = max(self._scored(self._all() if exact else self._searched()), key=lambda scored: scored[0].rank())
        pairs = tuple(sorted((pair for pair in found[1] if pair[0] != pair[1]), key=str))
        return Best(found[0], pairs, exact or found[0].rank() == PERFECT)

    def _scored(self, alignments: Iterator[tuple[Pair, ...]]) -> Iterator[tuple[Matches, tuple[Pair, ...]]]:
        for pairs in alignments:
            matches = self.matches(pairs)
            yield matches, pairs
            if matches.rank() == PERFECT:
                return

    def matches(self, pairs: Sequence[Pair]) -> Matches:
        """Count the common tuples of two graphs under an alignment.

        A tuple with one movable end can only match a tuple of its counterpart: such counts are cached by pair, and only
        edges between movable nodes are compared again.
        """
        sums: tuple[int, ...] = self._fixed
        ours: dict[int, Label] = {}
        theirs: dict[int, Label] = {}
        for pair in pairs:
            reference, predicted = pair
            counted = self._pairs.get(pair)
            if counted is None:
                counted = self._pairs[pair] = self._counted(reference, predicted)
            # Six plain numbers: this loop runs for a thousand alignments of a dozen pairs.
            a, b, c, d, e, f = sums
            u, v, w, x, y, z = counted
            sums = (a + u, b + v, c + w, d + x, e + y, f + z)
            if predicted is not None:
                ours[predicted] = predicted
            if reference is not None:
                theirs[reference] = predicted if predicted is not None else ("reference", reference)
        moving = matched(self.predicted.moving(ours), self.reference.moving(theirs))
        return Matches(Match(*sums[:3]), Match(*sums[3:]) + moving)

    def _counted(self, reference: int | None, predicted: int | None) -> tuple[int, ...]:
        """Return the matches of one pair's states and relations, as six numbers."""
        return _matches(self.predicted.about(predicted), self.reference.about(reference))

    def _all(self) -> Iterator[tuple[Pair, ...]]:
        yield self._derived([group.identity() for group in self.groups])
        for choice in product(*(group.alignments() for group in self.groups)):
            yield tuple(pair for pairs in choice for pair in pairs)

    def _derived(self, bijections: Sequence[Sequence[Pair]]) -> tuple[Pair, ...]:
        """Return the pairs of the bijections with a named object."""
        ours, theirs = self.predicted.named, self.reference.named
        return tuple(pair for pairs in bijections for pair in pairs if pair[0] in theirs or pair[1] in ours)

    def _searched(self) -> Iterator[tuple[Pair, ...]]:
        """Alignments of a local search from two initial guesses, which exchanges the counterparts of two objects."""
        for start in ([group.identity() for group in self.groups], [self._guess(group) for group in self.groups]):
            yield self._derived(start)
            yield from self._improved(start)

    def _improved(self, bijections: list[list[Pair]]) -> Iterator[tuple[Pair, ...]]:
        rank = self.matches(self._derived(bijections)).rank()
        for _ in range(ROUNDS):
            options = [option for n in range(len(bijections)) for option in self._exchanges(bijections, n)]
            scored = [(self.matches(self._derived(option)).rank(), number) for number, option in enumerate(options)]
            best, number = max(scored, key=lambda pair: (pair[0], -pair[1]), default=(rank, -1))
            if best <= rank:
                return
            rank, bijections = best, options[number]
            yield self._derived(bijections)

    def _exchanges(self, bijections: list[list[Pair]], number: int) -> Iterator[list[list[Pair]]]:
        pairs = bijections[number]
        named = [p[0] in self.reference.named or p[1] in self.predicted.named for p in pairs]
        for i, j in combinations(range(len(pairs)), 2):
            if named[i] or named[j]:
                swapped = list(pairs)
                swapped[i], swapped[j] = (pairs[i][0], pairs[j][1]), (pairs[j][0], pairs[i][1])
                yield [*bijections[:number], swapped, *bijections[number + 1 :]]

    def _guess(self, group: _Group) -> list[Pair]:
        """Return the bijection of a class with most matching tuples, ignoring those between movable nodes."""
        import numpy as np
        from scipy.optimize import linear_sum_assignment

        pairs = group.identity()
        counts = [[self._counted(reference, predicted) for _, predicted in pairs] for reference, _ in pairs]
        weights = np.array([[found[0] + found[3] for found in row] for row in counts])
        rows, columns = linear_sum_assignment(weights, maximize=True)
        return [(pairs[i][0], pairs[j][1]) for i, j in zip(rows.tolist(), columns.tolist(), strict=True)]


About = tuple[Set[object], Mapping[object, int]]
"""State tuples, and counts of relation tuples."""


def _matches(predicted: About, reference: About) -> tuple[int, ...]:
    return (*shared(predicted[0], reference[0]), *matched(predicted[1], reference[1]))


class _Side:
    """The tuples of one graph, separated by their dependence on the alignment.

    Movable nodes are the instances of the classes that either program names. Other nodes are fixed: rooms, doors and
    characters are compared by id and the rest by class, in every alignment.

    Args:
        view: the graph.
        named: the nodes that its program names.
        movable: as above.
        either: whether an aligned node's tuples count even if this graph's program does not name it.

    Attributes:
        named: as given.
        fixed: the characters' states, and their edges to fixed nodes.
    """

    def __init__(self, view: View, named: Set[int], movable: Set[int], either: bool) -> None:
        self.named, self._either, self._classes = named, either, view.nodes.classes
        self._about: dict[int, About] = {}
        self._to_characters: dict[int, Tuples] = {}
        self._out: dict[int, list[Edge]] = {}
        self._into: dict[int, list[Edge]] = {}
        moving, characters = view.mask(movable), view.mask(view.nodes.characters)
        for i in indices(moving):
            self._sort(view, i, moving, characters)
        relations: Tuples = Counter()
        for i in indices(characters):
            for (relation, out), row in view.rows(i).items():
                # Edges from a character are in its own row.
                for j in indices(row & ~moving if out else row & ~moving & ~characters):
                    ends = _label(view, i), _label(view, j)
                    relations[relation, ends if out else ends[::-1]] += 1
        self.fixed: About = {(i, state) for i in indices(characters) for state in view.states(i)}, relations

    def _sort(self, view: View, i: int, moving: int, characters: int) -> None:
        """Read a movable node's tuples."""
        node = view.ids[i]
        relations: Tuples = Counter()
        for (relation, out), row in view.rows(i).items():
            if out:
                for j in indices(row & moving):
                    edge = Edge(node, relation, view.ids[j])
                    self._out.setdefault(node, []).append(edge)
                    self._into.setdefault(edge.target, []).append(edge)
            for j in indices(row & ~moving):
                relations[relation, out, _label(view, j)] += 1
            for j in indices(row & characters):
                self._to_characters.setdefault(node, Counter())[relation, out, _label(view, j)] += 1
        self._about[node] = view.states(i), relations

    def about(self, node: int | None) -> About:
        """Return the state and relation tuples of an aligned node, without its edges to movable nodes."""
        if node is not None and (self._either or node in self.named):
            return self._about[node]
        return frozenset(), self._to_characters.get(node, {}) if node is not None else {}

    def moving(self, labels: Mapping[int, Label]) -> Mapping[object, int]:
        """Edges between movable nodes with a scored end, and edges of characters to unaligned movable nodes."""
        about = labels.keys() if self._either else self.named
        found: dict[object, int] = {}
        ends: list[Edge] = []
        if self._out:
            for node in about:
                ends += self._out.get(node, ())
                ends += [edge for edge in self._into.get(node, ()) if edge.source not in about]
        classes = self._classes
        for source, relation, target in ends:
            item = (relation, labels.get(source, classes[source]), labels.get(target, classes[target]))
            found[item] = found.get(item, 0) + 1
        for node, tuples in self._to_characters.items():
            if node not in labels:
                for ends_at, count in tuples.items():
                    one = (classes[node], ends_at)
                    found[one] = found.get(one, 0) + count
        return found


def _label(view: View, number: int) -> Label:
    return view.nodes.labels.get(view.ids[number], "?")


@dataclass(frozen=True, slots=True)
class _Group:
    """A class that either program names: its instances in both graphs, and the named ones."""

    predicted: tuple[int, ...]
    reference: tuple[int, ...]
    named_predicted: tuple[int, ...]
    named_reference: tuple[int, ...]

    def count(self) -> int:
        """Return an upper bound of the number of alignments."""
        ours, theirs = len(self.predicted), len(self.reference)
        images = math.perm(max(ours, len(self.named_reference)), len(self.named_reference))
        if len(self.named_reference) == ours and ours == theirs:
            return images
        left = max(theirs - len(self.named_reference), len(self.named_predicted))
        return images * math.perm(left, len(self.named_predicted))

    def identity(self) -> list[Pair]:
        """Return the bijection that keeps common ids, and pairs the rest in order, or with None."""
        same = [i for i in self.reference if i in self.predicted]
        theirs: list[int | None] = [i for i in self.reference if i not in same]
        ours: list[int | None] = [i for i in self.predicted if i not in same]
        longest = max(len(ours), len(theirs))
        padded = zip(theirs + [None] * (longest - len(theirs)), ours + [None] * (longest - len(ours)), strict=True)
        return [*((i, i) for i in same), *padded]

    def alignments(self) -> Iterator[tuple[Pair, ...]]:
        """Yield every assignment of counterparts to the named objects of either program."""
        for images in _choices(self.predicted, len(self.named_reference)):
            first = tuple(zip(self.named_reference, images, strict=True))
            rest = [node for node in self.named_predicted if node not in images]
            free = [node for node in self.reference if node not in self.named_reference]
            for origins in _choices(free, len(rest)):
                yield (*first, *zip(origins, rest, strict=True))


def _groups(predicted: View, reference: View, ours: Set[int], theirs: Set[int]) -> list[_Group]:
    classes = {predicted.nodes.classes[i] for i in ours} | {reference.nodes.classes[i] for i in theirs}
    return [
        _Group(
            predicted.nodes.instances.get(name, ()),
            reference.nodes.instances.get(name, ()),
            tuple(sorted(i for i in ours if predicted.nodes.classes[i] == name)),
            tuple(sorted(i for i in theirs if reference.nodes.classes[i] == name)),
        )
        for name in sorted(classes)
    ]


def _choices(candidates: Sequence[int], number: int) -> Iterator[tuple[int | None, ...]]:
    """Yield every ordered choice of `number` candidates; None fills in for missing ones."""
    padded: list[int | None] = [*candidates, *[None] * (number - len(candidates))]
    return permutations(padded, number)
