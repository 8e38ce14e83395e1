"""`home list|show|lint|convert`, through typer's runner."""

import json

import pytest
from typer.testing import CliRunner

from hearth.cli import app


def run(*arguments):
    return CliRunner().invoke(app, ["home", *map(str, arguments)])


def test_list_counts_each_home():
    result = run("list", "--json")
    homes = {row["home"]: row for row in json.loads(result.stdout)["homes"]}
    assert result.exit_code == 0
    assert homes["maple"]["rooms"] == 4
    assert homes["maple"]["nodes"] > 350
    assert "maple" in run("list").stdout


def test_show_says_what_is_in_each_room_and_draws(tmp_path):
    result = run("show", "maple", "--out", tmp_path / "maple.svg", "--json")
    contents = {room["room"]: room["things"] for room in json.loads(result.stdout)["contents"]}
    assert result.exit_code == 0
    assert contents["kitchen"]["fridge"] == 1
    assert (tmp_path / "maple.svg").read_text().startswith("<svg")
    assert "fridge" in run("show", "maple").stdout


def test_lint_ends_with_1_where_something_is_wrong(tmp_path):
    assert run("lint", "maple").exit_code == 0
    nodes = [
        {"id": 1, "class_name": "kitchen", "category": "Rooms"},
        {"id": 2, "class_name": "cup", "category": "Props"},
    ]
    odd = {"nodes": nodes, "edges": [{"from_id": 2, "relation_type": "INSIDE", "to_id": 7}]}
    (tmp_path / "odd.json").write_text(json.dumps(odd))
    result = run("lint", tmp_path / "odd.json", "--json")
    assert result.exit_code == 1
    assert {fault["code"] for fault in json.loads(result.stdout)["faults"]} == {"UNKNOWN_ID", "NO_ROOM"}


def test_convert_writes_graphs_and_ids(tmp_path):
    assert run("convert", "maple", tmp_path / "copy.json").exit_code == 0
    assert run("lint", "copy", "--homes", tmp_path).exit_code == 0
    assert run("convert", "maple", tmp_path / "maple.ids.csv").exit_code == 0
    assert (tmp_path / "maple.ids.csv").read_text().startswith("id,name\n1,living_room\n")


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (("show", "mapel"), "UNKNOWN_HOME"),
        (("show", "missing.yaml"), "MISSING_FILE"),
        (("list", "--homes", "nowhere"), "MISSING_FILE"),
        (("convert", "maple", "copy.txt"), "UNSUPPORTED_FILE"),
    ],
)
def test_bad_input_is_one_clear_error(arguments, code):
    result = run(*arguments, "--json")
    assert result.exit_code == (2 if code == "UNKNOWN_HOME" else 1)
    assert [fault["code"] for fault in json.loads(result.stdout)["errors"]] == [code]


@pytest.mark.parametrize(("name", "data"), [("x.json", b"{"), ("x.json", b"[]"), ("x.yaml", b"\x00"), ("x.yaml", b"")])
def test_files_that_are_not_homes_are_refused(tmp_path, name, data):
    (tmp_path / name).write_bytes(data)
    result = run("show", tmp_path / name)
    assert result.exit_code == 1
    assert "Traceback" not in result.output


def test_a_generated_plan_is_a_home_like_others(tmp_path):
    result = run("generate", "--rooms", 3, "--seed", 5, "--out", tmp_path / "oak.yaml", "--json")
    assert result.exit_code == 0
    assert json.loads(result.stdout)["rooms"] == 3
    assert run("lint", "oak", "--homes", tmp_path).exit_code == 0
    assert run("generate", "--rooms", 20).exit_code == 1


def test_each_help_has_an_example():
    for command in ("list", "show", "lint", "convert", "edit", "generate", "stats"):
        assert f"hearth home {command}" in run(command, "--help").stdout


def test_things_are_added_moved_removed_and_set(tmp_path):
    out = tmp_path / "mine.json"
    nodes = {node["class_name"]: node["id"] for node in json.loads(_copied(tmp_path).read_text())["nodes"]}
    fridge, cup, table = nodes["fridge"], nodes["cup"], nodes["coffee_table"]
    orders = ("--add", f"apple:in:{fridge}", "--move", f"{cup}:on:{table}", "--set", f"{fridge}:open")
    result = run("edit", "maple", *orders, "--remove", nodes["mouse"], "--out", out, "--json")
    assert result.exit_code == 0, result.output
    (apple,) = json.loads(result.stdout)["added"]
    graph = json.loads(out.read_text())
    edges = {(e["from_id"], e["relation_type"], e["to_id"]) for e in graph["edges"]}
    states = {node["id"]: node["states"] for node in graph["nodes"]}
    assert {(apple, "INSIDE", fridge), (cup, "ON", table)} <= edges
    assert "OPEN" in states[fridge] and nodes["mouse"] not in states
    assert run("lint", out).exit_code == 0
    assert run("show", out, "--out", tmp_path / "mine.svg").exit_code == 0


def _copied(tmp_path):
    assert run("convert", "maple", tmp_path / "copy.json").exit_code == 0
    return tmp_path / "copy.json"


@pytest.mark.parametrize(
    ("order", "code"),
    [
        (("--add", "appel:on:44"), "UNKNOWN_OBJECT"),
        (("--add", "apple"), "SYNTAX"),
        (("--add", "apple:inside:44"), "NO_PLACE"),
        (("--move", "cup:on:44"), "SYNTAX"),
        (("--remove", "9999"), "UNKNOWN_ID"),
        (("--set", "44:LOUD"), "SYNTAX"),
    ],
)
def test_orders_that_make_no_sense_are_refused(tmp_path, order, code):
    result = run("edit", "maple", *order, "--out", tmp_path / "x.json", "--json")
    assert result.exit_code == (2 if code == "UNKNOWN_ID" else 1)
    (fault,) = json.loads(result.stdout)["errors"]
    assert fault["code"] == code and fault["suggestion"]
    assert not (tmp_path / "x.json").exists()


def test_nothing_is_removed_from_under_what_stays(tmp_path):
    graph = json.loads(_copied(tmp_path).read_text())
    kitchen = next(node["id"] for node in graph["nodes"] if node["class_name"] == "kitchen")
    inside = {e["from_id"] for e in graph["edges"] if e["to_id"] == kitchen and e["relation_type"] == "INSIDE"}
    out = tmp_path / "x.json"
    result = run("edit", "maple", "--remove", kitchen, "--out", out, "--json")
    (fault,) = json.loads(result.stdout)["errors"]
    assert result.exit_code == 1 and fault["code"] == "OCCUPIED" and f"{len(inside)} things" in fault["message"]
    assert not out.exists()
    every = [word for each in (kitchen, *sorted(inside)) for word in ("--remove", str(each))]
    assert run("edit", "maple", *every, "--out", out).exit_code == 0
    left = json.loads(out.read_text())
    assert len(left["nodes"]) == len(graph["nodes"]) - len(inside) - 1


def test_a_thing_that_holds_others_is_not_removed_alone(tmp_path):
    graph = json.loads(_copied(tmp_path).read_text())
    fridge = next(node["id"] for node in graph["nodes"] if node["class_name"] == "fridge")
    orders = ("--add", f"apple:in:{fridge}")
    assert run("edit", "maple", *orders, "--out", tmp_path / "fed.json").exit_code == 0
    result = run("edit", tmp_path / "fed.json", "--remove", fridge, "--out", tmp_path / "x.json", "--json")
    assert result.exit_code == 1 and "OCCUPIED" in result.stdout


def test_a_graph_is_laid_out(tmp_path):
    assert run("generate", "--rooms", 3, "--seed", 5, "--out", tmp_path / "small.json").exit_code == 0
    graph = json.loads((tmp_path / "small.json").read_text())
    for node in graph["nodes"]:
        node.pop("bounding_box"), node.pop("yaw", None)
    bare = tmp_path / "bare.json"
    bare.write_text(json.dumps(graph))
    found = json.loads(run("lint", bare, "--layout", "--json").stdout)
    assert {row["what"] for row in found["met"]} == {"things", "ON", "INSIDE", "CLOSE", "FACING"}
    assert all(row["shown"] > 0.6 * row["all"] for row in found["met"])
    assert run("convert", bare, tmp_path / "laid.json", "--layout").exit_code == 0
    laid = json.loads((tmp_path / "laid.json").read_text())
    assert all("bounding_box" in node for node in laid["nodes"])
    assert run("show", bare, "--out", tmp_path / "bare.svg").exit_code == 0


def test_statistics_stand_beside_each_other(tmp_path):
    _copied(tmp_path)
    found = json.loads(run("stats", "--generated", 2, "--homes", tmp_path, "--json").stdout)
    assert list(found) == ["ours", "generated", "theirs"]
    assert found["ours"]["homes"] == 7 and found["ours"]["pass lint"] == 7 and found["ours"]["nodes"] >= 350
    assert found["generated"]["homes"] == found["generated"]["pass lint"] == 2 and found["generated"]["rooms"] == 3.5
    assert found["theirs"]["homes"] == 1 and found["theirs"]["edges a node"] > 10
    assert found["theirs"]["smallest room, m2"] < found["theirs"]["room area, m2"] < found["theirs"]["largest room, m2"]
    assert found["ours"]["have the furniture of the thesis"] == 7 and found["ours"]["objects"] >= 350
    assert found["ours"]["fewest rooms"] >= 4 and found["ours"]["most rooms"] <= 7
    wanted = 100 * (found["ours"]["edges a node"] / found["theirs"]["edges a node"] - 1)
    assert found["ours"]["density beside theirs, %"] == pytest.approx(wanted, abs=0.06)
    degrees = sum(found["theirs"][f"{name} a node"] for name in ("ON", "INSIDE", "CLOSE", "FACING", "BETWEEN"))
    assert degrees == pytest.approx(found["theirs"]["edges a node"], abs=0.05)


def _nodes(path):
    return {node["id"]: node for node in json.loads(path.read_text())["nodes"]}


def _apart(one, other):
    a, b = one["bounding_box"], other["bounding_box"]
    return any(abs(p - q) >= (s + t) / 2 - 1e-6
               for p, q, s, t in zip(a["center"], b["center"], a["size"], b["size"], strict=True))  # fmt: skip


def test_what_is_put_somewhere_has_its_own_place_there(tmp_path):
    before = _nodes(_copied(tmp_path))
    ids = {node["class_name"]: node["id"] for node in before.values()}
    table, fridge, desk, bedroom = (ids[name] for name in ("coffee_table", "fridge", "desk", "bedroom"))
    chair, out = ids["chair"], tmp_path / "mine.json"
    orders = ("--add", f"cup:on:{table}", "--add", f"apple:in:{fridge}", "--move", f"{chair}:in:{bedroom}")
    assert run("edit", "maple", *orders, "--out", out).exit_code == 0
    after = _nodes(out)
    cup, apple = sorted(after.keys() - before.keys())
    top, box = after[table]["bounding_box"], after[cup]["bounding_box"]
    assert box["center"][1] - box["size"][1] / 2 >= top["center"][1] + top["size"][1] / 2 - 1e-3
    here = [e["from_id"] for e in json.loads(out.read_text())["edges"]
            if e["relation_type"] == "ON" and e["to_id"] == table]  # fmt: skip
    assert cup in here and all(_apart(after[cup], after[other]) for other in here if other != cup)
    inside = after[fridge]["bounding_box"]
    assert all(abs(a - b) < s / 2 for a, b, s in zip(after[apple]["bounding_box"]["center"], inside["center"],
                                                    inside["size"], strict=True))  # fmt: skip
    room = after[bedroom]["bounding_box"]
    stood = after[chair]["bounding_box"]["center"]
    assert all(abs(stood[k] - room["center"][k]) < room["size"][k] / 2 for k in (0, 2))
    assert after[desk] == before[desk]


def test_what_finds_no_room_is_refused(tmp_path):
    ids = {node["class_name"]: node["id"] for node in _nodes(_copied(tmp_path)).values()}
    beds = [word for _ in range(4) for word in ("--add", f"bed:in:{ids['bedroom']}")]
    done = run("edit", "maple", *beds, "--out", tmp_path / "x.json", "--json")
    assert done.exit_code == 1 and not (tmp_path / "x.json").exists()
    assert [fault["code"] for fault in json.loads(done.stdout)["errors"]] == ["NO_PLACE"]


def test_a_graph_with_values_too_deep_to_be_written(tmp_path):
    graph = '{"nodes": [], "edges": [], "more": ' + "[" * 300 + "]" * 300 + "}"
    (tmp_path / "home.json").write_text(graph)
    done = run("convert", tmp_path / "home.json", tmp_path / "copy.json")
    assert done.exit_code == 1 and "error[BAD_JSON]" in done.output
