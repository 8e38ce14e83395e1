"""The facts of the release's five knowledge files, as sets of names."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

LARGEST = 64 << 20
"""Bytes of a file, at most; the release's have less than one million."""

Fact = tuple[str, ...]
"""Names; what they mean depends on the table."""


def is_release(directory: Path) -> bool:
    """Return whether any of the release's files stands there."""
    return any((directory / file).exists() for file, _, _ in _FILES)


def read_release(directory: Path) -> dict[str, set[Fact]]:
    """Return the facts of the files there, by table: properties, states, placements, synonyms, affordances.

    Raises:
        HearthError: a file is not JSON or not of its form, or larger than any.
    """
    import orjson

    found = {}
    for file, table, facts in _FILES:
        path = directory / file
        if not path.is_file():
            continue
        try:
            found[table] = set(map(_texts, facts(orjson.loads(_bytes(path)))))
        except (ValueError, TypeError, KeyError, AttributeError) as error:
            message = f"not the release's file: {type(error).__name__} {error}"
            raise HearthError.of(Code.BAD_JSON, message, file=str(path)) from error
    return found


def _bytes(path: Path) -> bytes:
    size = path.stat().st_size
    if size > LARGEST:
        raise HearthError.of(Code.FILE_TOO_LARGE, f"{size:,} bytes are too many", file=str(path))
    return path.read_bytes()


def _texts(fact: Fact) -> Fact:
    """Return the fact, whose parts may be anything that JSON has.

    Raises:
        TypeError: one is not a text.
    """
    if not all(isinstance(part, str) for part in fact):
        kinds = ", ".join(type(part).__name__ for part in fact)
        raise TypeError(f"{kinds} where texts are expected")
    return fact


def _pairs(data: dict[str, list[str]]) -> Iterator[Fact]:
    """`{class: [names]}`: properties, states, equivalent names."""
    for name, others in data.items():
        yield from ((name, other) for other in others if other != name)


def _places(data: dict[str, list[dict[str, str]]]) -> Iterator[Fact]:
    for name, rows in data.items():
        yield from ((name, row["relation"], row["destination"]) for row in rows)


def _matrix(data: dict[str, Any]) -> Iterator[Fact]:
    for action, columns in data["affordances"].items():
        for position, column in enumerate(("object1", "object2")):
            yield from ((action, str(position), name) for name in columns[column])


_FILES: tuple[tuple[str, str, Callable[[Any], Iterator[Fact]]], ...] = (
    ("properties_data.json", "properties", _pairs),
    ("object_states.json", "states", _pairs),
    ("object_script_placing.json", "placements", _places),
    ("class_name_equivalence.json", "synonyms", _pairs),
    ("affordances.json", "affordances", _matrix),
)
