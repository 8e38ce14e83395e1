"""Reading the knowledge's files: YAML and CSV with the line of every entry, all faults collected.

Both readers return plain data and append a Diagnostic for each fault, so that one error can list all of them.
"""

import csv
import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.text_decoding import decode
from hearth.schemas.yaml_limits import LARGEST, LIMITS, LOADER, too_much


class Entry(NamedTuple):
    """A value with the place it stands at: `file:line`."""

    value: Any
    file: str
    line: int


class Faults(list[Diagnostic]):
    """The faults found so far, in the order of discovery."""

    def add(self, file: str, line: int, message: str, suggestion: str = "", code: Code = Code.BAD_TABLE) -> None:
        """Note one fault."""
        self.append(Diagnostic(code, message, file, line, suggestion=suggestion))

    def at(self, entry: Entry, message: str, suggestion: str = "", code: Code = Code.BAD_TABLE) -> None:
        """Note one fault at the place of an entry."""
        self.add(entry.file, entry.line, message, suggestion, code)


def check_extent(path: Path, faults: Faults) -> None:
    """Refuse a file of others' knowledge that takes too much to read; ours need no such check."""
    if not path.is_file():
        faults.add(str(path), 0, "is not a regular file", "move it elsewhere", Code.UNSUPPORTED_FILE)
        return
    size = path.stat().st_size
    if size > LARGEST:
        faults.add(str(path), 0, f"{size:,} bytes are too many", LIMITS, Code.FILE_TOO_LARGE)
    elif path.suffix != ".csv":
        text = decode(path.read_bytes())
        why = too_much(text) if isinstance(text, str) else ""
        if why:
            faults.add(str(path), 0, why, LIMITS, Code.FILE_TOO_LARGE)


def read_yaml(path: Path, faults: Faults) -> dict[str, Entry]:
    """Return the top-level entries of a YAML mapping, each with its line. Duplicate keys at any depth are faults."""
    text = _text(path, faults)
    if text is None:
        return {}
    loader = None
    try:
        loader = LOADER(text)
        node = loader.get_single_node()
        if node is None:
            return {}
        if not isinstance(node, yaml.MappingNode):
            faults.add(str(path), 1, "not a mapping of names", "write `Name: {...}` entries")
            return {}
        return {key: Entry(value, str(path), line) for key, value, line in _items(loader, node, str(path), faults)}
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark
        line, column = (mark.line + 1, mark.column + 1) if mark else (0, 0)
        faults.append(Diagnostic(Code.BAD_TABLE, f"not YAML: {error.problem}", str(path), line, column))
        return {}
    except yaml.YAMLError as error:  # a character that YAML does not allow
        faults.add(str(path), 0, f"not YAML: {' '.join(str(error).split())}")
        return {}
    finally:
        if loader is not None:
            loader.dispose()


def _items(loader: Any, node: yaml.MappingNode, file: str, faults: Faults) -> Iterator[tuple[str, Any, int]]:
    """Yield the (key, value, line) of a mapping, refusing keys that stand twice."""
    first: dict[str, int] = {}
    for key_node, value_node in node.value:
        line = key_node.start_mark.line + 1
        key = key_node.value if isinstance(key_node, yaml.ScalarNode) else str(key_node.start_mark)
        if key in first:
            faults.add(file, line, f"`{key}` stands twice, first in line {first[key]}", "keep one of them")
            continue
        first[key] = line
        yield key, _value(loader, value_node, file, faults), line


def _value(loader: Any, node: yaml.Node, file: str, faults: Faults) -> Any:
    if isinstance(node, yaml.MappingNode):
        return {key: value for key, value, _ in _items(loader, node, file, faults)}
    if isinstance(node, yaml.SequenceNode):
        return [_value(loader, child, file, faults) for child in node.value]
    if node.tag == "tag:yaml.org,2002:str":
        return node.value
    return _SCALARS.get(node.tag, _as_text)(node.value)


def _as_text(value: str) -> str:
    return value


def _as_bool(value: str) -> bool | str:
    """YAML 1.1 reads On and Off as truth values; here they are names, and only true and false are not."""
    return {"true": True, "false": False}.get(value.lower(), value)


def _as_number(value: str) -> Any:
    try:
        return int(value)
    except ValueError:
        pass
    try:
        return float(value)
    except ValueError:
        return value


_SCALARS: dict[str, Any] = {
    "tag:yaml.org,2002:bool": _as_bool,
    "tag:yaml.org,2002:int": _as_number,
    "tag:yaml.org,2002:float": _as_number,
    "tag:yaml.org,2002:null": lambda _: None,
}


def read_csv(path: Path, columns: tuple[str, ...], faults: Faults) -> list[tuple[tuple[str, ...], int]]:
    """Return the rows of a CSV file with a header line, as (cells in the order of `columns`, line).

    Lines that begin with `#` are comments. A missing column or a row of another length is a fault.
    """
    text = _text(path, faults)
    if text is None:
        return []
    reader = csv.reader(_uncommented(text), strict=True)
    rows: list[tuple[tuple[str, ...], int]] = []
    try:
        header = next((row for row in reader if row), [])
        if tuple(header) != columns:
            faults.add(str(path), reader.line_num, f"columns are {','.join(header)}", f"they are {','.join(columns)}")
            return []
        width = len(columns)
        for row in reader:
            if len(row) == width:
                rows.append((tuple(row), reader.line_num))
            elif row:
                faults.add(str(path), reader.line_num, f"{len(row)} cells", f"there are {width} columns")
    except csv.Error as error:
        faults.add(str(path), reader.line_num, f"not CSV: {error}")
    return rows


def _uncommented(text: str) -> Iterator[str]:
    """Comment lines become empty ones, so that line numbers stay true."""
    for line in io.StringIO(text):
        yield "\n" if line.startswith("#") else line


def _text(path: Path, faults: Faults) -> str | None:
    try:
        text = decode(path.read_bytes(), str(path))
    except OSError as error:
        faults.add(str(path), 0, f"cannot be read: {error.strerror}", code=Code.MISSING_FILE)
        return None
    if isinstance(text, Diagnostic):
        faults.append(text)
        return None
    return text


def strings(value: Any) -> tuple[str, ...]:
    """Return a list of names from a YAML value: a list, a single name, or nothing."""
    if value is None:
        return ()
    if isinstance(value, str):
        return (value,)
    return tuple(map(str, value)) if isinstance(value, list) else (str(value),)


DIGITS = 9
"""Of a number at most: ids are published as 32 bits, and Python refuses to read numbers of thousands of digits."""


def whole_number(text: str) -> int:
    """Return the whole number that a cell says, or -1."""
    return int(text) if text.isdecimal() and len(text) <= DIGITS else -1
