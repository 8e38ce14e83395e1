"""Errors of Hearth in place of those that reading a damaged dataset raises."""

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from hearth.kb.spelling import key_of, near_names
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code


@contextmanager
def reading(place: Path | str) -> Iterator[None]:
    """Name the dataset where its tables cannot be read, or hold values that no build writes.

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
    """Name the dataset where a use of its rows fails; faults of the machine, such as a full disk, stay as they are.

    Raises:
        HearthError: DAMAGED_FILE, in place of errors that our own code raises for values that no build writes.
    """
    try:
        yield
    except (HearthError, OSError, MemoryError):
        raise
    except Exception as error:
        raise unreadable(error, place) from error


def unreadable(error: Exception, place: Path | str) -> HearthError:
    """Return the error for a dataset whose tables cannot be read."""
    message = f"its tables cannot be read: {_reason(error)}"
    remedy = "`verify` names the files that are damaged; fetch or publish the dataset again"
    return HearthError.of(Code.DAMAGED_FILE, message, file=str(place), suggestion=remedy)


def _reason(error: Exception) -> str:
    """Return why rows cannot be used; names of Python's errors say nothing to a reader."""
    said = str(error).split("\n", 1)[0]
    if isinstance(error, KeyError | IndexError):
        return f"a row refers to {said}, which is not there" if isinstance(error, KeyError) else "a row is too short"
    if type(error).__module__ == "builtins":
        return f"a value is of another kind ({said})"
    return said


_UNKNOWN = re.compile(
    r"(?i:column) (?:named )?\"?(?P<column>[^\"\s]+)\"?(?: not found|$)"
    r"|(?P<kind>Table|View|[\w ]*Function|Table) with name \"?(?P<name>[^\"\s]+)\"? does not exist"
)
"""Messages of DuckDB for a column, table or function that does not exist."""


_OF_FILES = frozenset({"InvalidInputException", "ConversionException"})
"""Errors of DuckDB that are about a file, where they name one: it is damaged, or its columns have other types."""


def refused_question(error: Exception, folder: Path, names: Mapping[str, Sequence[str]]) -> HearthError:
    """Return the error of a question that DuckDB did not answer: it, or a table of the folder, is at fault.

    Args:
        error: DuckDB's error.
        folder: of the dataset.
        names: of all columns, of all tables and views, and of all functions, by `column`, `table` and `function`.
    """
    message = str(error).split("\n\n", 1)[0]
    if "Required module" in message:
        return _without_form()
    if isinstance(error, MemoryError) or type(error).__name__ == "OutOfMemoryException":
        return too_big(message)
    if "arquet" in message and str(folder) in message and type(error).__name__ in _OF_FILES:
        return unreadable(error, folder)
    unbound = type(error).__name__ in ("BinderException", "CatalogException")
    if unbound and (found := _UNKNOWN.search(message.split("\n", 1)[0].rstrip("!"))):
        return _unknown(found["column"] or found["name"], (found["kind"] or "column").split()[-1].lower(), names)
    return HearthError.of(Code.SYNTAX, message)


def _without_form() -> HearthError:
    """Return the error of values for which DuckDB wants a library that Hearth does without: times with a zone."""
    message, remedy = "a value inside another has a time zone, which answers do not", "cast it: CAST(column AS VARCHAR)"
    return HearthError.of(Code.BAD_ARGUMENT, message, suggestion=remedy)


def too_slow(seconds: float | None) -> HearthError:
    """Return the error of a question that was not answered in time."""
    remedy = "ask for less, or give more time with --within (0: no limit)"
    return HearthError.of(Code.TIMED_OUT, f"the question took longer than {seconds:g} s", suggestion=remedy)


def too_big(message: str) -> HearthError:
    """Return the error of a question whose answer needs more memory or disk than a question may take."""
    said = message.partition("\n")[0]
    remedy = "ask for less: fewer columns, a LIMIT, or a WHERE"
    return HearthError.of(Code.FILE_TOO_LARGE, f"the question needs more memory than it may take: {said}".rstrip(": "),
                          suggestion=remedy)  # fmt: skip


def _unknown(name: str, kind: str, names: Mapping[str, Sequence[str]]) -> HearthError:
    kind = "table" if kind == "view" else kind
    near = near_names(name, {key_of(each): each for each in names.get(kind, ()) if key_of(each) != key_of(name)})
    other = next((each for each, known in names.items() if each != kind and name.lower() in known), "")
    meant = f"did you mean {' or '.join(f'`{each}`' for each in near)}?" if near else ""
    if other:
        meant = f"{meant} `{name.lower()}` is a {other}".strip()
    remedy = meant or "`DESCRIBE programs` prints the columns of a table, `SHOW TABLES` the tables"
    return HearthError(Diagnostic(Code.BAD_ARGUMENT, f"there is no {kind} `{name}`", found=name, suggestion=remedy))
