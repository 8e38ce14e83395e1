"""`kb ...` on the command line: what it prints, in words and as JSON, and how it ends."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from hearth import cli


def run(*arguments, status=0):
    result = CliRunner().invoke(cli.app, ["kb", *map(str, arguments)])
    assert result.exit_code == status, result.output
    return result.output


def as_json(*arguments, status=0):
    return json.loads(run(*arguments, "--json", status=status))


def test_show_says_everything_of_an_object():
    text = run("show", "Refrigerator")
    assert "keeps food cold behind an insulated door" in text
    assert "more with --all" in text and "more with --all" not in run("show", "fridge", "--all")
    assert as_json("show", "fridge")["default_states"] == ["CLEAN", "CLOSED", "OFF", "PLUGGED_IN"]


def test_show_takes_an_action_too():
    assert as_json("show", "switch on") == as_json("action", "SWITCHON")


def test_action_says_what_it_needs_and_changes():
    text = run("action", "Open")
    assert "state(o, OPEN)" in text and "NO_FREE_HAND" in text and "leave the Open out" in text


def test_find_and_path():
    assert as_json("find", "--can", "Grab", "--in", "fridge", "--kind", "fruit")["found"][0] == "food_apple"
    assert "objects" in run("find", "--room", "bathroom", "--has", "CREAM")
    assert run("path", "spectacles", "book") == "spectacles -goes_with-> book  (ours)\n"
    assert run("path", "bed", "bed") == "they are one\n"


def test_find_takes_a_word_of_names_of_objects_and_actions():
    assert as_json("find", "wait") == {"found": [], "count": 0, "actions": ["Wait"]}
    assert {"bathroom_counter", "kitchen_counter"} <= {*as_json("find", "counter")["found"]}
    assert as_json("find", "pick up")["actions"] == ["Grab"]
    assert as_json("find", "juice", "--in", "fridge")["found"] == ["juice"]
    assert run("find", "wait").splitlines()[-2:] == ["Wait    Wait", "0 objects, 1 action"]
    assert run("find", "zorb").endswith("0 objects, 0 actions\n")
    assert "actions" not in as_json("find", "--in", "fridge")


def test_lint_ends_with_1_when_something_contradicts(tmp_path):
    assert run("lint") == "11 checks: no contradictions\n"
    (tmp_path / "placements.csv").write_text("object,relation,destination,room,weight,evidence\ndresser,IN,cup,,1,me\n")
    assert "dresser is placed in cup, which is too small for it" in run("lint", "--kb", tmp_path, status=1)
    assert as_json("lint", "--kb", tmp_path, status=1)["findings"][0]["check"] == "size"


def test_diff_ends_with_1_when_a_fact_is_missing_without_a_reason(tmp_path):
    (tmp_path / "properties_data.json").write_text('{"cup": ["GRABBABLE"]}')
    assert "random steps the grammar rejects" in run("diff", tmp_path)
    (tmp_path / "properties_data.json").write_text('{"cup": ["EATABLE"]}')
    assert "missing properties: cup EATABLE: NO REASON" in run("diff", tmp_path, status=1)
    assert as_json("diff", tmp_path, status=1)["missing_without_reason"] == 1


def test_mine_proposes_lines(tmp_path):
    import pyarrow as pa
    import pyarrow.parquet as pq

    step = {"action": "PutIn", "objects": [{"name": "shoes", "instance": 1}, {"name": "oven", "instance": 1}]}
    pq.write_table(pa.table({"steps": [[step]] * 3}), tmp_path / "programs.parquet")
    assert "+shoes,IN,oven,,5,mined" in run("mine", tmp_path)
    assert as_json("mine", tmp_path)["lines"] == {"placements.csv": ["shoes,IN,oven,,5,mined"]}


def test_export_writes_other_forms(tmp_path):
    assert run("export", "pddl").startswith("(define (domain hearth)")
    assert run("export", "table", "--to", tmp_path / "actions.md") == ""
    assert (tmp_path / "actions.md").read_text().startswith("| action |")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("show", "frige"), "`frige` is not a known object"),
        (("action", "Opne"), "`Opne` is not a known action"),
        (("find", "--in", "frige"), "`frige` is not a known object"),
        (("path", "cup", "frige"), "`frige` is not a known object"),
        (("mine", "nowhere"), "no programs table here"),
        (("diff", "nowhere"), "is not a directory of knowledge files"),
    ],
)
def test_bad_input_is_one_message_and_status_1(arguments, message):
    assert message in run(*arguments, status=1)


def test_a_form_that_there_is_not_is_wrong_usage():
    assert "`yaml` is not a form" in run("export", "yaml", status=2)


@pytest.mark.parametrize("command", ["show", "action", "find", "path", "lint", "diff", "mine", "export"])
def test_every_command_shows_an_example(command):
    assert f"hearth kb {command}" in run(command, "--help")
