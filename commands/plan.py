"""`plan`: solves a dataset's problems with a planner and runs the plans in the engine."""

from pathlib import Path

from hearth.commands import output


def plan(dataset: Path, problems: int = 200, workers: int = 0, as_json: bool = False) -> None:
    """Solve planning problems of a dataset with Fast Downward, and run the plans in the engine.

    Problems are those of `export --format pddl`, spread over the executions of the dataset. Each is read by
    unified-planning and solved. The plan is run as steps in the execution's environment and must reach its goal. The
    status is 1 if a plan does not. Needs unified-planning and up-fast-downward; a problem takes a few seconds.

    \b
    Example:
      hearth plan data_out --problems 20
    """
    from hearth.analysis.planner_agreement import agreement
    from hearth.commands.progress_line import bar
    from hearth.datasets.dataset import Dataset

    with bar("problems") as seen:
        found = agreement(Dataset.open(dataset), problems, workers, seen)
    if as_json:
        output.emit(found)
    else:
        rows = [["problems read", found.problems], ["solved", found.solved], ["plans that run", found.ran]]
        output.table(["what", "number"], [*rows, ["plans that reach the goal", found.reached], *found.statuses.items()])
        things = f"{found.objects[0]:.1f} of {found.objects[1]:.0f} things in a problem"
        output.line(f"\n{things}; {found.steps:.1f} steps in a plan")
        for line in found.disagreements:
            output.line(line)
    output.status(len(found.disagreements), strict=True)
