"""A small scene graph of ours with class names as VirtualHome 2.x writes them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

GRAB = ["GRABBABLE", "MOVABLE"]
OPENS = ["CAN_OPEN", "CONTAINERS"]
KITCHEN, STUDY = 11, 12
NODES: dict[int, tuple[str, str, list[str], list[str], int]] = {
    KITCHEN: ("kitchen", "Rooms", [], [], 0),
    STUDY: ("bathroom", "Rooms", [], [], 0),
    20: ("character", "Characters", [], [], KITCHEN),
    31: ("remotecontrol", "Electronics", [*GRAB, "HAS_SWITCH"], ["OFF"], KITCHEN),
    32: ("garbagecan", "Furniture", OPENS, ["CLOSED"], KITCHEN),
    33: ("clothesshirt", "Props", GRAB, [], KITCHEN),
    34: ("cutleryknife", "Props", GRAB, [], KITCHEN),
    35: ("bathroomcabinet", "Furniture", OPENS, ["CLOSED"], STUDY),
    36: ("mug", "Props", GRAB, [], KITCHEN),
    37: ("mug", "Props", GRAB, [], KITCHEN),
    38: ("mug", "Props", GRAB, [], STUDY),
    39: ("microwave", "Appliances", [*OPENS, "HAS_SWITCH"], ["CLOSED", "OFF"], KITCHEN),
    40: ("pie", "Food", [*GRAB, "EATABLE"], [], KITCHEN),
    41: ("plate", "Props", [*GRAB, "SURFACES", "RECIPIENT"], [], KITCHEN),
    42: ("sink", "Furniture", ["CONTAINERS", "RECIPIENT"], [], STUDY),
    43: ("faucet", "Furniture", ["HAS_SWITCH"], ["OFF"], STUDY),
    44: ("hands_both", "BodyParts", ["BODY_PART"], [], KITCHEN),
}
Edge = tuple[int, str, int]
IN_MICROWAVE: tuple[Edge, ...] = ((40, "INSIDE", 39),)
IN_CABINET: tuple[Edge, ...] = ((38, "INSIDE", 35),)
IN_CAN: tuple[Edge, ...] = ((34, "INSIDE", 32),)
BY_HANDS: tuple[Edge, ...] = ((44, "CLOSE", 42), (42, "CLOSE", 44), (44, "CLOSE", 43), (43, "CLOSE", 44),
                              (44, "CLOSE", 20), (20, "CLOSE", 44))  # fmt: skip


def graph(edges: tuple[Edge, ...] = (), changed: dict[int, dict[str, Any]] | None = None) -> dict[str, Any]:
    """Return the graph with more edges, and with other values of nodes; None takes a key out."""
    nodes = []
    for node, (name, category, can, states, _) in NODES.items():
        whole = {"id": node, "class_name": name, "category": category, "properties": can, "states": states}
        nodes.append(
            {key: value for key, value in (whole | (changed or {}).get(node, {})).items() if value is not None}
        )
    rooms = [(node, "INSIDE", values[4]) for node, values in NODES.items() if values[4]]
    return {
        "nodes": nodes,
        "edges": [{"from_id": a, "relation_type": r, "to_id": b} for a, r, b in (*rooms, *edges)],
    }


def written(file: Path, value: Any) -> Path:
    file.write_text(json.dumps(value))
    return file
