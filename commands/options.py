"""Options and arguments of several commands, each declared once; those of one command are in its file."""

import os
from pathlib import Path
from typing import Annotated

import typer

_HOMES = "A folder of homes laid over ours."


def processes(count: int) -> int:
    """The number of processes: 0 means one for each core."""
    return count or os.cpu_count() or 1


Json = Annotated[bool, typer.Option("--json", help="Print one JSON document for machines instead of text.")]
Strict = Annotated[bool, typer.Option("--strict", help="Exit with status 1 if anything was rejected.")]
Kb = Annotated[Path | None, typer.Option("--kb", metavar="DIR", help="A folder of knowledge laid over ours.")]
Homes = Annotated[Path | None, typer.Option("--homes", metavar="DIR", help=_HOMES)]
HomeName = Annotated[str, typer.Option("--home", metavar="NAME", help="A home of ours, or of --homes.")]
Graph = Annotated[Path | None, typer.Option("--graph", metavar="FILE", help="A scene graph as the release writes it.")]
Seed = Annotated[int, typer.Option("--seed", metavar="N", min=0, help="Seed of all random choices.")]
Limit = Annotated[int | None, typer.Option("--limit", metavar="N", min=1, help="Read at most N programs.")]
Workers = Annotated[
    int, typer.Option("--workers", "-j", metavar="N", min=0, callback=processes, help="Processes; 0: one a core.")
]
Program = Annotated[Path, typer.Argument(metavar="FILE", help="A program file; `-` reads standard input.")]
Source = Annotated[Path, typer.Argument(metavar="SOURCE", help="Programs: a release, a folder or a file.")]
Dataset = Annotated[Path, typer.Argument(metavar="DATASET", help="A build's folder, or the dataset inside it.")]
