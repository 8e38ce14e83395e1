"""Environments and runs as rows: rebuilt from what differs, they are what they were."""

from __future__ import annotations

import copy

import pyarrow as pa
import pytest

from hearth.datasets.format.case_rows import difference_of, difference_on_replay, environment_of, home_of, run_row
from hearth.datasets.format.row_conversion import (
    condition_rows,
    conditions_of,
    environment_change,
    environment_row,
    failure_row,
    node_of,
    node_row,
    step_rows,
    steps_of,
)
from hearth.grounding.environments.default_state import prepared
from hearth.grounding.environments.sampling import sample
from hearth.kb.loading.load import default
from hearth.pipelines.engine.build_homes import Homes
from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.engine.stage import Job
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node
from hearth.schemas.graph_change import Change
from hearth.schemas.row_types import DifferenceRow
from hearth.schemas.syntax import parse_program
from hearth.schemas.tables import struct
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

PROGRAMS = [
    "[Walk] <bedroom> (1)\n[Walk] <bed> (1)\n[Lie] <bed> (1)",
    "[Walk] <fridge> (1)\n[Open] <fridge> (1)\n[Grab] <milk> (1)\n[Close] <fridge> (1)",
    "[Walk] <television> (1)\n[SwitchOn] <television> (1)\n[Walk] <couch> (1)\n[Sit] <couch> (1)",
    "[Walk] <violin_case> (1)\n[Walk] <kitchen> (1)\n[Walk] <cup> (1)\n[Grab] <cup> (1)\n[Walk] <sink> (1)\n"
    "[PutIn] <cup> (1) <sink> (1)",
]


@pytest.fixture(scope="module")
def homes(inputs):
    return Homes(Settings(homes_folder=str(inputs / "homes")))


def drawn(homes, text, seed, name="cabin"):
    program, faults = parse_program("Title\nWords\n\n" + text)
    assert not faults
    found = sample(program, homes.home(name), seed, "case")
    assert not isinstance(found, Failure), found.message()
    return found


@pytest.mark.parametrize("text", [PROGRAMS[0], PROGRAMS[1], PROGRAMS[2]])
@pytest.mark.parametrize("seed", range(4))
def test_an_environment_is_rebuilt_from_what_differs(homes, text, seed):
    environment, _ = drawn(homes, text, seed)
    row = environment_of(environment, homes.edges("cabin"))
    rebuilt = World.start(home_of(as_read(row), homes.home("cabin"))).graph()
    expected = environment.world.graph()
    assert rebuilt.edges == expected.edges
    assert [(node.id, node.class_name, sorted(node.states)) for node in rebuilt.nodes] == [
        (node.id, node.class_name, sorted(node.states)) for node in expected.nodes
    ]


@pytest.mark.parametrize("seed", range(2))
def test_both_ways_to_find_what_differs_agree(homes, seed):
    environment, _ = drawn(homes, PROGRAMS[1], seed)
    quick = environment_of(environment, homes.edges("cabin"))
    slow = difference_of(environment.world, homes.home("cabin"), homes.edges("cabin"))
    for row in (*quick["added_nodes"], *slow["added_nodes"]):
        row["states"].sort()
    for name, value in slow.items():
        key = repr if name == "added_nodes" else None
        assert sorted(quick[name], key=key) == sorted(value, key=key), name


def as_read(value):
    """A row as Parquet gives it back: edges and states are structs."""
    if isinstance(value, dict):
        return {name: as_read(part) for name, part in value.items()}
    if hasattr(value, "_asdict"):
        return value._asdict()
    if isinstance(value, tuple) and len(value) == 2:
        return {"node": value[0], "state": value[1]}
    return [as_read(part) for part in value] if isinstance(value, list) else value


def test_nodes_that_are_removed_or_other_than_at_home(homes):
    home = homes.home("cabin")
    graph = World.start(home).graph()
    nodes = [node for node in graph.nodes if node.id != 21]
    nodes[nodes.index(graph.node(22))] = Node(22, "bowl", "Props", ("GRABBABLE",), ("CLEAN",))
    edges = tuple(edge for edge in graph.edges if 21 not in (edge.source, edge.target))
    other = World.start(Home.from_graph(EnvironmentGraph(tuple(nodes), edges), "cabin", default()))
    row = difference_of(other, home, homes.edges("cabin"))
    assert row["removed_nodes"] == [21, 22]
    assert World.start(home_of(as_read(row), home)).graph().edges == other.graph().edges
    assert home_of(as_read(row), home).classes == other.home.classes


def test_a_change_is_read_from_parquet_as_it_was_written():
    bowl = Node(22, "bowl", "Props", ("GRABBABLE",), ("CLEAN",), "bowl_1", Box((0.0, 1.0, 2.0), (0.5, 0.5, 0.5)), 90.0)
    edges = (Edge(22, "INSIDE", 1), Edge(22, "ON", 3)), (Edge(4, "CLOSE", 5),)
    change = Change(*edges, ((3, "OPEN"),), ((3, "CLOSED"),), (bowl, Node(23, "cup")), (22,))
    table = pa.Table.from_pylist(
        [{"environment": environment_row(change)}], pa.schema([("environment", struct(DifferenceRow))])
    )
    assert environment_change(table.to_pylist()[0]["environment"]) == change


def case_of(homes, text, seed=0):
    environment, execution = drawn(homes, text, seed)
    return as_read(
        {
            "home": "cabin",
            "title": "",
            "description": "",
            "steps": step_rows(environment.program),
            "environment": environment_of(environment, homes.edges("cabin")),
            **run_row(execution),
        }
    )


def test_a_case_replays(homes):
    assert difference_on_replay(case_of(homes, PROGRAMS[1]), homes) == ""


def break_tick(case):
    case["ticks"][1]["set_states"].append({"node": 20, "state": "DIRTY"})


def break_count(case):
    case["ticks"].pop()


def break_failure(case):
    case["failure"] = failure_row(Failure(Code.NOT_CLOSE))


def break_environment(case):
    fridge = next(row["node"] for row in case["bindings"] if row["name"] == "fridge")
    case["environment"]["cleared_states"].append({"node": fridge, "state": "CLOSED"})
    case["environment"]["set_states"].append({"node": fridge, "state": "OPEN"})


def break_binding(case):
    for row in case["bindings"]:
        row["node"] = 20


@pytest.mark.parametrize("damage", [break_tick, break_count, break_failure, break_environment, break_binding])
def test_what_does_not_replay_is_reported(homes, damage):
    case = copy.deepcopy(case_of(homes, PROGRAMS[1]))
    damage(case)
    assert difference_on_replay(case, homes)


def test_publishing_refuses_what_does_not_replay(homes, made):
    from hearth.pipelines import publish

    case = {**copy.deepcopy(made.rows("sample")[0]), "split": "test"}
    context = publish.Context(Job(publish.STAGE, made.settings))
    assert [table for table, _ in publish.process(case, context)][:1] == ["programs.test"]
    break_count(case)
    refused = publish.process(case, context)
    assert refused.code == "REPLAY_DIFFERS"
    assert case["execution_id"] in refused.diagnostics[0].found


def test_a_home_in_its_default_state_is_what_environments_differ_from(homes, inputs):
    assert prepared(homes.home("cabin")).home.states == homes.home("cabin").states


def test_values_come_back_from_their_rows():
    node = Node(7, "cup", "Props", ("GRABBABLE",), ("CLEAN",), "cup_1", Box((1.0, 2.0, 3.0), (0.1, 0.2, 0.3)), 90.0)
    assert node_of(node_row(node)) == node
    failure = Failure(Code.NOT_CLOSE, 2, 0, "Grab", (7,), ("cup",), "close", "far")
    row = failure_row(failure)
    assert (row["code"], row["objects"], row["names"], row["actual"]) == ("NOT_CLOSE", [7], ["cup"], "far")
    program, _ = parse_program("T\n\n<char1> [PutBack] <cup> (2) <table> (1) {hand=left} | <char0> [StandUp]\n")
    assert steps_of(step_rows(program)) == program.steps


def test_conditions_of_version_0_1_0_are_read_by_their_new_names():
    row = {"name": "stowed", "objects": [{"name": "cup", "instance": 1}], "step": 2, "hard": True}
    (found,) = conditions_of([row])
    assert str(found) == "in_closed_container(cup (1))"
    assert condition_rows([found]) == [{**row, "name": "in_closed_container"}]
