"""The README, the tour and the quick start show what commands and cells print, under the names that files have."""

from __future__ import annotations

import doctest
import re
from pathlib import Path
from textwrap import dedent

import pytest
from typer.testing import CliRunner

from hearth import cli

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text("utf-8")
TOUR = (ROOT / "docs/tour.md").read_text("utf-8")
PAGES = README + "\nText.\n\n" + TOUR
BLOCKS = [dedent(block).strip("\n") for block in re.findall(r"(?:^(?: {4}.*)?\n)*^ {4}.*\n(?=\S|\n\S)", PAGES, re.M)]


def block(start: str) -> str:
    """The indented block that begins with these words."""
    (found,) = (each for each in BLOCKS if each.startswith(start))
    return found


@pytest.fixture
def program(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "watch_tv.txt"
    path.write_text(block("Watch TV\nSit") + "\n")
    return path


def printed(*words: str) -> str:
    return "\n".join(line.rstrip() for line in CliRunner().invoke(cli.app, list(words)).output.strip().split("\n"))


def test_a_fault_is_shown_as_check_prints_it(program):
    program.write_text(program.read_text().replace("[Walk] <television>", "[Walk] <televison>"))
    assert block("error[UNKNOWN_OBJECT]").replace(" ", "") in printed("check", "watch_tv.txt").replace(" ", "")


@pytest.mark.parametrize("command", ["run", "repair"])
def test_a_command_prints_what_is_shown(program, command):
    shown = block("Watch TV, in maple\n  goal" if command == "repair" else "Watch TV, in maple\n  <tele")
    assert printed(command, "watch_tv.txt", "--home", "maple") == shown


def test_commands_of_the_tour_exist():
    used = set(re.findall(r"(?:`|^    )hearth ([a-z][a-z-]+)", PAGES, re.M))
    assert len(used) > 10 and used <= cli.COMMANDS_BY_NAME.keys()


@pytest.mark.slow
def test_pictures_and_films_have_the_names_that_are_told(program):
    small = ("--home", "maple", "--width", "64", "--fps", "5")
    assert "sheet.png" in printed("render-program", "watch_tv.txt", *small, "--mode", "video", "--out", "film")
    named = set(re.findall(r"`(\w+\.\w+)`", TOUR.split("`--mode video` films the program")[1].split("\n\n")[0]))
    assert named and named <= {path.name for path in Path("film").iterdir()}


def test_the_quick_start_prints_what_it_shows(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found = doctest.testfile(str(ROOT / "docs/quick-start.md"), module_relative=False)
    assert found.failed == 0 and found.attempted > 15
