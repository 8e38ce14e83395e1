"""VirtualHome's Unity protocol: the published demo flow, every action, and what clients get wrong."""

from __future__ import annotations

import copy
import json
import threading

import numpy as np
import pytest

from hearth.interop.virtualhome.camera_images import MODES, colour_of
from hearth.interop.virtualhome.protocol_actions import ACTIONS, Simulator
from hearth.interop.virtualhome.protocol_messages import read_request
from hearth.interop.virtualhome.script_recordings import Recordings
from hearth.interop.virtualhome.unity_scene import UnityScene
from hearth.web.unity_protocol import unity_application
from tests.interop.unity_client import UnityClient, ids_of, relations, states

MAPLE = 4

ACTIONS_OF_UNITY = [
    "idle",
    "environment",
    "clear",
    "fast_reset",
    "clear_procedural",
    "procedural_generation",
    "environment_graph",
    "expand_scene",
    "add_character",
    "move_character",
    "check_script",
    "render_script",
    "camera_count",
    "character_cameras",
    "camera_data",
    "camera_image",
    "add_camera",
    "update_camera",
    "add_character_camera",
    "update_character_camera",
    "observation",
    "instance_colors",
    "set_time",
    "activate_physics",
    "remove_terrain",
    "point_cloud",
]
"""The list of the specification."""

DEMO = """<char0> [walk] <fridge> ({fridge}) | <char1> [walk] <sofa> ({sofa})
<char0> [open] <fridge> ({fridge}) | <char1> [sit] <sofa> ({sofa})
<char0> [grab] <milk> ({milk}) | <char1> [watch] <tv> ({tv})
<char0> [close] <fridge> ({fridge})
<char0> [walk] <table> ({table}) | <char1> [standup]
<char0> [putback] <milk> ({milk}) <table> ({table}) | <char1> [grab] <cat> (1000)
<char0> [walk] <mug> ({mug})
<char0> [grab] <mug> ({mug})
<char0> [walk] <sink> ({sink})
<char0> [putin] <mug> ({mug}) <sink> ({sink})"""


def with_cat(graph):
    """A graph with a cat on the sofa and the television on, as in the published demo."""
    edited = copy.deepcopy(graph)
    sofa = ids_of(graph)["sofa"]
    edited["nodes"].append({"class_name": "cat", "category": "Animals", "id": 1000, "properties": [], "states": []})
    edited["edges"].append({"from_id": 1000, "relation_type": "ON", "to_id": sofa})
    next(node for node in edited["nodes"] if node["class_name"] == "tv")["states"] = ["ON"]
    return edited


def names_in(folder):
    return {path.name for path in folder.iterdir()}


def test_every_action_of_unity_is_answered():
    assert set(ACTIONS_OF_UNITY) == set(ACTIONS)


def test_the_published_demo_flow(client, tmp_path):
    assert client.add_character("chars/Female2", "kitchen")["success"]
    assert client.add_character("chars/Male1", "livingroom")["success"]
    graph = client.graph()
    own = client.expand(graph)
    assert own["success"] and not any(json.loads(own["message"]).values()), own["message"]
    assert client.graph() == graph
    assert client.expand(with_cat(graph))["success"]
    lines = DEMO.format(**ids_of(graph)).split("\n")
    checked = client.ask("check_script", texts=lines)
    assert checked["success"], checked["message"]
    done, told = client.render(lines, recording=True, save_pose_data=True, skip_animation=True, image_width=64,
                               image_height=48, image_synthesis=["normal", "seg_inst", "flow"],
                               camera_mode=["PERSON_FROM_BACK", "0"], file_name_prefix="relax")  # fmt: skip
    assert done, told
    assert told["0"] == told["1"] == {"message": "Success"}
    assert told["recording"]["frames"] == 11
    folder = tmp_path / "out" / "relax"
    assert len(list((folder / "1").glob("Action_*_1_seg_inst.png"))) == 11
    stamps = (folder / "0" / "ftaa_relax.txt").read_text().split("\n")
    assert stamps[0] == f"<char0> [Walk] <fridge> ({ids_of(graph)['fridge']}) 1 1" and len(stamps) == 11
    poses = (folder / "0" / "pd_relax.txt").read_text().split("\n")
    joints = np.array([[float(value) for value in line.split(" ")] for line in poses[1:-1]])[:, 1:]
    assert joints.reshape(11, -1, 3).shape[1] > 15
    assert ("ON", ids_of(graph)["table"]) in relations(client, ids_of(graph)["milk"])
    assert ("HOLDS_RH", 1000) in relations(client, 399) | relations(client, 400)


def test_pictures_of_every_mode(client):
    client.add_character(room="kitchen")
    count = client.ask("camera_count")["value"]
    graph, top = client.graph(), count - 7
    for mode in MODES:
        (picture,) = client.images([top], mode)
        assert picture.shape == (48, 64, 3) and (picture.std() > 1 or mode == "flow"), mode
    (seen,) = client.images([top], "seg_inst")
    colours = json.loads(client.ask("instance_colors")["message"])
    known = {tuple(round(255 * value) for value in rgb) for rgb in colours.values()}
    shown = {tuple(pixel[::-1]) for pixel in seen.reshape(-1, 3).tolist()} - {(0, 0, 0)}
    assert len(known) == len(graph["nodes"]) and len(shown & known) > 20
    refused = client.ask("camera_image", [top], [{"mode": "albedo"}])
    assert not refused["success"] and "does not draw the mode `albedo`" in refused["message"]


def test_an_act_beside_one_that_failed_is_not_reported_as_done(client):
    for room in ("kitchen", "kitchen"):
        client.add_character(room=room)
    ids = ids_of(client.graph())
    walk = f"<char0> [walk] <fridge> ({ids['fridge']})"
    done, told = client.render([walk, f"{walk} | <char1> [grab] <fridge> ({ids['fridge']})"])
    assert not done and "from line 2 on" in told["0"]["message"] and "fridge" in told["1"]["message"]


def test_flow_is_that_of_the_last_line(client):
    client.add_character(room="kitchen")
    top = client.ask("camera_count")["value"] - 7
    (still,) = client.images([top], "flow")
    client.render([f"<char0> [walk] <fridge> ({ids_of(client.graph())['fridge']})"])
    (moved,) = client.images([top], "flow")
    assert (still == 255).all() and (moved != 255).any()


def test_matrices_of_cameras_project_as_the_pictures_do(client):
    """The published `world2im`, on the box of the sofa: its pixels in `seg_inst` lie around the projected middle."""
    sofa = next(node for node in client.graph()["nodes"] if node["class_name"] == "sofa")
    paint = np.array(colour_of(sofa["id"])[::-1])
    for camera in range(8):
        (data,) = json.loads(client.ask("camera_data", [camera])["message"])
        (picture,) = client.images([camera], "seg_inst", 640, 480)
        rows, columns = np.nonzero((picture == paint).all(axis=2))
        if len(rows) < 4_000:
            continue
        matrices = [np.array(data[k]).reshape(4, 4).T for k in ("projection_matrix", "world_to_camera_matrix")]
        at = matrices[0] @ matrices[1] @ np.array([*sofa["bounding_box"]["center"], 1.0])
        x, y = (at[0] / at[3] + 1) / 2 * 640, (1 - (at[1] / at[3] + 1) / 2) * 480
        assert abs(x - columns.mean()) < 60 and abs(y - rows.mean()) < 60
        return
    pytest.fail("no camera shows the sofa")


def test_cameras_of_clients(client):
    before = client.ask("camera_count")["value"]
    mount = {"position": {"x": 3, "y": 1.8, "z": 1}, "rotation": {"x": 20, "y": 0, "z": 0}, "field_view": 60}
    reply = client.ask("add_camera", texts=[mount])
    assert int(reply["message"].split(":")[1]) == before
    (first,) = client.images([before])
    assert client.ask("update_camera", [before], [{**mount, "field_view": 30}])["success"]
    (second,) = client.images([before])
    assert (first != second).any()
    assert not client.ask("update_camera", [0], [mount])["success"]
    named = {**mount, "camera_name": "chest"}
    assert client.ask("add_character_camera", texts=[named])["success"]
    assert not client.ask("update_character_camera", texts=[{**mount, "camera_name": "tail"}])["success"]
    client.add_character()
    assert json.loads(client.ask("character_cameras")["message"])[-1] == "chest"
    assert client.ask("camera_count")["value"] == before + 1 + 7
    seen = json.loads(client.ask("observation", [0])["message"])
    assert len(seen) > 5 and set(seen) <= {str(node["id"]) for node in client.graph()["nodes"]}


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("<char0> [teleport] <fridge> (137)", "line 2: unknown action `teleport`"),
        ("<char0> [walk] <fridge> (99999)", "line 2: `fridge` (99999): there is no node 99999"),
        ("<char0> [walk] <sofa> (137)", "line 2: `sofa` (137): node 137 is a `fridge`"),
        ("<char5> [walk] <fridge> (137)", "there is no character 5"),
        ("<char0> [grab] <milk> (142)", "the milk is inside the fridge, which is closed"),
        ("walk to the fridge", "line 2"),
    ],
)
def test_lines_that_cannot_be_done(client, line, words):
    client.add_character(room="kitchen")
    done, told = client.render(["<char0> [walk] <fridge> (137)", line])
    assert not done and words in str(told), told


def test_scripts_without_characters(client):
    done, told = client.render(["<char0> [walk] <fridge> (137)"])
    assert not done and "`add_character` first" in told
    assert client.ask("check_script", texts=["<char0> [walk] <fridge> (1)"])["success"]


def test_a_script_that_finds_its_things_and_one_that_is_only_checked(client):
    client.add_character(room="bedroom")
    lines = ["<char0> [Walk] <tv> (1)", "<char0> [switchon] <tv> (1)", "<char0> [Walk] <sofa> (1)",
             "<char0> [Sit] <sofa> (1)"]  # fmt: skip
    assert client.render(lines, find_solution=True, skip_execution=True)[0]
    assert states(client, "tv") == ["OFF", "PLUGGED_IN"] or "ON" not in states(client, "tv")
    assert client.render(lines, find_solution=True)[0]
    assert "ON" in states(client, "tv")


def test_the_other_actions(client):
    client.add_character(room="kitchen")
    at = {"x": 4.0, "y": 0.0, "z": 1.0}
    assert client.ask("move_character", texts=[{"char_index": 0, "character_position": at}])["success"]
    person = next(node for node in client.graph()["nodes"] if node["class_name"] == "character")
    assert np.hypot(person["bounding_box"]["center"][0] - 4, person["bounding_box"]["center"][2] - 1) < 0.8
    (day,) = client.images([0])
    assert client.ask("set_time", texts=[{"hours": 22, "minutes": 30, "seconds": 0}])["success"]
    (night,) = client.images([0])
    assert night.mean() < day.mean()
    physics = client.ask("activate_physics", texts=[{"gravity": -10}])
    assert not physics["success"] and "activate_physics does not work" in physics["message"]
    assert client.ask("remove_terrain")["success"] and client.ask("idle")["success"]
    cloud = json.loads(client.ask("point_cloud")["message"])
    assert len(cloud["points"]) == len(cloud["ids"]) > 1_000
    reply = client.ask("procedural_generation", [3])
    assert reply["success"] and reply["message"] == "3" and client.graph()["nodes"]
    assert client.ask("fast_reset")["success"]
    assert "there is no environment 49; 0 birch" in client.ask("environment", [49])["message"]


@pytest.mark.parametrize("prefix", ["../../evil", "/etc/evil", "a/b/../../..", "..", "nul\0", "x" * 5_000])
def test_recordings_stay_in_the_folder(client, tmp_path, prefix):
    client.add_character(room="kitchen")
    before = names_in(tmp_path)
    settings = {"recording": True, "skip_animation": True, "image_width": 16, "image_height": 16,
                "camera_mode": ["FIRST_PERSON"], "output_folder": "/tmp/elsewhere",
                "file_name_prefix": prefix}  # fmt: skip
    done, told = client.render(["<char0> [walk] <fridge> (137)"], **settings)
    assert done, told
    assert names_in(tmp_path) - before == {"out"} and len(names_in(tmp_path / "out")) == 1


def test_a_recording_replaces_its_own_and_not_the_files_of_others(client, tmp_path):
    (tmp_path / "out" / "script").mkdir(parents=True)
    (tmp_path / "out" / "script" / "mine.txt").write_text("mine")
    client.add_character(room="kitchen")
    small = {"recording": True, "skip_animation": True, "image_width": 16, "image_height": 16, "camera_mode": ["0"]}
    _, first = client.render(["<char0> [walk] <fridge> (137)", "<char0> [open] <fridge> (137)"], **small)
    _, second = client.render(["<char0> [close] <fridge> (137)"], **small)
    assert first["recording"]["folder"] == second["recording"]["folder"] == "script~2"
    assert len(list((tmp_path / "out" / "script~2" / "0").glob("Action_*"))) == 2
    assert (tmp_path / "out" / "script" / "mine.txt").read_text() == "mine"


@pytest.mark.parametrize(
    "body",
    [b"", b"[]", b"nonsense", b"{}", b'{"action": 7}', b'{"action": "idle", "intParams": ["a"]}', b"[" * 100_000,
     b'{"action": "idle", "stringParams": [1]}', b'{"action": "camera_image", "intParams": [-1]}',
     b'{"action": "expand_scene", "stringParams": ["{}", "{\\"nodes\\": 3, \\"edges\\": []}"]}',
     b'{"action": "render_script", "stringParams": ["{\\"frame_rate\\": 1e9}"]}',
     b'{"action": "add_camera", "stringParams": ["{\\"position\\": 1}"]}', b'{"action": "fly"}',
     b'{"action": "camera_image", "intParams": [0], "stringParams": ["{\\"image_width\\": 100000}"]}'],
)  # fmt: skip
def test_what_is_no_request_is_refused_in_the_protocol_s_own_words(server, body):
    reply = server.answer(body)
    assert reply["success"] is False and reply["message"] and "INTERNAL_ERROR" not in reply["message"]


def test_a_refusal_is_a_line_of_the_log(server, caplog):
    server.answer(b'{"action": "camera_image", "intParams": [0], "stringParams": ["{\\"mode\\": \\"albedo\\"}"]}')
    server.answer(b'{"action": "fly\\u001b[2J\\nme"}')
    first, second = (record.getMessage() for record in caplog.records)
    assert first.startswith("refused camera_image: Hearth does not draw the mode `albedo`")
    assert second.startswith("refused fly\\x1b[2J me: there is no action")
    server.answer(b'{"action": "idle"}')
    assert len(caplog.records) == 2


def test_ids_are_repeated_and_settings_of_other_kinds_refused():
    assert read_request(b'{"id": 1.5, "action": "idle"}').id == "1.5"


def test_two_clients_at_once_are_answered_in_turn(server):
    replies = []
    ask = {"action": "camera_image", "intParams": [0], "stringParams": ['{"image_width": 64, "image_height": 48}']}
    bodies = [json.dumps({**ask, "id": str(number)}).encode() for number in range(4)]
    threads = [threading.Thread(target=lambda b=body: replies.append(server.answer(b))) for body in bodies]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(reply["id"] for reply in replies) == list("0123") and all(reply["success"] for reply in replies)
    assert len({tuple(reply["message_list"]) for reply in replies}) == 1


def test_over_http(homes, tmp_path):
    from starlette.testclient import TestClient

    app = unity_application(Simulator(UnityScene(homes), Recordings(None)))
    there = TestClient(app, base_url="http://127.0.0.1:8080")
    client = UnityClient(post=lambda body: there.post("/", content=body).content)
    assert client.reset(0) and client.ask("camera_count")["value"] > 20
    huge = there.post("/", content=b" " * (17 << 20))
    assert huge.status_code == 200 and not huge.json()["success"] and "FILE_TOO_LARGE" in huge.json()["message"]
    evil = there.post("/", json={"action": "idle"}, headers={"Origin": "https://evil.example"})
    assert evil.status_code == 403
    assert there.post("/", json={"action": "idle"}, headers={"Host": "evil.example"}).status_code == 403
    client.add_character(room="kitchen")
    done, told = client.render(["<char0> [standup]"], recording=True)
    assert not done and "--out DIR" in told
