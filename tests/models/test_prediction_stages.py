"""The output of `model show`: stages, two programs side by side, and bad input."""

from __future__ import annotations

import json
from random import Random

import pytest
from typer.testing import CliRunner

from hearth import cli
from hearth.models.prediction_stages import side_by_side
from hearth.schemas.program import ObjectRef, Step
from hearth.scoring.metrics.lcs import similarity


def call(*words):
    return CliRunner().invoke(cli.app, ["model", "show", *map(str, words)])


@pytest.fixture
def sketch(tmp_path):
    path = tmp_path / "sketch.txt"
    path.write_text("[SwitchOn] <television> (1)\n[Sit] <couch> (1)\n")
    return path


def random_program(random):
    return tuple(Step(random.choice("ABC"), (ObjectRef(random.choice("xyz"), 1),)) for _ in range(random.randint(0, 8)))


@pytest.mark.parametrize("seed", range(60))
def test_side_by_side_is_both_programs_and_their_longest_common_subsequence(seed):
    random = Random(seed)
    one, other = random_program(random), random_program(random)
    lines = list(side_by_side(one, other))
    assert tuple(line.left for line in lines if line.left) == one
    assert tuple(line.right for line in lines if line.right) == other
    common = [line for line in lines if line.common]
    assert all(line.left == line.right for line in common)
    assert len(common) == round(similarity(one, other) * max(len(one), len(other), 1)) or not (one or other)


def test_a_sketch_in_two_homes(sketch):
    result = call("planner", "--sketch", sketch, "--home", "maple", "--home", "birch")
    assert result.exit_code == 0, result.output
    assert "= [SwitchOn] <television>" in result.output and result.output.count("It runs.") == 2
    found = json.loads(call("planner", "--sketch", sketch, "--home", "maple", "--home", "birch", "--json").stdout)
    assert [each["home"] for each in found["homes"]] == ["maple", "birch"]
    assert all(each["executable"] and len(each["sketch"]) == 2 for each in found["homes"])


def test_from_a_text_to_a_sketch_to_a_program():
    found = json.loads(call("retrieve-edit", "Turn on the TV and sit down", "--writer", "planner", "--json").stdout)
    assert found["executable"] and found["program"] and found["sketch"]


def test_the_chooser_that_comes_with_hearth_writes_at_once(sketch):
    found = json.loads(call("chooser", "--sketch", sketch, "--home", "cedar", "--json").stdout)
    program = " ".join(found["program"])
    assert found["executable"] and "[SwitchOn] <television>" in program and "[Sit] <couch>" in program
    assert len(found["program"]) > len(found["sketch"])


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("planner", "Sit down"), "--sketch"),
        (("retrieve-edit", "Sit down", "--writer", "retrieve-edit"), "does not write programs for sketches"),
        (("retrieve-edit", "--sketch", "SKETCH"), "reads texts, not sketches"),
    ],
)
def test_models_and_inputs_that_do_not_fit(words, message, sketch):
    result = call(*(sketch if word == "SKETCH" else word for word in words))
    assert result.exit_code == 1 and message in result.output and "Traceback" not in result.output


@pytest.mark.parametrize("text", ["[Fly] <moon> (1)\n", "[Eat] <volcano> (1)\n[Levitate] <cup> (1)\n"])
def test_sketches_that_no_home_can_do(text, tmp_path):
    """A program that runs, or a reason; unknown actions are named by the reader."""
    path = tmp_path / "sketch.txt"
    path.write_text(text)
    result = call("planner", "--sketch", path, "--home", "maple", "--json")
    assert result.exit_code == 1 and "Traceback" not in result.output
    found = json.loads(result.stdout)
    assert found.get("failure") or found["errors"]
