"""Train, validation and test splits, stored as a table.

Near duplicates are assigned together, whatever their activity: a program and its repaired descendants, programs with
nearly the same steps, and programs with nearly the same description. If a rule would still separate such a group, its
programs outside the latest part have none. The remaining leakage is measured and compared with that of a random split.
"""

from array import array
from collections.abc import Callable, Iterable, Iterator, Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from hearth.datasets.format.split_columns import NOTHING, PARTS, SplitPrograms
from hearth.datasets.format.split_runs import Runs
from hearth.schemas.published_rows import SplitRow
from hearth.schemas.rng import derive

RULES = {
    "activities": "by program: activities 7:1:2; the parts are those of `programs.split`",
    "held_out_home": "by execution: as `activities`, with {held_out} held out (thesis 5.6): train and validation in the"
    " other homes, test_seen_home there too, test_held_out_home in {held_out}",
    "homes_1_4": "by program: trained in homes 1-4 ({1_4}), validated in 5 ({5_5}), tested in 1-6 (4.4): test_seen in"
    " 1-4, test_unseen in 5-6 ({5_6})",
    "homes_1_5": "by program: trained in homes 1-5 ({1_5}), tested in 6-7 ({6_7}) (6.5.1, 7.4)",
}
"""The rule of each split, with the names of homes put in; homes are numbered by name.

In a split by program, a program has one part, or none in some homes; by execution, it may have another in each home.
"""

LEFT_OUT = "left_out"
"""Name in files for programs without a part in `activities`."""

SHARES = (*PARTS, LEFT_OUT)
"""The shares of a table that descends from programs; each has files of its own."""

BY_CASE = ("programs", "environments", "executions", "perturbations", "repairs")
"""Tables that have a row for a program in an environment, each in the share of its program."""

DRAWN = ("frames", "videos", "clips", "demonstration_frames")
"""Tables of pictures of executions, each row in the share of its program; clips are in the part that they name."""

DESCENDED = (*BY_CASE, "sketches", *DRAWN)
"""Tables that descend from programs."""


def share_of(table: str, part: str | None) -> str:
    """Return the name of the share of a table that has the rows of a part: `executions.test`."""
    return f"{table}.{part or LEFT_OUT}"


_NONE: Mapping[str, Mapping[str, str | None]] = MappingProxyType({})


def groups(programs: SplitPrograms) -> NDArray[np.int32]:
    """(ids,) for each program the place of its group of near duplicates: that of the first of its originals."""
    above = array("i", range(len(programs.ids)))

    def find(place: int) -> int:
        while above[place] != place:
            above[place] = above[above[place]]
            place = above[place]
        return place

    def join(one: int, other: int) -> None:
        a, b = sorted((find(one), find(other)))
        above[b] = a

    for near in (programs.steps, programs.texts):
        first = array("i", [NOTHING]) * near.count
        for root, number in zip(programs.root.data, near.numbers.data, strict=True):
            if number != NOTHING:
                if first[number] == NOTHING:
                    first[number] = root
                join(first[number], root)
        for one, other in zip(near.one.data, near.other.data, strict=True):
            join(first[one], first[other])
    return np.fromiter(map(find, programs.root.data), np.int32, len(above))


def by_activity(programs: SplitPrograms, group: NDArray[np.int32]) -> NDArray[np.int8]:
    """(ids,) position in `PARTS` of each program's part in `activities`; `NOTHING` if it has none.

    That is the part of its activity, unless a near duplicate, by its `groups`, is in a later part.
    """
    last = np.full(len(programs.ids), NOTHING, np.int8)
    np.maximum.at(last, group, programs.part)
    return np.where(programs.part == last[group], programs.part, np.int8(NOTHING))


def part_name(number: int) -> str | None:
    """Return the name of a part by its position in `PARTS`; None for `NOTHING`."""
    return None if number == NOTHING else PARTS[number]


def held_out(runs: Runs, seed: int) -> str:
    """Return the home that is held out; homes are numbered in the order of `Runs.homes`."""
    return runs.homes[derive(seed, "split", "home") % len(runs.homes)] if runs.homes else ""


class SplitRows(Iterable[SplitRow]):
    """A row for each run and split, sorted by `split` and `execution_id`; millions, made anew each time.

    Attributes:
        own: names of the splits that come with sources, in order.

    Args:
        programs: all published programs.
        runs: every execution that ran to its end.
        seed: of the assignment.
        own: id of an original -> split -> part, where its source gives them; other programs are in no such split.
    """

    def __init__(
        self,
        programs: SplitPrograms,
        runs: Runs,
        seed: int,
        own: Mapping[str, Mapping[str, str | None]] = _NONE,
    ) -> None:
        self._programs, self._runs, self._own = programs, runs, own
        self.own = sorted({name for given in own.values() for name in given})
        group = groups(programs)
        self._part = by_activity(programs, group)
        self._decile = {split: _deciles(programs, group, seed, split) for split in _BY_HOME}
        self._held_out = held_out(runs, seed)
        self._number = {home: place for place, home in enumerate(runs.homes, 1)}

    def __iter__(self) -> Iterator[SplitRow]:
        ids = self._programs.ids
        for split in sorted({*RULES, *self.own}):
            for execution_id, place, part in self.parts(split):
                yield {"split": split, "execution_id": execution_id, "program_id": ids[place], "part": part}

    def parts(self, split: str) -> Iterator[tuple[str, int, str | None]]:
        """Yield for each run in a split its id, the place of its program, and its part; in the order of the ids."""
        part_of = self._rule(split)
        for execution_id, place, home in self._runs:
            if split in RULES or split in self._own.get(self._original(place), ()):
                yield execution_id, place, part_of(place, home)

    def _original(self, place: int) -> str:
        original: int = self._programs.root[place]
        return self._programs.ids[original]

    def _rule(self, split: str) -> Callable[[int, str], str | None]:
        """Return a function that gives the part of a run in a split, by the place of its program and its home."""
        if split == "activities":
            return lambda place, home: part_name(self._part[place])
        if split == "held_out_home":
            return lambda place, home: _by_held_out(part_name(self._part[place]), home == self._held_out)
        if split in _BY_HOME:
            return lambda place, home: _by_home(split, self._decile[split][place], self._number[home])
        return lambda place, home: self._own[self._original(place)][split]


def _deciles(programs: SplitPrograms, group: NDArray[np.int32], seed: int, split: str) -> NDArray[np.int8]:
    """(ids,) 0 to 9, by group."""
    found = np.zeros(len(programs.ids), np.int8)
    for place in np.unique(group).tolist():
        found[place] = derive(seed, "split", split, programs.ids[place]) % 10
    return found[group]


def _by_held_out(part: str | None, held_out: bool) -> str | None:
    if part == "test":
        return "test_held_out_home" if held_out else "test_seen_home"
    return None if held_out else part


_BY_HOME = {
    "homes_1_4": ((7, 1, 4, "train"), (8, 5, 5, "validation"), (9, 1, 4, "test_seen"), (10, 5, 6, "test_unseen")),
    "homes_1_5": ((7, 1, 5, "train"), (10, 6, 7, "test")),
}
"""The part of programs up to a decile of their groups, in the homes from a number to a number."""


def _by_home(split: str, decile: int, home: int) -> str | None:
    _, first, last, part = next(rule for rule in _BY_HOME[split] if decile < rule[0])
    return part if first <= home <= last else None
