"""Faults of the JSON of a scene graph, in words: the first node or edge that lacks a key, and its own keys."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

NEEDED: Final = {"nodes": ("id", "class_name"), "edges": ("from_id", "relation_type", "to_id")}
"""Keys that every node and every edge has."""

REMEDY: Final = "nodes need id and class_name; edges need from_id, relation_type and to_id"

_SHOWN = 6
"""Keys of a node or an edge that a message lists."""


def graph_fault(data: Any, error: Exception) -> str:
    """Return why a JSON value is not a scene graph.

    Args:
        data: the value.
        error: which reading it raised; its words are used where no key is missing.
    """
    return next(_lacks(data), None) or f"a field of it is wrong: {str(error).strip(chr(39))}"


def _lacks(data: Any) -> Iterator[str]:
    for part, keys in NEEDED.items():
        entries = data.get(part) if isinstance(data, Mapping) else None
        if not isinstance(entries, Sequence) or isinstance(entries, str):
            yield f"it has no list `{part}`"
            continue
        for number, entry in enumerate(entries, 1):
            kind = part.removesuffix("s")
            if not isinstance(entry, Mapping):
                yield f"{kind} {number} is {str(entry)[:40]!r} instead of an object with {', '.join(keys)}"
            elif missing := [f"`{key}`" for key in keys if key not in entry]:
                yield f"{kind} {number} has no {' and no '.join(missing)}; it has {_keys(entry)}"


def _keys(entry: Mapping[str, Any]) -> str:
    names = [f"`{str(key)[:40]}`" for key in entry][:_SHOWN]
    more = ["..."] if len(entry) > _SHOWN else []
    return ", ".join([*names, *more]) or "no key"
