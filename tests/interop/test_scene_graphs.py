"""Scene graphs of other shapes: what is read, filled in and left out."""

import json

import pytest
from typer.testing import CliRunner

from hearth.cli import app
from hearth.homes.library import load_graph
from hearth.homes.lint import lint
from hearth.interop.scene_graphs.mapping_file import read_mapping
from hearth.interop.scene_graphs.reading import MOST_ENTRIES, complete
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import from_release, to_release
from hearth.schemas.graph_json_schema import graph_schema
from tests.interop.scene_graph_readings import KNOWN, classes, held, read, rooms_of

ROBOT = {
    "header": {"frame_id": "map"},
    "objects": [
        {"uid": "table_1", "label": "table", "room": "kitchen", "dimensions": {"x": 1.2, "y": 0.8, "z": 0.76},
         "pose": {"position": {"x": 1.0, "y": 2.0, "z": 0.38}, "orientation": {"x": 0, "y": 0, "z": 0.7, "w": 0.7}}},
        {"uid": "cup_1", "label": "cup", "parent": "table_1", "dimensions": {"x": 0.08, "y": 0.08, "z": 0.1},
         "pose": {"position": {"x": 1.1, "y": 2.0, "z": 0.81}, "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}}},
    ],
}  # fmt: skip

SHAPES = {
    "a list": ([{"name": "fridge", "room": "kitchen"}, {"name": "milk", "in": "fridge"}], {("milk", "fridge")}, set()),
    "a robot": (ROBOT, set(), {("cup", "table")}),
    "3DSSG": (
        {"scans": [{"scan": "f62fd5fd", "objects": [
            {"id": "1", "label": "floor"}, {"id": "2", "label": "bed"}, {"id": "3", "label": "pillow"}],
            "relationships": [[3, 2, 14, "lying on"], [2, 1, 14, "standing on"], [3, 2, 9, "bigger than"]]}]},
        set(), {("pillow", "bed")},
    ),
    "a hierarchy": (
        {"nodes": [
            {"id": 7, "layer": 4, "attributes": {"type": "RoomNodeAttributes", "name": "kitchen"}},
            {"id": 8, "layer": 2, "attributes": {"type": "ObjectNodeAttributes", "name": "table",
             "position": [2.0, 2.0, 0.4], "bounding_box": {"min": [1.5, 1.5, 0.0], "max": [2.5, 2.5, 0.8]}}}],
         "edges": [{"source": 7, "target": 8}]},
        set(), set(),
    ),
    "captions": (
        {"objects": [{"id": 0, "object_tag": "sofa"}, {"id": 1, "object_tag": "pillow"}],
         "relations": [{"object1": {"id": 1}, "object2": {"id": 0}, "object_relation": "a on b"}]},
        set(), {("pillow", "sofa")},
    ),
    "rooms with lists": (
        {"rooms": [{"type": "Kitchen", "objects": ["stove", {"name": "fridge", "contains": ["milk"]}]}]},
        {("milk", "fridge")}, set(),
    ),
    "mappings by id": (
        {"rooms": {"kitchen_0": {}}, "objects": {
            "fridge_abc_0": {"category": "fridge", "room": "kitchen_0", "states": {"open": False}},
            "milk_1": {"category": "milk", "in": "fridge_abc_0"}}},
        {("milk", "fridge")}, set(),
    ),
    "AI2-THOR": (
        {"objects": [
            {"objectType": "Fridge", "objectId": "Fridge|1", "isOpen": True, "parentReceptacles": ["Floor|1"],
             "position": {"x": 0, "y": 0, "z": 2}, "rotation": {"x": 0, "y": 90, "z": 0},
             "axisAlignedBoundingBox": {"center": {"x": 0, "y": 0.9, "z": 2}, "size": {"x": 0.8, "y": 1.8, "z": 0.8}}},
            {"objectType": "Milk", "objectId": "Milk|1", "parentReceptacles": ["Fridge|1"],
             "position": {"x": 0, "y": 1, "z": 2}, "rotation": {"x": 0, "y": 0, "z": 0},
             "axisAlignedBoundingBox": {"center": {"x": 0, "y": 1, "z": 2}, "size": {"x": 0.1, "y": 0.2, "z": 0.1}}},
            {"objectType": "Floor", "objectId": "Floor|1", "position": {"x": 0, "y": 0, "z": 0}}]},
        {("milk", "fridge")}, set(),
    ),
}  # fmt: skip
"""By the shape's name: a file, the things INSIDE others, the things ON others."""


@pytest.mark.parametrize("name", SHAPES)
def test_a_shape_becomes_a_home_without_faults(name):
    data, inside, on = SHAPES[name]
    found = read(data)
    assert held(found, "INSIDE") == inside
    assert held(found, "ON") == on
    assert lint(found.graph, KNOWN) == ()
    assert found.left_out == ()
    assert any(node.class_name == "character" for node in found.graph.nodes)


def test_a_thing_of_no_class_is_left_out_with_its_place():
    found = read({"objects": [{"label": "fridge"}, {"label": "rocket"}]})
    assert classes(found) == ["fridge"]
    [fault] = found.left_out
    assert fault.code is Code.UNKNOWN_OBJECT
    assert "objects[1]" in fault.message and "rocket" in fault.message


def test_poses_of_robots_are_turned_upright():
    table = next(node for node in read(ROBOT).graph.nodes if node.class_name == "table")
    assert table.box.center == (-2.0, 0.38, 1.0)  # x forwards, y to the left, z upwards
    assert table.box.size == (1.2, 0.76, 0.8)  # its length turns with it
    assert table.yaw == pytest.approx(270.0, abs=0.1)  # a quarter to the left


def test_the_axis_that_fits_the_sizes_of_the_classes_points_upwards():
    fridge = {"label": "fridge", "position": [0, 0, 0.9], "size": [0.7, 0.7, 1.8]}
    found = read([fridge])
    assert next(node for node in found.graph.nodes if node.class_name == "fridge").box.size[1] == 1.8
    lying = read([{**fridge, "position": [0, 0.9, 0], "size": [0.7, 1.8, 0.7]}])
    assert next(node for node in lying.graph.nodes if node.class_name == "fridge").box.size[1] == 1.8


def test_states_are_those_that_a_class_has():
    data = [
        {"label": "fridge", "isOpen": True, "isToggled": True},
        {"label": "apple", "isOpen": True, "states": ["on", "clean"]},
        {"label": "television", "state": "switched on"},
    ]
    states = {node.class_name: set(node.states) for node in read(data).graph.nodes}
    assert {"OPEN", "ON"} <= states["fridge"] and "CLOSED" not in states["fridge"]
    assert not {"OPEN", "ON"} & states["food_apple"]
    assert "ON" in states["television"] and "OFF" not in states["television"]


def test_a_child_of_something_left_out_goes_to_what_holds_that():
    drawer = {"id": "d", "label": "gizmo", "in": "f"}
    found = read([{"id": "f", "label": "dresser", "room": "bedroom"}, drawer, {"id": "s", "label": "book", "in": "d"}])
    assert ("book", "dresser") in held(found, "INSIDE") | held(found, "ON")
    assert rooms_of(found)["book"] == "bedroom"


def test_what_the_file_puts_nowhere_is_where_it_usually_is_and_counted():
    found = read([{"label": "fridge", "room": "kitchen"}, {"label": "sofa", "room": "living room"}, {"label": "apple"}])
    assert ("food_apple", "fridge") in held(found, "INSIDE")
    [note] = [note for note in found.fillings if "usually are" in note.what]
    assert note.number == 1


def test_every_entry_is_a_node_or_left_out():
    labels = ["fridge", "wall", "rocket", "cup", "floor", "spoon", "gizmo"]
    found = read([{"label": label} for label in labels])
    building = next(note.number for note in found.fillings if note.what.startswith("left out, as the table"))
    assert len(classes(found)) + len(found.left_out) + building == len(labels)


def test_a_name_of_several_things_is_no_reference():
    data = [{"label": "mug", "on": "table"}, {"label": "table"}, {"label": "table"}]
    [fault] = read(data).left_out
    assert fault.code is Code.DUPLICATE


def test_a_reference_to_nothing_is_named():
    data = {"objects": [{"id": 1, "label": "mug"}], "relations": [{"subject": 1, "predicate": "on", "object": 9}]}
    [fault] = read(data).left_out
    assert "`9`" in fault.message and "relations[0]" in fault.message


@pytest.mark.parametrize("reference", [float("nan"), float("inf"), 1e300, "x", None, [], [1, 2], {"x": 1}])
def test_odd_places_are_no_boxes(reference):
    found = read([{"label": "fridge", "position": [reference, 0, 0], "size": [1, reference, 1]}])
    assert classes(found) == ["fridge"]


def test_circles_end():
    data = [{"id": "a", "label": "box", "in": "b"}, {"id": "b", "label": "box", "in": "a"}, {"label": "sofa"}]
    assert classes(read(data)) == ["box", "box", "sofa"]


def test_too_many_entries_are_refused():
    with pytest.raises(HearthError) as raised:
        read([{"label": "cup"}] * (MOST_ENTRIES + 1))
    assert raised.value.diagnostics[0].code is Code.FILE_TOO_LARGE


@pytest.mark.parametrize("data", [None, 3, "home", [], {}, {"objects": []}, {"objects": [1, 2]}, [[[]]]])
def test_a_file_without_things_is_refused(data):
    with pytest.raises(HearthError) as raised:
        read(data)
    assert raised.value.diagnostics[0].code is Code.BAD_GRAPH


def test_the_same_file_gives_the_same_bytes():
    first, second = (read(json.loads(json.dumps(ROBOT))) for _ in range(2))
    assert first == second


def test_a_graph_of_the_release_s_layout_is_completed():
    data = {
        "nodes": [{"id": 1, "class_name": "kitchen", "category": "Rooms"},
                  {"id": 2, "class_name": "fridge", "category": "Appliances", "properties": [], "states": []}],
        "edges": [{"from_id": 2, "relation_type": "INSIDE", "to_id": 1}],
    }  # fmt: skip
    found = complete(from_release(data), KNOWN, "mine.json")
    fridge = found.graph.node(2)
    assert "CAN_OPEN" in fridge.properties and "CLOSED" in fridge.states and fridge.box is not None
    assert lint(found.graph, KNOWN) == ()


def test_a_mapping_names_fields_classes_and_units(tmp_path):
    path = tmp_path / "names.yaml"
    path.write_text(
        "fields: {label: kind, position: where}\nclasses: {gizmo: toaster, rocket: null}\nscale: 0.01\nup: z\n"
    )
    shape = read_mapping(path, KNOWN)
    things = [
        {"kind": "gizmo", "where": [100, 200, 50]},
        {"kind": "rocket"},
        {"kind": "table", "where": [200, 300, 40]},
    ]
    found = read(things, shape)
    assert classes(found) == ["table", "toaster"]
    assert found.left_out == ()
    assert next(node for node in found.graph.nodes if node.class_name == "toaster").box.center == (-2.0, 0.5, 1.0)


@pytest.mark.parametrize("text, line", [
    ("fields: {lable: kind}\n", 1), ("up: q\n", 1), ("scale: -1\n", 1), ("classes:\n  gizmo: toster\n", 2),
    ("fields: 3\n", 1), ("edges: {source: 3}\n", 1),
])  # fmt: skip
def test_faults_of_a_mapping_have_their_line(tmp_path, text, line):
    path = tmp_path / "names.yaml"
    path.write_text(text)
    with pytest.raises(HearthError) as raised:
        read_mapping(path, KNOWN)
    assert raised.value.diagnostics[0].line == line


def test_what_is_written_keeps_to_the_published_schema():
    validate = pytest.importorskip("jsonschema", reason="jsonschema is not installed").validate
    for data, _, _ in SHAPES.values():
        validate(json.loads(json.dumps(to_release(read(data).graph))), graph_schema())
    validate(json.loads(json.dumps(to_release(load_graph("maple", KNOWN)))), graph_schema())


def test_a_home_of_another_shape_is_one_command(tmp_path):
    def run(*words):
        return CliRunner().invoke(app, [*map(str, words)])

    (tmp_path / "scan.json").write_text(json.dumps(ROBOT))
    done = run("home", "convert", tmp_path / "scan.json", tmp_path / "home.json", "--fill", "--json")
    assert done.exit_code == 0, done.output
    document = json.loads(done.stdout)
    assert document["ids"] == {"2": "table_1", "3": "cup_1"} and document["left_out"] == []
    assert run("home", "lint", tmp_path / "home.json").exit_code == 0
    (tmp_path / "scan.json").write_text(json.dumps({"objects": [{"label": "fridge"}, {"label": "rocket"}]}))
    assert run("home", "convert", tmp_path / "scan.json", tmp_path / "home.json", "--fill").exit_code == 1


def test_any_name_of_a_class_will_do_in_a_mapping(tmp_path):
    path = tmp_path / "names.yaml"
    path.write_text("classes: {gizmo: tv, 3: bed}\n")
    found = read([{"label": "gizmo"}, {"label": 3}], read_mapping(path, KNOWN))
    assert classes(found) == ["bed", "television"] and found.left_out == ()


def test_a_file_of_unknown_things_alone_names_twenty_and_counts_the_others():
    with pytest.raises(HearthError) as raised:
        read([{"label": f"gizmo {letter}"} for letter in "abcdefghijklmnopqrstuvwxyz"])
    assert len(raised.value.diagnostics) == 21 and "and 6 more" in raised.value.diagnostics[-1].message


def test_several_faults_of_a_mapping_are_named_together(tmp_path):
    path = tmp_path / "names.yaml"
    path.write_text("up: q\nscale: -1\n")
    with pytest.raises(HearthError) as raised:
        read_mapping(path, KNOWN)
    assert len(raised.value.diagnostics) == 2
