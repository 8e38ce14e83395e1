"""YAML whose every value knows its line, so that a fault in a file can say where it stands."""

from typing import Any

import yaml

from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.yaml_limits import LIMITS, LOADER, too_much


class Text(str):
    """A string with the line it stands on."""

    __slots__ = ("line",)
    line: int


class Number(float):
    """A number with the line it stands on."""

    __slots__ = ("line",)
    line: int


class Mapping(dict[str, Any]):
    """A mapping with the line it begins on, the lines of its keys, and the keys that were given twice."""

    __slots__ = ("line", "lines", "twice")

    def __init__(self, line: int) -> None:
        super().__init__()
        self.line = line
        self.lines: dict[str, int] = {}
        self.twice: list[tuple[str, int]] = []

    def at(self, key: str) -> int:
        """Return the line of a key, or of the mapping where it lacks the key."""
        return self.lines.get(key, self.line)


class Sequence(list[Any]):
    """A list with the line it begins on."""

    __slots__ = ("line",)
    line: int


def line_of(value: object) -> int:
    """Return the line a value stands on; 0 when it does not know."""
    return int(getattr(value, "line", 0))


def read(text: str, file: str) -> Any:
    """YAML text as Mapping, Sequence, Text, Number, bool and None.

    Raises:
        HearthError: SYNTAX at the place YAML stopped, EMPTY, or FILE_TOO_LARGE.
    """
    why = too_much(text)
    if why:
        raise HearthError.of(Code.FILE_TOO_LARGE, why, file=file, suggestion=LIMITS)
    try:
        node = yaml.compose(text, Loader=LOADER)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark
        line, column = (mark.line + 1, mark.column + 1) if mark else (0, 0)
        message = f"not YAML: {error.problem or error.context}"
        raise HearthError(Diagnostic(Code.SYNTAX, message, file, line, column)) from error
    except yaml.YAMLError as error:
        raise HearthError.of(Code.SYNTAX, f"not YAML: {error}", file=file) from error
    if node is None:
        raise HearthError.of(Code.EMPTY, "nothing to read", file=file)
    return _value(node)


def _value(node: Any) -> Any:
    line = node.start_mark.line + 1
    if isinstance(node, yaml.MappingNode):
        return _mapping(node, line)
    if isinstance(node, yaml.SequenceNode):
        sequence = Sequence(map(_value, node.value))
        sequence.line = line
        return sequence
    return _scalar(node, line)


def _mapping(node: Any, line: int) -> Mapping:
    found = Mapping(line)
    for key_node, value_node in node.value:
        key = str(key_node.value)
        if key in found:
            found.twice.append((key, key_node.start_mark.line + 1))
        found.lines[key] = key_node.start_mark.line + 1
        found[key] = _value(value_node)
    return found


def _scalar(node: Any, line: int) -> Any:
    kind = node.tag.rpartition(":")[2]
    if kind == "null":
        return None
    if kind == "bool":
        return node.value.lower() in ("true", "yes", "on")
    if kind in ("int", "float"):
        try:
            number = Number(node.value.replace("_", ""))
        except ValueError:
            number = None
        if number is not None:
            number.line = line
            return number
    text = Text(node.value)
    text.line = line
    return text
