"""Files of results of strangers: what is in them has the kinds that tables and commands reckon with."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from hearth.challenges import result_files
from hearth.challenges.challenge_dataset import publish
from hearth.challenges.episode_agents import Lineup
from hearth.challenges.episodes import Job, played
from hearth.challenges.result_files import Header, first_line, line, read
from hearth.challenges.task_files import Suite, suite
from hearth.challenges.verification import read_whole
from hearth.cli import app
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

FEW = suite("wah", "test-1", limit=1)
ALONE = Header(FEW, Lineup("human_like", "none"), 1)
DEEP = "[" * 300 + "]" * 300


@pytest.fixture(scope="module")
def record():
    return played(Job(FEW.tasks[0], 0, ALONE.lineup, False, None, default))


def changed(tmp_path, record, place, value, header=ALONE):
    """A signed file whose episode has another value somewhere."""
    data = json.loads(line(header, record))
    data.pop("digest")
    inner = data
    for name in place[:-1]:
        inner = inner[name]
    inner[place[-1]] = value
    digest = result_files._digest(header, data)
    path = tmp_path / "changed.jsonl"
    path.write_bytes(first_line(header) + json.dumps({**data, "digest": digest}).encode() + b"\n")
    return path


BAD = [
    (("end",), {}), (("end",), {"code": []}), (("end",), {"code": "X", "more": [[]]}), (("helper_goal",), {"x": "y"}),
    (("metrics", "ticks"), True), (("metrics", "length"), 1e308), (("metrics", "success"), 1), (("seed",), -1),
    (("metrics", "ticks"), -(10**18)), (("seed",), 2**62),
]  # fmt: skip


@pytest.mark.parametrize(("place", "value"), BAD)
def test_values_of_other_kinds_are_no_episode(tmp_path, record, place, value):
    with pytest.raises(HearthError) as caught:
        read(changed(tmp_path, record, place, value))
    assert caught.value.diagnostics[0].code == Code.BAD_JSON


@pytest.mark.parametrize("place", ["end", "helper_goal"])
def test_values_deep_in_one_another_are_no_episode(tmp_path, record, place):
    path = changed(tmp_path, record, (place,), {"x": 1})
    path.write_text(path.read_text().replace('{"x": 1}', f'{{"x": {DEEP}}}'))
    with pytest.raises(HearthError) as caught:
        read(path)
    assert caught.value.diagnostics[0].code == Code.BAD_JSON


@pytest.mark.parametrize("command", [["score"], ["board"], ["infer"], ["build", "wah", "--limit", "1"]])
@pytest.mark.parametrize("case", ["none", "other task", "helped"])
def test_other_episodes_than_the_first_line_says(tmp_path, record, command, case):
    path = changed(tmp_path, record, *{"other task": (("task",), "x")}.get(case, (("helped",), case == "helped")))
    if case == "none":
        path.write_bytes(first_line(ALONE))
    words = ["challenge", *command[:2], str(path), *command[2:]]
    done = CliRunner().invoke(app, [*words, *(["--out", str(tmp_path / "out")] if command[0] == "build" else [])])
    assert done.exit_code == 1
    assert "error[DAMAGED_FILE]" in done.output


def test_episodes_with_a_helper_alone_have_no_speedup(tmp_path, record):
    lineup = Lineup("human_like", "hp", "true")
    header = Header(FEW, lineup, 1, episodes=((FEW.tasks[0].id, 0, True),))
    path = changed(tmp_path, record, ("helped",), True, header)
    done = CliRunner().invoke(app, ["challenge", "score", str(path), "--json"])
    assert done.exit_code == 0
    assert json.loads(done.output)["speedup"] is None


def test_a_short_file_may_not_say_millions_of_episodes(tmp_path):
    tasks = tuple(replace(FEW.tasks[0], id=f"t{number}") for number in range(5_000))
    header = Header(Suite("wah", "test-1", 3, tasks), Lineup("human_like", "hp", "true"), 1_000)
    path = tmp_path / "many.jsonl"
    path.write_bytes(first_line(header))
    assert header.count == 10_000_000
    with pytest.raises(HearthError, match="10,000,000"):
        read_whole(path)


def test_instructions_that_name_no_nodes(tmp_path, record):
    found = read_whole(changed(tmp_path, record, ("actions",), [["Grab x"]]))
    with pytest.raises(HearthError) as caught:
        publish(tmp_path / "out", "wah", default, [found], limit=1)
    assert caught.value.diagnostics[0].code == Code.BAD_ARGUMENT
