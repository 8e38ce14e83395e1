"""Predictions scored against a dataset: its programs are the references, its environments where they run."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from hearth.kb import knowledge as kb
from hearth.kb.hearing import understand
from hearth.pipelines.cases import start_of
from hearth.pipelines.dataset import Dataset
from hearth.pipelines.rows import bindings_of, program_of
from hearth.pipelines.surroundings import RULES
from hearth.pipelines.verify import StoredHomes
from hearth.schemas.errors import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.syntax import parse_steps
from hearth.scoring.evaluate import Options, Scored, evaluate
from hearth.scoring.predictions import read_pairs

PART = 500
"""References whose environments are in memory at a time."""


def judge(
    dataset: Dataset, file: Path, split: str = "", part: str = "", options: Options | None = None
) -> list[Scored]:
    """Score a file of predictions for executions of a dataset; those without a prediction are missing.

    A row has `id`, an execution's, and `predicted`: a program's text, its steps, or steps in words. Its reference is
    the program that the dataset has for the execution, bound as there, and it runs in the same environment. Rows of
    executions outside the part are not looked at.

    Args:
        dataset: with the references.
        file: JSON Lines or Parquet.
        split: a split of the dataset, or "" for all executions.
        part: of the split; one that begins so counts (`test` is all tests).
        options: how to score; each execution's own rules are used.

    Raises:
        HearthError: what `read_pairs` raises; UNKNOWN_ID where the dataset has no such split or part.
    """
    wanted = chosen(dataset, split, part)
    known: dict[str, tuple[Step, ...]] = dict.fromkeys(chosen(dataset), ())
    predicted = {pair.id: pair for pair in read_pairs(file, known, reader=read_line)}
    scored: list[Scored] = []
    homes = StoredHomes(dataset)
    for start in range(0, len(wanted), PART):
        cases = {case["execution_id"]: case for case in _cases(dataset, wanted[start : start + PART])}
        pairs = []
        for name in wanted[start : start + PART]:
            case = cases[name]
            steps = program_of(case, bindings_of(case["bindings"])).steps
            more = {**predicted[name].more, "activity": case["activity_id"], "home": case["home"]}
            pairs.append(replace(predicted[name], reference=steps, more=more))
        for pair in pairs:
            case = cases[pair.id]
            mine = replace(options or Options(), rules=RULES[case["rules"]])
            scored += evaluate([pair], homes.home(case["home"]).knowledge, _started(case, homes), mine)
    return scored


def _started(case: dict[str, Any], homes: StoredHomes) -> Any:
    world = start_of(case, homes)
    return lambda pair: world


def chosen(dataset: Dataset, split: str = "", part: str = "") -> list[str]:
    """The ids of the executions of a part of a split that ran to their end, sorted.

    Raises:
        HearthError: UNKNOWN_ID, naming what there is.
    """
    if not split:
        query = "SELECT execution_id FROM executions WHERE executable ORDER BY 1"
        return [name for (name,) in dataset.rows(query)[1]]
    query = """SELECT execution_id FROM splits SEMI JOIN (SELECT execution_id FROM executions WHERE executable)
        USING (execution_id) WHERE split = $split AND starts_with(part, $part) ORDER BY 1"""
    found = [name for (name,) in dataset.rows(query, split=split, part=part)[1]]
    if not found:
        there = dataset.rows("SELECT DISTINCT split || ' ' || part FROM splits ORDER BY 1")[1]
        message = f"no executions in part `{part}` of split `{split}`"
        suggestion = f"there are {', '.join(name for (name,) in there)}"
        raise HearthError.of(Code.UNKNOWN_ID, message, file=str(dataset.folder), suggestion=suggestion)
    return found


def _cases(dataset: Dataset, names: list[str]) -> Iterator[dict[str, Any]]:
    runs = dataset._named("executions", "execution_id", names)
    environments = dataset._named(
        "environments", "environment_id", sorted({r["environment_id"] for r in runs.values()})
    )
    programs = dataset._named("programs", "program_id", sorted({row["program_id"] for row in runs.values()}))
    for row in runs.values():
        yield {**programs[row["program_id"]], **row, "environment": environments[row["environment_id"]]}


def read_line(line: str) -> tuple[Step, ...] | Diagnostic:
    """A line of a program, or a step in words: `2. Put the cup on the table`."""
    parsed = parse_steps(line)
    if not isinstance(parsed, Diagnostic):
        return parsed
    said = line.lstrip("0123456789.:) ").strip() if line[:1].isdigit() else line.partition(":")[2] or line
    meant = understand(kb.default(), said).meant if said else None
    if meant is None:
        return parsed
    return (Step(meant.action.name, tuple(ObjectRef(name) for name in meant.names)),)
