"""`challenge tasks household` and `challenge solvable household`: tasks in people's words, and how many are solved."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.commands import output

if TYPE_CHECKING:
    from hearth.challenges.household_task_workers import Drawing

HOUSEHOLD = "household"
"""The challenge whose tasks are made one by one (`challenges/household.py`)."""

SHOWN = 20
"""Tasks that are printed, at most."""


def print_tasks(split: str, out: Path | None, seed: int, limit: int | None, workers: int, as_json: bool) -> None:
    """Draw tasks, write them into a file, and print instructions with their goals."""
    from hearth.challenges.household import digest_of
    from hearth.challenges.household_definition import NAME
    from hearth.challenges.household_files import task_data, write_tasks

    found = _drawn(split, seed, limit, workers)
    if out is not None:
        write_tasks(out, found.tasks)
    document: dict[str, Any] = {
        "challenge": NAME,
        "split": split,
        "tasks": len(found.tasks),
        "goals": len({task.goal for task in found.tasks}),
        "homes": len({task.home for task in found.tasks}),
        "rejected": sum(found.rejected.values()),
        "digest": digest_of(found.tasks),
        "out": out,
    }
    if as_json:
        shown = {} if out is not None else {"drawn": [task_data(task) for task in found.tasks]}
        output.emit({**document, "reasons": dict(found.rejected.most_common()), **shown})
        return
    for task in found.tasks[:SHOWN]:
        output.line(f"{task.id}  {task.family}, {task.home}, {output.counted(task.min_ticks, 'tick')}")
        output.line(f"  {output.shown(task.instruction)}\n  {output.shown(str(task.goal))}\n")
    if found.tasks[SHOWN:]:
        output.line(f"... and {len(found.tasks) - SHOWN:,} more; --out has all\n")
    output.figures(document)
    for reason, number in found.rejected.most_common():
        output.line(f"rejected: {number:,} draws: {reason}")


def print_solved(splits: list[str] | None, limit: int | None, workers: int, as_json: bool) -> None:
    """Print how many tasks the human-like agent solves that sees only the room it is in.

    Every task that is drawn was solved by an agent that sees everything.
    """
    from hearth.challenges.household_definition import NAME, settings
    from hearth.challenges.household_task_workers import attempts
    from hearth.commands.progress_line import bar
    from hearth.kb.loading.load import default

    names = splits or list(settings()["splits"])
    drawings = [_drawn(name, 0, limit, workers) for name in names]
    tasks = [task for each in drawings for task in each.tasks]
    with bar("episodes") as seen:
        found = list(attempts(tasks, default, workers, seen))
    solved = Counter(each.task.family for each in found if each.success)
    of_family = Counter(task.family for task in tasks)
    unsolved = [each.task.id for each in found if not each.success]
    figures = {
        "challenge": NAME,
        "splits": ", ".join(names),
        "tasks": len(tasks),
        "rejected": sum(sum(each.rejected.values()) for each in drawings),
        "oracle": len(tasks),
        "human_like": len(found) - len(unsolved),
        "share": round(1 - len(unsolved) / len(tasks), 4),
        "oracle_ticks": round(sum(task.min_ticks for task in tasks) / len(tasks), 1),
        "human_like_ticks": round(sum(each.ticks for each in found) / len(tasks), 1),
    }
    families = {name: f"{solved[name]} of {number}" for name, number in of_family.items()}
    if as_json:
        output.emit({**figures, "families": families, "unsolved": unsolved})
        return
    output.figures(figures)
    output.line("")
    output.table(("family", "solved by the human-like agent"), list(families.items()))
    for task_id in unsolved:
        output.line(f"not solved within {settings()['ticks']} ticks: {task_id}")


def print_table(split: str, seeds: int, out: Path, limit: int | None, workers: int, as_json: bool) -> None:
    """Let the reference agents do tasks, and print their success by split and family."""
    from hearth.analysis.household_table import AGENTS, household_rows, household_runs, household_suite
    from hearth.commands.progress_line import bar
    from hearth.kb.loading.load import default

    with bar("tasks") as seen:
        suite = household_suite(split, limit, default, workers, seen)
    with bar("episodes") as seen:
        found = household_rows(household_runs(suite, seeds, out, default, workers, lambda _: seen))
    if as_json:
        output.emit(found)
        return
    rows: dict[tuple[str, str], dict[str, dict[str, Any]]] = {}
    for row in found:
        rows.setdefault((row["kind"], row["group"]), {})[row["agent"]] = row
    names = tuple(AGENTS)
    columns = ("", "tasks", *(f"{name}, success" for name in names), *(f"{name}, ticks" for name in names[2:]))
    output.table(columns, [_cells(*key, row, names) for key, row in rows.items()])


def _cells(kind: str, group: str, row: dict[str, dict[str, Any]], names: tuple[str, ...]) -> list[Any]:
    """Return a line of the table: shares with their intervals, and mean ticks of those that solve tasks."""
    shares = [_share(row[name]) for name in names]
    ticks = [f"{row[name]['length']:.0f}" if row[name]["tasks"] else "" for name in names[2:]]
    return [group if kind == group else f"{kind} {group}", row[names[0]]["tasks"], *shares, *ticks]


def _share(figures: dict[str, Any]) -> str:
    """Return a share with its interval; empty of no task."""
    if not figures["tasks"]:
        return ""
    return f"{figures['success']:.2f} ({figures['success_from']:.2f}-{figures['success_to']:.2f})"


def _drawn(split: str, seed: int, limit: int | None, workers: int) -> Drawing:
    from hearth.challenges.household_task_workers import drawn_tasks
    from hearth.commands.progress_line import bar
    from hearth.kb.loading.load import default

    with bar("tasks") as seen:
        return drawn_tasks(split, limit, seed, default, workers, seen)
