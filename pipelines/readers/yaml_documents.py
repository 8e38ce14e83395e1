"""YAML with plans: lists of steps and records as in JSON, with the places of their texts."""

import re
from collections.abc import Iterator
from pathlib import PurePath
from typing import Any

import yaml

from hearth.pipelines.readers import json_records
from hearth.pipelines.readers.field_columns import Asked
from hearth.pipelines.readers.program_columns import column_of_steps
from hearth.pipelines.readers.reader_items import LARGEST_FILE, Item, opened, suffixless
from hearth.pipelines.readers.records_in_json import holds_program
from hearth.pipelines.readers.step_rows_by_task import Entry
from hearth.pipelines.readers.texts_with_positions import text_at, texts_in
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.yaml_limits import LIMITS, LOADER, too_much
from hearth.storage.archives import Place
from hearth.storage.rejects import Reject

NAME = "yaml"

MOST_DIGITS = 4_000
"""Digits of a number; Python reads up to 4,300."""

_INT = "tag:yaml.org,2002:int"
_NULL = "tag:yaml.org,2002:null"
_INDENT = re.compile(r"\n+( +)")


def values(path: Place, place: str) -> Iterator[tuple[Any, int]]:
    """Yield the value of each document of a file with its first line; a fault of its form ends it."""
    with opened(path) as (file, encoding):
        text = file.read(LARGEST_FILE).decode(encoding, "replace")
    if reason := too_much(text):
        fault = Diagnostic(Code.FILE_TOO_LARGE, f"YAML: {reason}", place, suggestion=LIMITS)
        yield Reject((fault,)), 1
        return
    try:
        for node in yaml.compose_all(text, LOADER):
            if node is not None:
                yield _value(node, text), node.start_mark.line + 1
    except (yaml.YAMLError, RecursionError) as error:
        yield _broken(error, place), 1
    except _NumberError as error:
        yield Reject((error.fault(place),)), error.line


def scan(path: Place, place: str, asked: Asked) -> Iterator[Item]:
    """Yield the items of each record of a file, as of JSON."""
    yield from json_records.of_entries(_entries(path, place), place, asked)


def holds_programs(path: Place, place: str) -> bool:
    """Return whether a file has steps in it, or is broken; settings of other programs have none."""
    return any(isinstance(value, Reject) or holds_program(value) for value, _, _ in _entries(path, place))


def _entries(path: Place, place: str) -> Iterator[Entry]:
    for value, line in values(path, place):
        if isinstance(value, list) and not all(isinstance(each, str) for each in value):
            for number, each in enumerate(value, 1):
                first = next((text.line for text in texts_in(each)), line)
                yield Entry(each, first, f"{place}[{number}]")
        else:
            yield Entry(_named(value, place), line, place if line == 1 else f"{place}:{line}")


def _named(value: Any, place: str) -> Any:
    """Return a list of steps as a record with the file's name as its title; other values as they are."""
    is_list = isinstance(value, list) and column_of_steps({"steps": ["\n".join(value)]})
    return {"title": suffixless(PurePath(place).name).replace("_", " "), "steps": value} if is_list else value


def _broken(error: Exception, place: str) -> Reject:
    mark = getattr(error, "problem_mark", None)
    line, column = (mark.line + 1, mark.column + 1) if mark else (0, 0)
    message = f"not YAML: {getattr(error, 'problem', None) or error}"
    remedy = "quote texts that hold `: ` or begin with a mark, and indent with spaces"
    return Reject((Diagnostic(Code.BAD_TABLE, message, place, line, column, suggestion=remedy),))


def _value(node: Any, text: str) -> Any:
    if isinstance(node, yaml.SequenceNode):
        return [_value(each, text) for each in node.value]
    if isinstance(node, yaml.MappingNode):
        return {str(_scalar(key, text)): _value(part, text) for key, part in node.value}
    return _scalar(node, text)


def _scalar(node: Any, text: str) -> Any:
    """Return a number or a text with its place; words such as `on`, which YAML takes for others, stay texts."""
    if not isinstance(node, yaml.ScalarNode):
        return "?"
    if node.tag == _NULL:
        return None
    if node.tag == _INT and node.value.isdecimal():
        if len(node.value) > MOST_DIGITS:
            raise _NumberError(len(node.value), node.start_mark)
        return int(node.value)
    line, column = node.start_mark.line + 1, node.start_mark.column + 1
    if node.style == "|":
        return _block(node, text)
    if node.style == ">":
        return _folded_block(node, text)
    quotes = int(node.style in ("'", '"'))
    if node.end_mark.line > node.start_mark.line:
        raw = text[node.start_mark.index + quotes : node.end_mark.index - quotes].rstrip()
        return _folded(node.value, line, column + quotes, raw, _ANY_INDENT)
    return text_at(node.value, line, column + quotes, node.value)


class _NumberError(Exception):
    """A number of more digits than Python reads."""

    def __init__(self, digits: int, mark: Any) -> None:
        super().__init__()
        self.digits, self.line, self.column = digits, mark.line + 1, mark.column + 1

    def fault(self, place: str) -> Diagnostic:
        """Return the number as a fault of the file."""
        message = f"a number of {self.digits:,} digits, at most {MOST_DIGITS:,} are read"
        return Diagnostic(
            Code.BAD_TABLE, message, place, self.line, self.column, suggestion="quote it, if it is a text"
        )


_ANY_INDENT = r"\n *\n *|\n *"


def _folded_block(node: Any, text: str) -> Any:
    """Return a text whose lines are joined, as `>` asks for."""
    head = text.find("\n", node.start_mark.index)
    found = _INDENT.match(text, head)
    if not found:
        return text_at(node.value, node.start_mark.line + 1, 1, node.value)
    line = node.start_mark.line + 1 + text.count("\n", head, found.end())
    value, indent = str(node.value), found[1]
    raw = text[found.end() : node.end_mark.index].rstrip() + "\n" * (len(value) - len(value.rstrip("\n")))
    return _folded(value, line, len(indent) + 1, raw, f"\n\n{indent}|\n{indent}|\n")


def _folded(value: str, line: int, column: int, raw: str, breaks: str) -> Any:
    """Return a text of several lines of the file that are joined, each with its place where the joints are plain."""
    is_plain = len(re.findall(f"{breaks}|.", raw, re.DOTALL)) == len(value)
    return text_at(value, line, column, raw, breaks) if is_plain else text_at(value, line, column, value)


def _block(node: Any, text: str) -> Any:
    """Return a text of lines as they stand, whose lines begin behind their indent."""
    head = text.find("\n", node.start_mark.index)
    found = _INDENT.match(text, head)
    if not found:
        return node.value
    unit = f"\n{found[1]}"
    line = node.start_mark.line + 1 + text.count("\n", head, found.end())
    return text_at(node.value, line, len(unit), node.value.replace("\n", unit), unit)
