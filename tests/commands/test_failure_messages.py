"""The message of each code that a program can meet, on one golden page: reason, remedy and code."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from hearth.cli import app
from hearth.schemas.failures import Code

PAGE = Path(__file__).resolve().parents[1] / "golden/messages.txt"
REFRESH = "if the new words are right: HEARTH_REFRESH=1 python -m pytest tests/commands/test_failure_messages.py"
FISH = "[Walk] <freezer> (1)\n[Open] <freezer> (1)\n[Grab] <food_fish> (1)\n"
KITCHEN = "[Walk] <fridge> (1)\n[Open] <fridge> (1)\n"

RUNS = {
    "NOT_AFFORDED": "[Walk] <sofa> (1)\n[Open] <sofa> (1)\n",
    "NOT_CLOSE": "[Sweep] <floor> (1)\n",
    "NOT_FACING": "[Walk] <television> (1)\n[Watch] <television> (1)\n",
    "NOT_IN_ROOM": "[Walk] <bedroom> (1)\n[Watch] <television> (1)\n",
    "NO_ROOM": FISH + "[Eat] <food_fish> (1)\n[Walk] <food_fish> (1)\n",
    "SITTING": "[Walk] <sofa> (1)\n[Sit] <sofa> (1)\n[Walk] <fridge> (1)\n",
    "LYING": "[Walk] <bed> (1)\n[Lie] <bed> (1)\n[Walk] <fridge> (1)\n",
    "NOT_SITTING_OR_LYING": "[WakeUp]\n",
    "DOOR_CLOSED": "[Walk] <door> (1.5)\n[Close] <door> (1.5)\n[Walk] <clothes_shirt> (1.380)\n",
    "NO_FREE_HAND": KITCHEN + "[Grab] <milk> (1)\n[Grab] <juice> (1)\n[Grab] <milk> (2)\n",
    "NOT_HOLDING": "[Drop] <newspaper> (1)\n",
    "NO_ORIGIN": "[PutObjBack] <mug> (1)\n",
    "OCCUPIED": "[Walk] <chair> (1.314)\n[Sit] <chair> (1.314)\n",
    "INSIDE_CLOSED": "[Walk] <fridge> (1)\n[Grab] <milk> (1)\n",
    "IS_OPEN": KITCHEN + "[Open] <fridge> (1)\n",
    "IS_CLOSED": "[Walk] <fridge> (1)\n[Close] <fridge> (1)\n",
    "IS_ON": "[Walk] <ceilinglamp> (1)\n[SwitchOn] <ceilinglamp> (1)\n",
    "IS_OFF": "[Walk] <television> (1)\n[SwitchOff] <television> (1)\n",
    "IS_PLUGGED": "[Walk] <toaster> (1)\n[PlugIn] <toaster> (1)\n",
    "IS_UNPLUGGED": "[Walk] <toaster> (1)\n[PlugOut] <toaster> (1)\n[PlugOut] <toaster> (1)\n",
    "NOT_WORN": "[PutOff] <clothes_shirt> (1)\n",
    "NOTHING_TO_EAT": "[Walk] <coffee_table> (1)\n[Eat] <coffee_table> (1)\n",
    "WRONG_STATE": "[Walk] <bathtub> (1)\n[Leave] <bathtub> (1)\n",
    "CONFLICT": "<char0> [Walk] <sofa> (1) | <char0> [Walk] <bed> (1)\n",
    "UNBOUND": "[Walk] <shower> (1)\n",
}
"""A program for each code, run in maple by action set 3; it fails at its last step."""

CHECKS = {
    "EMPTY": "",
    "SYNTAX": "[Walk <sofa> (1)\n",
    "BAD_INSTANCE": "[Walk] <sofa> (one)\n",
    "UNKNOWN_ACTION": "[Flie] <sofa> (1)\n",
    "UNKNOWN_OBJECT": "[Walk] <helicopterpad> (1)\n",
    "WRONG_ARITY": "[Walk]\n",
    "NOT_UNDERSTOOD": "1. walk to the sofa\n2. blorp the frobnicator\n",
    "FUZZY_MATCH": "1. wlak to the sofa\n2. sit on the sofa\n",
}
"""A text for each code of reading."""


def failing_line(printed: str) -> str:
    """Return the sentence on the step that failed, or the first fault."""
    lines = printed.strip().splitlines()
    return next((line for line in lines if re.match(r"step \d+ failed", line)), lines[0])


def said(tmp_path: Path, command: str, text: str, *options: str) -> str:
    """Return the line that a command prints about a text, without the file's folder."""
    file = tmp_path / "p.txt"
    file.write_text(f"A plan\n\n\n{text}" if command == "run" else text)
    found = CliRunner().invoke(app, [command, str(file), *options])
    return failing_line(found.output).replace(str(tmp_path) + "/", "")


def page(tmp_path: Path) -> str:
    """Return the golden page: each code with its text and the line that is printed about it."""
    runs = {
        code: said(tmp_path, "run", text, "--home", "maple", "--rules", "consequences") for code, text in RUNS.items()
    }
    checks = {code: said(tmp_path, "check", text) for code, text in CHECKS.items()}
    texts = {**RUNS, **CHECKS}
    parts = (f"== {code}\n{texts[code]}-> {line}\n" for code, line in {**runs, **checks}.items())
    return "\n".join(parts)


def test_the_golden_page_of_messages(tmp_path):
    printed = page(tmp_path)
    if os.environ.get("HEARTH_REFRESH"):
        PAGE.write_text(printed, "utf-8")
    assert printed == PAGE.read_text("utf-8"), REFRESH


@pytest.mark.parametrize("part", PAGE.read_text("utf-8").removeprefix("== ").split("\n== ") if PAGE.exists() else [])
def test_a_message_ends_with_its_code_and_says_no_notation(part):
    code, message = part.partition("\n")[0], part.rpartition("-> ")[2].strip()
    assert Code(code) and code in message
    if code in RUNS:
        assert message.endswith(f"({code})") and not re.search(r"\btick\b|not so|state\(", message)
