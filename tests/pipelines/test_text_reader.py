"""The reader of program text: several programs in a file, encodings, and what a fault costs."""

from __future__ import annotations

import pytest
from read_sources import PROGRAM, faults, read, rows


def test_a_file_may_hold_several_programs(write):
    text = f"{PROGRAM}\n\nSleep\nIn the bed.\n\n[Walk] <bed> (1)\n\n[Lie] <bed> (1)\n"
    first, second = rows(read(write("tv.txt", text)))
    assert (first["program_id"], first["title"], first["description"], first["line"]) == (
        "text:tv.txt",
        "Watch TV",
        "From the sofa.",
        0,
    )
    assert (second["program_id"], second["title"], second["line"]) == ("text:tv.txt#2", "Sleep", 7)
    assert second["text"].count("[") == 2


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "cp1252"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_encodings_and_line_ends_that_editors_write(write, encoding, end):
    program = PROGRAM.replace("sofa", "café’s sofa")
    (row,) = rows(read(write("tv.txt", program.replace("\n", end).encode(encoding))))
    assert row["text"].rstrip("\n") == program.rstrip("\n")


@pytest.mark.parametrize(
    ("name", "data", "code", "line"),
    [
        ("empty", b"", "EMPTY", 0),
        ("blank", b"\n  \n\n", "EMPTY", 0),
        ("nul", b"Watch TV\n\n[Walk] <tv>\x00 (1)\n", "NOT_TEXT", 3),
        ("latin-2", b"Wst\xf3\xb3\xbf\n\n[Walk] <kitchen> (1)\n", "NOT_TEXT", 1),
        ("two encodings", b"Caf\xc3\xa9\n\n[Walk] <caf\xe9> (1)\n", "NOT_TEXT", 3),
        ("long", b"Watch TV\n\n[Walk] <" + b"x" * 10_000_000 + b"> (1)\n", "LINE_TOO_LONG", 3),
    ],
)
def test_a_bad_file_is_a_reject_and_its_neighbours_stay(write, name, data, code, line):
    folder = write("p/b.txt", data).parent
    write("p/a.txt", PROGRAM)
    write("p/c.txt", PROGRAM)
    found = read(folder)
    assert [row["program_id"] for row in rows(found)] == ["text:p/a.txt", "text:p/c.txt"]
    assert faults(found) == [(code, "p/b.txt", line)]


def test_a_bad_program_costs_no_other_program_of_its_file(write):
    text = PROGRAM.encode() + b"\nBroken\x00\n\n[Walk] <bed> (1)\n\n" + PROGRAM.encode()
    found = read(write("tv.txt", text))
    assert [row["program_id"] for row in rows(found)] == ["text:tv.txt", "text:tv.txt#3"]
    assert faults(found) == [("NOT_TEXT", "tv.txt", 7)]


def test_a_line_beyond_all_bounds_is_reported(write):
    ((_, reject),) = read(write("a.txt", "Walk\n\n[Walk] <" + "x" * 3_000_000 + "> (1)\n"))
    assert "more than 10,000 characters" in reject.diagnostics[0].message


def test_a_title_without_steps_is_a_record_of_its_own(write):
    first, second = rows(read(write("two.txt", f"Ironing\nIron a shirt.\n\n\n{PROGRAM}")))
    assert (first["title"], second["title"], second["line"]) == ("Ironing", "Watch TV", 4)
    assert "[" not in first["text"] and second["text"].count("[") == 2
