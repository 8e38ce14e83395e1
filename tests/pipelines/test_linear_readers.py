"""Reading takes work in proportion to the size of a file, whatever is in it: calls are counted, not seconds."""

from __future__ import annotations

import random
import sys
from collections.abc import Callable

import pytest

from hearth.pipelines.engine.source_labels import labelled
from hearth.pipelines.ingest import items, read
from hearth.pipelines.readers import delimited
from hearth.pipelines.readers.record_ends import RecordEnds
from hearth.pipelines.readers.texts_with_positions import pieces_of, text_at
from hearth.schemas.diagnostics import HearthError

MOST_GROWTH = 2.6
"""Calls for twice the text, at most, as a multiple of those for the text; 4 would be a square."""

SIZE = 2_500

HEAD = "title,description,program\n"
STEP = "[Walk] <bed> (1)"


def filled(piece: str, head: str = "", tail: str = "") -> Callable[[int], str]:
    return lambda size: head + piece * (size // len(piece)) + tail


def columns(head: str, row: str, first: str = "title", own: str = "a") -> Callable[[int], str]:
    def text(size):
        count = size // (len(head) + len(row) + 6)
        return first + "".join(f",{head}{n}" for n in range(count)) + f"\n{own}" + f",{row}" * count + "\n"

    return text


def deep(begin: str, middle: str, end: str) -> Callable[[int], str]:
    def text(size):
        count = size // len(begin + end)
        return begin * count + middle + end * count

    return text


def stairs(size):
    return "".join(f"{' ' * n}- a\n" for n in range(int((2 * size) ** 0.5)))


HOSTILE = {
    # An open quote in each line, far apart, next to quotes that close, in front of long lines.
    "csv": {
        "quotes open": filled('Open,"never\n', HEAD),
        "quotes open apart": filled('x,"y\na\nb\n', HEAD),
        "quotes open far apart": filled('x,"y\n' + "a\n" * 60, HEAD),
        "quotes open before doubled ones": filled('x,"y\n' + 'a""b\n' * 60, HEAD),
        "three quotes": filled('x,"y",z"\n', HEAD),
        "one open quote": filled("Sleep,bed,x\n", HEAD + 'x,"y\n'),
        "long lines": filled('x,"y\n' + "z" * 900 + "\n", HEAD),
        "doubled quotes": filled('""', HEAD + 'a,b,"', '"\n'),
        "lines in a cell": filled(f"{STEP}\n", HEAD + 'a,b,"', '"\n'),
        "doubled quotes in lines": filled('[Walk] <""bed> (1)\n', HEAD + 'a,b,"', '"\n'),
        "commas": filled(",", HEAD),
        "commas alone": filled(","),
        "blank lines": filled("\n", HEAD),
        "many columns": columns("c", "x", "title,program", "a,walk to bed"),
        "many steps": columns("step", "walk to bed"),
        "rows that are steps": filled("a,1,walk to bed\n", "title,step,action\n"),
        "spaces": filled(" ", HEAD + "a,b,", "x\n"),
        "brackets": filled("[", HEAD + "a,b,", "\n"),
    },
    "json": {
        "lines in a text": filled(f"{STEP}\\n", '{"title":"a","program":"', '"}'),
        "escapes": filled("\\u0041\\n", '{"title":"a","program":"', '"}'),
        "spaces in lines": filled("walk  to   bed\\n", '{"title":"a","program":"', '"}'),
        "steps": filled('"walk to bed",', '{"title":"a","steps":[', '"x"]}'),
        "deep lists": deep("[", "", "]"),
        "deep objects": deep('{"a":', "1", "}"),
        "open": filled('{"a":'),
        "one key": filled('"title":"a",', "{", '"b":1}'),
        "objects": filled('{"title":"a","program":"walk to bed"},', "[", "1]"),
        "line breaks": filled("\n", "[", '{"title":"a","program":"walk to bed"}]'),
    },
    "jsonl": {
        "records": filled('{"title":"a","program":"walk to bed"}\n'),
        "open": filled('{"a":\n'),
        "lines in a text": filled(f"{STEP}\\n", '{"title":"a","program":"', '"}\n'),
        "quotes": filled('"'),
    },
    "yaml": {
        "lists": filled("- a: b\n"),
        "stairs": stairs,
        "lines in a text": filled(f"{STEP}\\n", '{"title":"a","program":"', '"}'),
        "brackets": filled("["),
        "documents": filled("---\n"),
    },
    "txt": {
        "programs": filled(f"Sleep\nGo to bed.\n\n\n{STEP}\n\n"),
        "steps": filled(f"{STEP}\n", "Sleep\nGo to bed.\n\n\n"),
        "steps in a line": filled(f"{STEP} "),
        "paragraphs": filled("a\n\n"),
        "fences": filled("```\n~~~\n"),
        "fenced documents": filled('```json\n{"a":1}\n'),
        "items": filled("- walk to bed\n"),
        "items in a line": filled("1. walk to bed "),
        "then": filled("walk to bed then "),
        "brackets": filled("("),
        "calls": filled("f("),
        "emphasis": filled("*"),
        "quotes": filled("'\""),
        "spaces": filled(" ", "a", "b"),
        "pipes": filled("|a|b|\n"),
        "thoughts": filled("Action: walk\nThought: x\n"),
        "stairs": stairs,
        "comments": filled("# a\n"),
        "functions": filled("def a():\n"),
        "plans": filled("(walk bed)\n"),
    },
}  # fmt: skip


def calls(path):
    """Count the functions that are called while the file is read."""
    count = 0

    def counted(_frame, event, _value):
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(counted)
    try:
        for _, item in items(labelled([str(path)]), found_columns={}):
            for _ in read(item, salt="s"):
                pass
    except HearthError:  # nothing in it is data
        pass
    finally:
        sys.setprofile(None)
    return count


@pytest.mark.parametrize(("suffix", "name"), [(suffix, name) for suffix, texts in HOSTILE.items() for name in texts])
def test_twice_the_text_is_twice_the_work(tmp_path, suffix, name):
    path, counts = tmp_path / f"a.{suffix}", []
    for size in (60, 60, SIZE, 2 * SIZE):  # the first reading loads what the others use, too
        path.write_text(HOSTILE[suffix][name](size))
        counts.append(calls(path))
    _, least, once, twice = counts
    assert twice - least < MOST_GROWTH * (once - least) + 2_000, counts


def test_a_row_with_an_open_quote_costs_about_as_much_as_a_whole_one(tmp_path):
    path, counts = tmp_path / "a.csv", {}
    for row in ("Nap,bed,x\n", "Nap,bed,x\n", 'Nap,"bed\n', 'Nap,"b",e,"d\n', 'Nap,"bed\n\n\n'):
        path.write_text(HEAD + row * 400)
        counts[row] = calls(path)
    good, *broken = counts.values()
    assert max(broken) < 3 * good, counts


PIECES = ('"', '""', ",", '"a', 'a"', "\n", "x,y,z", '"q,\n', "\n\n", ",,", '"x\ny"', "ü")


def plain_cells(rows, number, lines):
    """Cells of the record that begins on a line: line after line is added until it can be parsed."""
    import csv
    import io

    text = ""
    for line in rows[number : number + lines]:
        text += line
        try:
            return len(next(csv.reader(io.StringIO(text, newline=""), strict=True), []))
        except csv.Error:
            text += "\n"
    return 0


def test_records_end_where_a_plain_search_finds_their_ends():
    random_ = random.Random(7)
    for _ in range(300):
        rows = "".join(random_.choice(PIECES) for _ in range(random_.randint(1, 60))).split("\n")
        lines = random_.choice((1, 2, 5, 200))
        ends = RecordEnds(lambda number, rows=rows: rows[number] if number < len(rows) else None, ",")
        for number in random_.sample(range(len(rows)), len(rows)):
            assert ends.cells(number, lines) == plain_cells(rows, number, lines), (rows, number, lines)


@pytest.mark.parametrize(
    ("row", "line", "column"),
    [
        ('Open,"never closed,x', 2, 6),
        ('"a\nb","never closed,x', 3, 4),
        ('a,"b\nc,""d"",\n', 2, 3),
    ],
)
def test_an_open_quote_is_a_fault_where_it_opens(tmp_path, row, line, column):
    path = tmp_path / "a.csv"
    path.write_text(f"{HEAD}{row}\nSleep,Go to bed.,{STEP}\n")
    found = [item for _, item in items(labelled([str(path)]))]
    ((code, _, _, *place, _, _),) = next(item.value for item in found if item.reader == "refused")
    assert (code, place) == ("BAD_TABLE", [line, column])
    assert any(item.reader != "refused" for item in found), "the row after it is read"


def test_pieces_of_a_text_have_their_places_wherever_they_are():
    text = text_at('a"b\nc"\nd', 3, 5, 'a""b\nc""\nd', '""')
    assert [(piece, piece.line, piece.column) for piece in pieces_of(text, ["b", 'c"', "d"])] == [
        ("b", 3, 8),
        ('c"', 4, 1),
        ("d", 5, 1),
    ]
    layout = delimited.Layout(("a", "b", "c"), ",")
    cells = delimited.cells_at('"x\ny",z,"q\n\nr"', ["x\ny", "z", "q\n\nr"], 7, layout)
    assert [(cell.line, cell.column) for cell in cells] == [(7, 2), (8, 4), (8, 7)]
