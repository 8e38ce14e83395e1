"""Train, validation and test splits, stored as a table.

Near duplicates are assigned together, whatever their activity: a program and its repaired descendants, programs with
nearly the same steps, and programs with nearly the same description. If a rule would still separate such a group, its
programs outside the latest part have none. The leakage that remains is measured, beside that of a random split.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import groupby
from types import MappingProxyType
from typing import Any

from hearth.datasets.format.near_duplicates import near_sequences, near_texts
from hearth.schemas.published_rows import SplitRow
from hearth.schemas.rng import derive

NEAR = 0.9
"""Normalised LCS of steps, or similarity of texts, from which two programs are near duplicates."""

SHORTEST_TEXT = 20
"""Least characters of a description that is compared: short ones such as `Watch TV.` coincide by chance."""


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

OWN = "by program: the parts that its source gives; augmented programs have those of their originals"
"""The rule of a split that comes with a source."""

PARTS = ("train", "validation", "test")
"""The parts of `activities`, which is `programs.split`; of near duplicates, those in earlier parts are left out."""

LEFT_OUT = "left_out"
"""In names of files, programs without a part in `activities`."""


@dataclass(frozen=True, slots=True)
class SplitProgram:
    """The fields of a program that splits depend on.

    Attributes:
        program_id: its id.
        activity: its activity.
        part: one of `PARTS`, assigned by activity.
        root: id of its original, or its own.
        steps: action and class names, one text per step, without instances.
        description: its text.
    """

    program_id: str
    activity: str
    part: str
    root: str
    steps: tuple[str, ...]
    description: str


Run = tuple[str, str, str]
"""Execution id, program id and home of an execution that ran to its end."""

_NONE: Mapping[str, Mapping[str, str | None]] = MappingProxyType({})


def roots(parents: dict[str, str | None]) -> dict[str, str]:
    """Program id -> id of its original."""
    found: dict[str, str] = {}
    for name in parents:
        top = name
        while (parent := parents.get(top)) is not None:
            top = parent
        found[name] = top
    return found


class Similarity:
    """Near duplicates among programs, by steps and by description; short descriptions are ignored."""

    def __init__(self, programs: Iterable[SplitProgram]) -> None:
        programs = list(programs)
        steps = sorted({each.steps for each in programs if each.steps})
        texts = sorted({text for each in programs if len(text := normalised(each.description)) >= SHORTEST_TEXT})
        self._steps = _neighbours(steps, near_sequences(steps, NEAR))
        self._texts = _neighbours(texts, near_texts(texts, NEAR))

    def by_steps(self, program: SplitProgram) -> set[Any]:
        """The steps of similar programs: normalised LCS at least `NEAR`; the program's own included."""
        return self._steps.get(program.steps) or ({program.steps} if program.steps else set())

    def by_text(self, program: SplitProgram) -> set[Any]:
        """The normalised descriptions of similar programs, its own included."""
        text = normalised(program.description)
        return self._texts.get(text) or ({text} if len(text) >= SHORTEST_TEXT else set())


def _neighbours(values: Sequence[Any], pairs: Iterable[tuple[int, int]]) -> dict[Any, set[Any]]:
    """The values that have neighbours, with these and themselves."""
    found: dict[Any, set[Any]] = {}
    for one, other in pairs:
        for a, b in ((values[one], values[other]), (values[other], values[one])):
            found.setdefault(a, {a}).add(b)
    return found


def normalised(text: str) -> str:
    """A text in lower case with single spaces."""
    return " ".join(text.lower().split())


def groups(programs: Sequence[SplitProgram], similarity: Similarity) -> dict[str, str]:
    """Program id -> its group of near duplicates, named by the first of its originals."""
    representative = {each.root: each.root for each in programs}

    def find(name: str) -> str:
        while representative[name] != name:
            representative[name] = representative[representative[name]]
            name = representative[name]
        return name

    for near in (similarity.by_steps, similarity.by_text):
        first: dict[Any, str] = {}
        for each in programs:
            for like in near(each):
                a, b = sorted((find(each.root), find(first.setdefault(like, each.root))))
                representative[b] = a
    return {each.program_id: find(each.root) for each in programs}


def by_activity(programs: Sequence[SplitProgram], similarity: Similarity) -> dict[str, str | None]:
    """The part of each program in `activities`: that of its activity, unless a near duplicate is in a later part."""
    group = groups(programs, similarity)
    last: dict[str, int] = {}
    for each in programs:
        mine = group[each.program_id]
        last[mine] = max(last.get(mine, 0), PARTS.index(each.part))
    return {
        each.program_id: each.part if each.part == PARTS[last[group[each.program_id]]] else None for each in programs
    }


def homes_of(runs: Iterable[Run], seed: int) -> tuple[list[str], str]:
    """The homes of runs, in the order in which splits number them, and the one that is held out."""
    homes = sorted({home for _, _, home in runs})
    return homes, homes[derive(seed, "split", "home") % len(homes)] if homes else ""


class SplitRows(Iterable[SplitRow]):
    """A row for each run and split, sorted by `split` and `execution_id`; millions, made anew each time.

    Args:
        programs: all published programs.
        runs: execution id, program id and home of every execution that ran to its end.
        seed: of the assignment.
        similarity: near duplicates among these programs.
        own: id of an original -> split -> part, where its source gives them; other programs are in no such split.
    """

    def __init__(
        self,
        programs: Sequence[SplitProgram],
        runs: Iterable[Run],
        seed: int,
        similarity: Similarity,
        own: Mapping[str, Mapping[str, str | None]] = _NONE,
    ) -> None:
        self._runs, self._own = sorted(runs), own
        self._root = {each.program_id: each.root for each in programs}
        self._part_of = by_activity(programs, similarity)
        group = groups(programs, similarity)
        self._decile = {
            split: {name: derive(seed, "split", split, mine) % 10 for name, mine in group.items()} for split in _BY_HOME
        }
        homes, self._held_out = homes_of(self._runs, seed)
        self._number = {home: place for place, home in enumerate(homes, 1)}

    def __iter__(self) -> Iterator[SplitRow]:
        for split in sorted({*RULES, *(name for given in self._own.values() for name in given)}):
            part_of = self._rule(split)
            for run in self._runs:
                execution_id, program_id, _ = run
                if split in RULES or split in self._own.get(self._root[program_id], ()):
                    part = part_of(run)
                    yield {"split": split, "execution_id": execution_id, "program_id": program_id, "part": part}

    def _rule(self, split: str) -> Callable[[Run], str | None]:
        """What gives the part of a run in a split."""
        if split == "activities":
            return lambda run: self._part_of[run[1]]
        if split == "held_out_home":
            return lambda run: _by_held_out(self._part_of[run[1]], run[2] == self._held_out)
        if split in _BY_HOME:
            return lambda run: _by_home(split, self._decile[split][run[1]], self._number[run[2]])
        return lambda run: self._own[self._root[run[1]]][split]


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


def summary(
    programs: Sequence[SplitProgram],
    runs: Iterable[Run],
    rows: Iterable[SplitRow],
    seed: int,
    similarity: Similarity,
) -> dict[str, Any]:
    """Homes in order, and for each split rule, counts of runs and programs by part, and leakage, as JSON.

    `leakage` counts test programs with a program in train that has the same original (`siblings`), nearly the same
    steps (`steps`), or nearly the same description (`texts`); `at_random` is the leakage of a random split of equal
    size.

    Args:
        programs: all published programs.
        runs: as of `SplitRows`.
        rows: sorted by split.
        seed: of the assignment.
        similarity: near duplicates among these programs.
    """
    by_id = {each.program_id: each for each in programs}
    homes, out = homes_of(runs, seed)
    spans = {f"{first}_{last}": ", ".join(homes[first - 1 : last]) or "none here" for first, last in _SPANS}
    measured = {
        split: _measured(Members.of(some), by_id, seed, similarity)
        for split, some in groupby(rows, lambda row: row["split"])
    }
    rules = {**RULES, **dict.fromkeys(sorted(measured.keys() - RULES.keys()), OWN)}
    nobody = _measured(Members(), by_id, seed, similarity)
    described = {
        split: {"rule": rule.format(held_out=out, **spans), **measured.get(split, nobody)}
        for split, rule in rules.items()
    }
    return {"seed": seed, "near": NEAR, "homes": homes, "held_out": out, "splits": described}


def _measured(members: Members, by_id: Mapping[str, SplitProgram], seed: int, similarity: Similarity) -> dict[str, Any]:
    programs = dict(sorted(members.programs.items()))
    train = [by_id[name] for name in programs.get("train", ())]
    tested = dict.fromkeys(name for part, names in programs.items() if part.startswith("test") for name in names)
    test = [by_id[name] for name in tested]
    return {
        "runs": {part: members.runs[part] for part in programs},
        "runs_without_part": members.runs[None],
        "programs": {part: len(names) for part, names in programs.items()},
        "leakage": leakage(train, test, similarity),
        "at_random": leakage(*_at_random([*train, *test], len(test), seed), similarity),
    }


@dataclass(slots=True)
class Members:
    """How many runs the parts of a split have, and the ids of their programs."""

    runs: Counter[str | None] = field(default_factory=Counter)
    programs: dict[str, dict[str, None]] = field(default_factory=dict)

    @classmethod
    def of(cls, rows: Iterable[SplitRow]) -> Members:
        """Those of the rows of a split."""
        found = cls()
        for row in rows:
            part = row["part"]
            found.runs[part] += 1
            if part:
                found.programs.setdefault(part, {})[row["program_id"]] = None
        return found


_SPANS = ((1, 4), (5, 5), (5, 6), (1, 5), (6, 7))


def _at_random(programs: list[SplitProgram], tested: int, seed: int) -> tuple[list[SplitProgram], list[SplitProgram]]:
    shuffled = sorted(programs, key=lambda each: derive(seed, "random split", each.program_id))
    return shuffled[tested:], shuffled[:tested]


def leakage(train: Sequence[SplitProgram], test: Sequence[SplitProgram], similarity: Similarity) -> dict[str, int]:
    """Number of test programs with a sibling, similar steps or a similar description in train."""
    known = {each.root for each in train}
    steps = {like for each in train for like in similarity.by_steps(each)}
    texts = {like for each in train for like in similarity.by_text(each)}
    return {
        "programs": len(test),
        "siblings": sum(each.root in known for each in test),
        "steps": sum(each.steps in steps for each in test),
        "texts": sum(normalised(each.description) in texts for each in test),
    }
