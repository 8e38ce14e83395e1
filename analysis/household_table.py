"""The reference rows of `household`: agents at random, the expert and the human-like agent, by split and by family."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hearth.challenges.episode_agents import Lineup
from hearth.challenges.episodes import Known
from hearth.challenges.household_as_challenge import as_task, split_of
from hearth.challenges.household_definition import NAME, settings
from hearth.challenges.household_task_workers import drawn_tasks
from hearth.challenges.metrics import CONFIDENT, mean, of_tasks, share_interval
from hearth.challenges.published_tasks import PUBLISHED
from hearth.challenges.result_files import Results
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import Suite
from hearth.storage.names import inside
from hearth.storage.parallel import Seen, unseen

AGENTS = {
    "random": "random",
    "admissible random": "admissible_random",
    "expert": "oracle",
    "human-like": "human_like",
}
"""The main agent of each row: any action and seen things; any legal instruction; one that sees everything; and one that
sees its own room."""

USUAL_LIMIT = 10
"""Tasks of each split where no number is given: one of each family."""

ALL = "all"
"""The group of all tasks."""


@dataclass(frozen=True)
class Group:
    """Tasks that a row of the table is about.

    Attributes:
        kind: `all`, `split` or `family`.
        name: of the split or family.
        tasks: their ids.
    """

    kind: str
    name: str
    tasks: frozenset[str]


def household_suite(split: str, limit: int | None, known: Known, workers: int = 1, seen: Seen = unseen) -> Suite:
    """Return the first tasks of a split, or of every split where it is empty."""
    names = [split] if split else list(settings()["splits"])
    chosen = [drawn_tasks(name, limit or USUAL_LIMIT, 0, known, workers, seen) for name in names]
    tasks = tuple(as_task(task) for each in chosen for task in each.tasks)
    return Suite(NAME, split_of(tasks), PUBLISHED, tasks)


def household_runs(
    suite: Suite,
    seeds: int,
    folder: Path,
    known: Known,
    workers: int = 1,
    watch: Callable[[str], Seen] | None = None,
) -> dict[str, Results]:
    """Let each agent do the tasks alone; results that a folder has already are kept.

    Args:
        suite: the tasks.
        seeds: episodes of each task.
        folder: gets a file of results for each agent.
        known: gives the knowledge.
        workers: processes.
        watch: for the name of an agent, the function that is called with the number of its episodes done.
    """
    folder.mkdir(parents=True, exist_ok=True)
    found = {}
    for name, main in AGENTS.items():
        seen = watch(name) if watch else unseen
        found[name] = run(suite, Lineup(main), seeds, inside(folder, f"{main}.jsonl"), known, workers, seen)
    return found


def groups(suite: Suite) -> Iterator[Group]:
    """Yield all tasks, those of each split, and those of each family, in the order of the tasks."""
    tasks = suite.tasks
    yield Group(ALL, ALL, frozenset(task.id for task in tasks))
    for split in dict.fromkeys(task.split for task in tasks):
        yield Group("split", split, frozenset(task.id for task in tasks if task.split == split))
    for family in dict.fromkeys(task.sets[0] for task in tasks):
        yield Group("family", family, frozenset(task.id for task in tasks if task.sets[0] == family))


def household_rows(found: Mapping[str, Results]) -> list[dict[str, Any]]:
    """Return a row for each agent and group: success with its 95 % interval, and the ticks of its tasks."""
    suite = next(iter(found.values())).header.suite
    outcomes = {name: results.finished(False) for name, results in found.items()}
    rows = []
    for group in groups(suite):
        for name, some in outcomes.items():
            chosen = {task: episodes for task, episodes in some.items() if task in group.tasks}
            rows.append({"kind": group.kind, "group": group.name, "agent": name, **_figures(chosen)})
    return rows


def _figures(outcomes: Mapping[str, Sequence[Mapping[str, Any]]]) -> dict[str, Any]:
    """Return the means over tasks; the interval is Wilson's, which holds near 0 and 1, too."""
    if not outcomes:
        return {
            "tasks": 0,
            "success": None,
            "success_from": None,
            "success_to": None,
            "length": None,
            "length_ci": None,
        }
    success, length = of_tasks(outcomes, "success"), of_tasks(outcomes, "length")
    share, ticks = mean(list(success.values())).value, mean(list(length.values()))
    low, high = share_interval(share, len(success))
    return {
        "tasks": len(success),
        "success": share,
        "success_from": low,
        "success_to": high,
        "length": ticks.value,
        "length_ci": None if ticks.error is None else CONFIDENT * ticks.error,
    }
