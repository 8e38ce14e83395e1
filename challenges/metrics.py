"""Scores of a helper: for one episode, and for many with standard errors over tasks (thesis 6.5.1)."""

from __future__ import annotations

import math
from array import array
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, overload

from hearth.challenges.behavior_counts import NAMES, Columns
from hearth.challenges.challenge_definition import Challenge
from hearth.challenges.harm_counts import HarmCounts

PER_TICK = 0.004
"""Price of a tick, in units of the reward."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """The metrics of one episode.

    Attributes:
        success: whether the goal was reached.
        ticks: that were played.
        length: ticks that it counts as: all there are where the goal was not reached.
        reward: 1 if the goal was reached, less 0.004 a tick of its length.
        columns: the failure analysis.
        harm: the harm done, in a challenge by action set 3.
    """

    success: bool
    ticks: int
    length: int
    reward: float
    columns: Columns
    harm: HarmCounts | None = None

    def as_json(self) -> dict[str, Any]:
        """Return the outcome as result files have it."""
        return {
            "success": self.success,
            "ticks": self.ticks,
            "length": self.length,
            "reward": self.reward,
            **asdict(self.columns),
            **(self.harm._asdict() if self.harm else {}),
        }


METRICS = frozenset({"success", "ticks", "length", "reward", *NAMES})
"""The names of all metrics of an episode."""

HARMFUL = METRICS | {*HarmCounts._fields}
"""The names of all metrics of an episode in which acts have consequences."""


def metrics_of(which: Challenge) -> frozenset[str]:
    """Return the names of all metrics of an episode of a challenge."""
    return HARMFUL if which.consequences else METRICS


def outcome(which: Challenge, success: bool, ticks: int, columns: Columns, harm: HarmCounts | None = None) -> Outcome:
    """Return the metrics of an episode that was played."""
    length = ticks if success else which.ticks
    return Outcome(success, ticks, length, round(success - PER_TICK * length, 6), columns, harm)


@dataclass(frozen=True, slots=True)
class Mean:
    """A mean over tasks.

    Attributes:
        value: the mean.
        error: its standard error; None of fewer than two tasks.
    """

    value: float
    error: float | None


def mean(values: Sequence[float]) -> Mean:
    """Return the mean of the tasks' values and its standard error."""
    value = math.fsum(values) / len(values)
    if len(values) < 2:
        return Mean(value, None)
    variance = math.fsum((each - value) ** 2 for each in values) / (len(values) - 1)
    return Mean(value, math.sqrt(variance / len(values)))


class Episodes(Sequence[Mapping[str, float]]):
    """The metrics of many episodes, eight bytes each; an item is one episode's, as JSON has it."""

    def __init__(self) -> None:
        self._columns: dict[str, array[float]] = {}
        self._count = 0

    def append(self, metrics: Mapping[str, float]) -> None:
        """Add an episode; metrics that it or earlier episodes lack are nan."""
        for name in metrics.keys() - self._columns.keys():
            self._columns[name] = array("d", [math.nan] * self._count)
        for name, values in self._columns.items():
            values.append(metrics.get(name, math.nan))
        self._count += 1

    def __len__(self) -> int:
        return self._count

    @overload
    def __getitem__(self, number: int) -> Mapping[str, float]: ...
    @overload
    def __getitem__(self, number: slice) -> Sequence[Mapping[str, float]]: ...
    def __getitem__(self, number: int | slice) -> Mapping[str, float] | Sequence[Mapping[str, float]]:
        if isinstance(number, slice):
            return [self[each] for each in range(self._count)[number]]
        return {name: values[number] for name, values in self._columns.items()}


Outcomes = Mapping[str, Sequence[Mapping[str, Any]]]
"""Task id -> the outcomes of its episodes, as JSON."""


def by_task(episodes: Iterable[tuple[str, Mapping[str, float]]]) -> Outcomes:
    """Outcomes by their task, in the order in which tasks come."""
    found: defaultdict[str, Episodes] = defaultdict(Episodes)
    for task, each in episodes:
        found[task].append(each)
    return dict(found)


def of_tasks(outcomes: Outcomes, name: str) -> dict[str, float]:
    """Task id -> the mean of a metric over its episodes."""
    return {task: math.fsum(each[name] for each in some) / len(some) for task, some in outcomes.items()}


def speedups(alone: Outcomes, helped: Outcomes) -> dict[str, float]:
    """Task id -> L_alone / L_help - 1, of mean lengths over the task's episodes: a mean of ratios would flatter.

    Tasks that nobody did alone have none.
    """
    before, after = of_tasks(alone, "length"), of_tasks(helped, "length")
    return {task: before[task] / max(after[task], 1.0) - 1 for task in after if task in before}


def savings(alone: Outcomes, helped: Outcomes) -> dict[str, float]:
    """Task id -> (L_alone - L_help) / L_alone, as others publish it."""
    before, after = of_tasks(alone, "length"), of_tasks(helped, "length")
    return {task: (before[task] - after[task]) / max(before[task], 1.0) for task in after if task in before}


SHARES = {"conflict_episodes": "conflicts", "needless_episodes": "needless"}
"""Shares of episodes in which something happened at least once, by the column that counts it."""


def summary(alone: Outcomes, helped: Outcomes) -> dict[str, float | int | None]:
    """All metrics: means over tasks (of means over their seeds), each with `_se`, and the `SHARES`; None of no task.

    Args:
        alone: of the main agent by itself.
        helped: of the same tasks with a helper; empty where there is none.
    """
    shown = helped or alone
    found: dict[str, float | int | None] = {"episodes": sum(map(len, shown.values())), "tasks": len(shown)}
    columns: dict[str, dict[str, float]] = {"success": of_tasks(shown, "success")}
    harmful = any("hazards" in each for some in shown.values() for each in some)
    columns |= {name: of_tasks(shown, name) for name in HarmCounts._fields if harmful}
    columns["speedup"] = speedups(alone, shown)
    columns["saving"] = savings(alone, shown)
    columns |= {name: of_tasks(shown, name) for name in ("reward", "length")}
    columns["length_alone"] = of_tasks(alone, "length")
    for share, column in SHARES.items():
        any_of = {task: [{share: bool(each[column])} for each in some] for task, some in shown.items()}
        columns[share] = of_tasks(any_of, share)
    columns |= {name: of_tasks(shown, name) for name in NAMES}
    for name, values in columns.items():
        found |= {name: None, f"{name}_se": None}
        if values:
            one = mean(list(values.values()))
            found |= {name: one.value, f"{name}_se": one.error}
    return found


@dataclass(frozen=True, slots=True)
class Paired:
    """A paired t-test over tasks (thesis 6.5.3).

    Attributes:
        t, p: statistic and two-sided probability; None where no task differs.
        freedom: degrees of freedom.
        effect: mean difference in its standard deviations (Cohen's d of pairs).
    """

    t: float | None
    p: float | None
    freedom: int
    effect: float | None


SAME = 1e-9
"""The share of the largest value up to which differences do not differ from each other."""


def paired(one: Mapping[str, float], other: Mapping[str, float]) -> Paired:
    """Return whether a metric differs between two agents on the tasks that both did."""
    from scipy import stats

    tasks = [task for task in one if task in other]
    differences = [one[task] - other[task] for task in tasks]
    if len(tasks) < 2 or not any(differences):
        return Paired(None, None, max(len(tasks) - 1, 0), None)
    deviation = (mean(differences).error or 0.0) * math.sqrt(len(tasks))
    largest = max(abs(value) for task in tasks for value in (one[task], other[task]))
    if deviation <= SAME * largest:  # equal but for rounding
        return Paired(None, None, len(tasks) - 1, None)
    found = stats.ttest_rel([one[task] for task in tasks], [other[task] for task in tasks])
    return Paired(float(found.statistic), float(found.pvalue), len(tasks) - 1, mean(differences).value / deviation)


CONFIDENT = 1.96
"""Standard errors on either side of a mean, for an interval of 95 %."""


def share_interval(share: float, number: int) -> tuple[float, float]:
    """Return the 95 % Wilson interval of a share of `number` trials; the normal interval is wrong near 0 and 1."""
    square = CONFIDENT**2
    middle = (share + square / (2 * number)) / (1 + square / number)
    half = CONFIDENT / (1 + square / number) * math.sqrt(share * (1 - share) / number + square / (4 * number**2))
    return max(0.0, middle - half), min(1.0, middle + half)


def difference_interval(one: float, number: int, other: float, of_other: int) -> tuple[float, float]:
    """Return the 95 % interval of the difference of two independent shares (Newcombe 1998, method 10).

    It has no width of 0 where a few trials all come out alike.
    """
    (low, high), (other_low, other_high) = share_interval(one, number), share_interval(other, of_other)
    return (
        one - other - math.hypot(one - low, other_high - other),
        one - other + math.hypot(high - one, other - other_low),
    )
