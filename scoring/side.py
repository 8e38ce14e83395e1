"""One of the two graphs of an alignment: its tuples, sorted by what a change of counterparts can touch."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Set

from hearth.schemas.graph import Edge
from hearth.scoring.views import View

Label = int | str | tuple[str, int]
"""What a node is compared by: its counterpart's id, its own id, or its class."""

Tuples = Counter[object]


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
        self._characters = nodes.characters
        self._fixed = nodes.characters | nodes.left_out
        self._classes = nodes.classes
        self.still_states: Tuples = Counter(view.states(nodes.characters))
        self.still_relations: Tuples = Counter()
        self._states: dict[int, Tuples] = {node: Counter() for node in movable}
        self._relations: dict[int, Tuples] = {node: Counter() for node in movable}
        self._to_characters: dict[int, Tuples] = {}
        self._between: list[Edge] = []
        for node, state in view.states(movable):
            self._states[node][state] += 1
        for edge in view.edges(movable | nodes.characters):
            self._sort(edge, movable)

    def about(self, node: int | None) -> tuple[Tuples, Tuples]:
        """The state and relation tuples of an aligned node, its edges to movable nodes left aside."""
        if node is None:
            return Counter(), Counter()
        if self._either or node in self.named:
            return self._states[node], self._relations[node]
        return Counter(), self._to_characters.get(node, Counter())

    def moving(self, labels: Mapping[int, Label]) -> Tuples:
        """Edges between movable nodes of which one is scored, and the characters' to those that are not aligned."""
        about = labels.keys() if self._either else self.named
        found: Tuples = Counter(
            (edge.relation, self._label(edge.source, labels), self._label(edge.target, labels))
            for edge in self._between
            if edge.source in about or edge.target in about
        )
        for node, tuples in self._to_characters.items():
            if node not in labels:
                for item, count in tuples.items():
                    found[self._classes[node], item] += count
        return found

    def _sort(self, edge: Edge, movable: Set[int]) -> None:
        if edge.source in movable and edge.target in movable:
            self._between.append(edge)
        elif edge.source in movable:
            self._add(edge.source, edge.target, (edge.relation, "to"))
        elif edge.target in movable:
            self._add(edge.target, edge.source, (edge.relation, "from"))
        else:
            self.still_relations[edge.relation, self._still(edge.source), self._still(edge.target)] += 1

    def _add(self, node: int, other: int, how: tuple[str, str]) -> None:
        item = (*how, self._still(other))
        self._relations[node][item] += 1
        if other in self._characters:
            self._to_characters.setdefault(node, Counter())[item] += 1

    def _still(self, node: int) -> Label:
        return node if node in self._fixed else self._classes.get(node, "?")

    def _label(self, node: int, labels: Mapping[int, Label]) -> Label:
        return labels.get(node, self._classes[node])
