"""The board of a challenge: runs that were verified, next to each other, and differences with intervals.

Success, ticks, faults and hazards are counted anew from the recorded actions and answers, so that no file can lie about
them. Tokens, seconds and cost are the word of a server, and are marked as such.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Any

from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episodes import Known, Record, replayed, start_of
from hearth.challenges.metrics import (
    CONFIDENT,
    Mean,
    Outcomes,
    difference_interval,
    mean,
    of_tasks,
    paired,
    share_interval,
    summary,
)
from hearth.challenges.result_files import Results
from hearth.challenges.tasks import Task
from hearth.challenges.verification import read_whole, verify
from hearth.llm.language_settings import MILLION
from hearth.llm.turns import faults_of
from hearth.simulation.hazards import hazards_among
from hearth.storage.files import file_digest
from hearth.storage.parallel import Seen, spread, unseen

COMPARED = ("success", "length")
"""The metrics whose differences between runs are given."""

MOST_FAULTS = 4
"""Codes of faults in a row of the page."""


@dataclass(frozen=True)
class Submission:
    """A file of results on a board.

    Attributes:
        row: its figures.
        results: the file, as read.
    """

    row: dict[str, Any]
    results: Results

    @property
    def outcomes(self) -> Outcomes:
        """Return the metrics of the episodes that count: with the helper, where there is one."""
        return self.results.finished(self.results.header.helped[-1])


def submissions(paths: Sequence[Path], known: Known, workers: int = 1, seen: Seen = unseen) -> list[Submission]:
    """Return runs with their figures, verified ones first, then by success, speedup and ticks.

    Args:
        paths: files of results.
        known: gives the knowledge.
        workers: processes.
        seen: called with the number of files done.

    Raises:
        HearthError: those of `read_whole`.
    """
    found = []
    for number, path in enumerate(paths, 1):
        results = read_whole(path)
        faults = verify(results, str(path), known, workers)
        found.append(Submission(_row(path, results, [fault.message for fault in faults]), results))
        seen(number, len(paths))
    _count_hazards(found, known, workers)
    return sorted(found, key=lambda each: _rank(each.row))


def _rank(row: Mapping[str, Any]) -> tuple[Any, ...]:
    speedup = row["speedup"]
    return not row["verified"], -(speedup or 0) if row["helper"] != "none" else 0, -(row["success"] or 0), row["file"]


def _row(path: Path, results: Results, faults: Sequence[str]) -> dict[str, Any]:
    header = results.header
    helped = header.helped[-1]
    figures = summary(results.finished(False), results.finished(True) if helped else {})
    share, number = figures["success"], int(figures["episodes"] or 0)
    interval = share_interval(share, number) if share is not None and number else (None, None)
    return {
        "file": path.name,
        "digest": file_digest(path)[:16],
        "suite": f"{header.suite.challenge} {header.suite.split}",
        "tasks_digest": header.suite.digest,
        "published": None if header.suite.household else header.suite.published,
        "main": header.lineup.main,
        "helper": header.lineup.helper,
        "goal": header.lineup.goal,
        "episodes": number,
        "unfinished": len(results.unfinished),
        "success": share,
        "success_from": interval[0],
        "success_to": interval[1],
        "length": figures["length"],
        "length_ci": _half(figures["length_se"]),
        "speedup": figures["speedup"] if helped else None,
        "speedup_se": figures["speedup_se"] if helped else None,
        "reward": figures["reward"],
        "hazards": None,
        **language_figures(results),
        "verified": not faults,
        "differences": list(faults),
    }


def _half(error: float | int | None) -> float | None:
    return None if error is None else CONFIDENT * error


def language_figures(results: Results) -> dict[str, Any]:
    """Return the figures of the language models of a run; None where there are none."""
    described = results.header.language
    names = ("model", "protocol", "protocol_fingerprint", "prompt", "prompt_fingerprint", "constrained")
    found: dict[str, Any] = {name: ", ".join(sorted({str(one[name]) for one in described.values() if name in one}))
                             or None for name in names}  # fmt: skip
    said = [(described[n], one) for each in results.records for n, one in (each.language or {}).items()]
    if not said:
        return {**found, **dict.fromkeys(("turns", "tokens_in", "tokens_out", "seconds", "cost", "faults"), None)}
    faults: Counter[str] = sum((faults_of(one) for _, one in said), Counter())
    priced = all("price_in" in facts for facts, _ in said)
    cost = sum(
        one["tokens_in"] * facts.get("price_in", 0) + one["tokens_out"] * facts.get("price_out", 0)
        for facts, one in said
    )
    return {
        **found,
        "turns": sum(len(one["turns"]) for _, one in said),
        "tokens_in": sum(one["tokens_in"] for _, one in said),
        "tokens_out": sum(one["tokens_out"] for _, one in said),
        "seconds": round(sum(one["seconds"] for _, one in said), 1),
        "cost": round(cost / MILLION, 6) if priced else None,
        "faults": dict(faults.most_common()),
    }


@dataclass(frozen=True)
class _Watched:
    """An episode whose hazards are to be counted, and the number of its run."""

    run: int
    task: Task
    record: Record
    known: Known


def _count_hazards(found: Sequence[Submission], known: Known, workers: int) -> None:
    """Fill the hazards of the runs that are verified; all episodes go to the same processes, which start once."""
    counts = {number: Counter[str]() for number, each in enumerate(found) if each.row["verified"]}
    for number, hazards in spread(hazards_of, _watched(found, counts, known), workers):
        counts[number] += hazards
    for number, hazards in counts.items():
        found[number].row["hazards"] = dict(hazards.most_common())


def _watched(found: Sequence[Submission], numbers: Iterable[int], known: Known) -> Iterator[_Watched]:
    for number in numbers:
        results = found[number].results
        tasks = {task.id: task for task in results.header.suite.tasks}
        helped = results.header.helped[-1]
        yield from (
            _Watched(number, tasks[each.task], each, known) for each in results.records if each.helped == helped
        )


def hazards_of(watched: _Watched) -> tuple[int, Counter[str]]:
    """Return the hazards that a verified episode brought, by name, and the number of its run."""
    which = challenge(watched.task.challenge)
    start = start_of(watched.task, watched.known(), None if watched.record.helped else 1)
    ticks, _, _ = replayed(which, watched.task, watched.record, start)
    return watched.run, Counter(found.hazard.name for found in hazards_among((start, *(tick.world for tick in ticks))))


def comparisons(found: Sequence[Submission]) -> Iterator[dict[str, Any]]:
    """Yield the differences between each two verified runs on the tasks that both did, with intervals of 95 %.

    Lengths are paired by task: what is hard for both does not count. Differences of success have the interval of
    Newcombe (1998, method 10) for independent shares, which is wider than a paired one, and has no width of 0 where a
    few tasks all come out alike.
    """
    for one, other in combinations([each for each in found if each.row["verified"]], 2):
        if one.results.header.suite.challenge != other.results.header.suite.challenge:
            continue
        for name in COMPARED:
            first, second = of_tasks(one.outcomes, name), of_tasks(other.outcomes, name)
            differences = [first[task] - second[task] for task in first if task in second]
            if not differences:
                continue
            value = mean(differences)
            low, high = _of_shares(first, second) if name == "success" else _of_pairs(value, len(differences))
            yield {
                "one": one.row["file"],
                "other": other.row["file"],
                "metric": name,
                "tasks": len(differences),
                "difference": value.value,
                "from": low,
                "to": high,
                "p": paired(first, second).p,
            }


def _of_shares(first: Mapping[str, float], second: Mapping[str, float]) -> tuple[float, float]:
    """Return the interval of the difference of two shares of successful tasks."""
    common = [task for task in first if task in second]
    shares = [math.fsum(each[task] for task in common) / len(common) for each in (first, second)]
    return difference_interval(shares[0], len(common), shares[1], len(common))


def _of_pairs(value: Mean, number: int) -> tuple[float | None, float | None]:
    """Return the interval of a mean of differences, by Student's t; none of one task."""
    from scipy import stats

    if value.error is None:
        return None, None
    half = float(stats.t.ppf(0.975, number - 1)) * value.error
    return value.value - half, value.value + half
