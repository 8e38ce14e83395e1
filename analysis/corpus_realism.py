"""The similarity of a corpus to people's, measured by its predictions of the people's corpus.

The halves of the people's corpus predict each other for comparison.

Each draw splits the other corpus into halves A and B and draws as many programs of this one as A has; every measure is
taken of A against B and of the draw against B. Their ratio is 1 if the corpora can't be distinguished.
"""

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import combinations
from math import isnan, log2
from random import Random
from statistics import fmean, pstdev
from typing import Any, NamedTuple

from hearth.analysis.corpus_statistics import Corpus
from hearth.analysis.ngrams import WittenBell
from hearth.datasets.format.ids import activity_id
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import Step
from hearth.schemas.rng import rng
from hearth.scoring.bootstrap import intervals

DRAWS, ORDER = 20, 3
SMOOTHING = f"interpolated Witten-Bell, order {ORDER}, over the steps of both corpora"
"""The smoothing of probabilities, printed with the perplexities."""

FEWEST = 4
"""Programs that either corpus needs."""


class Sample(NamedTuple):
    """A program: its activity, its steps as instructions without instances, and the words of its description."""

    activity: str
    steps: tuple[str, ...]
    words: tuple[str, ...]


def programs(corpus: Corpus) -> list[Sample]:
    """Return the programs of a corpus, in the order of their ids."""
    found = sorted(corpus.programs, key=lambda each: each.program_id)
    texts = {name: tuple(re.findall(r"[^\W_]+", text.lower())) for name, text in corpus.descriptions.items()}
    return [
        Sample(activity_id(one.title), tuple(map(_instruction, one.steps)), texts.get(one.description_id, ()))
        for one in found
        if one.steps
    ]


def _instruction(step: Step) -> str:
    return " ".join((step.action, *(ref.name for ref in step.objects)))


# Measures of programs against others


def divergence(one: Counter[str], other: Counter[str]) -> float:
    """Jensen-Shannon divergence in bits: 0 for equal distributions, 1 for ones without a common element."""
    found = 0.0
    first, second = one.total(), other.total()
    if not first or not second:
        return float("nan")
    for name in sorted(one.keys() | other.keys()):
        p, q = one[name] / first, other[name] / second
        found += sum(x / 2 * log2(2 * x / (p + q)) for x in (p, q) if x)
    return found


def actions(found: Iterable[Sample]) -> Counter[str]:
    """Return the number of steps with each action."""
    return Counter(step.partition(" ")[0] for one in found for step in one.steps)


def objects(found: Iterable[Sample]) -> Counter[str]:
    """Return the number of steps with each object."""
    return Counter(name for one in found for step in one.steps for name in step.split(" ")[1:])


def lengths(found: Iterable[Sample]) -> Counter[str]:
    """Return the number of programs with each number of steps."""
    return Counter(str(len(one.steps)) for one in found)


def words(found: Iterable[Sample]) -> Counter[str]:
    """Return the number of times each word is in descriptions."""
    return Counter(word for one in found for word in one.words)


def unseen(train: Sequence[Sample], test: Sequence[Sample]) -> float:
    """Share of the steps of some programs whose instruction others don't have."""
    known = {step for one in train for step in one.steps}
    asked = [step for one in test for step in one.steps]
    return sum(step not in known for step in asked) / len(asked)


def _perplexity(train: Sequence[Sample], test: Sequence[Sample], vocabulary: frozenset[str]) -> float:
    return WittenBell((one.steps for one in train), vocabulary, ORDER).perplexity(one.steps for one in test)


_COUNTS: dict[str, Callable[[Iterable[Sample]], Counter[str]]] = {
    "actions": actions,
    "objects": objects,
    "lengths": lengths,
    "words": words,
}


def _measures(train: Sequence[Sample], test: Sequence[Sample], vocabulary: frozenset[str]) -> dict[str, float | None]:
    found: dict[str, float | None] = {
        "step perplexity": _perplexity(train, test, vocabulary),
        "unseen instructions": unseen(train, test),
    }
    for name, count in _COUNTS.items():
        apart = divergence(count(train), count(test))
        found[f"divergence of {name}"] = None if isnan(apart) else apart
    return found


# Comparison


def compare(
    ours: Sequence[Sample], theirs: Sequence[Sample], seed: int = 0, draws: int = DRAWS, by_activity: bool = False
) -> dict[str, Any]:
    """Every measure of our draws and of their halves against the other half, and the ratio, as means with intervals.

    Args:
        ours, theirs: as `programs` gives them.
        seed: of draws and intervals.
        draws: number of draws.
        by_activity: whole activities are in one half, so that neither half has programs of the other's activities.

    Returns:
        By measure: `ours`, `theirs`, `ratio`; each a mean and the bounds of its 95% bootstrap interval over draws.

    Raises:
        HearthError: EMPTY, a corpus has fewer than `FEWEST` programs, or halves by activity have fewer than two.
    """
    for source, found in (("compared", ours), ("other", theirs)):
        if len(found) < FEWEST:
            message = f"the {source} corpus has {len(found)} programs; {FEWEST} are needed"
            raise HearthError.of(Code.EMPTY, message, suggestion="give a source with more programs")
    if by_activity and len({one.activity for one in theirs}) < 2:
        message = "the other corpus has one activity; halves by activity need two"
        raise HearthError.of(Code.EMPTY, message, suggestion="give a source with more activities, or halve by programs")
    vocabulary = frozenset(step for one in (*ours, *theirs) for step in one.steps)
    columns: dict[str, list[float | None]] = defaultdict(list)
    for number in range(draws):
        chance = rng(seed, "realism", number)
        first, second = _halves(theirs, chance, by_activity)
        drawn = chance.sample(list(ours), min(len(ours), len(first)))
        first = first[: len(drawn)]
        mine, own = (_measures(train, second, vocabulary) for train in (drawn, first))
        for name, value in mine.items():
            usual = own[name]
            columns[f"{name}/ours"].append(value)
            columns[f"{name}/theirs"].append(usual)
            columns[f"{name}/ratio"].append(value / usual if value is not None and usual else None)
    spans = intervals(columns, seed)
    names = dict.fromkeys(column.partition("/")[0] for column in columns)
    kinds = ("ours", "theirs", "ratio")
    return {
        name: {kind: spans[f"{name}/{kind}"]._asdict() for kind in kinds if f"{name}/{kind}" in spans} for name in names
    }


def _halves(found: Sequence[Sample], chance: Random, by_activity: bool) -> tuple[list[Sample], list[Sample]]:
    """Two halves at random; by activity, they are nearly equal."""
    if not by_activity:
        shuffled = chance.sample(list(found), len(found))
        return shuffled[: len(found) // 2], shuffled[len(found) // 2 :]
    members: dict[str, list[Sample]] = defaultdict(list)
    for one in found:
        members[one.activity].append(one)
    halves: tuple[list[Sample], list[Sample]] = ([], [])
    for name in chance.sample(sorted(members), len(members)):
        min(halves, key=len).extend(members[name])
    return halves


# Descriptions of one corpus


def portrait(found: Sequence[Sample]) -> dict[str, float | int | None]:
    """Return a corpus by itself.

    Sizes, lengths, similarity within activities (table 3.1), and statistics of its words.
    """
    texts = list(dict.fromkeys(one.words for one in found if one.words))
    sizes = [len(one.steps) for one in found]
    counts = [len(text) for text in texts]
    grams = [gram for text in texts for gram in zip(*(text[start:] for start in range(4)), strict=False)]
    used = words(Sample("", (), text) for text in texts)
    return {
        "programs": len(found),
        "activities": len({one.activity for one in found}),
        "instructions": len({step for one in found for step in one.steps}),
        "steps": round(fmean(sizes), 2),
        "steps, deviation": round(pstdev(sizes), 2),
        "LCS within activities": _within(found),
        "descriptions": len(texts),
        "words": round(fmean(counts), 2) if counts else None,
        "words, deviation": round(pstdev(counts), 2) if counts else None,
        "word types": len(used),
        "word types used once": round(sum(count == 1 for count in used.values()) / len(used), 3) if used else None,
        "distinct 4-grams": round(len(set(grams)) / len(grams), 3) if grams else None,
    }


def _within(found: Sequence[Sample]) -> float | None:
    """Mean over activities of the mean normalised LCS between their programs."""
    means = [value for value in similarities(found).values() if value is not None]
    return round(fmean(means), 3) if means else None


def similarities(found: Sequence[Sample]) -> Mapping[str, float | None]:
    """Return the mean normalised LCS over pairs of programs of each activity; None for one program (table 3.1)."""
    from rapidfuzz.distance import LCSseq

    members: dict[str, list[tuple[str, ...]]] = defaultdict(list)
    for one in found:
        members[one.activity].append(one.steps)
    alike = LCSseq.normalized_similarity
    return {
        name: fmean(alike(a, b) for a, b in combinations(rows, 2)) if len(rows) > 1 else None
        for name, rows in sorted(members.items())
    }


def of_activities(found: Sequence[Sample], others: Sequence[Sample]) -> list[Sample]:
    """Return the programs whose activity others have, too."""
    wanted = {one.activity for one in others}
    return [one for one in found if one.activity in wanted]
