"""Tables 4.4 and 4.5: programs from descriptions, the thesis's figures beside ours beside yardsticks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from hearth.models.data import Example, examples
from hearth.models.evaluation import by_group
from hearth.models.interface import Steps
from hearth.models.model_registry import restore
from hearth.models.predicting import completed
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import rng
from hearth.scoring.baselines import THESIS
from hearth.scoring.bootstrap import Interval
from hearth.scoring.dataset_scores import score_steps
from hearth.scoring.evaluate import METRICS

if TYPE_CHECKING:
    from hearth.datasets.dataset import Dataset

TABLES = ("4.4", "4.5")

COLUMNS = {"action": "lcs_action", "object": "lcs_object", "step": "lcs_step", "mean": "lcs_mean",
           "executable": "executable", "f1": "f1", "goal": "goal"}  # fmt: skip
"""Columns of the table, and the scores that they show."""


class Row(NamedTuple):
    """A method's scores: the thesis's are single numbers, ours have intervals by activity.

    Attributes:
        method: its name.
        of: `thesis`, `yardstick` or `ours`.
        scores: by column.
        seeds: how many trained models the scores are means of; 0 for what is not trained.
        minutes: of training, their mean.
    """

    method: str
    of: str
    scores: dict[str, Interval | float]
    seeds: int = 0
    minutes: float | None = None


class Entrant(NamedTuple):
    """A method and its programs for the test examples, once for each seed."""

    method: str
    of: str
    answers: list[list[Steps]]
    minutes: list[float]


def table(
    number: str,
    dataset: Dataset,
    split: str,
    models: Sequence[Path | str],
    *,
    beam: int = 1,
    repaired: bool = False,
    seed: int = 0,
) -> list[Row]:
    """The rows of a table, over the original programs of all test parts of a split.

    Args:
        number: 4.4 or 4.5.
        dataset: for 4.4 of synthesized programs, for 4.5 of people's.
        split: of the dataset.
        models: checkpoints; several of one model are its seeds.
        beam: as in `Trained.predict`.
        repaired: also a row for each model with its programs bound and repaired in their environments.
        seed: of yardsticks and intervals.

    Raises:
        HearthError: BAD_ARGUMENT, if there is no such table; errors of `restore` and `examples`.
    """
    if number not in TABLES:
        message = f"no table `{number}` of programs from texts"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=f"there are {', '.join(TABLES)}")
    test = sorted(examples(dataset, split, "test", originals=True), key=lambda each: each.executions[0])
    entrants = [*_yardsticks(dataset, split, test, seed), *_trained(models, test, beam)]
    if repaired:
        entrants += [_completed(dataset, each, test) for each in entrants if each.of == "ours"]
    return [*_of_thesis(number), *_scored(dataset, test, entrants, seed)]


def _of_thesis(number: str) -> Iterator[Row]:
    for each in THESIS:
        name, _, place = each.baseline.partition(", table ")
        if place == number:
            values = {column: getattr(each, column) for column in COLUMNS}
            yield Row(name, "thesis", {column: value for column, value in values.items() if value is not None})


def _yardsticks(dataset: Dataset, split: str, test: Sequence[Example], seed: int) -> Iterator[Entrant]:
    """What needs no training, and another person's program for the same text, where there is one."""
    train = examples(dataset, split, "train", originals=True)
    yield Entrant("Empty program", "yardstick", [[()] * len(test)], [])
    drawn = [rng(seed, "random retrieval", each.program_id).choice(train).steps for each in test]
    yield Entrant("Random retrieval", "yardstick", [drawn], [])
    others = [_sibling(each, test) for each in test]
    if any(others):
        yield Entrant("Another person, same text", "yardstick", [others], [])


def _sibling(one: Example, test: Sequence[Example]) -> Steps:
    """The program of another example with the same text; empty if there is none."""
    found = (each.steps for each in test if each is not one and _text(each) == _text(one))
    return next(found, ())


def _text(example: Example) -> tuple[str, str]:
    return example.title, example.description


def _trained(models: Sequence[Path | str], test: Sequence[Example], beam: int) -> list[Entrant]:
    found: dict[str, Entrant] = {}
    for model in models:
        name, trained = restore(model)
        texts = {_text(each): each.request for each in test}
        known = dict(zip(texts, trained.predict(list(texts.values()), beam), strict=True))
        entrant = found.setdefault(name, Entrant(name, "ours", [], []))
        entrant.answers.append([known[_text(each)] for each in test])
        minutes = trained.checkpoint().trained.get("minutes")
        entrant.minutes.extend([minutes] if minutes is not None else [])
    return list(found.values())


def _completed(dataset: Dataset, entrant: Entrant, test: Sequence[Example]) -> Entrant:
    names = [each.executions[0] for each in test]
    answers = []
    for answer in entrant.answers:
        done = dict(completed(dataset, zip(names, answer, strict=True)))
        answers.append([done[name] for name in names])
    return Entrant(f"{entrant.method}, repaired", "ours", answers, entrant.minutes)


def _scored(dataset: Dataset, test: Sequence[Example], entrants: Sequence[Entrant], seed: int) -> Iterator[Row]:
    every = [answer for each in entrants for answer in each.answers]
    pairs = ((each.executions[0], answer[place]) for place, each in enumerate(test) for answer in every)
    scored = score_steps(dataset, pairs)
    groups = [each.activity for each in test]
    first = 0
    for each in entrants:
        count = len(each.answers)
        columns: dict[str, list[float | None]] = {}
        for column, metric in COLUMNS.items():
            found = [[METRICS[metric](scored[row * len(every) + first + k]) for k in range(count)]
                     for row in range(len(test))]  # fmt: skip
            columns[column] = [_mean(values) for values in found]
        if each.method.startswith("Another"):
            missing = [not answer for answer in each.answers[0]]
            columns = {name: [None if gone else value for value, gone in zip(values, missing, strict=True)]
                       for name, values in columns.items()}  # fmt: skip
        first += count
        minutes = sum(each.minutes) / len(each.minutes) if each.minutes else None
        scores: dict[str, Any] = dict(by_group(columns, groups, seed))
        yield Row(each.method, each.of, scores, count if each.of == "ours" else 0, minutes)


def _mean(values: Sequence[float | None]) -> float | None:
    given = [float(value) for value in values if value is not None]
    return sum(given) / len(given) if given else None
