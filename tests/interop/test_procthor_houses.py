"""Houses of ProcTHOR: read as homes, written from homes, and read back equal."""

import copy
import gzip
import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from hearth.cli import app
from hearth.homes.library import load_graph, names
from hearth.homes.lint import lint
from hearth.interop.procthor.asset_sizes import installed, read_assets
from hearth.interop.procthor.floor_rectangles import rectangles
from hearth.interop.procthor.house import MOST_OBJECTS, MOST_ROOMS, is_house, read_house
from hearth.interop.procthor.house_export import house_of
from hearth.interop.procthor.house_reading import read_house_home
from hearth.interop.scene_graphs.shape import usual
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

KNOWN = default()
HOUSES = {
    path.stem: json.loads(path.read_text()) for path in sorted((Path(__file__).parent / "procthor_houses").iterdir())
}


def read(data, sizes=None):
    return read_house_home(read_house(data, "house.json"), usual(), KNOWN, sizes or {}, "house.json")


def written(graph, assets=None):
    return json.loads(json.dumps(house_of(graph, KNOWN, assets or {}).data))


def house(name="two_rooms"):
    return copy.deepcopy(HOUSES[name])


def edges(found):
    names_ = {node.id: node.class_name for node in found.graph.nodes}
    return {(names_[one], relation, names_[other]) for one, relation, other in found.graph.edges}


@pytest.mark.parametrize("name", HOUSES)
def test_a_house_is_a_home_without_faults(name):
    assert lint(read(house(name)).graph, KNOWN, name) == ()


@pytest.mark.parametrize("name", HOUSES)
def test_a_house_that_was_read_is_written_and_read_back_equal(name):
    found = read(house(name)).graph
    assert read(written(found)).graph == found


@pytest.mark.parametrize("name", names())
def test_a_home_of_ours_is_written_and_read_back_equal(name):
    graph = load_graph(name, KNOWN)
    found = read(written(graph))
    assert found.graph == graph and found.left_out == ()


def test_rooms_doors_objects_and_states_are_read():
    found = read(house())
    assert {("food_egg", "INSIDE", "fridge"), ("plate", "ON", "dining_table"), ("door", "BETWEEN", "kitchen"),
            ("door", "BETWEEN", "living_room"), ("window", "INSIDE", "living_room"),
            ("character", "INSIDE", "kitchen")} <= edges(found)  # fmt: skip
    nodes = {node.class_name: node for node in found.graph.nodes}
    assert "CLOSED" in nodes["door"].states and "ON" in nodes["television"].states
    assert "DIRTY" in nodes["plate"].states and "CLOSED" in nodes["fridge"].states
    assert nodes["doorjamb"].box.center == (4.0, 1.025, 2.0)
    assert nodes["window"].box.center[1:] == (1.45, 2.0)
    assert nodes["character"].box.center == (3.2, 0.85, 2.5)
    [left] = found.left_out
    assert left.code is Code.UNKNOWN_OBJECT and "objects[5]" in left.message


def test_a_room_with_six_corners_is_two_rooms_without_a_wall_between_them():
    found = read(house("six_corners"))
    rooms = [node for node in found.graph.nodes if node.category == "Rooms"]
    assert sorted(room.class_name for room in rooms) == ["bathroom", "kitchen", "living_room", "living_room"]
    [note] = [note for note in found.fillings if "four corners" in note.what]
    assert note.number == 1
    between = {e.source: {x.target for x in found.graph.edges if x.source == e.source and x.relation == "BETWEEN"}
               for e in found.graph.edges if e.relation == "BETWEEN"}  # fmt: skip
    assert len(between) == 3  # the gap of the living room, the empty wall, the door of the bathroom
    assert all(len(ends) == 2 for ends in between.values())


def test_floors_are_cut_into_rectangles():
    corners = [(0, 0), (0, 6), (3, 6), (3, 3), (6, 3), (6, 0)]
    rects = rectangles(corners)
    assert sum(rect.width * rect.depth for rect in rects) == pytest.approx(27)
    assert all(one.overlap(other) == 0 for one in rects for other in rects if one is not other)
    assert rectangles(corners[::-1]) == rects
    assert rectangles([(0, 0), (1, 2), (2, 0), (1, -2)]) == []


def test_sizes_of_models_come_from_the_database(tmp_path):
    path = tmp_path / "assets.json"
    path.write_text(json.dumps({"Fridge": [{"assetId": "Fridge_1", "boundingBox": {"x": 0.9, "y": 1.7, "z": 0.6}}]}))
    sizes = {each.id: each.size for models in read_assets(path).values() for each in models}
    nodes = {node.class_name: node for node in read(house(), sizes).graph.nodes}
    assert nodes["fridge"].box.size == (0.6, 1.7, 0.9)  # turned by a quarter
    wide = written(read(house(), sizes).graph, {"Fridge": [*read_assets(path)["Fridge"]]})
    assert next(each for each in wide["objects"] if each["id"].startswith("Fridge"))["assetId"] == "Fridge_1"


def test_models_of_the_installed_database_fit():
    path = installed()
    if path is None:
        pytest.skip("the package `procthor` is not installed")
    assets = read_assets(path)
    known = {each.id for models in assets.values() for each in models}
    graph = load_graph("maple", KNOWN)
    data = written(graph, assets)
    waiting = list(data["objects"])
    while waiting:
        each = waiting.pop()
        waiting += each.get("children", [])
        assert each["assetId"] in known
    assert read(data).graph == graph


def test_walls_and_holes_are_those_of_procthor():
    data = written(load_graph("maple", KNOWN))
    walls = {wall["id"]: wall for wall in data["walls"]}
    assert len(walls) == len(data["walls"])
    for hole in (*data["doors"], *data["windows"]):
        one, other = walls[hole["wall0"]], walls[hole["wall1"]]
        feet = [[(p["x"], p["z"]) for p in wall["polygon"][:2]] for wall in (one, other)]
        assert feet[0] == feet[1][::-1]  # both sides of one wall
        long = max(abs(feet[0][0][0] - feet[0][1][0]), abs(feet[0][0][1] - feet[0][1][1]))
        assert 0 <= hole["holePolygon"][0]["x"] < hole["holePolygon"][1]["x"] <= long


@pytest.mark.parametrize("change, code, words", [
    (lambda data: data["rooms"][0].update(floorPolygon=[{"x": float("nan"), "y": 0, "z": 0}] * 4), Code.BAD_GRAPH,
     "rooms[0]"),
    (lambda data: data["rooms"][0].update(roomType="Garage"), Code.UNKNOWN_OBJECT, "Garage"),
    (lambda data: data["rooms"].append(data["rooms"][0]), Code.DUPLICATE, "rooms[2]"),
    (lambda data: data["objects"][2].update(position={"x": 1, "y": float("inf"), "z": 0}), Code.BAD_GRAPH,
     "objects[2]"),
    (lambda data: data["objects"][2].update(position={"x": 1e9, "y": 0, "z": 0}), Code.BAD_GRAPH, "objects[2]"),
    (lambda data: data["objects"][2].update(id="Fridge|2|0"), Code.DUPLICATE, "objects[2]"),
    (lambda data: data["objects"][2].update(hearth={"holder": "Chair|2|6"}), Code.LOOP, "Chair|2|6"),
    (lambda data: data["doors"][0].update(wall0="wall|9"), Code.BAD_GRAPH, "doors[0]"),
    (lambda data: data["windows"][0].update(holePolygon=[]), Code.BAD_GRAPH, "windows[0]"),
])  # fmt: skip
def test_an_entry_that_cannot_be_read_is_left_out_with_its_place_and_a_remedy(change, code, words):
    data = house()
    change(data)
    found = read(data).left_out
    fault = next(fault for fault in found if words in fault.message)
    assert fault.code is code and fault.suggestion


@pytest.mark.parametrize("change, code", [
    (lambda data: data.update(rooms=[{"floorPolygon": 3}]), Code.BAD_GRAPH),
    (lambda data: data.update(rooms=data["rooms"] * MOST_ROOMS), Code.FILE_TOO_LARGE),
    (lambda data: data.update(objects=data["objects"] * MOST_OBJECTS), Code.FILE_TOO_LARGE),
    (lambda data: [room.update(roomType="Nowhere") for room in data["rooms"]], Code.UNKNOWN_OBJECT),
])  # fmt: skip
def test_a_house_without_a_home_is_refused(change, code):
    data = house()
    change(data)
    assert is_house(data)
    with pytest.raises(HearthError) as raised:
        read(data)
    assert raised.value.diagnostics[0].code is code and raised.value.diagnostics[0].suggestion


def test_objects_in_one_another_a_thousand_times_end():
    data = house()
    inner = data["objects"][2]
    for number in range(1000):
        inner = {"id": f"Box|{number}", "position": {"x": 1, "y": 0, "z": 1}, "children": [inner]}
    data["objects"].append(inner)
    assert any("stands in" in fault.message for fault in read(data).left_out)


def run(*words):
    return CliRunner().invoke(app, [*map(str, words)])


def test_both_ways_are_a_command_each(tmp_path):
    first, second, house_file = (tmp_path / name for name in ("first.json", "second.json", "house.json"))
    assert run("home", "convert", "maple", first).exit_code == 0
    done = run("home", "export", "maple", "--format", "procthor", "--out", house_file, "--json")
    assert done.exit_code == 0, done.output
    assert json.loads(done.stdout)["only_for_hearth"]["stove"] == 1
    done = run("home", "convert", house_file, second)
    assert done.exit_code == 0, done.output
    assert first.read_bytes() == second.read_bytes()


@pytest.mark.parametrize("packed", [False, True])
def test_a_file_with_a_house_a_line_has_houses_by_number(tmp_path, packed):
    text = "".join(json.dumps(data) + "\n" for data in HOUSES.values()).encode()
    path = tmp_path / ("train.jsonl.gz" if packed else "train.jsonl")
    path.write_bytes(gzip.compress(text) if packed else text)
    done = run("home", "convert", path, tmp_path / "home.json", "--scene", "2", "--json")
    assert done.exit_code == 0, done.output
    assert any(each["number"] == 1 and "four corners" in each["what"] for each in json.loads(done.stdout)["filled"])
    refused = run("home", "convert", path, tmp_path / "home.json", "--scene", "4")
    assert refused.exit_code == 1 and "UNKNOWN_ID" in refused.output


def test_a_damaged_file_of_houses_is_refused(tmp_path):
    path = tmp_path / "train.jsonl.gz"
    path.write_bytes(gzip.compress(b'{"rooms": []}')[:-6])
    done = run("home", "convert", path, tmp_path / "home.json")
    assert done.exit_code == 1 and "BAD_ARCHIVE" in done.output
