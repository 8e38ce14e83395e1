"""Bad input from the command line: rejects with code and place, or one clear error and status 1 (2 where
the command itself is wrong); never a traceback."""

from __future__ import annotations

import json
import zipfile

import pytest
from typer.testing import CliRunner

from hearth.cli import app

PROGRAM = "Watch TV\nFrom the sofa.\n\n[Walk] <television> (1)\n[SwitchOn] <television> (1)\n"


def invoke(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def ingest(tmp_path, *sources):
    return invoke("ingest", *sources, "--out", tmp_path / "out", "--workers", 1, "--json")


@pytest.mark.parametrize(
    ("name", "data", "code"),
    [
        ("empty.txt", b"", "EMPTY"),
        ("nul.txt", b"Watch\x00\n\n[Walk] <bed> (1)\n", "NOT_TEXT"),
        ("long.txt", b"Watch\n\n[Walk] <" + b"x" * 10_000_000 + b"> (1)\n", "LINE_TOO_LONG"),
        ("cut.zip", b"PK\x03\x04" + bytes(100), "BAD_ARCHIVE"),
        ("photo.png", b"\x89PNG\r\n\x1a\n", "UNSUPPORTED_FILE"),
        ("batch.csv", b"HITId,WorkerId,Answer.title\n1,2,3\n", "BAD_TABLE"),
        ("other.csv", b"a,b\n1,2\n", "BAD_TABLE"),
    ],
)
def test_alone_it_is_one_clear_error(write, tmp_path, name, data, code):
    result = ingest(tmp_path, write(name, data))
    assert result.exit_code == 1
    (fault,) = json.loads(result.stdout)["errors"]
    assert fault["code"] == code
    assert name in fault["file"]
    assert "Traceback" not in result.output


def test_among_others_it_is_a_reject(write, tmp_path):
    write("mix/empty.txt", b"")
    write("mix/nul.txt", b"\x00")
    write("mix/photo.png", b"\x89PNG\r\n\x1a\n")
    write("mix/cut.zip", b"PK\x03\x04" + bytes(100))
    folder = write("mix/tv.txt", PROGRAM.replace("\n", "\r\n")).parent
    result = ingest(tmp_path, folder)
    assert result.exit_code == 0, result.output
    counts = json.loads(result.stdout)["stages"]["ingest"]
    assert (counts["records_in"], counts["through"], counts["rejected"]) == (5, 1, 4)
    assert counts["codes"] == {"BAD_ARCHIVE": 1, "EMPTY": 1, "NOT_TEXT": 1, "UNSUPPORTED_FILE": 1}


def test_a_link_to_a_folder_says_so(write, tmp_path):
    folder = write("mix/tv.txt", PROGRAM).parent
    other = write("other/tv.txt", PROGRAM).parent
    (folder / "more").symlink_to(other)
    counts = json.loads(ingest(tmp_path, folder).stdout)["stages"]["ingest"]
    assert (counts["records_in"], counts["through"], counts["codes"]) == (2, 1, {"UNSUPPORTED_FILE": 1})
    (folder / "tv.txt").unlink()
    (fault,) = json.loads(ingest(tmp_path, folder).stdout)["errors"]
    assert "a link to a folder" in fault["message"]


def test_strict_makes_rejects_fatal(write, tmp_path):
    folder = write("mix/empty.txt", b"").parent
    write("mix/tv.txt", PROGRAM)
    result = invoke("ingest", folder, "--out", tmp_path / "out", "--workers", 1, "--strict")
    assert result.exit_code == 1


def test_an_archive_without_the_folders(tmp_path):
    path = tmp_path / "other.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("a/b.jpg", "c")
    result = ingest(tmp_path, path)
    assert result.exit_code == 1
    assert "needs one of the folders" in json.loads(result.stdout)["errors"][0]["suggestion"]


@pytest.mark.parametrize(
    ("line", "code", "place"),
    [
        ("[Fly] <television> (1)", "UNKNOWN_ACTION", (4, 2)),
        ("[Walk] <televison> (1)", "UNKNOWN_OBJECT", (4, 9)),
        ("[Walk] <bed> (1) <bed> (2)", "WRONG_ARITY", (4, 8)),
        ("[Walk] <bed> (one)", "BAD_INSTANCE", (4, 15)),
        ("[Walk <bed> (1)", "SYNTAX", (4, 1)),
        ("[Special] <hum a tune>", "SPECIAL_BLOCK", (4, 1)),
        ("[Eat] <couch> (1)", "NOT_AFFORDED", (4, 8)),
    ],
)
def test_a_bad_program_is_a_reject_with_line_and_column(write, built, line, code, place):
    write("p/a.txt", PROGRAM)
    folder = write("p/b.txt", f"Title\nWords.\n\n{line}\n").parent
    stages = built(folder)
    stages.run("ingest", "validate")
    (reject,) = stages.rejects("validate")
    assert (reject["record_id"], reject["code"]) == ("text:p/b.txt", code)
    assert (reject["line"], reject["column"]) == place
    assert [row["program_id"] for row in stages.rows("validate")] == ["text:p/a.txt"]


def test_every_fault_of_a_program_is_reported(write, built):
    text = PROGRAM + "[Fly] <television> (1)\n[Walk] <televison> (1)\n[Walk] <tv> (x)\n"
    stages = built(write("a.txt", text))
    stages.run("ingest", "validate")
    assert [(row["line"], row["code"], row["fault"]) for row in stages.rejects("validate")] == [
        (6, "UNKNOWN_ACTION", 0),
        (7, "UNKNOWN_OBJECT", 1),
        (8, "BAD_INSTANCE", 2),
    ]


def test_special_blocks_that_are_known_are_replaced(write, built):
    stages = built(write("a.txt", "Toilet\n\n[Walk] <toilet> (1)\n[Special] <Flush the  toilet>\n[Walk] <sink> (1)\n"))
    stages.run("ingest", "validate")
    (row,) = stages.rows("validate")
    assert [(step["action"], step["line"]) for step in row["steps"]] == [("Walk", 3), ("Touch", 4), ("Walk", 5)]


def test_a_home_that_there_is_not(write, tmp_path):
    result = invoke("build", write("a.txt", PROGRAM), "--out", tmp_path / "out", "-j", 1, "--home", "mapel")
    assert result.exit_code == 2
    assert "did you mean `maple`?" in result.output


def test_a_stage_that_there_is_not(tmp_path):
    result = invoke("build", "--out", tmp_path / "out", "--only", "polish")
    assert result.exit_code == 2
    assert "stages are ingest" in result.output


def test_a_folder_that_cannot_be_written(write, tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("")
    result = invoke("ingest", write("a.txt", PROGRAM), "--out", blocked / "out", "--workers", 1)
    assert result.exit_code == 1
    assert "Traceback" not in result.output
