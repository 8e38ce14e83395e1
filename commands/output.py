"""Output of commands: tables, JSON, faults with their source underlined; and exit statuses."""

import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from math import isnan
from pathlib import Path
from typing import Any, TextIO

import typer

from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.terminal import shown as shown  # noqa: PLC0414 - commands take it from here
from hearth.schemas.terminal import shown_json

OK = 0
"""Done; rejected records are reported, not fatal."""

BAD_INPUT = 1
"""Something could not be read or run, or, with `--strict`, something was rejected."""

USAGE = 2
"""The command line itself is wrong (typer's own status)."""

_RED, _BLUE, _BOLD, _RESET = "\x1b[31m", "\x1b[34m", "\x1b[1m", "\x1b[0m"
_SHOWN = 100
_AROUND = 40


def status(rejected: int, *, strict: bool) -> None:
    """End the command with status 1 if something was rejected and `strict` is True; otherwise return."""
    if strict and rejected:
        raise typer.Exit(BAD_INPUT)


def emit(value: Any) -> None:
    """Print one JSON document: keys in the given order, dataclasses and paths converted, a line break at the end."""
    sys.stdout.write(_document(value))
    sys.stdout.flush()


def write(file: Path, value: Any) -> None:
    """Write the output of `emit` into a file."""
    from hearth.storage.chosen_files import write as write_chosen

    file.parent.mkdir(parents=True, exist_ok=True)
    write_chosen(file, _document(value).encode())


def _document(value: Any) -> str:
    """Return the JSON text of a value: no character in it moves the cursor of a terminal, nor turns text around."""
    import orjson

    options = orjson.OPT_INDENT_2 | orjson.OPT_APPEND_NEWLINE | orjson.OPT_NON_STR_KEYS | orjson.OPT_SERIALIZE_NUMPY
    try:
        data = orjson.dumps(value, default=_plain, option=options)
    except orjson.JSONEncodeError as error:
        if "surrogates" not in str(error):
            raise
        data = orjson.dumps(_with_escapes(value), default=_plain, option=options)
    return shown_json(data.decode())


def _with_escapes(value: Any) -> Any:
    """Return a value whose texts can be UTF-8: bytes of a file's name that are none become `\\udcff`, as in `line`."""
    if isinstance(value, (str, Path)):
        return str(value).encode("utf-8", "backslashreplace").decode()
    if is_dataclass(value) and not isinstance(value, type):
        value = {each.name: getattr(value, each.name) for each in fields(value) if not each.name.startswith("_")}
    elif not isinstance(value, (Mapping, list)):
        try:
            value = _plain(value)
        except TypeError:
            return value
    if isinstance(value, Mapping):
        return {_with_escapes(name): _with_escapes(each) for name, each in value.items()}
    return [_with_escapes(each) for each in value] if isinstance(value, list) else value


def line(*values: object, sep: str = " ", end: str = "\n", file: TextIO | None = None, flush: bool = False) -> None:
    """Print values as `print` does, safe for a terminal: the way of all text of commands that is not a table."""
    print(shown(sep.join(map(str, values))), end=end, file=file, flush=flush)


def _plain(value: Any) -> Any:
    if isinstance(value, Path):
        return str(value)
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, (set, frozenset)):
        return sorted(value)
    if isinstance(value, tuple) and hasattr(value, "_asdict"):
        return value._asdict()
    if isinstance(value, tuple):
        return list(value)
    raise TypeError(f"{type(value).__name__} has no JSON form")


def say(text: str, document: Any, as_json: bool) -> None:
    """Print a text, or the same as a JSON document."""
    emit(document) if as_json else line(text)


def note(text: str) -> None:
    """Print information about the work itself, apart from its result."""
    line(text, file=sys.stderr)


def records(rows: Sequence[Mapping[str, Any]], title: str = "") -> None:
    """Print rows as a table with their keys as columns."""
    if rows:
        table(tuple(rows[0]), [tuple(row.values()) for row in rows], title)


def figures(values: Mapping[str, Any]) -> None:
    """Print values by their names, one a line."""
    table(("figure", "value"), [(name.replace("_", " "), value) for name, value in values.items()])


def table(columns: Sequence[str], rows: Iterable[Sequence[Any]], title: str = "") -> None:
    """Print a table: drawn by rich on a terminal, plain aligned columns elsewhere. Numbers are right-aligned."""
    columns, cells = [shown(name) for name in columns], [[_text(cell) for cell in row] for row in rows]
    numeric = [_is_numeric(row[number] for row in cells) for number in range(len(columns))]
    if sys.stdout.isatty():
        _rich_table(columns, cells, numeric, title)
        return
    if title:
        line(title)
    widths = [max(map(len, column)) for column in zip(columns, *cells, strict=True)]
    for row in [list(columns), *cells]:
        parts = (_aligned(cell, width, right) for cell, width, right in zip(row, widths, numeric, strict=True))
        print("  ".join(parts).rstrip())


def _rich_table(columns: Sequence[str], rows: list[list[str]], numeric: list[bool], title: str) -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    drawn = Table(title=shown(title) or None, title_justify="left", header_style="bold")
    for name, right in zip(columns, numeric, strict=True):
        drawn.add_column(name, justify="right" if right else "left", overflow="fold")
    for row in rows:
        drawn.add_row(*map(Text, row))
    Console().print(drawn)


def _text(cell: Any) -> str:
    if cell is None or (isinstance(cell, float) and isnan(cell)):
        return ""
    if isinstance(cell, bool):
        return "yes" if cell else "no"
    if isinstance(cell, int):
        return f"{cell:,}"
    if isinstance(cell, float):
        return "" if isnan(cell) else f"{cell:,.3f}"  # not a number: there was nothing to compare
    return shown(str(cell))


def _is_numeric(cells: Iterable[str]) -> bool:
    shown = [cell.replace(",", "").replace(".", "").lstrip("-") for cell in cells if cell]
    return bool(shown) and all(cell.isdigit() for cell in shown)


def _aligned(cell: str, width: int, right: bool) -> str:
    return cell.rjust(width) if right else cell.ljust(width)


def report(faults: Iterable[Diagnostic], stream: TextIO | None = None, kind: str = "error") -> None:
    """Print faults as a compiler does: code, place, the line, and the words at fault underlined."""
    out = stream or sys.stderr
    colour = out.isatty()
    for fault in faults:
        print(explain(fault, colour=colour, kind=kind), file=out)


def explain(fault: Diagnostic, *, colour: bool = False, kind: str = "error") -> str:
    """One fault as text of several lines.

    error[UNKNOWN_OBJECT]: no object is called `televison`
      --> watch.txt:5:9
        |
      5 | [Watch] <televison> (1)
        |         ^^^^^^^^^^^ did you mean `television`?
    """
    red, blue, bold, reset = (_RED, _BLUE, _BOLD, _RESET) if colour else ("", "", "", "")
    lines = [f"{red}{kind}[{fault.code}]{reset}: {bold}{_one_line(shown(fault.message))}{reset}"]
    pad = " " * max(3, len(str(fault.line or "")))
    if fault.place():
        lines.append(f"{pad}{blue}-->{reset} {shown(fault.place())}")
    if fault.source and fault.line:
        source, column = _window(fault.source, max(1, fault.column - fault.before))
        lines.append(f"{pad} {blue}|{reset}")
        lines.append(f"{blue}{fault.line:>{len(pad)}} |{reset} {source}")
        marks = _underline(source, column, fault.length)
        lines.append(f"{pad} {blue}|{reset} {red}{marks}{reset} {shown(fault.suggestion)}".rstrip())
    elif fault.suggestion:
        lines.append(f"{pad} {blue}={reset} {shown(fault.suggestion)}")
    return "\n".join(lines)


def _one_line(message: str) -> str:
    return " ".join(message.split())


def _window(source: str, column: int) -> tuple[str, int]:
    """Return the part of a long line around `column` (from 1), and the column within it."""
    shown = "".join(char if char.isprintable() else " " for char in source)
    start = column - 1 - _AROUND if column - 1 > _SHOWN - _AROUND else 0
    start = max(0, start)
    return shown[start : start + _SHOWN], max(1, column - start)


def _underline(source: str, column: int, length: int) -> str:
    marks = "^" * max(1, _cells(source[column - 1 : column - 1 + length]))
    return " " * _cells(source[: column - 1]) + marks


def _cells(text: str) -> int:
    """Terminal columns of a text: wide East Asian characters take two, combining marks none."""
    import unicodedata

    wide = sum(unicodedata.east_asian_width(char) in "WF" for char in text)
    return len(text) + wide - sum(unicodedata.combining(char) > 0 for char in text)


def counted(number: int, noun: str) -> str:
    """`1 file`, `2,300 files`."""
    return f"{number:,} {noun}{'' if number == 1 else 's'}"
