"""`verify`: checks a dataset against its manifest, and runs its executions again."""

import sys
from pathlib import Path

from hearth.commands import output
from hearth.commands.time_limits import WITHIN


def verify(
    dataset: Path, workers: int = 0, strict: bool = False, as_json: bool = False, within: float = WITHIN
) -> None:
    """Check a dataset: hashes, columns, counts, references, and a replay of every execution.

    The status is 1 if there is a fault; each is printed with its file. The catalog is made again and compared. Files
    that the manifest does not name are warned of; with --strict they are faults.

    \b
    Example:
      hearth verify data_out
    """
    from hearth.commands.bounded_process import in_time
    from hearth.commands.progress_line import bar
    from hearth.datasets.verify import verify as checked

    with in_time(within), bar("shares run again") as seen:
        found = checked(dataset, workers, seen)
    if not as_json:
        if found.note:
            output.line(f"Note: {found.note}", file=sys.stderr)
        output.report(found.faults)
        output.report(found.unknown, kind="error" if strict else "warning")
    faults = (*found.faults, *(found.unknown if strict else ()))
    ran = f"{output.counted(found.executions, 'execution')} run again"
    checked_parts = f"{output.counted(found.files, 'file')}, {output.counted(found.rows, 'row')}, {ran}"
    result = output.counted(len(faults), "fault") if faults else "no faults"
    counts = {"files": found.files, "rows": found.rows, "executions": found.executions, "note": found.note}
    document = {**counts, "faults": found.faults, "unknown": found.unknown}
    output.say(f"{checked_parts}: {result}", document, as_json)
    output.status(len(faults), strict=True)
