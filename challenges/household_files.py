"""Files of household tasks: JSON with a digest of all that the tasks are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from hearth.challenges.household import HouseholdTask, digest_of
from hearth.challenges.household_definition import NAME, home_named
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.simulation.goal_text import read_goal
from hearth.storage import chosen_files
from hearth.storage.input_files import read_input

FORMAT = "hearth-household-1"

MOST_TASKS = 20_000
"""Tasks of a file, at most."""

_TEXTS = ("id", "family", "home", "instruction", "split", "activity")
_NUMBERS = ("seed", "min_ticks")


def task_data(task: HouseholdTask) -> dict[str, Any]:
    """Return a task as JSON."""
    return {
        "id": task.id,
        "family": task.family,
        "home": task.home,
        "seed": task.seed,
        "instruction": task.instruction,
        "goal": str(task.goal),
        "expert": list(task.expert),
        "min_ticks": task.min_ticks,
        "split": task.split,
        "activity": task.activity,
    }


def tasks_data(tasks: Sequence[HouseholdTask]) -> dict[str, Any]:
    """Return tasks as JSON, with their digest."""
    return {"format": FORMAT, "challenge": NAME, "digest": digest_of(tasks), "tasks": list(map(task_data, tasks))}


def write_tasks(path: Path, tasks: Sequence[HouseholdTask]) -> None:
    """Write a file of tasks."""
    import orjson

    data = tasks_data(tasks)
    chosen_files.write(path, orjson.dumps(data, option=orjson.OPT_INDENT_2 | orjson.OPT_APPEND_NEWLINE))


def read_tasks(path: Path, knowledge: Knowledge) -> tuple[HouseholdTask, ...]:
    """Return the tasks of a file.

    Raises:
        HearthError: MISSING_FILE, FILE_TOO_LARGE; BAD_JSON with the task at fault; DAMAGED_FILE where the tasks are not
            those of the digest.
    """
    import orjson

    try:
        data = orjson.loads(read_input(path))
    except orjson.JSONDecodeError as error:
        raise HearthError.of(Code.BAD_JSON, f"not JSON: {error}", file=str(path)) from error
    return tasks_of(data, str(path), knowledge)


def tasks_of(data: Any, path: str, knowledge: Knowledge) -> tuple[HouseholdTask, ...]:
    """Return the tasks of a file's content; errors as of `read_tasks`, and DUPLICATE."""
    if not isinstance(data, Mapping) or data.get("format") != FORMAT or not isinstance(data.get("tasks"), list):
        remedy = "`challenge tasks household --split train --limit 5 --out FILE` writes one"
        raise HearthError.of(Code.BAD_JSON, f"not a file of tasks ({FORMAT})", file=path, suggestion=remedy)
    if not 0 < len(data["tasks"]) <= MOST_TASKS:
        raise HearthError.of(Code.BAD_JSON, f"`tasks` is not a list of 1 to {MOST_TASKS:,} tasks", file=path)
    given = enumerate(data["tasks"], 1)
    tasks = tuple(_task(each, f"{path}: task {number}", knowledge) for number, each in given)
    if len({task.id for task in tasks}) < len(tasks):
        raise HearthError.of(Code.DUPLICATE, "two tasks have one id", file=path)
    if data.get("digest") != digest_of(tasks):
        message = f"the tasks have the digest {digest_of(tasks)}, not {str(data.get('digest'))[:40]}"
        remedy = "the file was changed after it was written"
        raise HearthError.of(Code.DAMAGED_FILE, message, file=path, suggestion=remedy)
    return tasks


def _task(given: Any, place: str, knowledge: Knowledge) -> HouseholdTask:
    if not isinstance(given, Mapping):
        raise HearthError.of(Code.BAD_JSON, "not a task", file=place)
    texts = all(isinstance(given.get(name), str) for name in (*_TEXTS, "goal"))
    numbers = all(type(given.get(name)) is int for name in _NUMBERS)
    expert = given.get("expert")
    if not texts or not numbers or not isinstance(expert, list) or not all(isinstance(each, str) for each in expert):
        remedy = "see `challenge tasks household` for the form"
        raise HearthError.of(Code.BAD_JSON, "a part is missing, or of another type", file=place, suggestion=remedy)
    goal = read_goal(given["goal"], home_named(given["home"], knowledge), place)
    values = {name: given[name] for name in (*_TEXTS, *_NUMBERS)}
    return HouseholdTask(**values, goal=goal, expert=tuple(expert))
