"""Monte Carlo tree search over the order of subgoals (thesis 6.4, B.1.1)."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from random import Random

Cost = Callable[[int, int], tuple[float, int]]
"""(cell, number of a subgoal) -> the ticks that it takes from there, and the cell at which it ends."""


@dataclass(frozen=True, slots=True)
class Search:
    """Settings of the search; the defaults are those of the published code.

    Attributes:
        simulations: how many orders are tried.
        c, base: of the exploration term, log((1 + N + base) / base) + c.
        depth: subgoals after the first that an order has at most; those that the tree does not have yet are random.
    """

    simulations: int = 100
    c: float = 0.1
    base: float = 1e6
    depth: int = 5


PUBLISHED = Search()


@dataclass(slots=True)
class _Node:
    visits: int = 0
    total: float = 0.0
    children: dict[int, _Node] = field(default_factory=dict)
    opened: bool = False


class Tree:
    """The search among some subgoals, of which each part of the goal needs a number.

    Attributes:
        values: by number of a subgoal the mean ticks, negative, of the orders that begin with it.
        visits: how many orders began with it.
    """

    def __init__(
        self,
        parts: Sequence[int],
        needed: dict[int, int],
        cost: Cost,
        cell: int,
        chooser: Random,
        settings: Search = PUBLISHED,
    ) -> None:
        """Search.

        Args:
            parts: of each subgoal, the part of the goal that it is for.
            needed: how many subgoals each part needs.
            cost: of a subgoal from a cell.
            cell: where the agent is.
            chooser: of rollouts and of the order of first trials.
            settings: of the search.
        """
        self._parts, self._needed, self._cost, self._chooser = parts, needed, _remembered(cost), chooser
        self._settings = settings
        self._scale = self._worst(cell)
        root = _Node()
        for _ in range(settings.simulations):
            self._simulate(root, cell)
        self.values = {i: node.total / node.visits * self._scale for i, node in root.children.items() if node.visits}
        self.visits = {i: node.visits for i, node in root.children.items() if node.visits}

    @property
    def best(self) -> int:
        """Return the number of the subgoal that was tried most often; of several the one of the highest value."""
        return max(self.visits, key=lambda i: (self.visits[i], self.values[i]))

    def _worst(self, cell: int) -> float:
        """Ticks that no order takes, to which values are in proportion."""
        most = max(self._cost(cell, i)[0] for i in range(len(self._parts)))
        return max(1.0, 2 * most * min(self._settings.depth + 1, sum(self._needed.values())))

    def _simulate(self, root: _Node, cell: int) -> None:
        node, path, ticks = root, [root], 0.0
        used: set[int] = set()
        needed = dict(self._needed)
        while node.opened and node.children and len(used) <= self._settings.depth:
            chosen = self._selected(node)
            cost, cell = self._cost(cell, chosen)
            ticks += cost
            used.add(chosen)
            needed[self._parts[chosen]] -= 1
            node = node.children[chosen]
            path.append(node)
        rest = self._rest(used, needed)
        if not node.opened:
            node.opened = True
            node.children = {i: _Node() for i in rest}
        ticks += self._rollout(rest, used, needed, cell)
        value = -ticks / self._scale
        for each in path:
            each.visits += 1
            each.total += value

    def _rollout(self, rest: list[int], used: set[int], needed: dict[int, int], cell: int) -> float:
        ticks = 0.0
        while rest and len(used) <= self._settings.depth:
            chosen = rest[int(self._chooser.random() * len(rest))]
            cost, cell = self._cost(cell, chosen)
            ticks += cost
            used.add(chosen)
            needed[self._parts[chosen]] -= 1
            rest = self._rest(used, needed)
        return ticks

    def _rest(self, used: set[int], needed: dict[int, int]) -> list[int]:
        return [i for i, part in enumerate(self._parts) if needed[part] > 0 and i not in used]

    def _selected(self, node: _Node) -> int:
        """Return the child of the highest upper bound; one that was never tried goes first."""
        untried = [i for i, child in node.children.items() if not child.visits]
        if untried:
            return untried[int(self._chooser.random() * len(untried))]
        settings = self._settings
        weight = math.log((1 + node.visits + settings.base) / settings.base) + settings.c
        weight *= math.sqrt(node.visits) / len(node.children)
        best, highest = -1, -math.inf
        for i, child in node.children.items():
            bound = child.total / child.visits + weight / (1 + child.visits)
            if bound > highest:
                best, highest = i, bound
        return best


def _remembered(cost: Cost) -> Cost:
    known: dict[tuple[int, int], tuple[float, int]] = {}

    def found(cell: int, subgoal: int) -> tuple[float, int]:
        key = cell, subgoal
        if key not in known:
            known[key] = cost(cell, subgoal)
        return known[key]

    return found
