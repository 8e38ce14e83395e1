"""The test that helpers do no harm: people of kinds that no helper was tuned with, alone and helped."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from hearth.agents.human_population import PEOPLE
from hearth.challenges.episode_agents import Lineup
from hearth.challenges.episodes import Known
from hearth.challenges.metrics import CONFIDENT, mean, of_tasks, speedups
from hearth.challenges.result_files import Results
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import Suite
from hearth.storage.names import inside
from hearth.storage.parallel import Seen, unseen


def helped_people(
    suite: Suite, helpers: Sequence[str], seeds: int, folder: Path, known: Known, workers: int = 1, seen: Seen = unseen
) -> Iterator[dict[str, Any]]:
    """Yield a row for each kind and helper, then one for each helper's worst kind.

    Args:
        suite: the tasks.
        helpers: by name.
        seeds: episodes of each task.
        folder: gets a file of results for each pair.
        known: gives the knowledge.
        workers: processes.
        seen: reports progress.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for helper in helpers:
        rows = []
        for kind in PEOPLE:
            out = inside(folder, f"{kind}-{helper}.jsonl")
            found = run(suite, Lineup(main=kind, helper=helper), seeds, out, known, workers, seen)
            rows.append(_row(kind, helper, found))
        yield from rows
        worst = min(rows, key=lambda row: (row["success"] - row["success_alone"], row["speedup"]))
        yield {**worst, "kind": f"worst: {worst['kind']}"}


def _row(kind: str, helper: str, found: Results) -> dict[str, Any]:
    alone, helped = found.outcomes(False), found.outcomes(True)
    before, after = of_tasks(alone, "success"), of_tasks(helped, "success")
    speedup = mean(list(speedups(alone, helped).values()))
    return {
        "kind": kind,
        "helper": helper,
        "success_alone": mean(list(before.values())).value,
        "success": mean(list(after.values())).value,
        "tasks_harmed": sum(after[task] < before[task] for task in before),
        "speedup": speedup.value,
        "speedup_ci": CONFIDENT * (speedup.error or 0.0),
    }
