"""Paths that mean something to a shell, a glob, SQL or a terminal are names like others, to every command."""

from __future__ import annotations

import shutil
import sys

import pytest
from typer.testing import CliRunner

from hearth import cli

NAMES = (
    "q[1]",
    "a*b?",
    "[]]",
    "two words",
    "möbel ü",
    "new\nline",
    'it\'s, "so"',
    "{a}",
    "%41",
    "-x",
    "~",
    "\u202egnp",
)

PROGRAM = "Fetch milk\nGo to the fridge and open it.\n\n\n[Walk] <fridge> (1)\n[Open] <fridge> (1)\n"

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="these are no names on Windows")


def run(*words):
    result = CliRunner().invoke(cli.app, [*map(str, words)])
    assert "error in Hearth" not in result.output, result.output
    assert "\u202e" not in result.output
    return result


@pytest.fixture
def folder(tmp_path, request):
    made = tmp_path / request.param
    made.mkdir()
    (made / f"{request.param}.txt").write_text(PROGRAM)
    return made


@pytest.mark.parametrize("folder", NAMES[:1] + NAMES[4:7], indirect=True)
def test_a_build_reads_and_writes_it(folder, tmp_path):
    out = tmp_path / f"out {folder.name}"
    result = run("build", folder, "--out", out, "--pictures", "0", "--workers", "1", "--limit", "1")
    assert result.exit_code == 0, result.output
    asked = run("query", out, "SELECT count(*) AS programs FROM programs WHERE parent_id IS NULL", "--csv")
    assert asked.stdout == "programs\n1\n", asked.output


@pytest.mark.parametrize("name", ["q[1] a*b?", "möbel\nü", 'it\'s, "so" {a}'])
def test_a_dataset_is_used_there(made, tmp_path, name):
    dataset, out = tmp_path / name, tmp_path / f"out {name}"
    shutil.copytree(made.out / "publish", dataset)
    for words in (
        ("query", dataset, "SELECT count(*) FROM programs"),
        ("query", dataset, "FROM programs", "--out", tmp_path / f"{name}.csv"),
        ("diff", dataset, made.out / "publish"),
        ("report", dataset, "--out", out),
        ("export", "text", dataset, "--out", tmp_path / f"text {name}"),
        ("kb", "mine", dataset),
    ):
        result = run(*words)
        assert result.exit_code == 0 or words[0] == "export", (words, result.output)


@pytest.mark.parametrize("folder", NAMES, indirect=True)
@pytest.mark.parametrize("command", ["check", "run", "repair", "sketch"])
def test_a_program_is_tried_there(folder, command):
    result = run(command, folder / f"{folder.name}.txt")
    assert result.exit_code == 0, result.output


def test_a_build_follows_no_link_out_of_a_dataset(made, tmp_path):
    dataset, guard = tmp_path / "dataset", tmp_path / "guard.parquet"
    shutil.copytree(made.out / "publish", dataset)
    part = next((dataset / "programs").glob("*.parquet"))
    part.rename(guard)
    part.symlink_to(guard)
    result = run("build", dataset, "--out", tmp_path / "out", "--pictures", "0", "--workers", "1")
    assert "leads out of the dataset" in result.output
    assert result.exit_code == 1 or "DAMAGED_FILE" in result.output


TITLE = "Fetch \x1b[2J\x1b]0;owned\x07 \u202emilk\u2066 \x9b31m\r\u200f"


@pytest.mark.parametrize("command", ["check", "run", "repair", "sketch"])
@pytest.mark.parametrize("json", [False, True])
def test_a_title_moves_no_terminal(tmp_path, command, json):
    file = tmp_path / f"{TITLE[:9]}.txt"
    file.write_text(PROGRAM.replace("Fetch milk", TITLE).replace("<fridge>", "<fri\x9bdge\u202e>", 1))
    good = tmp_path / "good.txt"
    good.write_text(PROGRAM.replace("Fetch milk", TITLE))
    for path in (file, good):
        shown = run(command, path, *["--json"] * json).output
        assert not {*shown} & {*"\x1b\x07\x9b\r\u202e\u2066\u200f"}, ascii(shown)
