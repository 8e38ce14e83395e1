"""Bad input of `home convert --fill`: a fault at each node, with a remedy, in bounded time and memory."""

import json
import math
import tracemalloc

import pytest
from typer.testing import CliRunner

from hearth import cli
from hearth.interop.scene_graphs import reading
from hearth.schemas.failures import Code
from tests.interop.scene_graph_readings import classes, read, rooms_of

SIZES = {"fridge": (0.7, 0.7, 1.8), "table": (1.2, 0.8, 0.75), "sofa": (2.0, 0.9, 0.8)}


def convert(folder, text=None):
    if text is not None:
        (folder / "scan.json").write_text(text)
    words = ["home", "convert", str(folder / "scan.json"), str(folder / "o.json"), "--fill", "--json"]
    result = CliRunner().invoke(cli.app, words)
    return result.exit_code, json.loads(result.stdout)


def furniture(scale=1.0, **more):
    things = [
        {"label": name, "position": [place * scale, 0, size[2] * scale / 2], "size": [each * scale for each in size]}
        for place, (name, size) in enumerate(SIZES.items())
    ]
    return {"objects": things, **more}


def heights(found):
    return {node.class_name: round(node.box.size[1], 2) for node in found.graph.nodes if node.class_name in SIZES}


@pytest.mark.parametrize("value", [math.nan, math.inf, "NaN", None, True])
@pytest.mark.parametrize("form", [list, lambda xyz: dict(zip("xyz", xyz, strict=True))])
def test_a_place_that_is_no_number_is_a_fault_of_its_node(value, form):
    data = [{"label": "fridge", "position": form([0, 0, 0])}, {"label": "table", "position": form([1, value, 0])}]
    [fault] = read(data).left_out
    assert fault.code is Code.BAD_GRAPH and fault.message.startswith("[1]: its position has") and fault.suggestion


def test_a_place_that_is_null_is_a_missing_one():
    assert read([{"label": "fridge", "position": [None] * 3}, {"label": "table", "position": None}]).left_out == ()


def test_a_negative_size_is_a_fault_of_its_node():
    [fault] = read([{"label": "fridge", "position": [0, 0, 0], "size": [1, -2, 1]}]).left_out
    assert "negative: -2" in fault.message and fault.message.startswith("[0]: ")


def test_a_file_with_nan_as_python_writes_it_is_read(tmp_path):
    data = furniture()
    data["objects"][2]["position"][0] = math.nan
    status, found = convert(tmp_path, json.dumps(data))
    [fault] = found["left_out"]
    assert status == 1 and fault["message"].startswith("objects[2]: its position has `nan`") and found["nodes"] == 5


def test_a_box_that_is_no_number_in_our_layout_names_its_node(tmp_path):
    box = {"center": [math.nan, 1, 1], "size": [1, 1, 1]}
    nodes = [{"id": 1, "class_name": "kitchen"}, {"id": 2, "class_name": "box", "bounding_box": box}]
    status, found = convert(tmp_path, json.dumps({"nodes": nodes, "edges": []}))
    [fault] = found["errors"]
    assert status == 1 and "nodes[1]: " in fault["message"] and fault["suggestion"]


def test_ids_of_two_nodes_in_our_layout_are_refused_with_both(tmp_path):
    nodes = [{"id": number, "class_name": name} for number, name in ((1, "kitchen"), (2, "box"), (2, "mug"))]
    status, found = convert(tmp_path, json.dumps({"nodes": nodes, "edges": []}))
    [fault] = found["errors"]
    assert status == 1 and fault["code"] == "DUPLICATE" and fault["suggestion"]
    assert "box (nodes[1])" in fault["message"] and "mug (nodes[2])" in fault["message"]


@pytest.mark.parametrize("metres", [1.0, 0.01, 0.001, 0.3048, 0.0254])
def test_sizes_of_known_classes_show_the_unit_and_the_axis(metres):
    found = read(furniture(1 / metres))
    assert found.left_out == () and heights(found) == {"fridge": 1.8, "table": 0.75, "sofa": 0.8}


def test_a_unit_that_the_file_names_is_taken():
    found = read({"metadata": {"units": "centimeters"}, "objects": furniture(100.0)["objects"][:2]})
    assert found.left_out == () and heights(found) == {"fridge": 1.8, "table": 0.75}


def test_an_unknown_unit_is_a_fault_with_the_key_of_the_mapping():
    [fault] = read(furniture(units="furlong")).left_out
    assert "`furlong`" in fault.message and "`scale:`" in fault.suggestion


def test_sizes_that_fit_no_unit_are_a_fault():
    [fault] = read(furniture(1 / 0.07)).left_out
    assert fault.code is Code.BAD_GRAPH and "times as large" in fault.message and "`scale:`" in fault.suggestion


def test_a_room_that_nothing_in_the_file_has_is_a_fault_of_the_thing():
    [fault] = read({"rooms": [{"id": "r1", "label": "kitchen"}], "objects": [{"label": "mug", "room": "r9"}]}).left_out
    assert fault.message.startswith("objects[0]: ") and "`r9`" in fault.message and fault.suggestion


def test_a_hundred_thousand_nodes_are_refused_before_all_are_read(monkeypatch):
    looked = []
    own = reading.entities_of
    monkeypatch.setattr(reading, "entities_of", lambda *given: looked.append(own(*given)) or looked[-1])
    with pytest.raises(Exception, match="20,000"):
        read({"objects": [{"id": number, "label": "cup"} for number in range(100_000)]})
    assert len(looked[0].entities) == reading.MOST_ENTRIES + 1


def test_a_hundred_thousand_nodes_of_our_layout_are_refused(tmp_path):
    nodes = [{"id": number, "class_name": "mug"} for number in range(1, 100_001)]
    status, found = convert(tmp_path, json.dumps({"nodes": nodes, "edges": []}))
    [fault] = found["errors"]
    assert status == 1 and fault["code"] == "FILE_TOO_LARGE" and fault["suggestion"]


def test_lists_of_members_are_not_counted_as_things(monkeypatch):
    monkeypatch.setattr(reading, "MOST_ENTRIES", 3)
    data = {"rooms": [{"id": "r", "label": "kitchen", "contains": ["a", "b"]}],
            "objects": [{"id": "a", "label": "mug"}, {"id": "b", "label": "fridge"}]}  # fmt: skip
    found = read(data)
    assert classes(found) == ["fridge", "mug"] and rooms_of(found)["mug"] == "kitchen"


def test_a_file_of_gigabytes_is_refused_without_being_read(tmp_path):
    with (tmp_path / "scan.json").open("wb") as file:
        file.truncate(2_000_000_000)
    tracemalloc.start()
    status, found = convert(tmp_path)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    [fault] = found["errors"]
    assert status == 1 and fault["code"] == "FILE_TOO_LARGE" and most < 300_000_000


def test_a_chain_of_holders_is_walked_once(monkeypatch):
    count = 1_000
    looked = reading.completion.below

    class Counted(dict):
        gets = 0

        def get(self, *given):
            Counted.gets += 1
            return super().get(*given)

    monkeypatch.setattr(reading.completion, "below", lambda graph: Counted(looked(graph)))
    monkeypatch.setattr(reading._Reading, "_measured", lambda self, graph: graph)
    found = read([{"id": str(number), "label": "box", "in": str(number + 1)} for number in range(count)])
    assert len(classes(found)) == count and 0 < Counted.gets < 3 * count
