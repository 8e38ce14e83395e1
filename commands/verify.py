"""`verify`: checks a dataset against its manifest, and runs its executions again."""

from __future__ import annotations

import sys

from hearth.commands import options, output


def verify(dataset: options.Dataset, workers: options.Workers = 0, as_json: options.Json = False) -> None:
    """Check a dataset: hashes, columns, counts, references, and a replay of every execution.

    The status is 1 if there is a fault; each is printed with its file.

    \b
    Example:
      python cli.py verify data_out
    """
    from hearth.commands.progress_line import bar
    from hearth.datasets.verify import verify as checked

    with bar("shares run again") as seen:
        found = checked(dataset, workers, seen)
    if not as_json:
        if found.note:
            print(f"Note: {found.note}", file=sys.stderr)
        output.report(found.faults)
    ran = f"{output.counted(found.executions, 'execution')} run again"
    checked_parts = f"{output.counted(found.files, 'file')}, {output.counted(found.rows, 'row')}, {ran}"
    result = output.counted(len(found.faults), "fault") if found.faults else "no faults"
    counts = {"files": found.files, "rows": found.rows, "executions": found.executions}
    output.say(f"{checked_parts}: {result}", {**counts, "note": found.note, "faults": found.faults}, as_json)
    output.status(len(found.faults), strict=True)
