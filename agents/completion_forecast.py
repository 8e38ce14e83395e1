"""The time at which a main agent with a helper reaches a goal: a quick simulation of both.

Both fetch one thing after another. Only ticks and places count, and no world is changed. The main agent carries one
thing at a time, and begins with the thing that saves most walking. The helper makes trips for one or two things.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from hearth.agents.interchangeable_objects import HELPER, MAIN, Situation

BOTH_HANDS = 6
"""Ticks that it takes more to open something with both hands full."""

LATER = 0.02
"""The price of each tick in which a single thing is still missing: of two plans that end together the prompter wins."""

MOST = 400.0
"""Ticks after which a simulation ends."""

HANDS = 2

TAKE, GIVE = -1, -2


class Stop(NamedTuple):
    """Something that the helper does next.

    Attributes:
        heap: number of the heap to which a thing belongs.
        row: of the predicate for which it is put; `TAKE` to take it, `GIVE` to hand it over.
    """

    heap: int
    row: int = TAKE


_Trip = tuple[float, int, int]
"""Ticks, heap, row."""


class _Errand(NamedTuple):
    """The current errand of an agent: the heap of its thing, its row, whether the thing is carried, and its start."""

    heap: int
    row: int
    carried: bool
    began: float


class Forecast:
    """A simulation from a situation under one goal."""

    def __init__(self, situation: Situation, lacking: Mapping[int, int], pursued: int = -1) -> None:
        """Ask about one goal.

        Args:
            situation: now.
            lacking: row -> how many are still wanted.
            pursued: number of the thing that the one who is helped goes for, if that is known; -1 otherwise.
        """
        self.at, self._wanted, self._pursued = situation, lacking, pursued

    def finish(self, stops: Sequence[Stop] = (), wait: float = 0.0) -> float:
        """Ticks until the goal is reached, with a little for all that is brought late.

        Args:
            stops: the helper's first stops; after them it takes the best one by its estimate.
            wait: ticks until it begins, because it watches; where nothing is left for the other, for nothing.
        """
        heaps = self.at.heaps
        self.lacking = dict(self._wanted)
        self.left = [len(heap.things) if heap.holder < 0 else 0 for heap in heaps]
        self.hands = [number for number, heap in enumerate(heaps) if heap.holder == HELPER for _ in heap.things]
        self.cells, self.shut, self.now, self.late = list(self.at.starts), self.at.shut, 0.0, 0.0
        self.stops, self.stop = list(stops), None
        self.errand: _Errand | None = None
        self._main_begins()
        if wait and self.errand is None:
            return MOST
        self._helper_next(wait)
        while self.lacking:
            self.now = min(self.main_at, self.helper_at)
            if self.now > MOST:
                return MOST
            if self.main_at <= self.helper_at:
                self._main_done()
            else:
                self._helper_done()
        return self.now + LATER * self.late

    # The main agent

    def _main_begins(self) -> None:
        for number, heap in enumerate(self.at.heaps):
            row = next((row for row in heap.rows if row in self.lacking), -1) if heap.holder == MAIN else -1
            if row >= 0:
                self._carry(number, row)
                return
        self._main_chooses(self._pursued)

    def _main_chooses(self, pursued: int = -1) -> None:
        """Choose the main agent's next thing: the one that saves most, being near now and far from its target."""
        best, chosen = math.inf, (-1, -1)
        for (number, row), saved in self._savings().items():
            ticks, cell = self._fetch(MAIN, number)
            cost = ticks + self._bring(MAIN, cell, row) - saved
            if pursued in self.at.heaps[number].things:
                cost -= MOST
            if cost < best:
                best, chosen = cost, (number, row)
        self.errand, self.main_at = None, math.inf
        if chosen[0] >= 0:
            self.errand = _Errand(*chosen, carried=False, began=self.now)
            self.main_at = self.now + self._fetch(MAIN, chosen[0])[0]

    def _savings(self) -> dict[tuple[int, int], float]:
        """Heap and row -> ticks that fetching it now saves later: those of a round trip, or of the dearest that will be
        needed where the cheapest are taken.
        """
        trips: defaultdict[int, list[tuple[int, int]]] = defaultdict(list)
        for number, heap in enumerate(self.at.heaps):
            for row in heap.rows if self.left[number] else ():
                if row in self.lacking:
                    trips[row].append((self.at.round_trip(number, row), number))
        found = {}
        for row, each in trips.items():
            needed, dearest = self.lacking[row], 0.0
            for ticks, number in sorted(each):
                dearest = ticks if needed > 0 else dearest
                needed -= self.left[number]
                found[number, row] = min(ticks, dearest)
        return found

    def _carry(self, number: int, row: int) -> None:
        self.errand = _Errand(number, row, carried=True, began=self.now)
        self.main_at = self.now + self._bring(MAIN, self.cells[MAIN], row)

    def _main_done(self) -> None:
        errand = self.errand
        assert errand is not None
        if errand.carried:
            self.cells[MAIN] = self._end(MAIN, self.at.targets[errand.row][0])
            self._put(errand.row)
            self._main_chooses()
        else:
            self._take(MAIN, errand.heap)
            self._carry(errand.heap, errand.row)

    def _main_again(self) -> None:
        """Turn the main agent to another thing, from its present place, if its errand has become useless."""
        errand = self.errand
        if errand is None or (errand.row in self.lacking and (errand.carried or self.left[errand.heap])):
            return
        node = self.at.targets[errand.row][0] if errand.carried else self.at.heaps[errand.heap].node
        self.cells[MAIN] = self.at.after(MAIN, self.cells[MAIN], node, self.now - errand.began)
        self._main_chooses()

    # The helper

    def _helper_next(self, now: float) -> None:
        coming = {*self.hands, *(each.heap for each in self.stops if each.row == TAKE and self.left[each.heap])}
        self.stops = [each for each in self.stops if each.row == TAKE or each.heap in coming]
        stop = self.stop = self.stops.pop(0) if self.stops else self._best()
        if stop is None:
            self.helper_at = math.inf
        elif stop.row == GIVE:
            self.helper_at = now + self.at.giving
        elif stop.row == TAKE:
            self.helper_at = now + self._fetch(HELPER, stop.heap)[0]
        else:
            self.helper_at = now + self._bring(HELPER, self.cells[HELPER], stop.row, len(self.hands) == HANDS)

    def _helper_done(self) -> None:
        stop = self.stop
        assert stop is not None
        if stop.row == TAKE:
            if self.left[stop.heap]:
                self._take(HELPER, stop.heap)
                self.hands.append(stop.heap)
        else:
            self.hands.remove(stop.heap)
            self._given(stop.heap) if stop.row == GIVE else self._brought(stop.row)
        self._main_again()
        if self.lacking:
            self._helper_next(self.now)

    def _brought(self, row: int) -> None:
        self.cells[HELPER] = self._end(HELPER, self.at.targets[row][0])
        self._put(row)

    def _given(self, number: int) -> None:
        """Hand a thing over; the agent that has it brings it to its target."""
        self.cells[HELPER] = self.cells[MAIN]
        row = next((row for row in self.at.heaps[number].rows if row in self.lacking), -1)
        if row >= 0 and (self.errand is None or not self.errand.carried):
            self._carry(number, row)

    def _best(self) -> Stop | None:
        """Return the helper's best stop: bring a thing in its hands, else the trip with the fewest ticks."""
        rest = dict(self.lacking)
        if self.errand is not None and self.errand.row in rest:
            rest[self.errand.row] -= 1
        rest = {row: number for row, number in rest.items() if number}
        if held := list(self._held(rest)):
            return Stop(*min(held)[1:])
        singles = list(self._singles(rest)) if len(self.hands) < HANDS else []
        if not singles:
            return self._overtaking()
        best = min(singles)
        return self._set_out(best, [] if self.hands else singles, rest)

    def _set_out(
        self, best: tuple[float, int, int], singles: list[tuple[float, int, int]], rest: Mapping[int, int]
    ) -> Stop:
        """Begin a trip for one thing, or for another one, too, where that takes fewer ticks for each."""
        ticks, number, row = best
        stops = [Stop(number, row)]
        fetched, cell = self._fetch(HELPER, number)
        for _, other, theirs in singles:
            if (other == number and self.left[number] < HANDS) or (theirs == row and rest[row] < HANDS):
                continue
            more, end = (1, cell) if other == number else self._fetch(HELPER, other, cell)
            first = self._bring(HELPER, end, row, full=True)
            there = self.at.leg(HELPER, end, self.at.targets[row][0])[1]
            both = fetched + more + first + (1 if theirs == row else self._bring(HELPER, there, theirs))
            if both / 2 < ticks:
                ticks, stops = both / 2, [Stop(other), Stop(number, row), Stop(other, theirs)]
        self.stops[:0] = stops
        return Stop(number)

    def _overtaking(self) -> Stop | None:
        """Return the helper's stop for the main agent's current thing, where the helper is faster."""
        errand = self.errand
        if errand is None or len(self.hands) == HANDS:
            return None
        rest = self.main_at - self.now
        if not errand.carried:
            rest += self._bring(MAIN, self._fetch(MAIN, errand.heap)[1], errand.row)
        ticks, number, row = min([*self._held(self.lacking), *self._singles(self.lacking)], default=(math.inf, -1, -1))
        if ticks >= rest:
            return None
        if number not in self.hands:
            self.stops[:0] = [Stop(number, row)]
            return Stop(number)
        return Stop(number, row)

    def _held(self, rows: Iterable[int]) -> Iterator[_Trip]:
        """Yield the things in the helper's hands that some rows lack: ticks to bring each, heap, row."""
        for number in self.hands:
            for row in self.at.heaps[number].rows:
                if row in rows:
                    yield self._bring(HELPER, self.cells[HELPER], row, len(self.hands) == HANDS), number, row

    def _singles(self, rows: Iterable[int]) -> Iterator[_Trip]:
        """Yield the things that the helper could fetch for some rows: ticks of the trip, heap, row."""
        for number, heap in enumerate(self.at.heaps):
            for row in heap.rows if self.left[number] else ():
                if row in rows:
                    ticks, cell = self._fetch(HELPER, number)
                    yield ticks + self._bring(HELPER, cell, row), number, row

    # Both

    def _end(self, who: int, node: int) -> int:
        return self.at.leg(who, self.cells[who], node)[1]

    def _fetch(self, who: int, number: int, cell: int | None = None) -> tuple[float, int]:
        """Return the ticks until an agent takes a thing of a heap, and the cell then.

        The main agent closes the containers that it has opened.
        """
        heap = self.at.heaps[number]
        ticks, end = self.at.leg(who, self.cells[who] if cell is None else cell, heap.node)
        shut = heap.inside and self.shut >> heap.node & 1
        return ticks + 1 + shut * (2 if who == MAIN else 1), end

    def _bring(self, who: int, cell: int, row: int, full: bool = False) -> float:
        """Ticks until something that is held is put for a row."""
        node, inside = self.at.targets[row]
        shut = inside and self.shut >> node & 1
        return self.at.leg(who, cell, node)[0] + 1 + shut * (1 + BOTH_HANDS * full)

    def _take(self, who: int, number: int) -> None:
        node = self.at.heaps[number].node
        self.cells[who] = self._end(who, node)
        self.left[number] -= 1
        self.shut &= ~(1 << node)

    def _put(self, row: int) -> None:
        self.shut &= ~(1 << self.at.targets[row][0])
        self.late += self.now
        if row in self.lacking:
            self.lacking[row] -= 1
            if not self.lacking[row]:
                del self.lacking[row]
