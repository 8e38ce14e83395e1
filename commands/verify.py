"""`verify`: is a dataset what it says it is?"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from hearth.commands import output

Folder = Annotated[Path, typer.Argument(metavar="DATASET", help="A build's folder, or the dataset inside it.")]

Workers = Annotated[int, typer.Option("--workers", "-j", metavar="N", min=0, help="Processes; 0: one a core.")]


def verify(dataset: Folder, workers: Workers = 0, as_json: output.Json = False) -> None:
    """Check a dataset: hashes, columns, counts, references, and every execution run again from what is on disk.

    Exit status 1 where anything is wrong, each fault with its file.

    \b
    Example:
      python cli.py verify data_out
    """
    import os

    from hearth.commands.waiting import bar
    from hearth.pipelines.verify import verify as checked

    with bar("shares run again") as seen:
        found = checked(dataset, workers or os.cpu_count() or 1, seen)
    if found.note and not as_json:
        print(f"Note: {found.note}", file=sys.stderr)
    if as_json:
        told = {"files": found.files, "rows": found.rows, "executions": found.executions}
        faults = [output.diagnostic_json(fault) for fault in found.faults]
        output.emit({**told, "note": found.note, "faults": faults})
    else:
        output.report(found.faults)
        ran = f"{output.counted(found.executions, 'execution')} run again"
        said = f"{output.counted(found.files, 'file')}, {output.counted(found.rows, 'row')}, {ran}"
        print(f"{said}: {output.counted(len(found.faults), 'fault')}" if found.faults else f"{said}: all as it says")
    output.status(len(found.faults), strict=True)
