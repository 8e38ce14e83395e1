"""VirtualHome's symbolic classes by our engine: what scripts of `evolving_graph` ask of them."""

from __future__ import annotations

import json

import pytest

from hearth.interop.virtualhome.symbolic_classes import (
    EnvironmentGraph,
    EnvironmentState,
    Property,
    Relation,
    ScriptParseException,
    State,
    read_script,
    read_script_from_list_string,
    read_script_from_string,
)
from hearth.interop.virtualhome.symbolic_execution import ScriptExecutor, check_script
from hearth.schemas.graph import to_release

LINES = ["[WALK] <fridge> (1)", "[OPEN] <fridge> (1)", "[GRAB] <milk> (1)"]


@pytest.fixture(scope="module")
def home(knowledge):
    from hearth.homes import library

    return to_release(library.load_graph("maple", knowledge))


def test_a_graph_answers_as_theirs(home):
    graph = EnvironmentGraph(home)
    (fridge,) = graph.get_nodes_by_attr("class_name", "fridge")
    assert State.CLOSED in fridge.states and Property.CAN_OPEN in fridge.properties
    assert str(fridge) == f"<fridge> ({fridge.id})" and graph.get_node(fridge.id) == fridge
    milk = graph.get_nodes_by_attr("class_name", "milk")[0]
    assert fridge in graph.get_nodes_from(milk, Relation.INSIDE) and graph.has_edge(milk, Relation.INSIDE, fridge)
    assert graph.get_char_node(0).class_name == "character" and graph.get_char_node(3) is None
    assert graph.get_max_node_id() == max(graph.get_node_ids()) and set(graph.to_dict()) >= {"nodes", "edges"}
    assert EnvironmentState(graph).get_node_ids() == sorted(graph.get_node_ids())


def test_a_script_is_executed(home):
    executor = ScriptExecutor(EnvironmentGraph(home), None)
    executable, state, graphs = executor.execute(read_script_from_list_string(LINES))
    assert executable and len(graphs) == 4, executor.info.get_error_string()
    character = state.get_char_node(0)
    (held,) = state.get_nodes_from(character, Relation.HOLDS_RH)
    assert held.class_name == "milk"
    assert State.OPEN in state.get_nodes_by_attr("class_name", "fridge")[0].states
    assert next(executor.find_solutions(read_script_from_list_string(LINES))).get_nodes()


def test_why_a_script_is_not_executed(home):
    executor = ScriptExecutor(EnvironmentGraph(home), None)
    executable, _, graphs = executor.execute(read_script_from_list_string([LINES[0], LINES[2]]))
    assert not executable and len(graphs) == 2
    assert "the milk is inside the fridge, which is closed" in executor.info.get_error_string()
    assert next(executor.find_solutions(read_script_from_list_string([LINES[2]])), None) is None


def test_check_script_returns_eight_values(home):
    message, state, graphs, start, mapping, info, helper, script = check_script(LINES, [], None, home, False)
    assert message == "Script is executable" and len(graphs) == 4 and start["nodes"] and state.get_nodes()
    assert (mapping, info, helper, len(script)) == ({}, {}, None, 3)
    message, *_ = check_script(LINES[2:], [], None, home, False)
    assert message.startswith("Script is not executable, since ")
    assert check_script(["[FLY] <milk> (1)"], [], None, home) == (None,) * 8


def test_check_script_adds_what_a_script_needs(home):
    lines = ["[WALK] <umbrella> (1)", "[TOUCH] <umbrella> (1)"]
    assert "Script is not executable" in check_script(lines, [], None, home, False)[0]
    message, _, graphs, start, mapping, *_ = check_script(lines, [], None, home)
    assert message == "Script is executable" and len(graphs) == 3
    (umbrella,) = mapping.values()
    assert umbrella in {node["id"] for node in start["nodes"]}


def test_scripts_of_texts_and_files(tmp_path):
    (tmp_path / "a.txt").write_text("Milk\nTake it\n\n\n" + "\n".join(LINES))
    (tmp_path / "g.json").write_text(json.dumps({"nodes": [], "edges": []}))
    assert len(read_script(tmp_path / "a.txt")) == 3
    assert len(read_script_from_string(", ".join(LINES))) == 3
    with pytest.raises(ScriptParseException):
        read_script(tmp_path / "none.txt")
