"""The page "What the thesis says, what we measure": it has every table and figure, and each command on it exists."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from click import Context

from hearth import cli

ROOT = Path(__file__).resolve().parents[2]
FIGURES = {"2": 4, "3": 6, "4": 9, "5": 7, "6": 9, "7": 6, "A": 5, "B": 8, "C": 8}
TABLES = {"2": 2, "3": 1, "4": 6, "5": 5, "A": 4, "B": 1, "C": 3}
"""The number of tables in the thesis, by chapter."""


@pytest.fixture(scope="module")
def thesis(module):
    return module("docs/hooks/thesis_page.py")


@pytest.fixture(scope="module")
def items(thesis):
    return {item["item"]: item for item in thesis.items(thesis.load())}


def test_the_page_is_current(thesis):
    assert thesis.PAGE.read_text("utf-8") == thesis.page(), "write it with: python docs/hooks/thesis_page.py"


def test_every_table_and_figure_of_the_thesis_is_there(items):
    wanted = [f"figure {part}-{number}" for part, count in FIGURES.items() for number in range(1, count + 1)]
    wanted += [f"table {part}.{number}" for part, count in TABLES.items() for number in range(1, count + 1)]
    assert sorted(set(items) - set(wanted)) == ["text 3.4", "text 3.4.1", "text 6.5", "text A.4"]
    assert not set(wanted) - set(items)


def test_a_number_of_ours_has_a_command_and_a_day(items):
    for name, item in items.items():
        mine = [row["ours"] for row in item.get("rows", ()) if row["ours"]]
        assert bool(mine) == (item["state"] == "measured" or (item["state"] == "part" and "measured" in item)), name
        assert not mine or (item["commands"] and re.fullmatch(r"20\d\d-\d\d-\d\d", item["measured"]["date"])), name
        assert item["state"] != "made" or item["commands"], name


def fault(command: str) -> str:
    """Return the fault of a command; "" if it could be run. Options and the number of arguments are parsed."""
    first, *words = shlex.split(command)
    if first == "python":
        return "" if (ROOT / words[0]).is_file() else f"no file {words[0]}"
    if first == "make":
        return "" if re.search(rf"^{words[0]}:", (ROOT / "Makefile").read_text("utf-8"), re.M) else "no such target"
    if first != "hearth" or words[0] not in cli.COMMANDS_BY_NAME:
        return "no such command"
    found = cli.load(words.pop(0))
    while parts := getattr(found, "commands", None):
        if words[0] not in parts:
            return f"no command {words[0]}"
        found = parts[words.pop(0)]
    try:
        found.parse_args(Context(found), words)
    except Exception as error:
        return str(error)
    return ""


def test_every_command_exists(items):
    commands = [command for item in items.values() for command in item.get("commands", ())]
    faults = {command: fault(command) for command in commands}
    assert len(commands) > 80 and not {command: what for command, what in faults.items() if what}


@pytest.mark.parametrize(
    "command",
    ["hearth corpus fold", "hearth home list --colour", "hearth query a", "python docs/x.py", "make tea", "ls"],
)
def test_a_command_that_does_not_exist_is_seen(command):
    assert fault(command)


def test_an_item_that_is_measured_again_has_the_same_numbers(thesis, items, tmp_path):
    again = {**items["table C.2"], "rows": [dict(row, ours="") for row in items["table C.2"]["rows"]]}
    thesis.fill(again, thesis.printed(again, tmp_path))
    assert again["rows"] == items["table C.2"]["rows"], 'measure it with: python docs/hooks/thesis_page.py "table C.2"'


def test_a_row_may_have_two_places(thesis):
    item = {"rows": [{"what": "both", "ours": "", "at": ["a", "b"]}, {"what": "none", "ours": ""}]}
    thesis.fill(item, {"a": 0.25, "b": 3})
    assert [row["ours"] for row in item["rows"]] == [".250, 3", ""]


def test_values_are_found_and_shown(thesis):
    document = {"rows": [{"name": "a b", "mean": 0.5}, {"name": "x", "mean": 1234}], "pairs": [["x", 1234]]}
    assert thesis.value_at(document, "rows/name=a b/mean") == 0.5
    assert thesis.value_at(document, "pairs/0=x/1") == 1234
    both = [{"name": "x", "of": "thesis", "n": 1}, {"name": "x", "of": "ours", "n": 2}]
    assert thesis.value_at(both, "name=x&of=ours/n") == 2
    with pytest.raises(LookupError):
        thesis.value_at(document["rows"][:1], "name=c/mean")
    assert [thesis.shown(each) for each in (0.2451, 1234, 11.82, 9857.3, {"mean": 0.3, "low": -0.2, "high": 2.0})] == [
        ".245", "1,234", "11.8", "9,857", ".300 (-.200-2.00)",
    ]  # fmt: skip
