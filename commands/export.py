"""`export`: a published dataset in another form."""

from pathlib import Path
from typing import Annotated

import typer

from hearth.commands import options, output

Format = Annotated[str, typer.Option("--format", "-f", metavar="FORM", help="release, nl, jsonl, code, networkx, ...")]
Out = Annotated[Path, typer.Option("--out", "-o", metavar="DIR", help="A new or empty folder.")]
Programs = Annotated[
    list[str] | None, typer.Option("--program", metavar="ID", help="Only this one; may be given several times.")
]
Limit = Annotated[int | None, typer.Option("--limit", metavar="N", min=0, help="At most N programs.")]


def export(
    dataset: options.Dataset,
    form: Format,
    out: Out,
    program: Programs = None,
    limit: Limit = None,
    as_json: options.Json = False,
) -> None:
    """Write a published dataset in another form.

    Forms: release (the original layout, which `ingest` reads back), nl (natural-language steps, pairs for instruction
    tuning, examples of planning papers), jsonl (every table), code (Python functions), networkx (node-link JSON) and
    graphml (graphs before and after), rdf (Turtle), pddl (a domain, and a problem for each execution).

    \b
    Example:
      python cli.py export data_out --format nl --out words
    """
    from hearth.datasets.dataset import Dataset
    from hearth.datasets.export.batches import Wanted
    from hearth.datasets.export.formats import COUNTED
    from hearth.datasets.export.formats import export as exported

    number = exported(Dataset.open(dataset), form, out, Wanted(tuple(program or ()), limit))
    text = f"{output.counted(number, COUNTED.get(form, 'program'))} in {out}"
    output.say(text, {"format": form, "out": out, "count": number}, as_json)
