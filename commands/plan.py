"""`plan`: do a planner and the engine agree on a dataset's problems?"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from hearth.commands import output

Folder = Annotated[Path, typer.Argument(metavar="DATASET", help="A build's folder, or the dataset inside it.")]
Problems = Annotated[
    int, typer.Option("--problems", "-n", metavar="N", min=1, help="How many executions to ask about.")
]
Workers = Annotated[int, typer.Option("--workers", "-j", metavar="N", min=0, help="Processes; 0: one a core.")]


def plan(dataset: Folder, problems: Problems = 200, workers: Workers = 0, as_json: output.Json = False) -> None:
    """Solve planning problems of a dataset with Fast Downward, and run the plans in the engine.

    Problems are those of `export --format pddl`, of executions from all over the dataset. Each is read by
    unified-planning and solved; the plan comes back as steps, is run where the execution began, and must reach its
    goal.
    Ends with status 1 if one does not. Needs unified-planning and up-fast-downward; a problem takes a few seconds.

    \b
    Example:
      python cli.py plan data_out --problems 20
    """
    import os
    from dataclasses import asdict

    from hearth.commands.waiting import bar
    from hearth.exports.planning import agreement
    from hearth.pipelines.dataset import Dataset

    with bar("problems") as seen:
        found = agreement(Dataset.open(dataset), problems, workers or os.cpu_count() or 1, seen)
    if as_json:
        output.emit(asdict(found))
    else:
        rows = [["problems read", found.problems], ["solved", found.solved], ["plans that run", found.ran]]
        output.table(["what", "number"], [*rows, ["plans that reach the goal", found.reached], *found.statuses.items()])
        print(
            f"\n{found.objects[0]:.1f} of {found.objects[1]:.0f} things in a problem; {found.steps:.1f} steps in a plan"
        )
        for line in found.disagreements:
            print(line)
    if found.disagreements:
        raise typer.Exit(output.BAD_INPUT)
