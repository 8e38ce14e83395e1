"""The detection of the labelled faults of our corpus."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from hearth.analysis import error_detection
from hearth.cli import app
from hearth.pipelines.build import corpus
from hearth.schemas.diagnostics import HearthError


@pytest.fixture(scope="module")
def report(knowledge):
    from pathlib import Path

    paths = corpus()
    return error_detection.score(
        error_detection.find(paths, knowledge), error_detection.read_key(Path(paths[0]).parent / "key.csv")
    )


def test_what_is_refused_is_faulty(report):
    assert report.rejected_precision == 1


def test_almost_every_fault_is_found_and_few_where_there_are_none(report):
    assert report.recall >= 0.98
    assert report.precision >= 0.92


@pytest.mark.parametrize(
    "fault",
    [
        "bad_instance", "contradiction", "duplicate", "empty", "missing_walk", "mojibake", "near_duplicate",
        "not_afforded", "off_topic", "pasted", "prose", "rejected", "special", "syntax", "undeclared_props",
        "unknown_action", "unknown_description", "unknown_object", "wrong_arity",
    ],
)  # fmt: skip
def test_found_every_time(report, fault):
    (score,) = [one for one in report.scores if one.fault == fault]
    assert score.found == score.labelled > 0


def test_counts_on_a_small_key():
    found = error_detection.Found({"a": {"!EMPTY"}, "b": {"NOT_CLOSE"}, "x": {"OFF_TOPIC"}, "y": {"!SYNTAX"}}, 10)
    report = error_detection.score(found, {"a": "empty", "b": "missing_walk", "c": "missing_walk", "d": "prose"})
    assert (report.precision, report.recall, report.rejected_precision) == (0.5, 0.5, 0.5)
    assert {one.fault: one.recall for one in report.scores} == {"empty": 1, "missing_walk": 0.5, "prose": 0}
    assert dict(report.false) == {"OFF_TOPIC": 1, "!SYNTAX": 1}


def test_the_command(tmp_path):
    key, source = tmp_path / "key.csv", tmp_path / "a.txt"
    key.write_text("HITId,stage,fault,note\na.txt,2,syntax,x\n")
    source.write_text("Nap\n\n\n[Walk <bed> (1)\n")
    result = CliRunner().invoke(app, ["corpus", "dirt", str(key), str(source), "--json"])
    assert json.loads(result.stdout)["recall"] == 1


@pytest.mark.parametrize(
    ("data", "code"),
    [(b"a,b\n1,2\n", "BAD_TABLE"), (b"HITId,fault\n\x81\x81\x81,x\n", "NOT_TEXT"), (b"", "BAD_TABLE")],
)
def test_what_is_no_key_is_refused(tmp_path, data, code):
    (tmp_path / "key.csv").write_bytes(data)
    with pytest.raises(HearthError, match=code):
        error_detection.read_key(tmp_path / "key.csv")


def test_a_key_may_be_a_spreadsheets(tmp_path):
    (tmp_path / "key.csv").write_bytes("HITId;fault\r\na;empty\r\n".encode("utf-16"))
    assert error_detection.read_key(tmp_path / "key.csv") == {"a": "empty"}
