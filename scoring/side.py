"""One of the two graphs of an alignment: its tuples, sorted by what a change of counterparts can touch."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Set

from hearth.schemas.graph import Edge
from hearth.scoring.views import Label, Tuples, View


class Side:
    """The tuples of a graph, read once.

    Movable nodes are the instances of the classes that either program names. Of all others rooms, doors and characters
    are compared by id and the rest by class, whatever the alignment; these are the still ends.

    Args:
        view: the graph.
        named: the nodes its program names.
        movable: as above.
        either: an aligned node's tuples count even when this side's program does not name it.

    Attributes:
        named: as given.
        still_states: the characters' states.
        still_relations: the characters' edges to still ends.
    """

    def __init__(self, view: View, named: Set[int], movable: Set[int], either: bool) -> None:
        nodes = view.nodes
        self.named = named
        self._either = either
        self._classes = nodes.classes
        self.still_states: Tuples = Counter(view.states(nodes.characters))
        self._states: dict[int, Tuples] = {node: Counter() for node in movable}
        for node, state in view.states(movable):
            self._states[node][state] += 1
        found = view.sorted_edges(movable)
        self.still_relations = found.still
        self._relations, self._to_characters = found.single, found.to_characters
        self._out: dict[int, list[Edge]] = {}
        self._into: dict[int, list[Edge]] = {}
        for edge in found.between:
            self._out.setdefault(edge.source, []).append(edge)
            self._into.setdefault(edge.target, []).append(edge)

    def about(self, node: int | None) -> tuple[Tuples, Tuples]:
        """The state and relation tuples of an aligned node, its edges to movable nodes left aside."""
        if node is None:
            return Counter(), Counter()
        if self._either or node in self.named:
            return self._states[node], self._relations[node]
        return Counter(), self._to_characters.get(node, Counter())

    def moving(self, labels: Mapping[int, Label]) -> Mapping[object, int]:
        """Edges between movable nodes of which one is scored, and the characters' to those that are not aligned."""
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
                for told, count in tuples.items():
                    one = (classes[node], told)
                    found[one] = found.get(one, 0) + count
        return found
