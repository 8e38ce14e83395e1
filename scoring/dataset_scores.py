"""Predictions scored against a dataset: its programs are the references, its environments where they run."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import groupby
from pathlib import Path
from typing import Any

from hearth.datasets.damage_faults import using
from hearth.datasets.dataset import Dataset
from hearth.datasets.format.case_rows import Source, start_of
from hearth.datasets.format.row_conversion import bindings_of, program_of
from hearth.datasets.format.stored_cases import StoredCaseRow, stored_cases
from hearth.datasets.verify import opened
from hearth.kb.language.reading_modes import Fuzzy
from hearth.kb.language.recognition_knowledge import recognizing
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import Program, Step
from hearth.scoring.evaluate import GOALS, BothLcs, Options, Reference, lcs_of, note_goal, scored
from hearth.scoring.line_reader import LineReader
from hearth.scoring.line_sequences import steps_of
from hearth.scoring.prediction_rows import Named
from hearth.scoring.prediction_scores import Scored
from hearth.scoring.predictions import Pair, read_pairs
from hearth.scoring.refused_rows import FirstFaults
from hearth.simulation.engine import run
from hearth.simulation.rules import RULES
from hearth.storage.parallel import Seen, spread, unseen

PART = 250
"""References in memory at a time, the unit of a worker's work."""

_ID = "execution_id::VARCHAR AS execution_id"
"""The id as text: a stranger's table may have ids of another type, which no reference has."""

Job = tuple[str, list[Pair], Options]
"""A dataset's folder, pairs without their references, and how to score them."""


def score_dataset(
    dataset: Dataset,
    file: Path,
    split: str = "",
    part: str = "",
    options: Options | None = None,
    workers: int = 1,
    seen: Seen = unseen,
    *,
    only_given: bool = False,
    originals: bool = False,
    fuzzy: Fuzzy = Fuzzy.TYPOS,
    rejects: FirstFaults | None = None,
) -> list[Scored]:
    """Score a file of predictions for executions of a dataset; those without a prediction are missing.

    A row has `predicted`, a program's text, its steps, or natural-language steps. `id` (or `execution_id`) names the
    execution; `program_id` with `home` stands for all executions of that program there, without `home` for all of its
    executions. The reference is the execution's program in the dataset, bound as there; the prediction runs in the same
    environment. Rows of executions outside the part are ignored.

    Args:
        dataset: with the references.
        file: JSON Lines or Parquet.
        split: a split of the dataset, or "" for all executions.
        part: prefix of the split's parts (`test` is all tests).
        options: how to score; each execution's own rules are used.
        workers: number of processes; the scores do not depend on it.
        seen: reports progress.
        only_given: leave out executions without a prediction.
        originals: leave out executions of augmented programs.
        fuzzy: how far a natural-language step may be from one that is known.
        rejects: gets the faults of rows, which are left out; without it they are raised.

    Returns:
        The scores by id, without worlds.

    Raises:
        HearthError: errors of `read_pairs` and of `chosen`.
    """
    wanted = chosen(dataset, split, part, originals)
    predicted = {pair.id: pair for pair in _read(dataset, file, rejects, fuzzy)}
    pairs = [predicted[name] for name in wanted if predicted[name].line or not only_given]
    if not pairs:
        message = "no prediction is of an execution that is asked for"
        suggestion = f"ids are those of the part's executions, as `{wanted[0]}`"
        raise HearthError.of(Code.EMPTY, message, file=str(file), suggestion=suggestion)
    found = _in_shares(dataset, pairs, options, workers, seen)
    for each in found:
        note_goal(each, rejects)
    return found


def score_given(
    dataset: Dataset, file: Path, options: Options | None = None, workers: int = 1, seen: Seen = unseen
) -> list[Scored]:
    """Score a file of predictions as `score_dataset`, but only the executions that it names."""
    return _in_shares(dataset, [pair for pair in _read(dataset, file) if pair.line], options, workers, seen)


def _read(dataset: Dataset, file: Path, rejects: FirstFaults | None = None, fuzzy: Fuzzy = Fuzzy.TYPOS) -> list[Pair]:
    """Return a pair for each execution of a dataset; `line` is 0 where the file lacks it."""
    opened.cache_clear()
    known: dict[str, tuple[Step, ...]] = dict.fromkeys(_every(dataset), ())
    with recognizing(dataset.knowledge):
        return read_pairs(file, known, LineReader(dataset.knowledge, fuzzy), _named(dataset), rejects)


def score_steps(
    dataset: Dataset, predicted: Iterable[tuple[str, tuple[Step, ...]]], options: Options | None = None
) -> list[Scored]:
    """Score (execution id, program) pairs in order, as `score_dataset`, in this process.

    Pairs of one execution should be adjacent: it is then read and run once.
    """
    return _in_shares(dataset, [Pair(name, steps, ()) for name, steps in predicted], options, 1, unseen)


def _in_shares(dataset: Dataset, pairs: list[Pair], options: Options | None, workers: int, seen: Seen) -> list[Scored]:
    shares = [pairs[start : start + PART] for start in range(0, len(pairs), PART)]
    jobs: list[Job] = [(str(dataset.folder), share, options or Options()) for share in shares]
    return [each for done in spread(_scored_share, jobs, workers, seen) for each in done]


def _scored_share(job: Job) -> list[Scored]:
    folder, pairs, options = job
    dataset, homes = opened(folder)
    cases = {
        case["execution_id"]: case for case in stored_cases(dataset, list(dict.fromkeys(pair.id for pair in pairs)))
    }
    if missing := sorted({pair.id for pair in pairs} - cases.keys()):
        message = f"the statistics of its file say that it has no such id: {missing[0]}"
        raise HearthError.of(Code.DAMAGED_FILE, message, file=str(dataset.folder / "executions"))
    filled = [_filled(pair, cases[pair.id]) for pair in pairs]
    with using(folder):
        every = zip(filled, lcs_of(filled, options.instances), strict=True)
    groups = groupby(every, key=lambda each: each[0].id)
    return [each for name, group in groups for each in _scored(cases[name], list(group), homes, options)]


def _scored(
    case: StoredCaseRow, pairs: Sequence[tuple[Pair, BothLcs]], homes: Source, options: Options
) -> Iterator[Scored]:
    """Yield the scores of an execution's predictions, given with their LCS."""
    with using(f"execution {case['execution_id']}"):
        world = start_of(case["environment"], case["home"], homes)
        options = replace(options, rules=RULES[case["rules"]])
        program = Program(steps=steps_of(pairs[0][0].reference))
        # Reading and applying the stored ticks takes four times as long as running the program again.
        ran = run(world, program, options.rules)
        reference = Reference.of(program, world, ran.final if ran.executable else None)
    for pair, lcs in pairs:
        each = scored(pair, lcs, world.home.knowledge, world, options, reference)
        # A world references its whole home: worlds are dropped, only scores are kept.
        yield replace(each, execution=each.execution and replace(each.execution, final=None))


def _filled(pair: Pair, case: StoredCaseRow) -> Pair:
    """Return a pair with its reference, and the fields for grouping, without a goal that its row brings along."""
    with using(f"execution {case['execution_id']}"):
        steps = program_of(case, bindings_of(case["bindings"])).steps
    given = {name: value for name, value in pair.more.items() if name not in GOALS}
    return replace(pair, reference=steps, more={**given, "activity": case["activity_id"], "home": case["home"]})


def _named(dataset: Dataset) -> Named:
    """Return a function from a row without `id` to its executions."""
    of_program: dict[str, list[str]] = {}
    there: dict[tuple[str, str], list[str]] = {}
    query = f"SELECT {_ID}, program_id::VARCHAR, home::VARCHAR FROM executions WHERE {dataset.included} ORDER BY 1"
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


def _every(dataset: Dataset) -> list[str]:
    return [name for (name,) in dataset.rows(f"SELECT {_ID} FROM executions")[1]]


def chosen(dataset: Dataset, split: str = "", part: str = "", originals: bool = False) -> list[str]:
    """Return the ids of the executions in a part of a split, sorted; without a split, of all that the dataset includes.

    Args:
        dataset: with the executions.
        split: of the dataset; "" for none.
        part: prefix of the split's parts.
        originals: leave out executions of augmented programs.

    Raises:
        HearthError: UNKNOWN_ID, with the existing parts; BAD_ARGUMENT, for a part without a split.
    """
    if part and not split:
        message = f"the part `{part}` without its split"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="name the split that has it")
    only = _ORIGINALS if originals else ""
    if not split:
        query = f"SELECT {_ID} FROM executions {only} WHERE {dataset.included} ORDER BY 1"
        return [name for (name,) in dataset.rows(query)[1]]
    query = f"""SELECT {_ID} FROM splits SEMI JOIN (SELECT execution_id FROM executions {only} WHERE executable)
        USING (execution_id) WHERE split = $split AND starts_with(part, $part) ORDER BY 1"""
    found = [name for (name,) in dataset.rows(query, split=split, part=part)[1]]
    if not found:
        there = dataset.rows("SELECT DISTINCT split || ' ' || part FROM splits WHERE part IS NOT NULL ORDER BY 1")[1]
        message = f"no executions in part `{part}` of split `{split}`"
        suggestion = f"there are {', '.join(name for (name,) in there)}"
        raise HearthError.of(Code.UNKNOWN_ID, message, file=str(dataset.folder), suggestion=suggestion)
    return found


_ORIGINALS = "SEMI JOIN (SELECT program_id FROM programs WHERE parent_id IS NULL) USING (program_id)"
