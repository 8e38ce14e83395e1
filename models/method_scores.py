"""Rows of tables: methods with their programs for some executions, scored, with intervals by activity."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from hearth.datasets.dataset import Dataset
from hearth.models.evaluation import by_group
from hearth.models.interface import Steps
from hearth.scoring.bootstrap import Interval
from hearth.scoring.dataset_scores import score_steps
from hearth.scoring.prediction_scores import METRICS


class Row(NamedTuple):
    """A method's scores: the thesis's are single numbers, ours have intervals by activity.

    Attributes:
        method: its name.
        of: `thesis`, `yardstick` or `ours`.
        scores: by column.
        seeds: how many trained models the scores are means of; 0 for methods without training.
        minutes: of training, their mean.
    """

    method: str
    of: str
    scores: dict[str, Interval | float]
    seeds: int = 0
    minutes: float | None = None


class Entrant(NamedTuple):
    """A method and its programs for the test executions, once for each seed.

    Attributes:
        method: its name.
        of: `yardstick` or `ours`.
        answers: by seed; None where it says nothing, which is then not scored.
        minutes: of training, by seed.
    """

    method: str
    of: str
    answers: Sequence[Sequence[Steps | None]]
    minutes: Sequence[float] = ()


def scored_rows(
    dataset: Dataset,
    executions: Sequence[str],
    groups: Sequence[str],
    entrants: Sequence[Entrant],
    columns: Mapping[str, str],
    seed: int,
) -> Iterator[Row]:
    """Yield the rows of some methods, in order.

    Args:
        dataset: with the executions.
        executions: their ids.
        groups: the activity of each.
        entrants: the methods.
        columns: names of columns, and the scores that they show.
        seed: of the intervals.
    """
    every = [answer for each in entrants for answer in each.answers]
    pairs = ((name, answer[place] or ()) for place, name in enumerate(executions) for answer in every)
    scored = score_steps(dataset, pairs)
    first = 0
    for each in entrants:
        count = len(each.answers)
        values: dict[str, list[float | None]] = {}
        for column, metric in columns.items():
            values[column] = [
                _mean([METRICS[metric](scored[row * len(every) + first + k])
                       for k, answer in enumerate(each.answers) if answer[row] is not None])
                for row in range(len(executions))
            ]  # fmt: skip
        first += count
        minutes = sum(each.minutes) / len(each.minutes) if each.minutes else None
        scores: dict[str, Any] = dict(by_group(values, groups, seed))
        yield Row(each.method, each.of, scores, count if each.of == "ours" else 0, minutes)


def _mean(values: Sequence[float | None]) -> float | None:
    given = [float(value) for value in values if value is not None]
    return sum(given) / len(given) if given else None
