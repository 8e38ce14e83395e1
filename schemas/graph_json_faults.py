"""Faults in the JSON of a scene graph, in words: the first node or edge that lacks a key, and its own keys."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

NEEDED: Final = {"nodes": ("id", "class_name"), "edges": ("from_id", "relation_type", "to_id")}
"""Keys that every node and every edge has."""

ELSEWHERE: Final = {
    "id": ("node_id", "nodeid", "uid", "key", "object_id", "objectid"),
    "class_name": ("class", "classname", "label", "type", "name", "object_type"),
    "from_id": ("from", "source", "src", "subject", "head", "fromid", "source_id", "from_node", "start", "u"),
    "relation_type": ("relation", "predicate", "rel", "type", "label", "relationtype", "edge_type", "name", "key"),
    "to_id": ("to", "target", "dst", "object", "tail", "toid", "target_id", "to_node", "end", "v"),
}
"""The names that other projects' graphs have for these keys, in lower case."""

REMEDY: Final = (
    "nodes need id and class_name; edges need from_id, relation_type and to_id; "
    "`hearth home convert FILE OUT.json --fill` reads graphs of other shapes"
)

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
                yield f"{kind} {number} has no {' and no '.join(missing)}; it has {_keys(entry)}{_renamed(keys, entry)}"


def _renamed(keys: Sequence[str], entry: Mapping[str, Any]) -> str:
    """Return which of its keys to rename, where others call the missing ones so."""
    lower = {str(key).lower(): str(key) for key in entry}
    found = [
        f"`{lower[other][:40]}` to `{key}`"
        for key in keys
        if key not in entry and (other := next((each for each in ELSEWHERE[key] if each in lower), ""))
    ]
    return f": rename {', '.join(found)}" if found else ""


def _keys(entry: Mapping[str, Any]) -> str:
    names = [f"`{str(key)[:40]}`" for key in entry][:_SHOWN]
    more = ["..."] if len(entry) > _SHOWN else []
    return ", ".join([*names, *more]) or "no key"
