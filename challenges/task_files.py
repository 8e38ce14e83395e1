"""Files of tasks: written as JSON, read with every value checked; nothing of them becomes a path or code."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from hashlib import blake2b
from pathlib import Path
from typing import Any

from hearth.challenges import household_files, published_tasks
from hearth.challenges.challenge_definition import Challenge, challenge
from hearth.challenges.household import digest_of
from hearth.challenges.household_as_challenge import OpenTask, as_task, split_of
from hearth.challenges.household_definition import NAME as HOUSEHOLD
from hearth.challenges.tasks import Task
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage import chosen_files
from hearth.storage.input_files import read_input

FORMAT = "hearth-tasks-1"

MOST_TASKS = 20_000
"""Tasks of a file, at most."""

_ID = re.compile(r"[\w.-]{1,80}", re.ASCII)


@dataclass(frozen=True)
class Suite:
    """Tasks that belong together.

    Attributes:
        challenge: its name.
        split: which tasks these are.
        seed: they were drawn with; `published_tasks.PUBLISHED` for the published ones.
        tasks: in their order.
    """

    challenge: str
    split: str
    seed: int
    tasks: tuple[Task, ...]

    @cached_property
    def digest(self) -> str:
        """32 hexadecimal digits of all that the tasks are; equal for equal tasks."""
        import orjson

        if origins := self.household:
            return digest_of([task.origin for task in origins])
        data = [self.challenge, self.split, *map(task_data, self.tasks)]
        return blake2b(orjson.dumps(data, option=orjson.OPT_SORT_KEYS), digest_size=16).hexdigest()

    @property
    def household(self) -> tuple[OpenTask, ...]:
        """Return its tasks where they are household tasks; none where they are another challenge's."""
        return tuple(task for task in self.tasks if isinstance(task, OpenTask))

    @cached_property
    def published(self) -> bool:
        """Return whether these are published tasks: the first of their split; of `household`, those of their ids.

        A household task is made anew to find out, which takes a second or two.
        """
        if origins := self.household:
            return all(task.published for task in origins)
        try:
            return self.tasks == published_tasks.tasks(self.challenge, self.split, limit=len(self.tasks))
        except HearthError:
            return False


def suite(name: str, split: str, seed: int = published_tasks.PUBLISHED, limit: int | None = None) -> Suite:
    """Return the tasks of a split (see `published_tasks.tasks`)."""
    tasks = published_tasks.tasks(name, split, seed, limit)
    return Suite(name, split, published_tasks.PUBLISHED if name == HOUSEHOLD else seed, tasks)


def task_data(task: Task) -> dict[str, Any]:
    """Return a task as JSON."""
    return {
        "id": task.id,
        "home": task.home,
        "demonstration_home": task.demonstration_home,
        "sets": list(task.sets),
        "goal": challenge(task.challenge).grammar.written(task.goal),
        "seed": task.seed,
    }


def suite_data(found: Suite) -> dict[str, Any]:
    """Tasks as JSON, with their digest."""
    if origins := found.household:
        return household_files.tasks_data([task.origin for task in origins])
    return {
        "format": FORMAT,
        "challenge": found.challenge,
        "split": found.split,
        "seed": None if found.seed == published_tasks.PUBLISHED else found.seed,
        "digest": found.digest,
        "tasks": [task_data(task) for task in found.tasks],
    }


def write(path: Path, found: Suite) -> None:
    """Write a file of tasks."""
    import orjson

    chosen_files.write(path, orjson.dumps(suite_data(found), option=orjson.OPT_INDENT_2 | orjson.OPT_APPEND_NEWLINE))


def read(path: Path) -> Suite:
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
    return read_suite(data, str(path))


def read_suite(data: Any, file: str) -> Suite:
    """Return the tasks of a file's content; errors as of `read`."""
    if isinstance(data, Mapping) and data.get("format") == household_files.FORMAT:
        origins = tuple(map(as_task, household_files.tasks_of(data, file, default())))
        return Suite(HOUSEHOLD, split_of(origins), published_tasks.PUBLISHED, origins)
    if not isinstance(data, Mapping) or data.get("format") != FORMAT:
        remedy = "`challenge tasks wah --split test-1 --out FILE` writes one"
        raise HearthError.of(Code.BAD_JSON, f"not a file of tasks ({FORMAT})", file=file, suggestion=remedy)
    which = challenge(str(data.get("challenge")))
    split, seed, given = data.get("split"), data.get("seed"), data.get("tasks")
    if (
        not isinstance(split, str)
        or not _ID.fullmatch(split)
        or not _is_seed(published_tasks.PUBLISHED if seed is None else seed)
    ):
        raise HearthError.of(Code.BAD_JSON, "`split` is not a name, or `seed` not a number", file=file)
    if not isinstance(given, list) or not 0 < len(given) <= MOST_TASKS:
        raise HearthError.of(Code.BAD_JSON, f"`tasks` is not a list of 1 to {MOST_TASKS:,} tasks", file=file)
    tasks = tuple(_task(which, split, each, f"{file}: task {number}") for number, each in enumerate(given, 1))
    if len({task.id for task in tasks}) < len(tasks):
        raise HearthError.of(Code.DUPLICATE, "two tasks have one id", file=file)
    found = Suite(which.name, split, published_tasks.PUBLISHED if seed is None else seed, tasks)
    if data.get("digest") != found.digest:
        message = f"the tasks have the digest {found.digest}, not {str(data.get('digest'))[:40]}"
        raise HearthError.of(
            Code.DAMAGED_FILE, message, file=file, suggestion="the file was changed after it was written"
        )
    return found


def _is_seed(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and published_tasks.PUBLISHED <= value < 1 << 63


def _task(which: Challenge, split: str, given: Any, place: str) -> Task:
    """Return a task of a file, with every value checked."""
    if not isinstance(given, Mapping):
        raise HearthError.of(Code.BAD_JSON, "not a task", file=place)
    homes = (*which.train, *which.test)
    task_id, sets, seed, goal = (given.get(name) for name in ("id", "sets", "seed", "goal"))
    places = [given.get("home"), given.get("demonstration_home")]
    faults = {
        "id": not (isinstance(task_id, str) and _ID.fullmatch(task_id)),
        "home": places[0] not in homes,
        "demonstration_home": places[1] not in homes,
        "sets": not isinstance(sets, list) or not all(isinstance(s, str) and s in which.grammar.sets for s in sets),
        "seed": not _is_seed(seed) or seed == published_tasks.PUBLISHED,
        "goal": not isinstance(goal, Mapping),
    }
    if wrong := [name for name, fault in faults.items() if fault]:
        shown = str(given.get(wrong[0]))[:60]
        raise HearthError.of(
            Code.BAD_JSON, f"`{wrong[0]}` is {shown}", file=place, suggestion=_expected(wrong[0], homes)
        )
    assert isinstance(task_id, str) and isinstance(sets, list) and isinstance(seed, int) and isinstance(goal, Mapping)
    try:
        read_goal = which.grammar.read(goal)
    except HearthError as error:
        raise HearthError.of(error.diagnostics[0].code, error.diagnostics[0].message, file=place) from error
    return Task(task_id, which.name, split, str(places[0]), str(places[1]), tuple(sets), read_goal, seed)


def _expected(name: str, homes: Sequence[str]) -> str:
    return f"one of {', '.join(homes)}" if "home" in name else "see `challenge tasks` for the form"
