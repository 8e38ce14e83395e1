"""The law of plans: each line of a text ends as title, description, step, fault, counted note or known layout."""

import json
import re
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hearth.commands.inputs import read_programs
from hearth.kb.language.plan_lines import META, ROLE, is_said_around, plan_line
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program_boundaries import TITLE
from hearth.storage.rejects import Reject

PLANS = Path(__file__).parents[1] / "messy/plans.jsonl"
OF_FORMS = re.compile(
    r"\s*(?:(?:thought|think|obs\w*)\b|#|//|;|\||\[(?:scene|description)\]"
    r"|(?:\[?step \d+\]?:? )?done\b|(?:\[step \d+\]) done)",
    re.IGNORECASE,
)
"""Lines that forms read over: thoughts and what they answer, comments, layout of tables, the ends of plans."""

ANSWERS = re.compile(r"\s*(?:>|act\b)", re.IGNORECASE)
"""A text with such lines is a log: what its other lines say is the game's answer."""


def plain(text: str) -> str:
    return "".join(filter(str.isalnum, text.lower()))


def lost(file: Path, knowledge) -> list[str]:
    """Return the lines of which nothing is left; empty if notes are counted for all of them."""
    said, lines, noted = "", set(), 0
    try:
        for each in read_programs(file, knowledge, file.name):
            faults = each.diagnostics if isinstance(each, Reject) else (*each.faults, *each.warnings)
            lines |= {fault.line for fault in faults}
            counts = (re.match(r"(\d+|a) line", fault.message) for fault in faults if fault.code == Code.NO_STEP)
            noted += sum(int(count[1]) if count[1].isdigit() else 1 for count in counts if count)
            if not isinstance(each, Reject):
                said += plain(f"{each.program.title} {each.program.description}") + "|"
                lines |= set(each.program.lines)
    except HearthError as error:
        lines |= {fault.line for fault in error.diagnostics}
    texts = file.read_text(encoding="utf-8-sig").split("\n")
    is_log = any(map(ANSWERS.match, texts))
    found = [raw for number, raw in enumerate(texts, 1) if number not in lines and not is_known(raw, said, is_log)]
    return found if len(found) > noted else []


def is_known(raw: str, said: str, is_log: bool) -> bool:
    line = plan_line(raw)
    title = plain(ROLE.sub("", TITLE.sub("", line.text.removeprefix("[Goal]"), count=1), count=1))
    is_group = line.heading and line.numbered
    if (
        is_group
        or not line.text
        or title in said
        or plain(line.text) in said
        or OF_FORMS.match(raw)
        or META.match(line.text)
    ):
        return True
    return is_log or is_said_around(line.text) or line.text.endswith(":")


@pytest.fixture
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("plans")


def test_no_line_of_a_messy_plan_is_lost(folder, knowledge):
    found = {}
    for row in map(json.loads, PLANS.read_text(encoding="utf-8").splitlines()):
        if row["file"].endswith((".txt", ".md")):
            file = folder / row["file"]
            file.write_bytes(row["text"].encode())
            found[row["id"]] = lost(file, knowledge)
    assert {name: lines for name, lines in found.items() if lines} == {}


MARKS = (
    "",
    "1. ",
    "2) ",
    "Step 3: ",
    "- ",
    "* ",
    "   - ",
    "a. ",
    "☐ ",
    "👉 ",
    "First, ",
    "[x] ",
    "4 - ",
    "#5 ",
    "Step Six: ",
)
WORDS = (
    "Walk to the kitchen", "open the fridge", "Grab milk.", "Polish the moon.", "fly to Mars", "I sit on the sofa.",
    "walk to sofa -> sit on sofa", "grab book; read book", "open it and then close it", "[Walk] <sofa> (1)",
    "It hums, and it is cold.", "The robot grabs the mug",
)  # fmt: skip
TITLES = (
    "Task: Watch TV", "## Make tea", "**Go to bed**", "Read a novel", "### 2. Wash hands", "---", "```", "Author: me",
    "", "", "Title: Rest", "Rest: lie on bed, close eyes, sleep",
)  # fmt: skip
LINES = st.one_of(st.sampled_from(TITLES), st.builds("{}{}".format, st.sampled_from(MARKS), st.sampled_from(WORDS)))


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=300)
@given(lines=st.lists(LINES, min_size=1, max_size=12))
def test_no_line_of_any_plan_is_lost(folder, knowledge, lines):
    file = folder / "plan.txt"
    file.write_text("\n".join(lines), encoding="utf-8")
    assert lost(file, knowledge) == []
