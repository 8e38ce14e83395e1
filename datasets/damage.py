"""What reading a damaged dataset raises, as ours."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


@contextmanager
def reading(place: Path | str) -> Iterator[None]:
    """Name the dataset where its tables cannot be read, or hold what no build writes.

    Raises:
        HearthError: DAMAGED_FILE, in place of whatever DuckDB, Arrow or our own reading of the values raised.
    """
    try:
        yield
    except HearthError:
        raise
    except Exception as error:
        raise unreadable(error, place) from error


@contextmanager
def using(place: Path | str) -> Iterator[None]:
    """The same where something is made of rows: faults of the machine, as a full disk, stay what they are.

    Raises:
        HearthError: DAMAGED_FILE, in place of what our own use of values raised that no build writes.
    """
    try:
        yield
    except (HearthError, OSError, MemoryError):
        raise
    except Exception as error:
        raise unreadable(error, place) from error


def unreadable(error: Exception, place: Path | str) -> HearthError:
    """What is said of a dataset whose tables cannot be read."""
    said = str(error).split("\n", 1)[0]
    message = f"its tables cannot be read: {type(error).__name__} {said}"
    remedy = "`verify` names the files that are damaged; fetch or publish the dataset again"
    return HearthError.of(Code.DAMAGED_FILE, message, file=str(place), suggestion=remedy)


def refused_question(error: Exception, folder: Path) -> HearthError:
    """What is said of a question that DuckDB did not answer: it, or a table of the folder, is at fault."""
    message = str(error).split("\n\n", 1)[0]
    if "arquet" in message and str(folder) in message and type(error).__name__ == "InvalidInputException":
        return unreadable(error, folder)
    return HearthError.of(Code.SYNTAX, message)
