"""Inputs of `score program`: rows of predictions, or programs in any form that `check` reads."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from hearth.commands import inputs
from hearth.kb.knowledge import Knowledge
from hearth.kb.language.reading_modes import Fuzzy
from hearth.kb.language.recognition_knowledge import recognizing
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.scoring.environments import GRAPH, HOME
from hearth.scoring.line_reader import LineReader, in_order
from hearth.scoring.line_sequences import Line
from hearth.scoring.prediction_rows import has_predictions
from hearth.scoring.predictions import Pair, read_pairs
from hearth.scoring.refused_rows import FirstFaults
from hearth.storage.input_files import placed
from hearth.storage.rejects import Reject

ALL = "all"
"""The value of `--homes` that names all homes of ours."""


def read_predictions(
    file: Path, references: Path | None, known: Knowledge, rejects: FirstFaults, fuzzy: Fuzzy = Fuzzy.TYPOS
) -> list[Pair]:
    """Read predictions, with their references where they have one.

    Raises:
        HearthError: nothing in the file can be scored.
    """
    with placed(file) as path:
        if references or has_predictions(path):
            return read_pairs(path, references, LineReader(known, fuzzy), rejects=rejects, alone=references is None)
        pairs = list(_programs(path, known, inputs.name_of(file), rejects, fuzzy))
    if not pairs:
        raise _nothing(file, rejects)
    return pairs


def in_homes(pairs: Sequence[Pair], names: Sequence[str]) -> list[Pair]:
    """Return each prediction once for each home, whatever environment its row names."""
    return [replace(pair, more={**_unplaced(pair), HOME: name}) for pair in pairs for name in names]


def _unplaced(pair: Pair) -> dict[str, object]:
    return {name: value for name, value in pair.more.items() if name not in (HOME, GRAPH)}


def _programs(path: Path, known: Knowledge, name: str, rejects: FirstFaults, fuzzy: Fuzzy) -> Iterator[Pair]:
    number = 0
    with recognizing(known):
        programs = list(inputs.read_programs(path, known, name, "", fuzzy))
    for found in programs:
        if isinstance(found, Reject) and _is_blank_plan(found):
            number += 1
            yield Pair(str(number), (), (), found.diagnostics[0].line, {}, referenced=False)
        elif isinstance(found, Reject):
            rejects.reject(found.diagnostics)
        elif not found.program.steps and all(fault.code is Code.EMPTY for fault in found.faults):
            rejects.reject(found.faults)
        else:
            number += 1
            first = min((*found.program.lines, *(fault.line for fault in found.faults)), default=0)
            more = {"title": found.program.title}
            fuzzy_steps = sum(each.code is Code.FUZZY_MATCH for each in found.warnings)
            yield Pair(str(number), _lines(found), (), first, more, referenced=False, fuzzy=fuzzy_steps)


def _is_blank_plan(reject: Reject) -> bool:
    """Return whether a record has a field for its plan and nothing in it, which scores as an empty prediction."""
    return any(fault.code is Code.EMPTY and fault.found for fault in reject.diagnostics)


def _lines(given: inputs.Given) -> tuple[Line, ...]:
    """Return the lines of a program in order: its steps, and those that are refused with their codes."""
    return in_order(given.program.steps, given.program.lines, given.faults)


def _nothing(file: Path, rejects: FirstFaults) -> HearthError:
    if rejects:
        return HearthError(rejects)
    return HearthError.of(Code.EMPTY, "no program in it", file=str(file), suggestion="write one step a line")
