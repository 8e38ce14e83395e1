"""`run` and `replay` as a user meets them."""

import json
import zipfile

import pytest
from typer.testing import CliRunner

from hearth.cli import app
from hearth.schemas.failures import Code

WATCH = """Watch TV
Sit and watch.


[Walk] <television> (1)
[SwitchOn] <television> (1)
[Walk] <sofa> (1)
[Sit] <sofa> (1)
[Watch] <television> (1)
"""


def call(*arguments, **options):
    return CliRunner().invoke(app, [str(argument) for argument in arguments], **options)


def test_run_prints_the_binding_and_what_each_step_changed(tmp_path):
    file = tmp_path / "tv.txt"
    file.write_text(WATCH)
    result = call("run", file, "--home", "maple")
    assert result.exit_code == 0, result.output
    assert "<sofa> (1) is couch" in result.output
    assert "is ON" in result.output and "character" in result.output and "is SITTING" in result.output
    assert "Done: 5 steps." in result.output


@pytest.mark.parametrize(
    ("goal", "status", "words"),
    [
        ("SITTING(agent) and (LOOKAT or WATCH)", 0, "Goal: reached."),
        ("ON(television) then SITTING(agent)", 0, "Goal: reached."),
        ('{"actions": ["LOOKAT|WATCH"]}', 0, "Goal: reached."),
        ('{"node_goals": []}', 1, "not a goal: it has no 'actions'"),
        ("SITTING(agent) then ON(television)", 1, "Goal: not reached; unmet: (SITTING(agent)) then (ON(television))."),
        ("WATCH(televison)", 1, "did you mean `television`?"),
    ],
)
def test_run_asks_whether_a_goal_is_reached(tmp_path, goal, status, words):
    (tmp_path / "tv.txt").write_text(WATCH)
    (tmp_path / "goal.txt").write_text(goal)
    for given in (goal, f"@{tmp_path / 'goal.txt'}"):
        result = call("run", tmp_path / "tv.txt", "--goal", given)
        assert (result.exit_code, words in result.output) == (status, True), result.output
        found = json.loads(call("run", tmp_path / "tv.txt", "--goal", given, "--json").stdout)
        assert "errors" in found or found["goal"]["reached"] == (status == 0)


@pytest.mark.parametrize(("node", "found"), [(9999, "maple lacks 1 node that the program names: 9999"), (51, "")])
def test_nodes_that_a_home_lacks_are_bound_anew(tmp_path, node, found):
    (tmp_path / "sit.txt").write_text(f"[Walk] <sofa> (1.{node})\n[Sit] <sofa> (1.{node})\n")
    result = call("run", tmp_path / "sit.txt", "--home", "maple")
    assert result.exit_code == 0 and "<sofa> (1) is couch (51)" in result.output
    assert found in result.output and ("bound anew" in result.output) == bool(found)


def test_a_node_of_another_class_is_a_fault_with_both_names(tmp_path):
    (tmp_path / "sit.txt").write_text("[Walk] <sofa> (1.44)\n[Sit] <sofa> (1.44)\n")
    result = call("run", tmp_path / "sit.txt", "--home", "maple")
    assert result.exit_code == 1
    assert "`sofa` is said to be node 44, but that is a `television` in maple" in result.output


def test_explain_names_the_edges_that_checks_held_by(tmp_path):
    file = tmp_path / "tv.txt"
    file.write_text(WATCH)
    result = call("run", file, "--explain")
    assert "close(a, o)  by  character CLOSE television" in result.output
    assert "by  character FACING television" in result.output


def test_run_as_json_has_the_bound_steps_and_their_changes(tmp_path):
    file = tmp_path / "tv.txt"
    file.write_text(WATCH)
    result = call("run", file, "--json")
    found = json.loads(result.stdout)
    assert found["executable"] is True and len(found["changes"]) == len(found["steps"]) == 5
    assert [state for _, state in found["changes"][1]["set_states"]] == ["ON"]


def test_a_program_that_contradicts_itself_ends_with_status_1(tmp_path):
    file = tmp_path / "twice.txt"
    file.write_text(WATCH.replace("[Walk] <sofa> (1)", "[SwitchOn] <television> (1)"))
    result = call("run", file, "--json")
    found = json.loads(result.stdout)
    assert result.exit_code == 1 and found["failure"]["code"] == Code.IS_ON and found["failure"]["step"] == 3
    result = call("run", file, "--sample")
    assert result.exit_code == 1 and "Sampling does not help: step 3 failed" in result.output
    assert "(CONTRADICTION)" in result.output


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("Fly\n\n\n[Fly] <bed> (1)\n", "UNKNOWN_ACTION"),
        ("TV\n\n\n[Watch] <televison> (1)\n", "did you mean `television`"),
        ("TV\n\n\n[Watch]\n", "WRONG_ARITY"),
        ("TV\n\n\n[Watch] <television> (x)\n", "BAD_INSTANCE"),
        ("", "EMPTY"),
        ("a\x00b", "NOT_TEXT"),
    ],
)
def test_a_bad_file_is_explained(tmp_path, text, message):
    file = tmp_path / "bad.txt"
    file.write_text(text)
    result = call("run", file)
    assert result.exit_code == 1
    assert message in result.output and "Traceback" not in result.output


def test_replay_reproduces_the_release_sample(real_data):
    result = call("replay", real_data / "activityprograms-sample.zip", "--json", "--strict")
    found = json.loads(result.stdout)
    assert result.exit_code == 0
    assert (found["programs"], found["executed"], found["exact"], found["mismatches"]) == (267, 267, 267, [])


def test_replay_shows_the_edges_of_a_mismatch(real_data, tmp_path):
    """The stored end is changed: the edge that is not reproduced is printed."""
    changed = tmp_path / "changed.zip"
    with zipfile.ZipFile(real_data / "activityprograms-sample.zip") as source, zipfile.ZipFile(changed, "w") as target:
        for name in sorted(source.namelist()):
            if "file1003_2" not in name:
                continue
            data = source.read(name)
            if name.endswith(".json"):
                graphs = json.loads(data)
                graphs["final_graph"]["edges"].append({"from_id": 65, "relation_type": "ON", "to_id": 1})
                data = json.dumps(graphs).encode()
            target.writestr(name, data)
    result = call("replay", changed, "--strict")
    assert result.exit_code == 1
    assert "missing: 65 ON 1" in result.output


def test_replay_of_something_else_is_one_clear_error(tmp_path):
    file = tmp_path / "not.zip"
    file.write_bytes(b"PK\x03\x04 truncated")
    result = call("replay", file)
    assert result.exit_code == 1 and "UNSUPPORTED_FILE" in result.output and "Traceback" not in result.output


def test_explain_says_where_to_stand_which_hand_and_which_way_to_face(tmp_path):
    file = tmp_path / "tv.txt"
    file.write_text(
        "Fetch\n\n\n[Walk] <remote_control> (1)\n[Grab] <remote_control> (1)\n[SwitchOn] <television> (1)\n"
    )
    stances = json.loads(call("run", file, "--home", "maple", "--json").output)["stances"]
    assert [tick[0]["hand"] for tick in stances] == [None, "right", "left"]
    walked, grabbed, switched = (tick[0]["pose"] for tick in stances)
    assert len({(pose["x"], pose["z"]) for pose in (walked, grabbed, switched)}) == 1
    assert grabbed["yaw"] != switched["yaw"]
    assert "m, facing" in call("run", file, "--home", "maple", "--explain").output


def test_a_second_character_is_placed_too(tmp_path):
    file = tmp_path / "two.txt"
    file.write_text("Two\n\n\n<char0> [Walk] <chair> (1) | <char1> [Walk] <fridge> (1)\n")
    (tick,) = json.loads(call("run", file, "--home", "maple", "--json").output)["stances"]
    assert [stance["agent"] for stance in tick] == [0, 1]


def test_run_prints_where_the_four_moves_lead(tmp_path):
    file = tmp_path / "moves.txt"
    file.write_text("Move\nAbout.\n\n\n[Walkforward]\n[Turnleft]\n[Walktowards] <fridge> (1)\n[Turnright]\n")
    result = call("run", file, "--home", "maple")
    assert result.exit_code == 0, result.output
    found = [line.strip() for line in result.output.splitlines() if line.strip().startswith("character 0 at")]
    assert len(found) == 4
    before, turned = found[0].split(" m, facing "), found[1].split(" m, facing ")
    assert before[0] == turned[0] and (int(before[1].split()[0]) - int(turned[1].split()[0])) % 360 == 30
    assert found[2].split(" m,")[0] != found[1].split(" m,")[0]


def test_run_says_what_is_in_the_way_of_a_move(tmp_path):
    file = tmp_path / "blocked.txt"
    file.write_text("Move\nAbout.\n\n\n[Walk] <fridge> (1)\n[Walkforward]\n")
    result = call("run", file, "--home", "maple")
    assert result.exit_code == 1 and "step 2 failed: [Walkforward]" in result.output, result.output


def test_run_takes_with_the_hand_that_is_said(tmp_path):
    file = tmp_path / "left.txt"
    file.write_text("Take\nMilk.\n\n\n[Walk] <fridge> (1)\n[Open] <fridge> (1)\n[Grab] <milk> (1) {hand=left}\n")
    result = call("run", file, "--home", "maple")
    assert result.exit_code == 0 and "HOLDS_LH milk" in result.output, result.output
    file.write_text(file.read_text().replace("left", "third"))
    refused = call("run", file, "--home", "maple", "--strict")
    assert refused.exit_code != 0 and "`third` is not a value of `hand`" in refused.output and ":7:20" in refused.output
