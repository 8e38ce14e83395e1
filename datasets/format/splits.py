"""Train and test splits, stored as a table.

Near duplicates are assigned together, whatever their activity: a program and its repaired descendants, programs with
nearly the same steps, and programs with nearly the same description. If a rule would still separate such a group, its
training runs are excluded. The leakage that remains is measured, beside that of a random split.
"""

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
"""Least characters of a description that is compared: short ones such as `Watch TV.` coincide by chance."""


RULES = {
    "activities": "activities 7:3, one home held out (thesis 5.6): train in the other homes; test_seen_home and"
    " test_held_out_home have activities of which none was trained on",
    "homes_1_4": "trained in homes 1-4, validated in 5, tested in 1-6 (4.4), other programs each: test_seen in 1-4,"
    " test_unseen in 5-6",
    "homes_1_5": "trained in homes 1-5, tested in 6-7 (6.5.1, 7.4), other programs each",
}
"""The rule of each split. Homes are numbered by name; runs without a part are in `none`."""


@dataclass(frozen=True, slots=True)
class SplitProgram:
    """The fields of a program that splits depend on.

    Attributes:
        program_id: its id.
        activity: its activity.
        part: `train` or `test`, assigned by activity.
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
        return self._steps.get(program.steps, set())

    def by_text(self, program: SplitProgram) -> set[Any]:
        """The normalised descriptions of similar programs, its own included."""
        return self._texts.get(normalised(program.description), set())


def _neighbours(values: Sequence[Any], pairs: Iterable[tuple[int, int]]) -> dict[Any, set[Any]]:
    found = {value: {value} for value in values}
    for one, other in pairs:
        found[values[one]].add(values[other])
        found[values[other]].add(values[one])
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


def parts(
    programs: Sequence[SplitProgram], runs: Iterable[tuple[str, str, str]], seed: int, similarity: Similarity
) -> Iterator[SplitRow]:
    """A row for each run and split: `split`, `execution_id`, `program_id`, `part`.

    Args:
        programs: all published programs.
        runs: execution id, program id and home of every execution.
        seed: of the assignment.
        similarity: near duplicates among these programs.
    """
    known = {each.program_id: each for each in programs}
    group = groups(programs, similarity)
    tested = {group[each.program_id] for each in programs if each.part == "test"}
    runs = sorted(runs)
    homes = sorted({home for _, _, home in runs})
    number = {home: place for place, home in enumerate(homes, 1)}
    out = derive(seed, "split", "home") % len(homes) + 1 if homes else 0
    for execution_id, program_id, home in runs:
        mine, at = group[program_id], number[home]
        assigned = {
            "activities": _by_activity(known[program_id].part, mine in tested, at == out),
            "homes_1_4": _by_home_4(derive(seed, "split", "homes_1_4", mine) % 10, at),
            "homes_1_5": _by_home_5(derive(seed, "split", "homes_1_5", mine) % 10, at),
        }
        for split, part in assigned.items():
            yield {"split": split, "execution_id": execution_id, "program_id": program_id, "part": part}


def _by_activity(part: str, near_test: bool, held_out: bool) -> str:
    if part == "test":
        return "test_held_out_home" if held_out else "test_seen_home"
    return "none" if near_test or held_out else "train"


def _by_home_4(decile: int, home: int) -> str:
    if decile < 7:
        return "train" if home <= 4 else "none"
    if decile < 8:
        return "validation" if home == 5 else "none"
    return "test_seen" if home <= 4 else "test_unseen" if home <= 6 else "none"


def _by_home_5(decile: int, home: int) -> str:
    if decile < 7:
        return "train" if home <= 5 else "none"
    return "test" if 6 <= home <= 7 else "none"


def summary(
    programs: Sequence[SplitProgram], rows: Sequence[SplitRow], seed: int, similarity: Similarity
) -> dict[str, Any]:
    """Rule, counts of runs and programs by part, and leakage of each split, as JSON.

    `leakage` counts test programs with a program in train that has the same original (`siblings`), nearly the same
    steps (`steps`), or nearly the same description (`texts`); `at_random` is the leakage of a random split of equal
    size.
    """
    by_id = {each.program_id: each for each in programs}
    found: dict[str, Any] = {"seed": seed, "near": NEAR, "splits": {}}
    for split, rule in RULES.items():
        mine = [row for row in rows if row["split"] == split]
        members: dict[str, dict[str, None]] = {}
        for row in mine:
            members.setdefault(row["part"], {})[row["program_id"]] = None
        train = [by_id[name] for name in members.get("train", {})]
        test = [by_id[name] for part, names in sorted(members.items()) if part.startswith("test") for name in names]
        test = list({each.program_id: each for each in test}.values())
        found["splits"][split] = {
            "rule": rule,
            "runs": dict(sorted(Counter(row["part"] for row in mine).items())),
            "programs": {part: len(names) for part, names in sorted(members.items())},
            "leakage": leakage(train, test, similarity),
            "at_random": leakage(*_at_random([*train, *test], len(test), seed), similarity),
        }
    return found


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
