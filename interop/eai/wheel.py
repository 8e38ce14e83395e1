"""The wheels of the Embodied Agent Interface, read in place: tasks, graphs, gold programs, answers of models."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import orjson

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.archives import Member, archive, members, raw, refusal_of

ROOT = "virtualhome_eval/"
DATA = f"{ROOT}dataset/programs_processed_precond_nograb_morepreconds/"
PLACE = "TrimmedTestScene1_graph/results_intentions_march-13-18/file"
RESOURCES = f"{ROOT}resources/virtualhome/"
ANSWERS = re.compile(rf"{ROOT}llm_response/(\w+)/([\w.-]+)_outputs\.json")

ABILITIES = {
    "goal_interpretation": "goal_interpretation",
    "subgoal_decomposition": "subgoal_decomposition",
    "action_sequencing": "action_sequence",
    "transition_modeling": "transition_modeling",
}
"""The four abilities, and the folders that have the answers to them."""

LARGEST = 64 << 20
"""Bytes of a file of a wheel."""


class Answer(NamedTuple):
    """A model's answer to a task."""

    task: str
    text: str


@dataclass(frozen=True, slots=True)
class Task:
    """A task of the interface.

    Attributes:
        id: `27_2`, the number of its program.
        title: `Wash clothes`.
        states: `{id, class_name, state}`.
        relations: `{from_id, relation_type, to_id}`.
        actions: in order; several of one name by `|`.
        record: the task as the wheel has it.
    """

    id: str
    title: str
    states: tuple[Mapping[str, Any], ...]
    relations: tuple[Mapping[str, Any], ...]
    actions: tuple[str, ...]
    record: Mapping[str, Any]

    @property
    def empty(self) -> bool:
        """Return whether it asks for nothing."""
        return not (self.states or self.relations or self.actions)


class Wheel:
    """A wheel of `eai-eval` or `virtualhome-eval`.

    Args:
        path: the wheel; nothing of it is unpacked to the disk.

    Raises:
        HearthError: MISSING_FILE, BAD_ARCHIVE; BAD_TABLE: it has no tasks of the interface.
    """

    def __init__(self, path: Path) -> None:
        if not path.is_file():
            raise HearthError.of(Code.MISSING_FILE, "there is no such file", file=str(path),
                                 suggestion="pip download --no-deps virtualhome-eval==0.1.1")  # fmt: skip
        self.path = path
        self._members = {info.filename: info for info in members(archive(path))}
        if f"{RESOURCES}task_state_LTL_formula_accurate.json" not in self._members:
            raise HearthError.of(Code.BAD_TABLE, "not a wheel of the Embodied Agent Interface", file=str(path),
                                 suggestion="virtualhome-eval 0.1.1 or eai-eval 1.0.5")  # fmt: skip

    def bytes_of(self, name: str) -> bytes:
        """Return a file of the wheel.

        Raises:
            HearthError: MISSING_FILE, FILE_TOO_LARGE or BAD_ARCHIVE.
        """
        info = self._members.get(name)
        if info is None:
            raise HearthError.of(Code.MISSING_FILE, f"the wheel has no `{name}`", file=str(self.path))
        refused = refusal_of(info, str(self.path))
        if refused is not None:
            raise HearthError(refused.diagnostics)
        if info.file_size > LARGEST:
            raise HearthError.of(Code.FILE_TOO_LARGE, f"`{name}` has {info.file_size:,} bytes", file=str(self.path))
        with raw(Member(self.path, name)) as file:
            return file.read(LARGEST + 1)

    def json(self, name: str) -> Any:
        """Return the JSON value of a file.

        Raises:
            HearthError: as `bytes_of`; BAD_JSON.
        """
        try:
            return orjson.loads(self.bytes_of(name))
        except orjson.JSONDecodeError as error:
            raise HearthError.of(Code.BAD_JSON, f"`{name}` is not JSON: {error}", file=str(self.path)) from error

    @cached_property
    def tasks(self) -> Mapping[str, Task]:
        """The tasks by id, in the wheel's order."""
        found: dict[str, Task] = {}
        scenes = self.json(f"{RESOURCES}task_state_LTL_formula_accurate.json")
        for title, programs in scenes["scene_1"].items():
            for number, record in programs.items():
                found[number] = _task(number, title, record)
        return found

    def pair(self, task: str) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
        """Return the graphs before and after a task's gold program."""
        value = self.json(f"{DATA}init_and_final_graphs/{PLACE}{task}.json")
        return value["init_graph"], value["final_graph"]

    def gold(self, task: str) -> tuple[str, ...]:
        """Return the steps of a task's gold program."""
        text = self.bytes_of(f"{DATA}executable_programs/{PLACE}{task}.txt").decode("utf-8", "replace")
        return tuple(line.strip() for line in text.split("\n") if line.strip().startswith("["))

    def programs(self) -> tuple[str, ...]:
        """Return the numbers of the wheel's grounded programs, sorted."""
        begin, end = f"{DATA}executable_programs/{PLACE}", ".txt"
        return tuple(sorted(n[len(begin) : -len(end)] for n in self._members if n.startswith(begin)))

    def models(self, ability: str) -> tuple[str, ...]:
        """Return the models that answered to an ability; none of a wheel without answers."""
        found = (ANSWERS.fullmatch(name) for name in self._members)
        return tuple(sorted(each[2] for each in found if each and each[1] == ABILITIES[ability]))

    def answers(self, ability: str, model: str) -> Iterator[Answer]:
        """Yield the answers of a model."""
        name = f"{ROOT}llm_response/{ABILITIES[ability]}/{model}_outputs.json"
        for row in self.json(name):
            yield Answer(str(row["identifier"]).removeprefix("scene_1_"), str(row["llm_output"]))


def _task(number: str, title: str, record: Mapping[str, Any]) -> Task:
    goal = record["vh_goal"]
    rows = _once(goal["goal"])
    states = tuple(row for row in rows if "state" in row)
    relations = tuple(row for row in rows if "state" not in row)
    return Task(number, title, states, relations, tuple(dict.fromkeys(goal["actions"])), record)


def _once(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return rows, each once."""
    return list({tuple(sorted(row.items())): row for row in rows}.values())
