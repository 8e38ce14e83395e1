"""Manifests, values and questions of strangers that say what no build says."""

from __future__ import annotations

import json
import shutil
from xml.etree import ElementTree

import pytest
from typer.testing import CliRunner

import hearth
from hearth import cli
from hearth.datasets.damage_faults import unreadable
from hearth.datasets.export import graphs
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


@pytest.fixture
def data(made, tmp_path):
    return shutil.copytree(made.out / "publish", tmp_path / "data")


def changed(data, **fields):
    path = data / "manifest.json"
    path.write_text(json.dumps({**json.loads(path.read_text()), **fields}))


def run(*words, **more):
    return CliRunner().invoke(cli.app, [str(word) for word in words], **more)


def manifest(data):
    return json.loads((data / "manifest.json").read_text())


def test_ours_verifies(data):
    assert run("verify", data, "--strict").exit_code == 0


PARTS = {
    "none": lambda parts: [],
    "one fewer": lambda parts: parts[1:],
    "a part without files": lambda parts: [{"rows": 0, "files": []}],
    "one twice": lambda parts: [*parts, parts[0]],
}


@pytest.mark.parametrize("change", PARTS.values(), ids=PARTS)
def test_parts_that_are_left_out_are_found(data, change):
    changed(data, parts=change([dict(part) for part in manifest(data)["parts"]]))
    result = run("verify", data, "--strict")
    assert result.exit_code == 1 and "parts" in result.output, result.output


@pytest.mark.parametrize("field", ["version", "action_set"])
@pytest.mark.parametrize("text", ["\x1b[31m", "<img src=x>", "1.0\n", "", "x" * 100, "\u202e1"])
def test_a_version_of_other_characters_is_no_manifest(data, field, text):
    changed(data, **{field: text})
    for words in (("query", data, "SELECT 1"), ("diff", data, data), ("verify", data)):
        result = run(*words)
        assert result.exit_code == 1 and "BAD_JSON" in result.output and "\x1b" not in result.output


@pytest.mark.parametrize("question", [b"SELECT 1 \xff\xfe", b"\xff", b"SELECT '\xc3\x28'", b"\xed\xa0\x80"])
def test_a_question_that_is_no_text_is_a_fault_in_words(data, question):
    said = question.decode("utf-8", "surrogateescape")
    with pytest.raises(HearthError) as caught:
        hearth.load(data).sql(said)
    fault = caught.value.diagnostics[0]
    assert fault.code is Code.SYNTAX and "UTF-8" in fault.message and "argument" not in fault.message


ERRORS = [KeyError(115), OverflowError("cannot convert float infinity"), TypeError("not iterable"), IndexError("range")]


@pytest.mark.parametrize("error", ERRORS, ids=repr)
def test_damage_is_said_without_names_of_pythons_errors(error):
    said = unreadable(error, "here").diagnostics[0].message
    assert type(error).__name__ not in said and said.startswith("its tables cannot be read: ")


def test_graphml_of_odd_classes_is_xml(data, tmp_path, monkeypatch):
    plain = graphs._plain
    monkeypatch.setattr(graphs, "_plain", lambda value: f"{plain(value)}\x1b\x00\ufffe\u2028<")
    out = tmp_path / "out"
    assert run("export", data, "--format", "graphml", "--out", out).exit_code == 0
    files = list(out.rglob("*.graphml"))
    assert files and all("\\x1b" in "".join(ElementTree.parse(file).getroot().itertext()) for file in files)
