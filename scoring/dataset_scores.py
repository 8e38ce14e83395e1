"""Predictions scored against a dataset: its programs are the references, its environments where they run."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import groupby
from pathlib import Path
from typing import Any

from hearth.datasets.dataset import Dataset
from hearth.datasets.format.cases import Source, start_of
from hearth.datasets.format.codecs import bindings_of, program_of
from hearth.datasets.format.stored_cases import StoredCaseRow, stored_cases
from hearth.datasets.verify import opened
from hearth.kb.knowledge import Knowledge
from hearth.kb.language.understanding import understand
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.syntax import parse_steps
from hearth.scoring.evaluate import Options, Reference, Scored, lcs_of, scored
from hearth.scoring.lines import steps_of
from hearth.scoring.metrics.lcs import LcsScore
from hearth.scoring.prediction_rows import Named
from hearth.scoring.predictions import Pair, read_pairs
from hearth.simulation.engine import run
from hearth.simulation.rules import RULES
from hearth.storage.parallel import Seen, spread, unseen

PART = 250
"""References whose environments are in memory at a time, and a worker's share."""

Job = tuple[str, list[Pair], Options]
"""A dataset's folder, pairs without their references, and how to score them."""


def judge(
    dataset: Dataset,
    file: Path,
    split: str = "",
    part: str = "",
    options: Options | None = None,
    workers: int = 1,
    seen: Seen = unseen,
) -> list[Scored]:
    """Score a file of predictions for executions of a dataset; those without a prediction are missing.

    A row has `predicted`, a program's text, its steps, or steps in words, and says what it is for: `id` (or
    `execution_id`) is an execution's; `program_id` with `home` are all executions of that program there, without `home`
    all that it has. Its reference is the program that the dataset has for the execution, bound as there, and it runs in
    the same environment. Rows of executions outside the part are not looked at.

    Args:
        dataset: with the references.
        file: JSON Lines or Parquet.
        split: a split of the dataset, or "" for all executions.
        part: of the split; one that begins so counts (`test` is all tests).
        options: how to score; each execution's own rules are used.
        workers: processes; the scores are the same for any number.
        seen: told how many shares of them are scored.

    Returns:
        the scores by id; worlds are not kept.

    Raises:
        HearthError: what `read_pairs` raises; UNKNOWN_ID where the dataset has no such split or part.
    """
    opened.cache_clear()
    wanted = chosen(dataset, split, part)
    known: dict[str, tuple[Step, ...]] = dict.fromkeys(chosen(dataset), ())
    named = _named(dataset)
    predicted = {pair.id: pair for pair in read_pairs(file, known, partial(read_line, dataset.knowledge), named)}
    return _in_shares(dataset, [predicted[name] for name in wanted], options, workers, seen)


def judge_steps(
    dataset: Dataset, predicted: Iterable[tuple[str, tuple[Step, ...]]], options: Options | None = None
) -> list[Scored]:
    """Score programs for executions of a dataset, each with its execution's id, in order; as `judge`, in this process.

    Those of one execution should stand together: it is then read and run once.
    """
    return _in_shares(dataset, [Pair(name, steps, ()) for name, steps in predicted], options, 1, unseen)


def _in_shares(dataset: Dataset, pairs: list[Pair], options: Options | None, workers: int, seen: Seen) -> list[Scored]:
    shares = [pairs[start : start + PART] for start in range(0, len(pairs), PART)]
    jobs: list[Job] = [(str(dataset.folder), share, options or Options()) for share in shares]
    return [each for done in spread(_judged, jobs, workers, seen) for each in done]


def _judged(job: Job) -> list[Scored]:
    folder, pairs, options = job
    dataset, homes = opened(folder)
    cases = {case["execution_id"]: case for case in stored_cases(dataset, list({pair.id for pair in pairs}))}
    filled = [_filled(pair, cases[pair.id]) for pair in pairs]
    every = zip(filled, lcs_of(filled, options.instances), strict=True)
    groups = groupby(every, key=lambda each: each[0].id)
    return [each for name, group in groups for each in _scored(cases[name], list(group), homes, options)]


def _scored(
    case: StoredCaseRow, pairs: Sequence[tuple[Pair, LcsScore]], homes: Source, options: Options
) -> Iterator[Scored]:
    """The scores of an execution's predictions, given with their LCS."""
    world, options = start_of(case["environment"], case["home"], homes), replace(options, rules=RULES[case["rules"]])
    program = Program(steps=steps_of(pairs[0][0].reference))
    # To read and to apply the ticks that are stored takes four times as long as to run the program again.
    ran = run(world, program, options.rules)
    reference = Reference.of(program, world, ran.final if ran.executable else None)
    for pair, lcs in pairs:
        each = scored(pair, lcs, world.home.knowledge, world, options, reference)
        # A world holds its whole home: of thousands only what became of them is kept.
        yield replace(each, execution=each.execution and replace(each.execution, final=None))


def _filled(pair: Pair, case: StoredCaseRow) -> Pair:
    """A pair with its reference, and the fields it can be grouped by."""
    steps = program_of(case, bindings_of(case["bindings"])).steps
    return replace(pair, reference=steps, more={**pair.more, "activity": case["activity_id"], "home": case["home"]})


def _named(dataset: Dataset) -> Named:
    """Which executions a row without `id` is about."""
    of_program: dict[str, list[str]] = {}
    there: dict[tuple[str, str], list[str]] = {}
    query = "SELECT execution_id, program_id, home FROM executions WHERE executable ORDER BY 1"
    for execution_id, program_id, home in dataset.rows(query)[1]:
        of_program.setdefault(program_id, []).append(execution_id)
        there.setdefault((program_id, home), []).append(execution_id)

    def named(values: Mapping[str, Any]) -> Sequence[str]:
        if "execution_id" in values:
            return [str(values["execution_id"])]
        if "program_id" not in values:
            return []
        program, home = str(values["program_id"]), values.get("home")
        if home is None:
            return of_program.get(program) or [program]
        return there.get((program, str(home))) or [f"{program} in {home}"]

    return named


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


def read_line(knowledge: Knowledge, line: str) -> tuple[Step, ...] | Diagnostic:
    """A line of a program, or a step in words: `2. Put the cup on the table`."""
    parsed = parse_steps(line)
    if not isinstance(parsed, Diagnostic):
        return parsed
    said = line.lstrip("0123456789.:) ").strip() if line[:1].isdigit() else line.partition(":")[2] or line
    meant = understand(knowledge, said).meant if said else None
    if meant is None:
        return parsed
    return (Step(meant.action.name, tuple(ObjectRef(name) for name in meant.names)),)
