"""Programs for graphs as VirtualHome 2.x and people write them: names, node ids, what is left out, what is near."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from hearth.cli import app

GRAB = ("GRABBABLE", "MOVABLE")
OPENS = ("CAN_OPEN", "CONTAINERS")
THINGS = {
    7: ("kitchen", "Rooms", (), (), None),
    8: ("bedroom", "Rooms", (), (), None),
    40: ("chair", "Furniture", ("SITTABLE", *GRAB), (), 7),
    41: ("chair", "Furniture", ("SITTABLE", *GRAB), (), 7),
    2: ("cup", "Props", GRAB, (), 7),
    3: ("cup", "Props", GRAB, (), 7),
    51: ("coffeepot", "Appliances", ("CAN_OPEN", *GRAB), ("CLOSED",), 7),
    52: ("washingmachine", "Appliances", (*OPENS, "HAS_SWITCH"), ("CLOSED", "OFF"), 7),
    53: ("kitchencabinets", "Furniture", OPENS, ("CLOSED",), 7),
    54: ("dishbowl", "Props", (*GRAB, "RECIPIENT"), (), 7),
    55: ("bowl", "Props", (*GRAB, "RECIPIENT"), (), 7),
    56: ("cutleryfork", "Props", GRAB, (), 7),
    57: ("towelrack", "Furniture", GRAB, (), 7),
    58: ("kitchencounter", "Furniture", ("SURFACES",), (), 7),
    59: ("bottlewater", "Food", (*GRAB, "DRINKABLE"), (), 7),
    60: ("hands_both", "BodyParts", ("BODY_PART",), (), 8),
    61: ("sink", "Furniture", ("CONTAINERS", "RECIPIENT"), (), 8),
    90: ("character", "Characters", (), (), 7),
}
INSIDE = [(node, "INSIDE", thing[4]) for node, thing in THINGS.items() if thing[4]]


def call(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def graph(folder, *edges, change=None):
    nodes = [
        {"id": node, "class_name": name, "category": category, "properties": list(can), "states": list(states)}
        for node, (name, category, can, states, _) in THINGS.items()
    ]
    for node in nodes:
        node.update((change or {}).get(node["id"], {}))
    kept = [{key: value for key, value in node.items() if value is not ...} for node in nodes]
    found = [{"from_id": a, "relation_type": r, "to_id": b} for a, r, b in (*INSIDE, *edges)]
    (folder / "vh2.json").write_text(json.dumps({"nodes": kept, "edges": found}))
    return folder / "vh2.json"


def run(folder, steps, *more, **written):
    (folder / "p.txt").write_text("T\nd\n\n\n" + "\n".join(steps) + "\n")
    where = written.get("graph") or graph(folder)
    return call("run", folder / "p.txt", "--graph", where, "--as-is", *more)


@pytest.mark.parametrize(
    ("steps", "nodes"),
    [
        (["<char0> [walk] <chair> (41)"], ["chair (41)"]),
        (["[Walk] <chair> (1.41)", "[Walk] <coffeepot> (1.51)"], ["chair (41)", "coffeepot (51)"]),
        (["[Walk] <chair> (1.41)", "[Walk] <chair> (1.40)"], ["node 41 (chair), <chair> to node 40 (chair)"]),
        (["[Walk] <chair> (41)", "[Walk] <coffeepot> (1)"], ["chair (41)", "coffeepot (51)"]),
        (["[Walk] <cup> (3)", "[Walk] <cup> (2)"], ["<cup> (3) is cup (3)", "<cup> (2) is cup (2)"]),
        # As not all numbers are nodes, and there are two cups, 2 counts them.
        (["[Walk] <cup> (2)", "[Walk] <chair> (1)"], ["<cup> (2) is cup (2)", "<chair> (1) is chair (40)"]),
        (["[Walk] <cup> (1)", "[Walk] <cup> (2)"], ["<cup> (1) is cup (2)", "<cup> (2) is cup (3)"]),
        (["[Walk] <chair> (2)", "[Walk] <chair> (1)"], ["<chair> (2) is chair (40)", "<chair> (1) is chair (41)"]),
    ],
)
def test_a_number_that_is_a_node_of_the_class_is_that_node(tmp_path, steps, nodes):
    result = run(tmp_path, steps)
    assert result.exit_code == 0 and all(node in result.output for node in nodes), result.output


def test_it_is_said_which_nodes_are_named_and_which_the_graph_lacks(tmp_path):
    result = run(tmp_path, ["[Walk] <chair> (1.41)", "[Walk] <coffeepot> (1.999)"])
    assert "<chair> to node 41 (chair)" in result.output
    assert "vh2 lacks 1 node that the program names: 999 (<coffeepot>); bound anew" in result.output
    assert result.exit_code == 0 and "coffeepot (51)" in result.output


@pytest.mark.parametrize("step", ["[Walk] <chair> (1.51)", "[Walk] <kitchen> (1.8)", "[Grab] <cup> (2.40)"])
def test_a_node_of_another_class_is_a_fault(tmp_path, step):
    result = run(tmp_path, ["[Walk] <kitchen> (1)", step])
    assert result.exit_code == 1 and "is said to be node" in result.output and "p.txt:6" in result.output


@pytest.mark.parametrize(
    "name", ["washingmachine", "washing machine", "coffeepot", "kitchencabinets", "dishbowl", "bowl", "cutleryfork",
             "flurbo", "kitchencounter", "bottlewater"],
)  # fmt: skip
def test_names_as_the_graph_has_them_bind_there(tmp_path, name):
    where = graph(tmp_path, change={57: {"class_name": "flurbo"}})
    result = run(tmp_path, [f"[Walk] <{name}> (1)"], graph=where)
    assert result.exit_code == 0 and f"is {name.replace(' ', '')} (" in result.output, result.output


@pytest.mark.parametrize(
    ("left_out", "steps"),
    [
        ({54: {"category": ..., "properties": ..., "states": ...}}, ["[Walk] <dishbowl> (1)", "[Grab] <dishbowl> (1)"]),
        ({54: {"properties": ...}}, ["[Walk] <dishbowl> (1)", "[Grab] <dishbowl> (1)"]),
        ({54: {"category": "PRE_Bowl_02"}}, ["[Walk] <dishbowl> (1)", "[Grab] <dishbowl> (1)"]),
        ({52: {"states": ..., "properties": ...}}, ["[Walk] <washingmachine> (1)", "[Open] <washingmachine> (1)"]),
    ],
)
def test_what_a_node_leaves_out_is_that_of_its_class_and_counted(tmp_path, left_out, steps):
    where = graph(tmp_path, change=left_out)
    for result in (run(tmp_path, steps, graph=where), call("home", "lint", where)):
        assert result.exit_code == 0, result.output
        assert "1 node without category, properties or states: from the knowledge of the class" in result.output


def test_lint_names_what_nobody_can_walk_to_with_a_remedy_that_works(tmp_path):
    whole = json.loads(graph(tmp_path).read_text())
    whole["edges"] = [e for e in whole["edges"] if e["from_id"] != 3] + [
        {"from_id": 3, "relation_type": "ON", "to_id": 58}
    ]
    sparse, mended = tmp_path / "sparse.json", tmp_path / "mended.json"  # graphs are read once a process
    sparse.write_text(json.dumps(whole))
    result = call("home", "lint", sparse)
    remedy = '{"from_id": 3, "relation_type": "INSIDE", "to_id": 7}'
    assert result.exit_code == 1 and "cup (3) is INSIDE no room" in result.output and remedy in result.output
    assert run(tmp_path, ["[Walk] <cup> (1.3)"], graph=sparse).exit_code == 1
    mended.write_text(json.dumps({**whole, "edges": [*whole["edges"], json.loads(remedy)]}))
    assert call("home", "lint", mended).exit_code == 0
    assert run(tmp_path, ["[Walk] <cup> (1.3)"], graph=mended).exit_code == 0


def test_lint_names_things_that_nothing_can_be_done_with(tmp_path):
    where = graph(tmp_path, change={40: {"properties": []}, 41: {"properties": []}})
    result = call("home", "lint", where)
    assert result.exit_code == 0
    assert "chair (40, 41): nothing can be done with it, as its `properties` are empty" in result.output


IN, ON = [(54, "INSIDE", 53)], [(54, "ON", 58)]
OPEN = ["[Walk] <kitchencabinets> (1)", "[Open] <kitchencabinets> (1)", "[Grab] <dishbowl> (1)"]
NEAR = [(60, "CLOSE", 61), (61, "CLOSE", 60)]


@pytest.mark.parametrize(
    ("edges", "steps", "runs"),
    [
        (IN, OPEN, {"auto", "evolving_graph"}),
        (IN, [OPEN[0], OPEN[2]], set()),
        (ON, ["[Walk] <kitchencounter> (1)", "[Grab] <dishbowl> (1)"], {"auto", "default", "replay", "evolving_graph"}),
        (NEAR, ["[Walk] <bedroom> (1)", "[Rinse] <hands_both> (1)"], {"auto", "default", "replay"}),
        (NEAR, ["[Walk] <kitchen> (1)", "[Touch] <kitchen> (1)"], {"auto", "default", "replay"}),
        (NEAR, ["[Walk] <cup> (1.2)", "[Grab] <cup> (1.2)", "[Grab] <cup> (1.2)"], {"auto", "default", "replay"}),
        # One's own hands make near what is in the room, in another only by the release's rules and `evolving_graph`.
        (NEAR, ["[Walk] <bedroom> (1)", "[Rinse] <sink> (1)"], {"auto", "default", "replay"}),
        (NEAR, ["[Walk] <chair> (1)", "[Rinse] <sink> (1)"], {"replay", "evolving_graph"}),
        (NEAR, ["[Walk] <kitchen> (1)", "[Wash] <sink> (1)"], {"replay"}),
        (NEAR, ["[Walk] <cup> (1.2)", "[Grab] <cup> (1.2)", "[PutIn] <cup> (1.2) <sink> (1)"],
         {"replay", "evolving_graph"}),
    ],
)  # fmt: skip
def test_what_is_near_by_each_of_the_rules(tmp_path, edges, steps, runs):
    where = graph(tmp_path, *edges)
    for rules in ("auto", "default", "replay", "evolving_graph"):
        result = run(tmp_path, steps, "--rules", rules, graph=where)
        assert (result.exit_code == 0) is (rules in runs), (rules, result.output)
        assert ("read by the rules `evolving_graph`" in result.output) is (rules == "auto" and edges != NEAR)


@pytest.mark.parametrize("room", ["kitchen", "bedroom", "living room", "bathroom"])
def test_one_turns_to_a_room(tmp_path, room):
    (tmp_path / "p.txt").write_text(f"Look\n\n\n\n[TurnTo] <{room}> (1)\n")
    assert call("check", tmp_path / "p.txt").exit_code == 0
    (tmp_path / "p.txt").write_text(f"Wash\n\n\n\n[Wash] <{room}> (1)\n")
    result = call("check", tmp_path / "p.txt")
    assert result.exit_code == 1 and "its object must be any object that is not a room" in result.output


@pytest.mark.parametrize(
    ("goal", "words"),
    [
        ('{"actions": [], "goal": []}', "Goal: reached."),
        ('{"goal": []}', "Goal: reached."),
        ('{"vh_goal": {"actions": [], "goal": []}, "tl_goal": ""}', "Goal: reached."),
        ('{"task": "tea", "tl_goal": ""}', "not a goal: it has no 'actions'"),
        ("", "expected a name"),
    ],
)
def test_a_record_without_goals_is_reached_at_once(tmp_path, goal, words):
    result = run(tmp_path, ["[Walk] <chair> (1)"], "--goal", goal)
    assert words in result.output and (result.exit_code == 0) is (words == "Goal: reached."), result.output
