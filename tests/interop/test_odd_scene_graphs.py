"""Scene graphs of odd content: things of no class, words that mean nothing, ids that two things share."""

import pytest

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from tests.interop.scene_graph_readings import classes, held, read, rooms_of


@pytest.mark.parametrize("label", ["unknown", "object", "thing", 7])
def test_an_entry_without_a_class_is_left_out_by_name(label):
    found = read([{"label": "fridge"}, {"label": label}])
    assert len(found.left_out) == 1 and str(label) in found.left_out[0].message


def test_rooms_that_are_next_to_one_another_are_not_in_one_another():
    rooms = [{"id": n, "attributes": {"type": "RoomNodeAttributes", "name": name}} for n, name in
             enumerate(["kitchen", "bedroom"])]  # fmt: skip
    bed = {"id": 2, "attributes": {"type": "ObjectNodeAttributes", "name": "bed"}}
    place = {"id": 3, "attributes": {"type": "PlaceNodeAttributes", "name": "p(0)"}}
    edges = [{"source": 0, "target": 1}, {"source": 1, "target": 3}, {"source": 3, "target": 2}]
    found = read({"nodes": [*rooms, bed, place], "edges": edges})
    assert rooms_of(found)["bed"] == "bedroom" and found.left_out == ()
    assert not any(source in ("kitchen", "bedroom") for source in rooms_of(found))


def test_relations_of_unknown_words_are_counted():
    data = {
        "objects": [{"id": 1, "label": "mug"}, {"id": 2, "label": "table"}],
        "relationships": [[1, 2, 9, "wider than"]],
    }
    [note] = [note for note in read(data).fillings if note.what.startswith("relations without")]
    assert note.number == 1


def test_places_at_the_feet_of_things_are_raised():
    data = [
        {"label": "fridge", "position": [0, 0, 0], "size": [0.7, 1.8, 0.7]},
        {"label": "table", "position": [2, 0, 0], "size": [1.2, 0.7, 0.8]},
    ]
    heights = {node.class_name: node.box.center[1] for node in read(data).graph.nodes if node.box}
    assert heights["fridge"] == pytest.approx(0.9) and heights["table"] == pytest.approx(0.35)


def test_the_best_guess_of_a_detector_is_the_class():
    best = {"hypothesis": {"class_id": "table", "score": 0.9}}
    size = {"x": 1.2, "y": 0.8, "z": 0.76}
    found = read({"detections": [{"results": [best, {"hypothesis": {"class_id": "sofa"}}], "bbox": {"size": size}}]})
    assert classes(found) == ["table"]


def test_pairs_of_things_that_are_described_in_full_are_things():
    pair = {"object1": {"id": 0, "object_tag": "pillow"}, "object2": {"id": 1, "object_tag": "sofa"},
            "object_relation": "a on b"}  # fmt: skip
    assert held(read([pair]), "ON") == {("pillow", "sofa")}


def test_on_the_floor_is_in_the_room():
    found = read([{"label": "sofa", "room": "living room"}, {"label": "box", "on": "floor"}])
    assert found.left_out == () and rooms_of(found)["box"] == "living_room"


def test_words_for_states_that_mean_none_are_counted():
    found = read([{"label": "fridge", "state": "opn"}, {"label": "television", "states": ["on", "onn"]}])
    [note] = [note for note in found.fillings if note.what.startswith("words for states")]
    assert note.number == 2


def test_a_thing_that_holds_itself_is_named():
    data = [{"id": "a", "label": "box", "in": "a"}, {"id": "b", "label": "sofa", "contains": ["b"]}]
    assert [fault.code for fault in read(data).left_out] == [Code.LOOP, Code.LOOP]


def test_ids_that_two_things_share_are_named():
    found = read(
        {"rooms": [{"id": 1, "label": "kitchen"}], "objects": [{"id": 1, "label": "cup"}, {"id": 1, "label": "mug"}]}
    )
    [fault] = found.left_out
    assert fault.code is Code.DUPLICATE and "objects[1]" in fault.message and "objects[0]" in fault.message
    assert classes(found) == ["cup", "mug"]


@pytest.mark.parametrize("data", [
    [{"label": "fridge", "room": "garage"}],
    {"rooms": [{"label": "garage"}], "objects": [{"label": "fridge"}]},
])  # fmt: skip
def test_a_room_that_is_none_of_ours_is_named_with_a_remedy(data):
    [fault] = read(data).left_out
    assert fault.code is Code.UNKNOWN_OBJECT and "garage" in fault.message and "mapping file" in fault.suggestion


def test_the_basin_of_a_sink_is_the_sink():
    sink = {"objectType": "Sink", "objectId": "Sink|1"}
    basin = {"objectType": "SinkBasin", "objectId": "Sink|1|SinkBasin", "parentReceptacles": ["Sink|1"]}
    cup = {"objectType": "Cup", "objectId": "Cup|1", "parentReceptacles": ["Sink|1|SinkBasin"]}
    found = read({"objects": [sink, basin, cup]})
    assert classes(found) == ["cup", "sink"]
    assert ("cup", "sink") in held(found, "ON") | held(found, "INSIDE")


def test_a_scene_of_omnigibson_has_classes_and_places_apart():
    def info(category, room):
        return {"class_module": "omnigibson.objects", "class_name": "DatasetObject",
                "args": {"category": category, "model": "abc", "in_rooms": [room]}}  # fmt: skip

    def state(*place):
        return {"root_link": {"pos": list(place), "ori": [0, 0, 0, 1], "lin_vel": [0, 0, 0]}}

    data = {
        "metadata": {},
        "objects_info": {"init_info": {"fridge_abc_0": info("fridge", "kitchen_0"),
                                       "sofa_abc_0": info("sofa", "living_room_0"),
                                       "walls_abc_0": info("walls", "kitchen_0")}},
        "state": {"object_registry": {"fridge_abc_0": state(1.0, 2.0, 0.9), "sofa_abc_0": state(5.0, 2.0, 0.4),
                                      "walls_abc_0": state(0, 0, 0)}},
    }  # fmt: skip
    found = read(data)
    assert classes(found) == ["fridge", "sofa"] and found.left_out == ()
    assert rooms_of(found)["fridge"] == "kitchen" and rooms_of(found)["sofa"] == "living_room"
    [note] = [note for note in found.fillings if note.what.startswith("places, z upwards")]
    assert note.number == 2


def test_a_hundred_thousand_nodes_are_refused_at_once():
    with pytest.raises(HearthError) as raised:
        read({"objects": [{"id": number, "label": "cup"} for number in range(100_000)]})
    assert raised.value.diagnostics[0].code is Code.FILE_TOO_LARGE


def test_a_circle_of_holders_is_a_fault_at_a_node_of_it():
    found = read([{"id": one, "label": "box", "in": other} for one, other in ("ab", "bc", "ca")])
    [fault] = found.left_out
    assert fault.code is Code.LOOP and fault.message.startswith("[2]: ") and fault.suggestion
    assert fault.message.count("box") == 4
    inside = {(edge.source, edge.target) for edge in found.graph.edges if edge.relation == "INSIDE"}
    assert {(2, 3), (3, 4)} <= inside and (4, 2) not in inside


def test_a_second_holder_is_counted_and_no_circle():
    found = read([{"id": "m", "label": "mug", "on": "t", "in": "f"}, {"id": "t", "label": "table"},
                  {"id": "f", "label": "fridge"}])  # fmt: skip
    [note] = [note for note in found.fillings if note.what.startswith("second holders")]
    assert note.number == 1 and found.left_out == ()


def test_a_size_of_the_knowledge_turns_with_its_thing():
    """A bookshelf of the knowledge is wider than deep; a quarter turn puts its width across."""
    sizes = []
    for angle in (0, 90, 180):
        turn = {"label": "bookshelf", "position": [0, 0, 1], "yaw": angle}
        [node] = [each for each in read([turn, {"label": "bed", "position": [3, 0, 0.3]}]).graph.nodes
                  if each.class_name == "bookshelf"]  # fmt: skip
        sizes.append((node.box.size, node.yaw))
    (w, h, d), _ = sizes[0]
    assert w != d and [size for size, _ in sizes] == [(w, h, d), (d, h, w), (w, h, d)]


def test_an_entry_with_a_number_and_a_name_is_called_by_its_name():
    named = {"attributes": {"type": "ObjectNodeAttributes", "name": "unknown", "semantic_label": 25}}
    [fault] = read({"nodes": [{"attributes": {"name": "fridge"}}, named]}).left_out
    assert "`unknown`" in fault.message and "25" in fault.message
