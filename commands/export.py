"""`export`: a published dataset in another form."""

from pathlib import Path

import typer

from hearth.commands import output
from hearth.commands.time_limits import WITHIN


def export(
    dataset: Path,
    out: Path,
    form: str = "",
    program: list[str] | None = None,
    limit: int | None = None,
    failures: bool = False,
    as_json: bool = False,
    within: float = WITHIN,
) -> None:
    """Write a published dataset in another form.

    Forms: release (the original layout, which `ingest` reads back), nl (natural-language steps, pairs for instruction
    tuning, examples of planning papers), jsonl and csv (every table), code (Python functions, which run), networkx
    (node-link JSON) and graphml (graphs before and after), rdf (Turtle), pddl (a domain, and a problem for each
    execution), coco (pictures, with the mask and the box of every thing in them).

    \b
    Example:
      hearth export data_out --format nl --out words
    """
    from hearth.commands.bounded_process import in_time
    from hearth.datasets.dataset import Dataset
    from hearth.datasets.export.formats import COUNTED, FORMATS
    from hearth.datasets.export.formats import export as exported
    from hearth.datasets.export.program_batches import Wanted

    if not form:
        raise typer.BadParameter(f"choose a form: {', '.join(FORMATS)}", param_hint="--format")
    with in_time(within):
        number = exported(Dataset.open(dataset, failures), form, out, Wanted(tuple(program or ()), limit))
    text = f"{output.counted(number, COUNTED.get(form, 'program'))} in {out}"
    output.say(text, {"format": form, "out": out, "count": number}, as_json)
