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


def faulty_files(folder):
    """Three files with one fault twice and another once, found in an order that is not that of lines."""
    for number in (1, 2, 3):
        steps = "[Walk] <kitchn> (1)\n[Fly] <bed> (1)\n[Walk] <kitchn> (1)\n[Walk] <bed> (1)\n"
        (folder / f"{number}.txt").write_text(f"Sleep\n\n\n{steps}")
    return sorted(folder.glob("*.txt"))


def test_equal_faults_are_printed_once_with_their_other_places(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = check(*(file.name for file in faulty_files(tmp_path)))
    assert result.stdout.count("error[UNKNOWN_OBJECT]") == result.stdout.count("error[UNKNOWN_ACTION]") == 1
    assert "+ 5 more: 6:9, 2.txt:4:9, 6:9, 3.txt:4:9, 6:9\n" in result.stdout
    assert "+ 2 more: 2.txt:5:2, 3.txt:5:2\n" in result.stdout
    assert result.stdout.endswith("3 files, 3 programs, 12 steps: 9 faults\n")


def test_the_json_has_every_fault_in_the_order_of_lines(tmp_path):
    (report, *_) = json.loads(check(*faulty_files(tmp_path), "--json").stdout)["files"]
    assert [fault["line"] for fault in report["faults"]] == [4, 5, 6]


def test_faults_and_warnings_stand_in_the_order_of_their_lines(tmp_path):
    (tmp_path / "b.txt").write_text("1. Walk to kitchin\n2. Zap the tea\n3. Walk to the sofa quickly\n4. Fly\n")
    (tmp_path / "a.txt").write_text("1. Zap the milk\n2. Walk to kitchan\n3. Zap the milk\n")
    result = check(tmp_path / "b.txt", tmp_path / "a.txt")
    places = [line.split("/")[-1] for line in result.stdout.splitlines() if "-->" in line]
    assert places == ["b.txt:1:4", "b.txt:2:4", "b.txt:3:4", "b.txt:4:4", "a.txt:1:4", "a.txt:2:4"]
    assert "+ 1 more: 3:4" in result.stdout


def test_a_summary_counts_faults_by_kind(tmp_path):
    result = check(tmp_path, *faulty_files(tmp_path)[1:], "--summary", "--lint")
    rows = [line.split()[:4] for line in result.stdout.splitlines()[1:-1]]
    assert rows[:2] == [["error", "UNKNOWN_OBJECT", "10", "3"], ["error", "UNKNOWN_ACTION", "5", "3"]]
    assert rows[2][0] == "warning" and "-->" not in result.stdout
    assert result.exit_code == 1


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
