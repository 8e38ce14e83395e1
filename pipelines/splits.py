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

from hearth.pipelines.alike import near_sequences
from hearth.schemas.rng import derive

NEAR = 0.9
"""Normalised LCS of steps, or similarity of texts, from which two programs are near duplicates."""

SHORTEST_TEXT = 20
"""Characters a description needs to count as a text of its own: `Watch TV.` says nothing about who wrote it."""

_CHUNK = 512

Row = dict[str, Any]

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


def groups(programs: Sequence[Told]) -> dict[str, str]:
    """Which group each program belongs to, by id; a group is named by the first of its originals."""
    ordered = sorted(programs, key=lambda each: each.program_id)
    leader = {each.root: each.root for each in ordered}

    def find(name: str) -> str:
        while leader[name] != name:
            leader[name] = leader[leader[name]]
            name = leader[name]
        return name

    # Programs with the same steps, or the same text, need comparing once.
    for same, near in ((_by(ordered, "steps"), near_steps), (_by(ordered, "description"), near_texts)):
        firsts = [members[0] for members in same]
        alike = [(firsts[one], firsts[other]) for one, other in near(firsts)]
        if near is near_steps:
            alike += [(members[0], other) for members in same for other in members[1:] if other.steps]
        else:
            alike += [(members[0], other) for members in same for other in members[1:] if _is_text(other.description)]
        for one, other in alike:
            a, b = sorted((find(one.root), find(other.root)))
            leader[b] = a
    return {each.program_id: find(each.root) for each in programs}


def _by(programs: Sequence[Told], field: str) -> list[list[Told]]:
    found: dict[Any, list[Told]] = {}
    for each in programs:
        found.setdefault(getattr(each, field), []).append(each)
    return list(found.values())


def _is_text(description: str) -> bool:
    return len(_worded(description)) >= SHORTEST_TEXT


def near_steps(programs: Sequence[Told], others: Sequence[Told] | None = None) -> Iterator[tuple[int, int]]:
    """Pairs of programs (places in the sequences) whose normalised LCS over steps is at least `NEAR`."""
    rows = [each.steps for each in programs]
    columns = rows if others is None else [each.steps for each in others]
    found = near_sequences(rows, columns, NEAR)
    yield from (pair for pair in found if others is not None or pair[0] != pair[1])


def near_texts(programs: Sequence[Told], others: Sequence[Told] | None = None) -> Iterator[tuple[int, int]]:
    """Pairs whose descriptions are nearly the same, case and spaces aside."""
    import numpy as np
    from rapidfuzz import fuzz, process

    rows, columns = (
        [_worded(each.description) for each in given] for given in (programs, programs if others is None else others)
    )
    cut = NEAR * 100
    for start in range(0, len(rows), _CHUNK):
        part = rows[start : start + _CHUNK]
        found = process.cdist(part, columns, scorer=fuzz.ratio, score_cutoff=cut - 1e-6, dtype=np.float32)
        for place, other in np.argwhere(found >= cut - 1e-5).tolist():
            one = start + place
            if (others is not None or one != other) and min(len(rows[one]), len(columns[other])) >= SHORTEST_TEXT:
                yield one, other


def _worded(text: str) -> str:
    return " ".join(text.lower().split())


def parts(programs: Sequence[Told], runs: Iterable[tuple[str, str, str]], seed: int) -> Iterator[Row]:
    """A row for each run and split: `split`, `execution_id`, `program_id`, `part`.

    Args:
        programs: all that are published.
        runs: execution id, program id and home of every execution.
        seed: of the deal.
    """
    known = {each.program_id: each for each in programs}
    group = groups(programs)
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


def summary(programs: Sequence[Told], rows: Sequence[Row], seed: int) -> Row:
    """What each split means, how many runs and programs its parts have, and how much leaks, as JSON.

    `leakage` counts test programs that have in train a program made of the same original (`siblings`), one with
    nearly the same steps (`steps`), or one for nearly the same text (`texts`); `at_random` is the same where as many
    programs are dealt one by one.
    """
    by_id = {each.program_id: each for each in programs}
    told: Row = {"seed": seed, "near": NEAR, "splits": {}}
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
            "leakage": leakage(train, test),
            "at_random": leakage(*_at_random([*train, *test], len(test), seed)),
        }
    return told


def _at_random(programs: list[Told], tested: int, seed: int) -> tuple[list[Told], list[Told]]:
    dealt = sorted(programs, key=lambda each: derive(seed, "random split", each.program_id))
    return dealt[tested:], dealt[:tested]


def leakage(train: Sequence[Told], test: Sequence[Told]) -> Row:
    """How many of the test programs have something of theirs in train, by `siblings`, `steps` and `texts`."""
    known = {each.root for each in train}
    steps, texts = (
        {getattr(asked[one], field) for one, _ in near(asked, [each[0] for each in _by(train, field)])}
        for field, near in (("steps", near_steps), ("description", near_texts))
        for asked in [[each[0] for each in _by(test, field)]]
    )
    return {
        "programs": len(test),
        "siblings": sum(each.root in known for each in test),
        "steps": sum(each.steps in steps for each in test),
        "texts": sum(each.description in texts for each in test),
    }
