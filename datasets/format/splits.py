"""Splits, frozen as a table: what a model may learn from, and what it is tested on.

Programs that say nearly the same are dealt together, whatever activity they are filed under: a program and all that
was made of it by repairs, programs with nearly the same steps, and programs for nearly the same text. Where a rule
would still part such a group, its training runs are left out. How much that leaves, and what dealing rows at random
would leave, is measured on the result.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from hearth.datasets.format.near_duplicates import near_sequences, near_texts
from hearth.schemas.rng import derive
from hearth.schemas.rows import SplitRow

NEAR = 0.9
"""Normalised LCS of steps, or similarity of texts, from which two programs are near duplicates."""

SHORTEST_TEXT = 20
"""Characters a description needs to count as a text of its own: `Watch TV.` says nothing about who wrote it."""


RULES = {
    "activities": "activities 7:3, one home held out (thesis 5.6): train in the other homes; test_seen_home and"
    " test_held_out_home have activities of which none was trained on",
    "homes_1_4": "trained in homes 1-4, validated in 5, tested in 1-6 (4.4), other programs each: test_seen in 1-4,"
    " test_unseen in 5-6",
    "homes_1_5": "trained in homes 1-5, tested in 6-7 (6.5.1, 7.4), other programs each",
}
"""What each split means. Homes are numbered by name; a run that a split has no part for is in `none`."""


@dataclass(frozen=True, slots=True)
class Told:
    """What a split needs to know of a program.

    Attributes:
        program_id: its id.
        activity: its activity.
        part: `train` or `test`, as its activity was dealt.
        root: the original it was made from, or itself.
        steps: action and class names, a text a step, instances left out.
        description: in words.
    """

    program_id: str
    activity: str
    part: str
    root: str
    steps: tuple[str, ...]
    description: str


def roots(parents: dict[str, str | None]) -> dict[str, str]:
    """The original that each program was made from, by id."""
    found: dict[str, str] = {}
    for name in parents:
        top = name
        while (parent := parents.get(top)) is not None:
            top = parent
        found[name] = top
    return found


class Likeness:
    """Which programs say nearly the same, found once for all programs; a text has to be long enough to say anything."""

    def __init__(self, programs: Iterable[Told]) -> None:
        programs = list(programs)
        steps = sorted({each.steps for each in programs if each.steps})
        texts = sorted({text for each in programs if len(text := worded(each.description)) >= SHORTEST_TEXT})
        self._steps = _neighbours(steps, near_sequences(steps, NEAR))
        self._texts = _neighbours(texts, near_texts(texts, NEAR))

    def by_steps(self, program: Told) -> set[Any]:
        """The steps of programs like it: those whose normalised LCS with its own is at least `NEAR`, its own too."""
        return self._steps.get(program.steps, set())

    def by_text(self, program: Told) -> set[Any]:
        """The same for what its description says, case and spaces aside."""
        return self._texts.get(worded(program.description), set())


def _neighbours(values: Sequence[Any], pairs: Iterable[tuple[int, int]]) -> dict[Any, set[Any]]:
    found = {value: {value} for value in values}
    for one, other in pairs:
        found[values[one]].add(values[other])
        found[values[other]].add(values[one])
    return found


def worded(text: str) -> str:
    """A text without what people write one way or another: case and spaces."""
    return " ".join(text.lower().split())


def groups(programs: Sequence[Told], likeness: Likeness) -> dict[str, str]:
    """Which group each program belongs to, by id; a group is named by the first of its originals."""
    leader = {each.root: each.root for each in programs}

    def find(name: str) -> str:
        while leader[name] != name:
            leader[name] = leader[leader[name]]
            name = leader[name]
        return name

    for near in (likeness.by_steps, likeness.by_text):
        first: dict[Any, str] = {}
        for each in programs:
            for like in near(each):
                a, b = sorted((find(each.root), find(first.setdefault(like, each.root))))
                leader[b] = a
    return {each.program_id: find(each.root) for each in programs}


def parts(
    programs: Sequence[Told], runs: Iterable[tuple[str, str, str]], seed: int, likeness: Likeness
) -> Iterator[SplitRow]:
    """A row for each run and split: `split`, `execution_id`, `program_id`, `part`.

    Args:
        programs: all that are published.
        runs: execution id, program id and home of every execution.
        seed: of the deal.
        likeness: of these programs.
    """
    known = {each.program_id: each for each in programs}
    group = groups(programs, likeness)
    tested = {group[each.program_id] for each in programs if each.part == "test"}
    runs = sorted(runs)
    homes = sorted({home for _, _, home in runs})
    number = {home: place for place, home in enumerate(homes, 1)}
    out = derive(seed, "split", "home") % len(homes) + 1 if homes else 0
    for execution_id, program_id, home in runs:
        mine, at = group[program_id], number[home]
        told = {
            "activities": _by_activity(known[program_id].part, mine in tested, at == out),
            "homes_1_4": _by_home_4(derive(seed, "split", "homes_1_4", mine) % 10, at),
            "homes_1_5": _by_home_5(derive(seed, "split", "homes_1_5", mine) % 10, at),
        }
        for split, part in told.items():
            yield {"split": split, "execution_id": execution_id, "program_id": program_id, "part": part}


def _by_activity(part: str, near_test: bool, held_out: bool) -> str:
    if part == "test":
        return "test_held_out_home" if held_out else "test_seen_home"
    return "none" if near_test or held_out else "train"


def _by_home_4(dealt: int, home: int) -> str:
    if dealt < 7:
        return "train" if home <= 4 else "none"
    if dealt < 8:
        return "validation" if home == 5 else "none"
    return "test_seen" if home <= 4 else "test_unseen" if home <= 6 else "none"


def _by_home_5(dealt: int, home: int) -> str:
    if dealt < 7:
        return "train" if home <= 5 else "none"
    return "test" if 6 <= home <= 7 else "none"


def summary(programs: Sequence[Told], rows: Sequence[SplitRow], seed: int, likeness: Likeness) -> dict[str, Any]:
    """What each split means, how many runs and programs its parts have, and how much leaks, as JSON.

    `leakage` counts test programs that have in train a program made of the same original (`siblings`), one with
    nearly the same steps (`steps`), or one for nearly the same text (`texts`); `at_random` is the same where as many
    programs are dealt one by one.
    """
    by_id = {each.program_id: each for each in programs}
    told: dict[str, Any] = {"seed": seed, "near": NEAR, "splits": {}}
    for split, rule in RULES.items():
        mine = [row for row in rows if row["split"] == split]
        members: dict[str, dict[str, None]] = {}
        for row in mine:
            members.setdefault(row["part"], {})[row["program_id"]] = None
        train = [by_id[name] for name in members.get("train", {})]
        test = [by_id[name] for part, names in sorted(members.items()) if part.startswith("test") for name in names]
        test = list({each.program_id: each for each in test}.values())
        told["splits"][split] = {
            "rule": rule,
            "runs": dict(sorted(Counter(row["part"] for row in mine).items())),
            "programs": {part: len(names) for part, names in sorted(members.items())},
            "leakage": leakage(train, test, likeness),
            "at_random": leakage(*_at_random([*train, *test], len(test), seed), likeness),
        }
    return told


def _at_random(programs: list[Told], tested: int, seed: int) -> tuple[list[Told], list[Told]]:
    dealt = sorted(programs, key=lambda each: derive(seed, "random split", each.program_id))
    return dealt[tested:], dealt[:tested]


def leakage(train: Sequence[Told], test: Sequence[Told], likeness: Likeness) -> dict[str, int]:
    """How many of the test programs have something of theirs in train, by `siblings`, `steps` and `texts`."""
    known = {each.root for each in train}
    steps = {like for each in train for like in likeness.by_steps(each)}
    texts = {like for each in train for like in likeness.by_text(each)}
    return {
        "programs": len(test),
        "siblings": sum(each.root in known for each in test),
        "steps": sum(each.steps in steps for each in test),
        "texts": sum(worded(each.description) in texts for each in test),
    }
