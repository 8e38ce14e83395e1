"""`challenge infer | people`: the beliefs of helpers that are not given the goal, and the test that they do no harm."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.commands import output

if TYPE_CHECKING:
    from hearth.challenges.episodes import Record
    from hearth.challenges.tasks import Task


def infer(results: Path, *, workers: int = 0, as_json: bool = False) -> None:
    """Print how well a helper inferred the goals of a run: F1 and log loss over time, and how calibrated it was.

    \b
    Example:
      hearth challenge infer nopa.jsonl
    """
    from hearth.analysis.online_inference import inference
    from hearth.challenges.verification import read_whole
    from hearth.commands.progress_line import bar
    from hearth.kb.loading.load import default

    with bar("episodes") as seen:
        found = inference(read_whole(results), default, workers, seen)
    if as_json:
        output.emit(found)
        return
    over = [(row["share"], row["f1"], row["f1_se"], row["log_loss"], row["log_loss_se"]) for row in found["over_time"]]
    output.table(("of the time alone", "F1", "±", "log loss", "±"), over)
    output.line()
    output.records(found["calibration"])
    output.line(f"\ncalibration error {found['calibration_error']}, {output.counted(found['episodes'], 'episode')}")


def people(
    name: str,
    helper: list[str] | None = None,
    split: str = "test",
    seeds: int = 1,
    *,
    out: Path,
    limit: int | None = None,
    workers: int = 0,
    as_json: bool = False,
) -> None:
    """Help people of kinds that no helper was tuned with, and print whether any task is done worse than alone.

    Of `owah_consequences` the rows also have the hazards, irreversible changes and waste of an episode, and the harm
    that came with an act of the helper. A helper with a veto (`nopa_veto`) after the same one without it has the share
    of the speedup that it keeps. Intervals are half-widths of 95 %.

    \b
    Examples:
      hearth challenge people owah --helper nopa --limit 20 --out data_out/challenges/people
      hearth challenge people owah_consequences --helper nopa --helper nopa_veto --limit 20 --out data_out/people
    """
    from hearth.analysis.helper_harm import helped_people
    from hearth.challenges.household_definition import need_two_agents
    from hearth.challenges.task_files import suite
    from hearth.commands.progress_line import bar
    from hearth.kb.loading.load import default

    need_two_agents(name)
    chosen = suite(name, split, limit=limit)
    with bar("episodes") as seen:
        rows = list(helped_people(chosen, helper or ["nopa", "expected_time"], seeds, out, default, workers, seen))
    if as_json:
        output.emit(rows)
    else:
        names = list(dict.fromkeys(name for row in rows for name in row))
        output.records([{name: row.get(name) for name in names} for row in rows])


def draw_beliefs(
    out: Path, task: Task, record: Record, helper: str, actions: Sequence[tuple[int, int, str, str]]
) -> None:
    """Draw a helper's beliefs (figure 7-4); errors as of `helper_beliefs.beliefs`."""
    from hearth.analysis.goal_belief_figure import drawn
    from hearth.challenges.helper_beliefs import beliefs
    from hearth.kb.loading.load import default
    from hearth.storage.chosen_files import write

    write(out, drawn(beliefs(task, record, helper, default()), actions).encode())


def print_by_set(found: Sequence[dict[str, Any]]) -> None:
    """Print a table of speedups by goal set (figures 7-6a, C-3)."""
    there = [row for row in found if "by_set" in row]
    names = tuple(there[0]["by_set"])
    cells = [
        [row["method"], *(f"{each['speedup']:.2f} ± {each['speedup_ci']:.2f}" for each in row["by_set"].values())]
        for row in there
    ]
    output.table(("method", *names), cells)
