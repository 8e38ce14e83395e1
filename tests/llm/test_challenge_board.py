"""The board: verified runs next to each other, their tokens, faults and hazards, and differences with intervals."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from lying_server import serving
from typer.testing import CliRunner

from hearth import cli
from hearth.analysis.challenge_board import comparisons, submissions
from hearth.analysis.challenge_board_page import board_page
from hearth.challenges.episode_agents import Lineup
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import suite
from hearth.kb.loading.load import default
from hearth.llm.language_settings import Asking, Means


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("board")
    tasks = suite("household", "valid_seen", limit=3)
    run(tasks, Lineup("human_like"), 1, folder / "people.jsonl", default)
    asking, means = Asking(most_turns=5), Means(prices=(1.0, 2.0))
    with serving(lambda body: "Fly away" if len(body["messages"]) % 4 else "wait") as (url, _):
        name = f"llm:<b>mini</b>@{url}"
        run(tasks, Lineup(name, asking=asking, means=means), 1, folder / "model.jsonl", default)
    return [folder / "model.jsonl", folder / "people.jsonl"]


@pytest.fixture(scope="module")
def found(files):
    return submissions(files, default)


def test_runs_are_ranked_and_verified(found):
    people, model = (each.row for each in found)
    assert (people["file"], people["success"], people["verified"]) == ("people.jsonl", 1.0, True)
    assert people["success_from"] < 0.5 < people["success_to"] == 1.0, "three tasks say little"
    assert people["tokens_in"] is None and people["protocol"] is None
    assert (model["success"], model["turns"], model["tokens_in"], model["tokens_out"]) == (0.0, 15, 150, 30)
    assert model["cost"] == pytest.approx((150 * 1 + 30 * 2) / 1e6)
    assert model["faults"] == {"UNKNOWN_ACTION": 9} and model["protocol"] == "hearth-text/1"
    assert len(model["protocol_fingerprint"]) == len(model["prompt_fingerprint"]) == 16
    assert people["hazards"] is not None and model["hazards"] == {}


def test_two_runs_are_compared_with_intervals(found):
    success, length = comparisons(found)
    assert (success["metric"], success["difference"], success["tasks"]) == ("success", 1.0, 3)
    assert 0 < success["from"] < 0.6 and success["to"] == pytest.approx(1.0, abs=1e-9)
    assert length["from"] < length["difference"] < length["to"] < 0


def test_a_false_run_is_last_and_compared_with_none(files, tmp_path):
    from dataclasses import replace

    from hearth.challenges.result_files import first_line, line, read

    results = read(files[1])
    record = next(iter(results.records))
    false = [replace(record, metrics={**record.metrics, "ticks": 1}), *list(results.records)[1:]]
    path = tmp_path / "false.jsonl"
    path.write_bytes(first_line(results.header) + b"".join(line(results.header, each) for each in false))
    found = submissions([path, files[0]], default)
    assert [each.row["verified"] for each in found] == [True, False] and list(comparisons(found)) == []
    assert "ticks is" in found[1].row["differences"][0] and found[1].row["hazards"] is None


def test_the_page_escapes_names_and_needs_no_network(found):
    page = board_page([each.row for each in found], comparisons(found))
    assert "&lt;b&gt;mini" in page and "<b>mini" not in page and "hearth-text/1" in page
    assert "src=" not in page and "<script" not in page and "@import" not in page
    assert "UNKNOWN_ACTION 9; 15 answers" in page and "1.00 (0." in page


def test_the_command(files, tmp_path):
    out = tmp_path / "pages/board.html"
    words = ["challenge", "board", *map(str, files), "--out", str(out), "-j", "1"]
    shown = CliRunner().invoke(cli.app, [*words, "--json"])
    rows = json.loads(shown.stdout)
    assert shown.exit_code == 0 and [row["file"] for row in rows] == ["people.jsonl", "model.jsonl"]
    assert {each["metric"] for each in rows[0]["compared"]} == {"success", "length"}
    assert Path(out).read_text().startswith("<!doctype html>")
    assert "people.jsonl" in CliRunner().invoke(cli.app, words).output
