"""Scene graphs with places, in the formats of robots, scans and simulators: rooms, doors, sizes."""

import json

import pytest
from typer.testing import CliRunner

from hearth.cli import app
from hearth.homes.lint import lint
from hearth.interop.scene_graphs.class_names import class_of
from hearth.interop.scene_graphs.shape import usual
from hearth.schemas.diagnostics import HearthError
from tests.interop.scene_graph_readings import KNOWN, classes, held, read, rooms_of


def named(found, name):
    return next(node for node in found.graph.nodes if node.class_name == name)


def count(found, beginning):
    return sum(note.number for note in found.fillings if note.what.startswith(beginning))


def doors(found):
    names = {node.id: node.class_name for node in found.graph.nodes}
    pairs = {}
    for edge in found.graph.edges:
        if edge.relation == "BETWEEN":
            pairs.setdefault(edge.source, set()).add(names[edge.target])
    return sorted(tuple(sorted(pair)) for pair in pairs.values())


def pose(x, y, z, turn=(0.0, 1.0)):
    return {"position": {"x": x, "y": y, "z": z}, "orientation": {"x": 0, "y": 0, "z": turn[0], "w": turn[1]}}


def corners(x0, y0, x1, y1):
    return {"points": [{"x": x, "y": y, "z": 0.0} for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]}


def robot(*more):
    """A robot's map of two rooms; more things may be added."""
    size = {"x": 0.7, "y": 0.7, "z": 1.8}
    return {
        "regions": [
            {"id": "region_0", "name": "kitchen", "polygon": corners(0, 0, 4, 3.5)},
            {"id": "region_1", "name": "living room", "polygon": corners(4, 0, 9, 3.5)},
        ],
        "objects": [
            {"id": "a", "class": "refrigerator", "pose": pose(0.4, 0.5, 0.9), "size": size},
            {"id": "b", "class": "table", "pose": pose(2, 1.7, 0.37, (0.7071, 0.7071)),
             "size": {"x": 1.2, "y": 0.8, "z": 0.74}},
            {"id": "c", "class": "couch", "pose": pose(6.5, 0.6, 0.4), "size": {"x": 2.0, "y": 0.9, "z": 0.8}},
            *more,
        ],
    }  # fmt: skip


def test_outlines_of_regions_are_rooms_that_hold_the_things_in_them():
    found = read(robot())
    assert rooms_of(found)["fridge"] == "kitchen" and rooms_of(found)["couch"] == "living_room"
    # x forwards and y to the left: the kitchen lies from -3.5 to 0 across, less half a wall at the living room.
    assert named(found, "kitchen").box.size[0] == 3.5 and named(found, "kitchen").box.center[0] == -1.75
    assert named(found, "living_room").box.size[2] == pytest.approx(5 - 0.06)
    assert doors(found) == [("kitchen", "living_room")] and lint(found.graph, KNOWN) == ()
    assert count(found, "doors that the file leaves out") == 1


def test_a_size_turns_with_its_thing():
    assert named(read(robot()), "table").box.size == (1.2, 0.74, 0.8)


def test_one_thing_out_of_reach_loses_its_box_and_no_other_does():
    far = {"id": "d", "class": "cup", "pose": pose(14, 9, 0.8), "size": {"x": 0.1, "y": 0.1, "z": 0.1}}
    found = read(robot(far))
    assert named(found, "cup").box is None and named(found, "couch").box.center[1] == 0.4
    assert count(found, "things without a box, as nobody can walk") == 1
    assert lint(found.graph, KNOWN) == ()


def test_where_most_things_are_out_of_reach_all_boxes_are_laid_out():
    things = [
        {"label": "box", "room": "kitchen", "position": [0, 20.0 * n, 0.2], "size": [0.4, 0.4, 0.4]} for n in range(3)
    ]
    found = read({"rooms": [{"id": "kitchen", "label": "kitchen", "polygon": corners(0, 0, 3, 3)}], "objects": things})
    assert count(found, "boxes of the file left out") == 3


def test_a_door_of_the_file_is_between_the_rooms_in_whose_wall_it_is():
    door = {
        "id": "d",
        "class": "door",
        "state": "closed",
        "pose": pose(4, 1.75, 1.0),
        "size": {"x": 0.08, "y": 0.9, "z": 2},
    }
    found = read(robot(door))
    assert doors(found) == [("kitchen", "living_room")] and count(found, "doors of the file") == 1
    assert "CLOSED" in named(found, "door").states and lint(found.graph, KNOWN) == ()


def test_a_list_of_doors_needs_no_labels():
    rooms = [{"name": "kitchen", "x": 0, "y": 0, "width": 3.0, "depth": 3.0},
             {"name": "bedroom", "x": 3.0, "y": 0, "width": 3.0, "depth": 3.0}]  # fmt: skip
    things = [{"name": "fridge", "x": 0.4, "y": 0.4, "z": 0, "size": [0.6, 0.6, 1.7]},
              {"name": "bed", "x": 5.0, "y": 1.5, "z": 0, "size": [2.0, 1.6, 0.5]}]  # fmt: skip
    found = read({"rooms": rooms, "doors": [{"between": ["kitchen", "bedroom"], "x": 3.0, "y": 1.5}], "things": things})
    assert doors(found) == [("bedroom", "kitchen")]
    assert rooms_of(found)["fridge"] == "kitchen" and rooms_of(found)["bed"] == "bedroom"
    assert count(found, "rooms whose places are their corners") == 2


@pytest.mark.parametrize("fields", [
    {"x": 2.0, "y": 1.0, "z": 0.375, "w": 1.2, "d": 0.8, "h": 0.75},
    {"cx": 2.0, "cy": 1.0, "cz": 0.375, "width": 1.2, "depth": 0.8, "height": 0.75},
    {"center": [2.0, 1.0, 0.375], "dimensions": {"width": 1.2, "depth": 0.8, "height": 0.75}},
    {"x_min": 1.4, "y_min": 0.6, "z_min": 0, "x_max": 2.6, "y_max": 1.4, "z_max": 0.75},
])  # fmt: skip
def test_places_and_sizes_may_be_numbers_of_their_own(fields):
    fridge = {"label": "fridge", "position": [0.4, 0.4, 0.9], "size": [0.7, 0.7, 1.8]}
    table = named(read([fridge, {"label": "table", **fields}]), "table")
    assert table.box.center == (-1.0, 0.375, 2.0) and table.box.size == (0.8, 0.75, 1.2)


def hydra(names=("R0", "R1"), **more):
    def node(number, layer, kind, name, place, size=None):
        box = {} if size is None else {"bounding_box": {"dimensions": size, "world_P_center": place}}
        own = {"type": kind, "name": name, "semantic_label": number % 10, "position": place, **box}
        return {"id": number, "layer": layer, "attributes": own}

    nodes = [node(1, 5, "SemanticNodeAttributes", "B0", [0, 0, 0]),
             node(10, 4, "RoomNodeAttributes", names[0], [1.5, 1.5, 0]),
             node(11, 4, "RoomNodeAttributes", names[1], [6, 1.5, 0]),
             node(21, 3, "PlaceNodeAttributes", "", [1, 1, 0]), node(22, 3, "PlaceNodeAttributes", "", [6, 1, 0]),
             node(31, 2, "ObjectNodeAttributes", "refrigerator", [0.4, 0.5, 0.9], [0.7, 0.7, 1.8]),
             node(32, 2, "ObjectNodeAttributes", "oven", [0.4, 2.2, 0.45], [0.6, 0.6, 0.9]),
             node(33, 2, "ObjectNodeAttributes", "bed", [6.6, 1.2, 0.3], [2.0, 1.6, 0.6])]  # fmt: skip
    links = [(1, 10), (1, 11), (10, 11), (10, 21), (11, 22), (21, 22), (21, 31), (21, 32), (22, 33)]
    return {"nodes": nodes, "edges": [{"source": one, "target": other} for one, other in links], **more}


def test_rooms_that_are_only_numbered_get_their_class_from_the_things_in_them():
    found = read(hydra())
    assert rooms_of(found)["fridge"] == "kitchen" and rooms_of(found)["bed"] == "bedroom"
    assert found.left_out == () and count(found, "rooms that the file only numbers") == 2
    assert named(found, "bed").box.size == (1.6, 0.6, 2.0) and lint(found.graph, KNOWN) == ()


def test_the_label_space_of_a_layer_comes_before_the_things():
    spaces = {"labelspaces": {"_l4p0": [[0, "living room"], [1, "kids bedroom"]]}}
    assert rooms_of(read(hydra(("R(0)", "R(1)"), metadata=spaces)))["fridge"] == "living_room"


def test_a_numbered_room_without_a_thing_is_named():
    data = {"rooms": [{"id": "R7", "name": "R7"}], "objects": [{"label": "fridge", "room": "kitchen"}]}
    [fault] = read(data).left_out
    assert "`R7`" in fault.message


def test_several_floors_are_rooms():
    def thing(number, label, place, size):
        return {"id": number, "label": label, "obb": {"centroid": place, "axesLengths": size,
                "normalizedAxes": [1, 0, 0, 0, 1, 0, 0, 0, 1]}}  # fmt: skip

    found = read({"objects": [
        thing(1, "floor", [2, 2, 0], [4, 4, 0.1]), thing(2, "floor", [6, 2, 0], [4, 4, 0.1]),
        thing(3, "refrigerator", [0.5, 0.5, 0.9], [0.7, 0.7, 1.8]), thing(4, "bed", [6, 2, 0.3], [1.6, 2.0, 0.6]),
        thing(5, "pillow", [6, 2.6, 0.66], [0.5, 0.4, 0.12])]})  # fmt: skip
    assert rooms_of(found)["fridge"] == "kitchen" and rooms_of(found)["bed"] == "bedroom"
    assert named(found, "bed").box.size == (2.0, 0.6, 1.6) and held(found, "ON") == {("pillow", "bed")}


def test_axes_of_habitat_are_mirrored_and_its_quaternions_begin_with_w():
    def instance(name, place, rotation=(1, 0, 0, 0)):
        return {"template_name": f"objects/{name}", "translation": place, "rotation": rotation}

    found = read({"stage_instance": {}, "object_instances": [
        instance("bed", [1.0, 0, -2.0]), instance("couch", [3.0, 0, -5.0], [0.7071, 0, 0.7071, 0])]})  # fmt: skip
    assert named(found, "bed").box.center[::2] == (1.0, 2.0)  # z away from us is north
    assert named(found, "bed").yaw == 180.0 and named(found, "couch").yaw == 90.0  # +z is the front of a model


def test_a_map_that_runs_askew_is_turned_straight():
    quarter = 0.13053  # sine of half of 15 degrees
    things = [{"label": label, "room": "bedroom", "pose": pose(x, x * 0.26795, z, (quarter, 0.99144)), "size": size}
              for label, x, z, size in (("bed", 0.0, 0.3, [2, 1.6, 0.6]), ("desk", 3.0, 0.37, [0.6, 1.2, 0.74]),
                                        ("dresser", 5.0, 0.5, [0.5, 1.0, 1.0]))]  # fmt: skip
    found = read(things)
    assert count(found, "places turned by") == 4 - 1
    assert [round(named(found, name).box.center[0], 2) for name in ("bed", "desk", "dresser")] == [0.0, 0.0, 0.0]


URDF = """<robot name="scene"><link name="world"/>
<link name="bed_1" category="bed" rooms="bedroom_0" bounding_box="2.0 1.6 0.6"/>
<joint name="j1" type="fixed"><origin xyz="-2 1 0.3" rpy="0 0 1.57"/><parent link="world"/><child link="bed_1"/></joint>
<link name="door_2" category="door" rooms="bedroom_0,kitchen_0" bounding_box="0.08 0.9 2.0"/>
<joint name="j2" type="fixed"><origin xyz="0 1 1.0" rpy="0 0 0"/><parent link="world"/><child link="door_2"/></joint>
<link name="fridge_3" category="fridge" rooms="kitchen_0" bounding_box="0.7 0.7 1.8"/>
<joint name="j3" type="fixed"><origin xyz="2 0 0.9" rpy="0 0 0"/><parent link="world"/><child link="fridge_3"/></joint>
</robot>"""

YAML = """objects:
- {id: a, label: fridge, room: kitchen, pose: {position: {x: 0.4, y: 0.5, z: 0.9}}}
- {id: b, label: milk, in: a}
"""


def convert(folder, name, text):
    (folder / name).write_text(text)
    done = CliRunner().invoke(app, ["home", "convert", str(folder / name), str(folder / "o.json"), "--fill", "--json"])
    return done.exit_code, json.loads(done.stdout)


def test_files_in_yaml_and_urdf_are_read(tmp_path):
    assert convert(tmp_path, "map.yaml", YAML)[1]["ids"] == {"2": "a", "3": "b"}
    status, found = convert(tmp_path, "scene.urdf", URDF)
    assert status == 0 and set(found["ids"].values()) == {"bedroom_0", "kitchen_0", "bed_1", "door_2", "fridge_3"}


@pytest.mark.parametrize("name, text, code", [
    ("map.yaml", "a: [", "BAD_TABLE"), ("scene.urdf", "<robot>", "SYNTAX"),
    ("scene.urdf", '<!DOCTYPE a [<!ENTITY b "c">]><robot/>', "SYNTAX"), ("scene.urdf", "<robot/>", "BAD_GRAPH"),
])  # fmt: skip
def test_faulty_files_in_yaml_and_urdf_are_refused(tmp_path, name, text, code):
    status, found = convert(tmp_path, name, text)
    assert status == 1 and found["errors"][0]["code"] == code


@pytest.mark.parametrize("label, name", [
    ("wooden chair", "chair"), ("small red_cup", "cup"), ("round glass table", "table"), ("kitchen sink", "sink"),
    ("carton of milk", "milk"), ("objects/fridge.glb", "fridge"), ("hot dog", ""), ("jam jar", ""), ("rocket", ""),
])  # fmt: skip
def test_adjectives_before_a_class_are_left_out(label, name):
    assert class_of(label, usual(), KNOWN).name == name


def test_adjectives_that_are_left_out_are_counted():
    assert count(read([{"label": "wooden chair"}, {"label": "fridge"}]), "classes without the adjectives") == 1


def test_a_thing_on_top_of_its_holder_is_on_it_whatever_the_file_calls_its_parent():
    dresser = {"id": "d", "label": "dresser", "position": [0, 0.5, 0], "size": [1.0, 1.0, 0.5]}
    inside = {"id": "s", "label": "shirt", "parent": "d", "position": [0, 0.3, 0], "size": [0.3, 0.1, 0.3]}
    on_top = {"id": "b", "label": "box", "parent": "d", "position": [0, 1.15, 0], "size": [0.3, 0.3, 0.3]}
    found = read([dresser, inside, on_top])
    assert ("box", "dresser") in held(found, "ON") and ("clothes_shirt", "dresser") in held(found, "INSIDE")


def test_things_of_no_file_are_refused():
    with pytest.raises(HearthError):
        read({"regions": [], "objects": []})
    assert classes(read(robot())) == ["couch", "fridge", "table"]
