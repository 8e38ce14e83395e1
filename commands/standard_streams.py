"""The standard streams of the process: one that a caller has closed is refused or opened, and a full one is said."""

import os
import sys
from typing import NoReturn

REFUSED = 1
"""The exit status where nothing can be written."""


def check_streams() -> None:
    """Open the input and the error stream where a caller has closed them; end the process where the output is closed.

    A file that the process opens would otherwise get the descriptor's number, and take what is meant for the stream.
    """
    lost = [number for number in range(3) if _closed(number)]
    for number in lost:
        opened = os.open(os.devnull, os.O_RDWR)
        if opened != number:
            os.dup2(opened, number)
            os.close(opened)
    sys.stdin = sys.stdin or os.fdopen(0, encoding="utf-8", closefd=False)
    sys.stderr = sys.stderr or os.fdopen(2, "w", encoding="utf-8", closefd=False)
    if 1 in lost or sys.stdout is None:
        end_without_output("it is closed")


def _closed(number: int) -> bool:
    try:
        os.fstat(number)
    except OSError:
        return True
    return False


def end_without_output(why: str) -> NoReturn:
    """Say why nothing can be written to the standard output, and end the process: what is left of it is lost."""
    from hearth.commands import output

    try:
        output.note(f"error[UNWRITABLE]: the standard output cannot be written: {why}")
        sys.stderr.flush()
    finally:
        os._exit(REFUSED)
