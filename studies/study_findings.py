"""The results of a study: success, speedup, reward and ratings with standard errors, and the thesis's tests."""

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from hearth.challenges.metrics import Outcomes, by_task, of_tasks, speedups
from hearth.challenges.result_files import Results
from hearth.schemas.yaml_limits import packaged
from hearth.studies.films_to_judge import JudgedFilm
from hearth.studies.statistical_tests import Comparison, compare, interval, rank_correlation
from hearth.studies.study import Study
from hearth.studies.study_folder import Collected, references_of
from hearth.studies.study_tables import Rows

PUBLISHED: dict[str, list[dict[str, str]]] = packaged("hearth.studies", "published_tests.yaml")

PEOPLE, AGENT = "people", "agent"
"""The actors: the study's people, real or simulated, or the human-like agent in the same tasks."""

METRICS = ("success", "speedup", "reward", "length")


@dataclass(frozen=True, slots=True)
class Figure:
    """A mean with its standard error and half its interval of 95 %; None where there are too few values."""

    mean: float
    error: float | None
    half: float
    count: int


def figure_of(values: Mapping[Any, float]) -> Figure | None:
    """Return the figure of values by task or film; None of no values."""
    if not values:
        return None
    found, half = interval(list(values.values()))
    return Figure(found.value, found.error, half, len(values))


@dataclass(frozen=True)
class Findings:
    """The results of a study.

    Attributes:
        study: the design.
        simulated: whether agents were in people's places.
        people: how many finished.
        left: how many left in the middle.
        values: (who, condition or group, metric or question) -> task or film -> value.
        comparisons: the tests.
        correlations: question -> Spearman's rho of the films' measure with their mean ratings, and its p.
        against: whose lengths alone the speedups are against.
        helper_faults: condition -> how many trials its helper ended by a fault; they are in no figure of people.
    """

    study: Study
    simulated: bool
    people: int
    left: int
    values: dict[tuple[str, str, str], dict[Any, float]]
    comparisons: list[Comparison] = field(default_factory=list)
    correlations: dict[str, tuple[float, float]] = field(default_factory=dict)
    against: str = ""
    helper_faults: dict[str, int] = field(default_factory=dict)

    def figure(self, who: str, group: str, metric: str) -> Figure | None:
        """Return a figure by who, condition and metric."""
        return figure_of(self.values.get((who, group, metric), {}))

    @property
    def groups(self) -> list[tuple[str, str]]:
        """Return the compared groups, name and title: conditions, or bands of programs."""
        films = self.study.films
        if films is not None and films.bands:
            return [(each.name, each.title) for each in films.bands]
        return [(each.name, each.title) for each in self.study.conditions]


def findings(collected: Collected, alone: Collected | None = None) -> Findings:
    """Return the results of a study.

    Args:
        collected: the study with all that was collected.
        alone: the study whose lengths are those without a helper; else those of a condition without one, and where
            there is none, the human-like agent's.
    """
    rows = Rows(collected)
    finished = sum(each.finished for each in rows.standings)
    left = sum(each.stage == "left" for each in rows.standings)
    values: dict[tuple[str, str, str], dict[Any, float]] = {}
    against = ""
    if collected.study.films is None:
        people = _by_condition(rows)
        results = references_of(collected)
        agent = {name: found.outcomes(found.header.helped[-1]) for name, found in results.items()}
        own, against = _alone(people, results, alone)
        values |= _measured(PEOPLE, people, own)
        values |= _measured(AGENT, agent, agent.get("alone", {}))
    values |= _ratings(rows)
    failed = Counter(row["condition"] for row in rows.trials() if row["counted"] and row["helper_fault"])
    found = Findings(collected.study, collected.simulated, finished, left, values, [], {}, against, dict(failed))
    found.comparisons.extend(_comparisons(found))
    found.correlations.update(_correlations(found, list(rows.films.values())))
    return found


def _by_condition(rows: Rows) -> dict[str, Outcomes]:
    """Condition -> task -> outcomes of the trials that count; those that a helper's fault ended do not."""
    found: dict[str, list[tuple[str, Mapping[str, float]]]] = {each.name: [] for each in rows.study.conditions}
    for row in rows.trials():
        if row["counted"] and not row["helper_fault"]:
            numbers = {name: value for name, value in row.items() if isinstance(value, (int, float))}
            found[row["condition"]].append((row["task_id"], numbers))
    return {name: by_task(some) for name, some in found.items()}


def _alone(
    people: Mapping[str, Outcomes], results: Mapping[str, Results], other: Collected | None
) -> tuple[Outcomes, str]:
    """Return the outcomes without a helper, and in words whose they are."""
    if other is not None:
        name = next(each.name for each in other.study.conditions if not each.helped)
        return _by_condition(Rows(other))[name], f"people alone ({other.study.name})"
    if people.get("alone"):
        return people["alone"], "people alone (this study)"
    if "alone" in results:
        return results["alone"].outcomes(False), "the human-like agent alone"
    return {}, "nobody"


def _measured(who: str, some: Mapping[str, Outcomes], alone: Outcomes) -> dict[tuple[str, str, str], dict[Any, float]]:
    found = {}
    for name, outcomes in some.items():
        for metric in ("success", "reward", "length"):
            found[who, name, metric] = of_tasks(outcomes, metric)
        helped = {task: each for task, each in outcomes.items() if task in alone}
        found[who, name, "speedup"] = speedups(alone, helped)
    return found


def _ratings(rows: Rows) -> dict[tuple[str, str, str], dict[Any, float]]:
    """Mean ratings of every task or film, by condition or band and question."""
    given: defaultdict[tuple[str, str, str], defaultdict[Any, list[float]]] = defaultdict(lambda: defaultdict(list))
    for row in rows.ratings():
        if row["counted"] and row["trial"] >= 0 and row["value"] is not None:
            given[PEOPLE, row["group"], row["question"]][row["item"]].append(row["value"])
    return {
        key: {item: sum(each) / len(each) for item, each in sorted(items.items())}
        for key, items in sorted(given.items())
    }


def scales(study: Study) -> list[str]:
    """Return the names of the questions after trials that are answered by numbers."""
    return [each.name for each in study.questions if each.kind == "scale"]


def published(study: str, metric: str, condition: str) -> str:
    """Return the thesis's report on people and agent under a condition."""
    rows = PUBLISHED.get(study, ())
    found = (row["text"] for row in rows if (row.get("metric", ""), row["condition"]) == (metric, condition))
    return next(found, "")


def _comparisons(found: Findings) -> Iterator[Comparison]:
    """People with the agent under each condition, and each condition with the next ones."""
    study, values = found.study, found.values
    people = "simulated people" if found.simulated else "people"
    if study.films is None:
        for condition in study.conditions:
            for metric in ("length", "speedup", "reward") if condition.helped else ("length", "reward"):
                pair = values.get((PEOPLE, condition.name, metric), {}), values.get((AGENT, condition.name, metric), {})
                names = f"{people}: {condition.title}", f"human-like agent: {condition.title}"
                if all(pair):
                    yield compare(metric, names, *pair, published(study.name, metric, condition.name))
    if study.films is not None and study.films.bands:
        return
    metrics = ("reward", *scales(study)) if study.films is None else scales(study)
    for metric in metrics:
        for place, one in enumerate(study.conditions):
            for other in study.conditions[place + 1 :]:
                first, second = values.get((PEOPLE, one.name, metric)), values.get((PEOPLE, other.name, metric))
                if first and second:
                    thesis = published(study.name, metric, other.name) if study.films else ""
                    yield compare(metric, (one.title, other.title), first, second, thesis)


def _correlations(found: Findings, films: list[JudgedFilm]) -> dict[str, tuple[float, float]]:
    """Return how the ratings of programs go with their LCS."""
    if not (found.study.films and found.study.films.bands):
        return {}
    result = {}
    for question in scales(found.study):
        rated = {item: value for (_, _, name), items in found.values.items() if name == question
                 for item, value in items.items()}  # fmt: skip
        pairs = [(film.measure, rated[film.item]) for film in films if film.item in rated]
        if (rho := rank_correlation(pairs)) is not None:
            result[question] = rho
    return result
