"""`check` against golden pages: each input beside what is printed about it."""

import json
import os
from pathlib import Path

import pytest
from typer.testing import CliRunner

from hearth import cli

GOLDEN = Path(__file__).resolve().parents[1] / "golden/check"
CASES = sorted(GOLDEN.glob("*.txt"))
REFRESH = "if the new text is right: HEARTH_REFRESH=1 python -m pytest tests/house/test_house_check.py"


def check(*arguments, **options):
    return CliRunner().invoke(cli.app, ["check", *map(str, arguments)], **options)


@pytest.mark.parametrize("case", CASES, ids=lambda path: path.stem)
def test_golden_pages(case, monkeypatch):
    monkeypatch.chdir(GOLDEN)
    result = check(case.name)
    shown = f"{result.stdout}status {result.exit_code}\n"
    page = case.with_suffix(".expected")
    if os.environ.get("HEARTH_REFRESH"):
        page.write_text(shown)
    assert shown == page.read_text(), REFRESH


def test_there_are_golden_pages():
    assert len(CASES) >= 10


def test_every_file_is_reported_though_others_can_not_be_read(tmp_path):
    good, picture, empty = tmp_path / "good.txt", tmp_path / "a.png", tmp_path / "empty.txt"
    good.write_text("Sleep\n\n\n[Walk] <bedroom> (1)\n")
    picture.write_bytes(b"\x89PNG\r\n\x1a\n\xff\xfe\xfd")
    empty.write_text("")
    result = check(picture, tmp_path, empty, tmp_path / "gone.txt", good, "--json")
    report = json.loads(result.stdout)
    codes = [[fault["code"] for fault in each["faults"]] for each in report["files"]]
    assert codes == [["UNSUPPORTED_FILE"], ["UNSUPPORTED_FILE", "EMPTY"], ["EMPTY"], ["MISSING_FILE"], []]
    assert [each["steps"] for each in report["files"]] == [0, 1, 0, 0, 1]
    assert (result.exit_code, report["faults"]) == (1, 5)


def test_clean_programs_are_status_0():
    result = check("-", input="Sleep\n\n\n[Walk] <bedroom> (1)\n")
    assert (result.exit_code, result.output) == (0, "1 file, 1 program, 1 step: no faults\n")


def test_a_very_long_line_does_not_take_its_neighbours_with_it(tmp_path):
    file = tmp_path / "long.txt"
    file.write_text("Sleep\n\n\n[Walk] <bedroom> (1)\n" + "[Walk] " + "<a> (1) " * 1_300_000 + "\n[Flie] <bed> (1)\n")
    result = check(file)
    assert "error[LINE_TOO_LONG]" in result.stdout and "error[UNKNOWN_ACTION]" in result.stdout
    assert len(result.stdout) < 2_000


@pytest.mark.parametrize("encoding", ["utf-16", "utf-8-sig", "utf-8"])
def test_windows_files_are_read(tmp_path, encoding):
    file = tmp_path / "windows.txt"
    file.write_bytes("Café\r\nSit “there”\r\n\r\n\r\n[Walk] <bedroom> (1)\r\n\r\n".encode(encoding))
    assert check(file).exit_code == 0


def test_a_user_may_bring_knowledge(tmp_path):
    result = check("-", "--kb", tmp_path / "none", input="Sleep\n\n\n[Walk] <bedroom> (1)\n")
    assert result.exit_code == 1
    assert "none" in result.output and "Traceback" not in result.output


def test_affordances_are_checked_unless_refused():
    program = "Shower\n\n\n[Grab] <shower> (1)\n"
    for given in ((), ("--affordances",)):
        result = check("-", *given, input=program)
        assert result.exit_code == 1 and "error[NOT_AFFORDED]: [Grab] can't be done to `shower`" in result.stdout
        assert ":4:9" in result.stdout
    assert check("-", "--no-affordances", input=program).exit_code == 0
