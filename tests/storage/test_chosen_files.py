"""Files that a user names for output: links, pipes, devices and sockets stay what they are."""

from __future__ import annotations

import os
import socket
import stat
import subprocess
import sys
import threading

import pytest
from typer.testing import CliRunner

from hearth import cli
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage import files
from hearth.storage.chosen_files import write

WRITERS = {
    "query": (["query", "DATASET", "SELECT 1 AS a", "--csv", "--out", "FILE"], ".csv"),
    "query as Parquet": (["query", "DATASET", "SELECT 1 AS a", "--parquet", "FILE"], ".parquet"),
    "a floor plan": (["home", "show", "maple", "--out", "FILE"], ".svg"),
    "a drawing": (["home", "generate", "--rooms", "3", "--seed", "1", "--out", "FILE"], ".png"),
    "a plan": (["home", "generate", "--rooms", "3", "--seed", "1", "--out", "FILE"], ".yaml"),
    "a graph": (["home", "edit", "maple", "--set", "137:OPEN", "--out", "FILE"], ".json"),
    "a grammar": (["kb", "export", "grammar", "--to", "FILE"], ".gbnf"),
    "a database": (["kb", "export", "duckdb", "--to", "FILE"], ".duckdb"),
    "tasks": (["challenge", "tasks", "wah", "--limit", "1", "--out", "FILE"], ".json"),
    "an environment": (["environment", "sample", "--home", "birch", "--seed", "7", "--out", "FILE"], ".json"),
}


@pytest.fixture(params=sorted(WRITERS))
def command(request, made):
    words, ending = WRITERS[request.param]
    return [str(made.out / "publish") if word == "DATASET" else word for word in words], ending


def run(words, file):
    return CliRunner().invoke(cli.app, [str(file) if word == "FILE" else word for word in words])


def test_a_pipe_gets_the_whole_and_stays_a_pipe(command, tmp_path):
    words, ending = command
    pipe, plain = tmp_path / f"pipe{ending}", tmp_path / f"plain{ending}"
    os.mkfifo(pipe)
    result = run(words, pipe)
    assert result.exit_code == 1 and "UNWRITABLE" in result.output and "nobody reads" in result.output
    reader, read = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK), bytearray()
    os.set_blocking(reader, True)
    gone = threading.Event()

    def reading():
        while data := os.read(reader, 1 << 16):
            read.extend(data)
        gone.set()

    holder = os.open(pipe, os.O_WRONLY)  # the reader sees the end once both writers are gone
    thread = threading.Thread(target=reading, daemon=True)
    thread.start()
    result = run(words, pipe)
    os.close(holder)
    assert result.exit_code == 0, result.output
    assert gone.wait(10)
    os.close(reader)
    assert stat.S_ISFIFO(pipe.lstat().st_mode)
    assert run(words, plain).exit_code == 0
    if ending not in (".duckdb", ".yaml"):  # those name themselves
        assert bytes(read) == plain.read_bytes()
    assert {each.name for each in tmp_path.iterdir()} == {pipe.name, plain.name}


def test_a_link_stays_one_and_its_file_gets_the_content_and_keeps_its_mode(command, tmp_path):
    words, ending = command
    target, link = tmp_path / "kept", tmp_path / f"link{ending}"
    target.write_text("before")
    target.chmod(0o600)
    link.symlink_to("kept")
    result = run(words, link)
    assert result.exit_code == 0, result.output
    assert link.is_symlink() and target.read_bytes() != b"before" and target.stat().st_mode & 0o777 == 0o600


def test_standard_output_is_written_to_by_its_name(made):
    words = ["query", str(made.out / "publish"), "SELECT 1 AS a", "--csv", "--out", "/dev/stdout"]
    found = subprocess.run([sys.executable, "-m", "hearth.cli", *words], capture_output=True, text=True, check=False)
    assert found.stdout == "a\n1\n" and found.returncode == 0


def test_what_standard_output_had_before_is_kept(made, tmp_path):
    words = ["query", str(made.out / "publish"), "SELECT 1 AS a", "--csv", "--out", "/dev/stdout"]
    with (tmp_path / "log").open("ab") as log:
        log.write(b"before\n")
        log.flush()
        subprocess.run([sys.executable, "-m", "hearth.cli", *words], stdout=log, stderr=subprocess.PIPE, check=True)
    assert (tmp_path / "log").read_text() == "before\na\n1\n"


def refusal(path):
    with pytest.raises(HearthError) as caught:
        write(path, b"new")
    return caught.value.diagnostics[0]


def test_a_socket_and_a_link_to_itself_are_refused(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with socket.socket(socket.AF_UNIX) as listens:
        listens.bind("s")
        assert refusal(tmp_path / "s").code is Code.UNWRITABLE and stat.S_ISSOCK((tmp_path / "s").stat().st_mode)
    (tmp_path / "loop").symlink_to("loop")
    assert "leads to itself" in refusal(tmp_path / "loop").message and (tmp_path / "loop").is_symlink()


def test_a_link_to_a_file_that_there_is_not_yet_makes_it(tmp_path):
    (tmp_path / "link").symlink_to("new")
    write(tmp_path / "link", b"text")
    assert (tmp_path / "new").read_bytes() == b"text" and (tmp_path / "link").is_symlink()


def test_a_question_over_a_link_to_itself_is_refused(made, tmp_path):
    (tmp_path / "loop.csv").symlink_to("loop.csv")
    result = run(["query", str(made.out / "publish"), "SELECT 1", "--out", "FILE"], tmp_path / "loop.csv")
    assert result.exit_code == 1 and "UNWRITABLE" in result.output


def test_files_of_a_dataset_take_the_place_of_no_pipe(tmp_path):
    os.mkfifo(tmp_path / "manifest.json")
    with pytest.raises(HearthError) as caught:
        files.write_json(tmp_path / "manifest.json", {})
    assert caught.value.diagnostics[0].code is Code.UNWRITABLE
    assert stat.S_ISFIFO((tmp_path / "manifest.json").lstat().st_mode)
