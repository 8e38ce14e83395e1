"""`release`: the original release's layout, readable by code written for it and by `ingest`."""

from pathlib import Path
from typing import Any

import orjson

from hearth.datasets.dataset import OWN, Dataset
from hearth.datasets.export.program_batches import Wanted, programs, runs, write
from hearth.datasets.format.row_conversion import program_of
from hearth.datasets.published_program import Run
from hearth.schemas.graph import to_release
from hearth.schemas.program import Program
from hearth.schemas.syntax import print_object, print_program
from hearth.storage.names import file_name, inside, leaves

ROOT = "programs_processed_precond_nograb_morepreconds"


def release(dataset: Dataset, to: Path, wanted: Wanted) -> int:
    """Programs as collected, their preconditions, grounded programs, and initial and final graphs.

    A program of the release keeps its path; another is in a batch named by its origin. A program has one environment a
    home: originals in perturbed ones are not written.

    Returns:
        Number of executions.
    """
    root = to / ROOT
    for row in programs(dataset, wanted):
        place = inside(root / "withoutconds", f"{stem(row['program_id'])}.txt")
        write(place, print_program(program_of(row)).encode())
    number = 0
    for number, (row, run) in enumerate(runs(dataset, wanted, OWN), 1):  # noqa: B007 - the last number is the count
        name, home = stem(row["program_id"]), file_name(run.home)
        grounded = print_grounded(program_of(row, run.bindings()))
        write(inside(root / "executable_programs", f"{home}/{name}.txt"), grounded.encode())
        graphs = {"init_graph": to_release(run.start), "final_graph": to_release(run.final)}
        write(inside(root / "init_and_final_graphs", f"{home}/{name}.json"), orjson.dumps(graphs))
        write(inside(root / "initstate", f"{name}.json"), orjson.dumps(_conditions(run)))
    return number


def stem(program_id: str) -> str:
    """`release:batch-1/file1_1` -> `batch-1/file1_1`; `crowd:P1` -> `crowd/P1_1`."""
    origin, _, rest = program_id.partition(":")
    if origin == "release" and "+" not in rest and not leaves(rest) and rest.isprintable() and rest.strip("./"):
        return rest
    return f"{file_name(origin)}/{file_name(rest)}_1"


def print_grounded(program: Program) -> str:
    """Return a bound program in the release's format: actions in capitals, `(1.41)` for a bound object."""
    head = f"{program.title}\n{program.description}\n\n\n"
    lines = []
    for number, step in enumerate(program.steps):
        text = " ".join((f"[{step.action.upper()}]", *map(print_object, step.objects)))
        lines.append(f" | {text}" if step.joins and number else f"\n{text}" if number else text)
    return f"{head}{''.join(lines)}\n"


def _conditions(run: Run) -> list[dict[str, Any]]:
    rows = []
    for condition in run.conditions:
        objects = [[ref["name"], str(ref["instance"])] for ref in condition["objects"]]
        rows.append({condition["name"]: objects[0] if len(objects) == 1 else objects})
    return rows
