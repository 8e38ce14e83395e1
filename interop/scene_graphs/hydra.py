"""Graphs of Hydra: entries that are named by their layer and number get the word of their layer's label space."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from hearth.interop.scene_graphs.class_names import is_number_only


def labelled(data: Any) -> Any:
    """Return a graph of Hydra whose entries have labels; any other value as it is.

    `metadata.labelspaces` has for each layer and partition, as `_l4p0`, the words of its semantic labels.
    """
    metadata = data.get("metadata") if isinstance(data, Mapping) else None
    spaces = metadata.get("labelspaces") if isinstance(metadata, Mapping) else None
    if not isinstance(spaces, Mapping) or not isinstance(data.get("nodes"), list):
        return data
    words = {name: _words(rows) for name, rows in spaces.items()}
    return {**data, "nodes": [_labelled(node, words) for node in data["nodes"]]}


def _words(rows: Any) -> dict[int, str]:
    pairs = rows.items() if isinstance(rows, Mapping) else rows if isinstance(rows, list) else []
    return {
        int(pair[0]): pair[1]
        for pair in pairs
        if len(pair) == 2 and str(pair[0]).isdecimal() and isinstance(pair[1], str)
    }


def _labelled(node: Any, words: Mapping[str, Mapping[int, str]]) -> Any:
    """Return a node with the word of its semantic label, where its name only numbers it."""
    attributes = node.get("attributes") if isinstance(node, Mapping) else None
    if not isinstance(attributes, Mapping) or not isinstance(attributes.get("name"), str):
        return node
    space = words.get(f"_l{node.get('layer')}p{node.get('partition', 0)}", {})
    label = attributes.get("semantic_label")
    word = space.get(label) if isinstance(label, int) else None
    is_named = bool(attributes["name"]) and not is_number_only(attributes["name"])
    return node if word is None or is_named else {**node, "attributes": {**attributes, "label": word}}
