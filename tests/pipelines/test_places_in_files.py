"""Places of faults: open the file at the line and column of a diagnostic, and find there what it shows."""

from __future__ import annotations

import csv
import io
import json
import zipfile

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hearth.commands import inputs
from hearth.kb.loading.load import default
from hearth.pipelines.readers.texts_with_positions import Text, text_at
from hearth.storage.rejects import Reject

BAD = ("Fly to moon", "[Fly] <bed> (1)", "[Walk] <piano-forte-x> (1)", "[Walk <bed> (1)", 'Say "qua" to é zzyx\tnow')
GOOD = ("Walk to kitchen", "[Walk] <bed> (1)", "[Sleep]", "Open fridge")
steps = st.lists(st.sampled_from(BAD + GOOD), min_size=1, max_size=5)
titles = st.sampled_from(["Nap", 'A "quoted" title', "Zwölf; Ämter, \\ slash", "Two\nlines"])
records = st.lists(st.tuples(titles, steps), min_size=1, max_size=4)


def as_jsonl(rows, ascii_only):
    return "".join(json.dumps({"title": t, "plan": s}, ensure_ascii=ascii_only) + "\n" for t, s in rows)


def as_json(rows, ascii_only):
    return json.dumps([{"title": t, "steps": s} for t, s in rows], indent=2, ensure_ascii=ascii_only)


def as_document(rows, ascii_only):
    return json.dumps({"data": [{"task": t, "plan": "\n".join(s)} for t, s in rows]}, ensure_ascii=ascii_only, indent=1)


def as_csv(rows, _):
    out = io.StringIO()
    csv.writer(out).writerows([["Task", "Plan"], *((title, "\n".join(steps)) for title, steps in rows)])
    return out.getvalue().replace("\r\n", "\n")


FORMS = {"a.jsonl": as_jsonl, "b.json": as_json, "c.json": as_document, "d.csv": as_csv}


def faults_of(path):
    for found in inputs.read_programs(path, default(), path.name):
        yield from found.diagnostics if isinstance(found, Reject) else (*found.faults, *found.warnings)


def shown_at(text, fault):
    """Return whether the words that a fault shows stand at its place, as JSON and CSV may write them."""
    line = text.split("\n")[fault.line - 1][fault.column - 1 :]
    first = fault.found.replace("\t", " ").removesuffix(" now")  # a tab, which is shown as a blank
    ways = {first, json.dumps(first)[1:-1], json.dumps(first, ensure_ascii=False)[1:-1], first.replace('"', '""')}
    return any(line.startswith(way) for way in ways)


@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize("name", FORMS)
@given(rows=records, ascii_only=st.booleans())
@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_what_a_fault_shows_stands_at_its_place(name, packed, rows, ascii_only, tmp_path):
    text = FORMS[name](rows, ascii_only)
    path = tmp_path / name
    path.write_text(text, "utf-8", newline="")
    if packed:
        path = tmp_path / "all.zip"
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr(name, text)
    lines = text.split("\n")
    for fault in faults_of(path):
        assert fault.file == (f"{path.name}/{name}" if packed else name)
        assert 1 <= fault.line <= len(lines)
        if fault.column and fault.found:
            assert shown_at(text, fault), fault


def test_a_step_of_a_line_of_json_is_shown_where_it_stands(write):
    file = write("ln.jsonl", '{"task":"A","plan":["Walk to kitchen","Fly to moon"]}\n{"task":"B","plan":["Sleep"]}\n')
    (fault,) = faults_of(file)
    assert (fault.line, fault.column, fault.source) == (1, 40, "Fly to moon")


def test_a_line_that_is_not_json_is_placed_in_the_file(write):
    file = write(
        "ln.jsonl", '{"task":"A","plan":["Sleep"]}\n{"task":"B" "plan":["Sleep"]}\n{"task":"C","plan":["Sleep"]}\n'
    )
    (fault,) = faults_of(file)
    assert (fault.code, fault.line, fault.column) == ("BAD_JSON", 2, 13) and "line 1" not in fault.message


def test_a_cell_of_several_lines_has_the_lines_of_the_file(write):
    file = write("d.csv", 'Task,Plan\nA,"1. Walk to kitchen\n2. Fly to moon"\nB,Fly to moon\n')
    assert [(f.line, f.column) for f in faults_of(file)] == [(3, 4), (4, 3)]


@pytest.mark.parametrize("value", ["a\nbc\n\nd", "one line", "\n", "tab\there\nand \\ there"])
@pytest.mark.parametrize("skip", [0, 8])
def test_lines_that_only_breaks_part_have_the_places_of_any_escape(monkeypatch, value, skip):
    text = text_at(value, 3, 5, json.dumps(value)[1:-1])
    quick = text.places(skip)
    monkeypatch.setattr(Text, "_has_breaks_alone", lambda _: False)
    assert text.places(skip) == quick
