"""Tables and JSON of people's own: columns given or guessed, encodings, programs in one cell, wrapped records."""

from __future__ import annotations

import csv
import io
import json

import pytest
from typer.testing import CliRunner

from hearth.cli import app
from hearth.kb.language.plan_lines import plan_line
from hearth.pipelines.engine.source_labels import labelled
from hearth.pipelines.ingest import items
from hearth.pipelines.ingest import read as read_item
from hearth.pipelines.readers.field_columns import guessed, read_columns, shown
from hearth.schemas.diagnostics import HearthError
from hearth.storage.rejects import Reject

ROWS = [
    ["TV", "Watch; the “news”, café", "[Walk] <television> (1)\n[SwitchOn] <television> (1)"],
    ["Tea", "Two\nlines", "1. Walk to kitchen\n2. Find kettle"],
    ["Sleep", "Go to bed", "Walk to bed; Sleep"],
]


def table(header, delimiter=",", rows=ROWS):
    out = io.StringIO()
    writer = csv.writer(out, delimiter=delimiter)
    writer.writerows([header, *rows])
    return out.getvalue()


def read(path, **columns):
    found = []
    for _, item in items(labelled([str(path)]), columns):
        found.extend(read_item(item))
    return found


def steps(row):
    lines = map(plan_line, row["text"].splitlines())
    return [line.text for line in lines if line.number is not None]


@pytest.mark.parametrize("delimiter", [",", ";", "\t", "|"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "cp1252"])
@pytest.mark.parametrize("name", ["sheet.csv", "sheet.txt"])
def test_exports_of_spreadsheets(write, delimiter, encoding, name):
    file = write(name, table(["Task", "Text", "Plan"], delimiter).encode(encoding))
    tv, tea, sleep = read(file)
    assert (tv["title"], tv["description"], steps(tv)) == ("TV", ROWS[0][1], ROWS[0][2].split("\n"))
    assert (tea["title"], tea["description"], tea["origin"]) == ("Tea", "Two\nlines", "spoken")
    assert [(row["place"], row["line"]) for row in (tv, tea, sleep)] == [(file.name, 1), (file.name, 3), (file.name, 6)]
    assert steps(sleep) == ["Walk to bed", "Sleep"]


def test_bytes_of_no_known_encoding_are_named_as_the_fault(write):
    text = table(["Task", "Plan"], rows=[["TV", "Sleep"], ["Чай", "Sleep"], ["Bed", "Sleep"]])
    found = read(write("sheet.csv", text.encode("koi8-r")))
    assert [isinstance(one, Reject) for one in found] == [False, True, False]
    assert found[1].code == "NOT_TEXT" and "Windows-1252" in found[1].diagnostics[0].message


def test_what_excel_adds_is_no_record(write):
    text = "sep=;\n" + table(["Task", "Plan"], ";", [["TV", "Sleep"], ["", ""], ["Bed"], ["Bed", "Sleep", ""]])
    found = read(write("sheet.csv", text))
    assert [one.code if isinstance(one, Reject) else one["title"] for one in found] == ["TV", "EMPTY", "BAD_TABLE"]


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (["Task", "Text", "Plan"], {"title": "Task", "description": "Text", "program": "Plan"}),
        (["Activity name", "Long description", "Robot steps"],
         {"title": "Activity name", "description": "Long description", "program": "Robot steps"}),
        (["id", "instruction", "output"], {"title": "instruction", "program": "output"}),
        (["Steps", "Program"], {"program": "Program"}),
        (["a", "b"], {}),
    ],
)  # fmt: skip
def test_guesses(names, expected):
    assert guessed(names, {}) == expected


def test_given_columns_come_before_guesses(write):
    file = write("sheet.csv", table(["Plan", "Text", "Was"]))
    assert [row["title"] for row in read(file, title="Plan", program="Was")] == ["TV", "Tea", "Sleep"]
    file = write("a.json", json.dumps([{"Was": "TV", "Wie": ["[Sleep]"], "text": "Words."}]))
    (row,) = read(file, title="Was", program="Wie", description="text")
    assert (row["title"], row["description"], row["text"]) == ("TV", "Words.", "[Sleep]\n")


@pytest.mark.parametrize("text", ["title", "name=Task", "title=", "=Task"])
def test_columns_that_name_no_field(text):
    with pytest.raises(HearthError, match="title=Task,program=Plan"):
        read_columns(text)
    assert read_columns(" title = My task , program=Plan,") == {"title": "My task", "program": "Plan"}


PRICES = [["Anna", "Two pounds of plums", "12 for the whole crate"], ["Ben", "One pear", "3 a piece"]]


def test_a_table_without_known_columns_names_them(write):
    (reject,) = read(write("sheet.csv", table(["Alpha", "Beta", "Gamma"], rows=PRICES)))
    (fault,) = reject.diagnostics
    assert (reject.code, fault.line, fault.found) == ("BAD_TABLE", 1, "Alpha, Beta, Gamma")
    assert "--columns title=Alpha" in fault.suggestion


def test_a_table_of_other_names_is_told_by_its_longest_cell_and_what_was_asked_for(write):
    file = write("sheet.csv", table(["Alpha", "Beta", "Gamma"], rows=PRICES))
    (reject,) = read(file)
    assert "--columns title=Alpha,program=Gamma" in reject.diagnostics[0].suggestion
    (reject,) = read(file, program="Delta")
    assert reject.diagnostics[0].message == "a table without a column `Delta`"


@pytest.mark.parametrize(
    "cell",
    [
        "[Walk] <bed> (1), [Sleep]",
        "[Walk] <bed> (1) [Sleep]",
        '["[Walk] <bed> (1)", "[Sleep]"]',
        "['[Walk] <bed> (1)', '[Sleep]']",
        "1. [Walk] <bed> (1) 2. [Sleep]",
        "[Walk] <bed> (1)\n[Sleep]\n",
    ],
)
def test_a_program_in_one_cell(write, cell):
    (row,) = read(write("sheet.csv", table(["Plan"], rows=[[cell]])))
    assert steps(row) == ["[Walk] <bed> (1)", "[Sleep]"]


NAP = ["[Walk] <bed> (1)", "[Sleep]"]


@pytest.mark.parametrize(
    ("value", "titles"),
    [
        (NAP, ["a"]),
        ([NAP, NAP], ["", ""]),
        (["Walk to bed", "Sleep"], ["a"]),
        ({"Nap": NAP, "Rest": "1. Walk to bed\n2. Sleep"}, ["Nap", "Rest"]),
        ({"version": 1, "plans": [{"task": "Nap", "plan": NAP}, {"activity": "Rest", "steps": NAP}]}, ["Nap", "Rest"]),
        ({"data": {"test": [{"instruction": "Nap", "output": "1. Walk to bed\n2. Sleep"}]}}, ["Nap"]),
        ({"turk_annotations": {"anns": [{"task_desc": "Nap", "high_descs": ["Walk to bed", "Sleep"]}]},
          "plan": {"high_pddl": [{"discrete_action": {"action": "GotoLocation"}}]},
          "scene": {"floor_plan": "FloorPlan1"}}, ["Nap"]),
        ({"title": "Nap", "text": "Walk to bed -> Sleep"}, ["Nap"]),
        ({"title": "Nap", "text": "I lie down.", "plan": "Walk to bed\nSleep"}, ["Nap"]),
    ],
)  # fmt: skip
def test_json_of_other_people(write, value, titles):
    found = read(write("a.json", json.dumps(value)))
    assert [row["title"] for row in found] == titles
    for row in found:
        assert [one.lower().strip("[")[:4] for one in steps(row)] == ["walk", "slee"]
    lines = read(write("a.jsonl", f"{json.dumps(value)}\n{json.dumps(value)}\n")) if isinstance(value, dict) else []
    assert len(lines) in (0, 2 * len(titles))


def test_an_object_without_a_program_names_its_keys(write):
    (reject,) = read(write("a.json", json.dumps({"colour": "red", "size": 3})))
    assert reject.code == "EMPTY" and "colour, size" in reject.diagnostics[0].message


def run(*arguments, status=0):
    result = CliRunner().invoke(app, [str(argument) for argument in arguments])
    assert result.exit_code == status, result.output
    return result


def test_commands_name_the_columns_and_the_template_is_read(write, tmp_path):
    sheet = tmp_path / "mine.csv"
    run("corpus", "template", "--out", sheet)
    assert run("corpus", "template").output == sheet.read_text()
    result = run("check", sheet)
    assert (
        "Columns of" in result.stderr
        and "program=program" in result.stderr
        and "2 programs, 9 steps: no" in result.output
    )
    sheet = write("own/odd.csv", table(["Alpha", "Beta", "Gamma"]))
    named = "title=Alpha,description=Beta,program=Gamma"
    assert run("run", sheet, "--columns", named).stdout.startswith("TV, in maple")
    result = run("ingest", sheet.parent, "--columns", named, "--out", tmp_path / "out", "-j", 1)
    assert "Columns of own/odd.csv: title=Alpha, description=Beta, program=Gamma" in result.stdout
    found = json.loads(run("ingest", sheet.parent, "--columns", named, "--out", tmp_path / "out", "--json").stdout)
    assert found["columns"]["own/odd.csv"]["title"] == "Alpha" and found["stages"]["ingest"]["through"] == 3


def test_a_folder_takes_what_can_be_read_and_lists_the_rest(write, tmp_path):
    files = {
        "plan.md": "# Nap\n1. Walk to bed\n2. Sleep\n", "a.json": json.dumps({"title": "Nap", "steps": NAP}),
        "sheet.csv": table(["Task", "Plan"], rows=[["TV", "Sleep"]]), "README.md": "# Programs\nMine.\n",
        "home.yaml": "- a: b\n- c: d\n", "photo.png": "\x89PNG", "page.html": "<html>\n</html>\n", ".hidden": "x",
    }  # fmt: skip
    for name, text in files.items():
        folder = write(f"mix/{name}", text.encode("latin-1")).parent
    found = json.loads(run("ingest", folder, "--out", tmp_path / "out", "-j", 1, "--json").stdout)
    counts = found["stages"]["ingest"]
    assert (counts["through"], counts["codes"]) == (3, {"UNSUPPORTED_FILE": 4})
    assert [line.partition(":")[0] for line in found["unread"]] == [
        "mix/README.md", "mix/home.yaml", "mix/page.html", "mix/photo.png",
    ]  # fmt: skip
    assert "Not read: mix/photo.png: a PNG picture" in run("ingest", folder, "--out", tmp_path / "out").stdout


@pytest.mark.parametrize(
    ("text", "message"),
    [("T\n\n[Fly] <bed> (1)\n", "nothing is left after `validate`: 1 refused"),
     ("T\n\n[SwitchOn] <tv> (1)\n[SwitchOn] <tv> (1)\n", "nothing is left after"),
     ("", "EMPTY")],
)  # fmt: skip
def test_a_build_of_which_nothing_is_left_says_so(write, tmp_path, text, message):
    result = run("build", write("a.txt", text), "--out", tmp_path / "out", "--home", "maple", "-j", 1, status=1)
    assert message in result.output and not (tmp_path / "out/publish").exists()


def test_fields_without_a_column_are_named():
    columns = guessed(("Activity", "What they said", "Steps"), {})
    assert shown("mine.csv", columns).startswith(
        "Columns of mine.csv: program=Steps, title=Activity; none for description."
    )
