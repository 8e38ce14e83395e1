"""Files that are named to be read: what never ends, or never begins, is refused."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.scoring import environments
from hearth.scoring.predictions import Pair
from hearth.storage.input_files import read_input

CLI = Path(__file__).resolve().parents[2] / "cli.py"


def run(*words, **options):
    command = [sys.executable, str(CLI), *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False, **options)


def code_of(path, *more):
    with pytest.raises(HearthError) as error:
        read_input(path, *more)
    return error.value.diagnostics[0].code


def test_only_regular_files_of_a_reasonable_size_are_read(tmp_path):
    (tmp_path / "a").write_bytes(b"12345")
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "link").symlink_to("/dev/zero")
    assert read_input(tmp_path / "a", 5) == b"12345"
    assert code_of(tmp_path / "a", 4) is Code.FILE_TOO_LARGE
    assert code_of(tmp_path / "b") is Code.MISSING_FILE
    assert code_of(Path("a\0b")) is Code.UNSUPPORTED_FILE
    for name in ("pipe", "link", "."):
        assert code_of(tmp_path / name) is Code.UNSUPPORTED_FILE


@pytest.mark.parametrize("words", [["check", "{}"], ["check", "--fix", "{}"], ["score", "program", "{}"]])
@pytest.mark.parametrize("path", ["/dev/zero", "pipe"])
def test_commands_refuse_what_never_ends(tmp_path, words, path):
    os.mkfifo(tmp_path / "pipe")
    done = run(*(word.format(path) for word in words), cwd=tmp_path)
    assert done.returncode == 1 and "regular file" in done.stdout + done.stderr


def test_what_a_shell_opened_is_read(tmp_path):
    (tmp_path / "a.txt").write_text("Drink\n\n\n[Walk] <kitchen> (1)\n")
    done = subprocess.run(["bash", "-c", f"{sys.executable} {CLI} check <(cat a.txt)"], cwd=tmp_path, check=False)
    assert done.returncode == 0


@pytest.mark.parametrize(
    "name", ["/dev/zero", "../secret.json", "pipe", "link", "/etc/passwd", "..", "", "in/out.json"]
)
def test_a_graph_that_a_prediction_names_is_a_file_beside_it(tmp_path, knowledge, name):
    folder = tmp_path / "given"
    folder.mkdir()
    (tmp_path / "secret.json").write_text(json.dumps({"nodes": [], "edges": []}))
    os.mkfifo(folder / "pipe")
    (folder / "link").symlink_to("/dev/zero")
    (folder / "in").symlink_to(tmp_path)
    (tmp_path / "out.json").write_text("{}")
    asked = environments.by_row(folder / "predictions.jsonl", knowledge)
    with pytest.raises(HearthError) as error:
        asked(Pair("p", (), (), 1, {"graph": name}))
    (fault,) = error.value.diagnostics
    assert fault.code in (Code.DAMAGED_FILE, Code.UNSUPPORTED_FILE) and "`p`" in fault.message
