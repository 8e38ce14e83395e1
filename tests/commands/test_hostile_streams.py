"""Streams and files that a caller chooses badly: closed, full, endless, links, or within the dataset that is asked."""

from __future__ import annotations

import subprocess
import sys

import pytest
from typer.testing import CliRunner

from hearth import cli
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

PROGRAM = "Watch TV\nWatch it.\n\n\n[Walk] <couch> (1)\n[Sit] <couch> (1)\n"


def hearth(command: str, folder):
    """Run a shell's line, in which `hearth` is the command."""
    line = command.replace("hearth ", f"{sys.executable} -m hearth.cli ")
    words = ["bash", "-c", line]
    return subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=120, check=False)


@pytest.fixture(scope="module")
def folder(made, tmp_path_factory):
    place = tmp_path_factory.mktemp("streams")
    (place / "a.txt").write_text(PROGRAM)
    (place / "mine").symlink_to(made.out / "publish")
    return place


@pytest.mark.parametrize(
    "words",
    ["home list --json", "home list", "run a.txt --json", "--help", "query --help", "--version",
     'query mine "SELECT 1" --csv', "check a.txt --json"],
)  # fmt: skip
def test_a_full_disk_is_said_in_a_line(folder, words):
    result = hearth(f"hearth {words} > /dev/full", folder)
    assert result.returncode == 1 and "no space left" in result.stderr.lower(), result.stderr
    assert "Traceback" not in result.stderr and "Exception" not in result.stderr, result.stderr


@pytest.mark.parametrize("words", ['query mine "SELECT 1"', "check a.txt", "--help"])
def test_a_closed_output_is_said_in_a_line(folder, words):
    result = hearth(f"hearth {words} >&-", folder)
    assert result.returncode == 1 and result.stderr.count("\n") == 1 and "it is closed" in result.stderr


def test_a_closed_input_is_an_empty_one_and_a_closed_error_stream_is_no_fault(folder):
    assert "EMPTY" in hearth("hearth check - <&-", folder).stdout
    result = hearth("hearth check a.txt 2>&-", folder)
    assert result.returncode == 0 and "no faults" in result.stdout


def test_a_question_from_an_endless_input_is_refused(folder):
    result = hearth("ulimit -v 8000000; hearth query mine - < /dev/zero", folder)
    assert result.returncode == 1 and "FILE_TOO_LARGE" in result.stderr


def test_a_question_of_the_standard_input_is_answered(folder):
    assert hearth("echo 'SELECT 7 AS a' | hearth query mine - --csv", folder).stdout == "a\n7\n"
    assert "UTF-8" in hearth("printf '\\xff' | hearth query mine -", folder).stderr


def test_one_file_that_cannot_be_read_hides_no_other(folder):
    result = hearth("hearth check /proc/self/mem a.txt", folder)
    assert result.returncode == 1 and "/proc/self/mem" in result.stdout and "2 files" in result.stdout


@pytest.mark.parametrize("place", ["copy/manifest.json", "copy/new.csv", "link/x.json", "copy/programs/../x.csv"])
def test_no_answer_is_written_into_the_dataset(made, tmp_path, place):
    import shutil

    shutil.copytree(made.out / "publish", tmp_path / "copy")
    (tmp_path / "link").symlink_to(tmp_path / "copy")
    before = {path: path.read_bytes() for path in (tmp_path / "copy").rglob("*") if path.is_file()}
    words = ["query", str(tmp_path / "copy"), "SELECT 1", "--out", str(tmp_path / place)]
    result = CliRunner().invoke(cli.app, words)
    assert result.exit_code == 1 and "UNWRITABLE" in result.output
    for command in (["export", "--format", "csv"], ["report"]):
        words = [command[0], str(tmp_path / "copy"), *command[1:], "--out", str((tmp_path / place).parent / "new")]
        result = CliRunner().invoke(cli.app, words)
        assert result.exit_code == 1 and "stays as it was published" in result.output
    assert before == {path: path.read_bytes() for path in (tmp_path / "copy").rglob("*") if path.is_file()}


def test_a_link_stays_one_and_the_file_keeps_its_mode(tmp_path):
    real, link = tmp_path / "real.txt", tmp_path / "link.txt"
    real.write_text(PROGRAM.replace("<couch>", "<cuoch>"))
    real.chmod(0o600)
    link.symlink_to("real.txt")
    CliRunner().invoke(cli.app, ["check", "--fix", str(link)])
    assert link.is_symlink() and str(link.readlink()) == "real.txt"
    assert "<cuoch>" not in real.read_text() and real.stat().st_mode & 0o777 == 0o600
    assert {path.name for path in tmp_path.iterdir()} == {"real.txt", "link.txt"}


@pytest.mark.parametrize(
    "public",
    ["https://a.example/\r\nX: y", "https://a.example\n", "https://a.example/path", "https://a.example/",
     "https://u:p@a.example", "https://a.example?x", "https://a.example#x", "https://a b", "https://-a", "https://ä.de",
     "https://a.example:99999", "https://a.example:0", "https://a\x1b[2J.example", "http://a.example", "https://"],
)  # fmt: skip
def test_a_public_address_is_a_name_and_a_port(public):
    from hearth.commands.serve import public_hosts

    with pytest.raises(HearthError) as caught:
        public_hosts(public)
    assert caught.value.diagnostics[0].code is Code.BAD_ARGUMENT


@pytest.mark.parametrize("public", ["https://a.example", "https://a-b.example:8443", "https://[::1]:8443"])
def test_public_addresses_are_taken(public):
    from hearth.commands.serve import public_hosts

    assert public_hosts(public) == (public.removeprefix("https://"),)
