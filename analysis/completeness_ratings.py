"""Completeness of programs (thesis 3.4.1): estimated from inserted repair steps, and rated by people."""

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from enum import IntEnum
from pathlib import Path
from statistics import median_low

from hearth.analysis.spreadsheet_cells import original_cell, sheet_of
from hearth.grounding.environments.sampling import sample
from hearth.grounding.preconditions.conditions import Preconditions
from hearth.grounding.preconditions.default_conditions import default_conditions
from hearth.kb.knowledge import Knowledge
from hearth.repair.repair_loop import repair
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import Program
from hearth.schemas.syntax import print_lines
from hearth.simulation.world.home import Home
from hearth.storage.csv_files import CsvTable


class Completeness(IntEnum):
    """Grades of completeness."""

    COMPLETE = 1
    MINOR = 2
    CRUCIAL = 3


SAID = {
    Completeness.COMPLETE: "complete",
    Completeness.MINOR: "missing minor steps",
    Completeness.CRUCIAL: "missing crucial steps",
}

THESIS = {Completeness.COMPLETE: 0.64, Completeness.MINOR: 0.28, Completeness.CRUCIAL: 0.08}
"""Shares of programs by completeness, by the median of five raters (thesis 3.4.1)."""

MOST_FAULTS = 200
"""Rows without a rating that are reported, at most."""

COLUMNS = ("program_id", "title", "description", "program", "rater", "rating")
HELP = "1 complete: a robot could do it as written; 2 minor steps are missing (a walk); 3 something crucial is missing"


def estimate(program: Program, home: Home, known: Knowledge, seed: int) -> Completeness | Failure:
    """Estimate a rating from the steps that repairs insert before the program runs.

    The environment meets the default preconditions and is else in its default state, so that missing steps show: a
    television that is watched but never switched on is off. A program beyond repair misses something crucial. A failure
    is returned if the home can't provide the objects.
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
    """Return a CSV for raters: each program once per rater, with an empty column `rating`."""
    rows: list[tuple[object, ...]] = [(*COLUMNS[:-1], f"rating ({HELP})")]
    for rater in range(1, raters + 1):
        for program_id, program in programs:
            steps = "\n".join(print_lines(program))
            rows.append((program_id, program.title, program.description, steps, f"rater {rater}", ""))
    return sheet_of(rows)


def read_sheets(paths: Iterable[Path]) -> dict[str, list[Completeness]]:
    """Return the ratings by program; rows without a rating are ignored.

    Raises:
        HearthError: every row whose rating is not 1, 2 or 3, up to `MOST_FAULTS`, and every table that can't be read
            or has missing columns.
    """
    found: dict[str, list[Completeness]] = defaultdict(list)
    faults: list[Diagnostic] = []
    for path in paths:
        try:
            for line, (program, given) in CsvTable(path, ("program_id", "rating*")).rows():
                answer = given.strip()
                if answer in ("1", "2", "3"):
                    found[original_cell(program)].append(Completeness(int(answer)))
                elif answer and len(faults) < MOST_FAULTS:
                    message = f"`{answer[:40]}` is not a rating"
                    faults.append(Diagnostic(Code.BAD_TABLE, message, str(path), line, suggestion="1, 2 or 3"))
        except HearthError as error:
            faults += error.diagnostics
    if faults:
        raise HearthError(faults)
    return dict(found)


def medians(ratings: Mapping[str, Sequence[Completeness]]) -> dict[str, Completeness]:
    """Return the median of each program's ratings; of two middle ones the better."""
    return {name: median_low(given) for name, given in ratings.items() if given}


def shares(classes: Iterable[Completeness]) -> dict[Completeness, float]:
    """Return the share of each class."""
    counts = Counter(classes)
    total = max(1, counts.total())
    return {each: counts[each] / total for each in Completeness}


def agreement(one: Mapping[str, Completeness], other: Mapping[str, Completeness]) -> float:
    """Share of equal grades among the programs of both; 0 if there are none."""
    both = one.keys() & other.keys()
    return sum(one[name] == other[name] for name in both) / len(both) if both else 0.0
