"""Mappings of YAML that people wrote, read key by key; every fault is named with its line and its remedy."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from difflib import get_close_matches
from typing import Any

from hearth.schemas import located_yaml
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code

ReadValue = Callable[[Any], Any]


class Faults(list[Diagnostic]):
    """Everything wrong with one file, in the order found."""

    def __init__(self, file: str) -> None:
        super().__init__()
        self.file = file

    def add(self, code: Code, message: str, line: int = 0, suggestion: str = "") -> None:
        """Note a fault; the same one at the same place only once."""
        fault = Diagnostic(code, message, self.file, line, suggestion=suggestion)
        if fault not in self:
            self.append(fault)

    def underlined(self, text: str) -> list[Diagnostic]:
        """Return the faults in the order of their lines, each with its line's words to underline."""
        lines = text.splitlines()
        found = []
        for fault in sorted(self, key=lambda fault: fault.line):
            source = lines[fault.line - 1] if 0 < fault.line <= len(lines) else ""
            column = len(source) - len(source.lstrip()) + 1 if source else 0
            found.append(replace(fault, source=source, column=column, length=len(source.strip())))
        return found


class WrongValueError(ValueError):
    """The expected form of a value."""


def reads(
    expected: str, allows: Callable[[Any], object], first: ReadValue | None = None, then: ReadValue | None = None
) -> ReadValue:
    """Return a reader of values of the expected form; those of another are faults.

    Args:
        expected: the form, for the message about a value of another.
        allows: whether a value has it.
        first: reads the value that is then asked about.
        then: what the reader makes of an allowed value; the value itself when left out.
    """

    def read(value: Any) -> Any:
        value = value if first is None else first(value)
        if not allows(value):
            raise WrongValueError(expected)
        return value if then is None else then(value)

    return read


def one_of(*words: str) -> ReadValue:
    """Return a reader of one of some words."""
    return reads(f"one of {', '.join(words)}", lambda value: value in words, then=str)


def fields(
    entry: Any, keys: Mapping[str, ReadValue], what: str, faults: Faults, need: tuple[str, ...] = (), line: int = 0
) -> dict[str, Any]:
    """Return the values of a mapping, read by their keys' readers; what can't be read is noted and left out.

    Args:
        entry: as `located_yaml.read` gives it.
        keys: the reader of each key; `list` for a list.
        what: the mapping's name in messages.
        faults: gets what is wrong.
        need: the keys that it must have.
        line: where it stands, if it does not know.
    """
    if not isinstance(entry, located_yaml.Mapping):
        faults.add(Code.SYNTAX, f"{what} is a mapping", located_yaml.line_of(entry) or line, ", ".join(keys))
        return {}
    for key, at in entry.twice:
        faults.add(Code.DUPLICATE, f"`{key}` stands twice", at, "keep one of them")
    found: dict[str, Any] = {}
    for key, value in entry.items():
        if key not in keys:
            near = get_close_matches(key, keys, 1)
            hint = f"did you mean `{near[0]}`?" if near else f"known are {', '.join(keys)}"
            faults.add(Code.SYNTAX, f"`{key}` is not part of {what}", entry.at(key), hint)
            continue
        try:
            found[key] = _list(value) if keys[key] is list else keys[key](value)
        except WrongValueError as wrong:
            faults.add(Code.SYNTAX, f"`{key}` is `{shown(value)}`", entry.at(key), f"write {wrong}")
    for key in need:
        if key not in entry:
            faults.add(Code.SYNTAX, f"{what} needs `{key}`", entry.line or line)
    return found


def _list(value: Any) -> Any:
    if not isinstance(value, list) and value is not None:
        raise WrongValueError("a list")
    return value or []


def shown(value: Any) -> str:
    """Return a value as messages quote it."""
    if isinstance(value, located_yaml.Number):
        return f"{float(value):g}"
    return str(value)[:60]
