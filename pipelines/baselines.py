"""Baselines of the thesis on a dataset's own split (4.3, tables 4.4 and 4.5): what a model has to beat."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable, Sequence
from random import Random
from typing import NamedTuple

from hearth.kb.knowledge import default
from hearth.kb.records import Action
from hearth.pipelines.dataset import Dataset
from hearth.pipelines.rows import program_of
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.rng import rng
from hearth.scoring.lcs import LEVELS, LcsScore, score_pairs

Steps = tuple[Step, ...]


class Example(NamedTuple):
    """An original program with its words."""

    program_id: str
    text: str
    steps: Steps


class Result(NamedTuple):
    """A baseline's scores: means over the test programs of LCS by action, object and step, and their mean."""

    baseline: str
    action: float
    object: float
    step: float
    mean: float


THESIS = (
    ("Random sampling, table 4.4", 0.226, 0.039, 0.020, 0.095),
    ("Random retrieval, table 4.4", 0.473, 0.079, 0.071, 0.207),
    ("Skip-thoughts retrieval, table 4.4", 0.642, 0.272, 0.252, 0.389),
    ("Random sampling, table 4.5", 0.106, 0.018, 0.004, 0.043),
    ("Random retrieval, table 4.5", 0.320, 0.037, 0.032, 0.130),
    ("Skip-thoughts retrieval, table 4.5", 0.469, 0.297, 0.266, 0.344),
)
"""The thesis's figures for the same baselines: 4.4 on synthetic programs, 4.5 on crowd-sourced ones."""


def baselines(dataset: Dataset, split: str = "activities", seed: int = 0) -> list[Result]:
    """Every baseline on the original programs of a split: learnt from `train`, asked of all its tests.

    A table of no test programs, or none to learn from, has no rows.
    """
    train, test = (_examples(dataset, split, part) for part in ("train", "test"))
    if not train or not test:
        return []
    return [_result(name, make(train, test, seed), test) for name, make in BASELINES.items()]


def _examples(dataset: Dataset, split: str, part: str) -> list[Example]:
    query = """SELECT * FROM programs WHERE parent_id IS NULL AND program_id IN
        (SELECT program_id FROM splits WHERE split = $split AND starts_with(part, $part)) ORDER BY program_id"""
    rows = dataset.sql(query, split=split, part=part).to_arrow_table().to_pylist()
    return [Example(r["program_id"], f"{r['title']} {r['description']}", program_of(r).steps) for r in rows]


def _result(name: str, predicted: Sequence[Steps], test: Sequence[Example]) -> Result:
    scores: list[LcsScore] = score_pairs(zip(predicted, (each.steps for each in test), strict=True))
    means = {level: sum(getattr(score, level) for score in scores) / len(scores) for level in LEVELS}
    mean = sum(score.mean for score in scores) / len(scores)
    return Result(name, means["action"], means["object"], means["step"], mean)


def random_sampling(train: Sequence[Example], test: Sequence[Example], seed: int) -> list[Steps]:
    """As long as some program; each action and its objects are picked at random."""
    knowledge = default()
    actions = [action for action in knowledge.actions.values() if action.executed]
    names = sorted(knowledge.objects)
    return [_sampled(rng(seed, "random sampling", each.program_id), train, actions, names) for each in test]


def _sampled(random: Random, train: Sequence[Example], actions: list[Action], names: list[str]) -> Steps:
    length = len(random.choice(train).steps)
    steps = []
    for _ in range(length):
        action = random.choice(actions)
        steps.append(Step(action.name, tuple(ObjectRef(random.choice(names)) for _ in range(action.arity))))
    return tuple(steps)


def random_retrieval(train: Sequence[Example], test: Sequence[Example], seed: int) -> list[Steps]:
    """Any program of train."""
    return [rng(seed, "random retrieval", each.program_id).choice(train).steps for each in test]


def nearest_description(train: Sequence[Example], test: Sequence[Example], seed: int) -> list[Steps]:
    """The program of the most similar words, by the cosine of TF-IDF weights; of equals the first."""
    counts = [_words(each.text) for each in train]
    known = Counter(word for found in counts for word in found)
    weight = {word: math.log((1 + len(train)) / (1 + number)) + 1 for word, number in known.items()}
    vectors = [_vector(found, weight) for found in counts]
    answers = []
    for each in test:
        asked = _vector(_words(each.text), weight)
        nearest = max(range(len(train)), key=lambda place: (_cosine(asked, vectors[place]), -place))
        answers.append(train[nearest].steps)
    return answers


def _words(text: str) -> Counter[str]:
    return Counter(re.findall(r"[^\W_]{2,}", text.lower()))


def _vector(words: Counter[str], weight: dict[str, float]) -> dict[str, float]:
    found = {word: number * weight[word] for word, number in words.items() if word in weight}
    length = math.sqrt(sum(value * value for value in found.values())) or 1.0
    return {word: value / length for word, value in found.items()}


def _cosine(one: dict[str, float], other: dict[str, float]) -> float:
    return sum(value * other[word] for word, value in one.items() if word in other)


BASELINES: dict[str, Callable[[Sequence[Example], Sequence[Example], int], list[Steps]]] = {
    "random sampling": random_sampling,
    "random retrieval": random_retrieval,
    "nearest description": nearest_description,
}
"""Each gives a program for every test example. To add one: a function, a row here, a test."""
