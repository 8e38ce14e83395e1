"""A flat small enough to count its tuples by hand, and golden files for the scoring tests."""

import os
from pathlib import Path

import pytest

from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

GOLDEN = Path(__file__).resolve().parents[1] / "golden/score"

FLAT = EnvironmentGraph(
    nodes=(
        Node(1, "kitchen", "Rooms"),
        Node(2, "bedroom", "Rooms"),
        Node(3, "door", "Doors", ("CAN_OPEN",), ("OPEN",)),
        Node(9, "character", "Characters", ("PERSON",)),
        Node(10, "table", "Furniture", ("SURFACES", "MOVABLE")),
        Node(11, "fridge", "Appliances", ("CAN_OPEN", "CONTAINERS"), ("CLOSED",)),
        Node(12, "chair", "Furniture", ("SITTABLE", "SURFACES")),
        Node(20, "cup", "Props", ("GRABBABLE", "RECIPIENT"), ("CLEAN",)),
        Node(21, "cup", "Props", ("GRABBABLE", "RECIPIENT"), ("CLEAN",)),
        Node(22, "television", "Electronics", ("HAS_SWITCH", "LOOKABLE"), ("OFF",)),
    ),
    edges=(
        Edge(3, "BETWEEN", 1),
        Edge(3, "BETWEEN", 2),
        Edge(9, "INSIDE", 2),
        *(Edge(node, "INSIDE", 1) for node in (10, 11, 12, 20, 21, 22)),
        Edge(20, "ON", 12),
        Edge(21, "ON", 12),
    ),
)


@pytest.fixture(scope="session")
def flat():
    return FLAT


@pytest.fixture(scope="session")
def world(knowledge):
    return World.start(Home.from_graph(FLAT, "flat", knowledge))


@pytest.fixture
def golden():
    """Compares a text with a golden file; with HEARTH_REFRESH=1 it writes the file instead."""

    def compare(name: str, found: str) -> None:
        path = GOLDEN / name
        if os.environ.get("HEARTH_REFRESH"):
            path.write_text(found)
        assert found == path.read_text(), f"refresh with HEARTH_REFRESH=1 .venv/bin/pytest tests/scoring -k {name}"

    return compare
