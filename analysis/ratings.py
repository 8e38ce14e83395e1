"""How complete programs are (thesis 3.4.1): estimated from what repairing has to insert, and as people rate it."""

from __future__ import annotations

import csv
import io
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from enum import IntEnum
from pathlib import Path
from statistics import median_low

from hearth.analysis.spreadsheet_cells import cell_said, sheet_of
from hearth.grounding.environments.sampling import sample
from hearth.grounding.preconditions.conditions import Preconditions
from hearth.grounding.preconditions.defaults import default_conditions
from hearth.kb.knowledge import Knowledge
from hearth.repair.loop import repair
from hearth.schemas.decoding import decode
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import Program
from hearth.schemas.syntax import print_lines
from hearth.simulation.world.home import Home
from hearth.storage.inputs import read_input


class Completeness(IntEnum):
    """What raters choose from."""

    COMPLETE = 1
    MINOR = 2
    CRUCIAL = 3


SAID = {
    Completeness.COMPLETE: "complete",
    Completeness.MINOR: "missing minor steps",
    Completeness.CRUCIAL: "missing crucial steps",
}

THESIS = {Completeness.COMPLETE: 0.64, Completeness.MINOR: 0.28, Completeness.CRUCIAL: 0.08}
"""Of 100 programs, by the median of five raters (thesis 3.4.1)."""

COLUMNS = ("program_id", "title", "description", "program", "rater", "rating")
HELP = "1 complete: a robot could do it as written; 2 minor steps are missing (a walk); 3 something crucial is missing"


def estimate(program: Program, home: Home, known: Knowledge, seed: int) -> Completeness | Failure:
    """What a rater would say, from the steps that have to be inserted before the program runs.

    The environment holds what programs rely on by habit and is otherwise at rest, so that a step nobody wrote is
    missed: a television that is watched and was never switched on is off. A program that repairs can't save misses
    something crucial. The failure is that of a home where its objects can't be had at all.
    """
    conditions = Preconditions(tuple(default_conditions(program, known)))
    found = sample(program, home, seed, conditions=conditions, must_run=False)
    if isinstance(found, Failure):
        return found
    environment, _ = found
    repaired = repair(environment.program, environment.world, (), known)
    if repaired.failure is not None:
        return Completeness.CRUCIAL
    came = [step.action for step, source in zip(repaired.program.steps, repaired.sources, strict=True) if source < 0]
    if not came:
        return Completeness.COMPLETE
    return Completeness.MINOR if known.group("unsaid").issuperset(came) else Completeness.CRUCIAL


def sheet(programs: Sequence[tuple[str, Program]], raters: int) -> str:
    """A CSV to be filled in: each program once a rater, the column `rating` left empty."""
    rows: list[tuple[object, ...]] = [(*COLUMNS[:-1], f"rating ({HELP})")]
    for rater in range(1, raters + 1):
        for program_id, program in programs:
            steps = "\n".join(print_lines(program))
            rows.append((program_id, program.title, program.description, steps, f"rater {rater}", ""))
    return sheet_of(rows)


def read_sheets(paths: Iterable[Path]) -> dict[str, list[Completeness]]:
    """The answers by program; rows that nobody filled in are left out.

    Raises:
        HearthError: every row whose rating is not 1, 2 or 3, and every table without the columns.
    """
    found: dict[str, list[Completeness]] = defaultdict(list)
    faults: list[Diagnostic] = []
    for path in paths:
        text = decode(read_input(path), str(path))
        if isinstance(text, Diagnostic):
            faults.append(text)
            continue
        delimiter = max(",;\t", key=text.partition("\n")[0].count)
        rows = csv.DictReader(io.StringIO(text, newline=""), delimiter=delimiter, restval="")
        names = rows.fieldnames or []
        column = next((name for name in names if name.startswith("rating")), None)
        if column is None or "program_id" not in names:
            missing = "rating" if column is None else "program_id"
            faults.append(Diagnostic(Code.BAD_TABLE, f"the table lacks the column `{missing}`", str(path), 1))
            continue
        for row in rows:
            answer = (row[column] or "").strip()
            if answer in ("1", "2", "3"):
                found[cell_said(row["program_id"])].append(Completeness(int(answer)))
            elif answer:
                message = f"`{answer[:40]}` is no rating"
                faults.append(Diagnostic(Code.BAD_TABLE, message, str(path), rows.line_num, suggestion="1, 2 or 3"))
    if faults:
        raise HearthError(faults)
    return dict(found)


def medians(ratings: Mapping[str, Sequence[Completeness]]) -> dict[str, Completeness]:
    """The median of each program's ratings; the better of two middle ones."""
    return {name: median_low(given) for name, given in ratings.items() if given}


def shares(classes: Iterable[Completeness]) -> dict[Completeness, float]:
    """The share of each class."""
    counts = Counter(classes)
    total = max(1, counts.total())
    return {each: counts[each] / total for each in Completeness}


def agreement(one: Mapping[str, Completeness], other: Mapping[str, Completeness]) -> float:
    """Of the programs that both speak of, the share they agree on; 0 where there are none."""
    both = one.keys() & other.keys()
    return sum(one[name] == other[name] for name in both) / len(both) if both else 0.0
