"""Text is cut into programs by pieces exactly as line by line; what came before is known again in little memory."""

import zipfile

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hearth.pipelines.crowd.duplicate_records import Repeated
from hearth.pipelines.crowd.key_counts import SeenSet, digest
from hearth.pipelines.readers import text_blocks as subject
from hearth.pipelines.readers.reader_items import Item
from hearth.schemas.program_boundaries import STEP, Splitter

LINES = (
    "Watch TV", "A sentence here.", "[Walk] <a> (1)", "", "", "", "  ", "\t", "<char0> [Sit] <b> (1)", "| x",
    "  indented",
    "one two three four five six seven eight nine ten", "  [Grab] <c> (1)", "x" * 29, "y" * 24, "\x0b", "a\u2028b", "é",
)  # fmt: skip


def line_by_line(text, longest):
    """First lines of programs and what they hold, the slow way."""
    found, splitter = [], Splitter()
    for number, line in enumerate(text.split("\n"), 1):
        if not line.strip():
            splitter.blank()
        elif splitter.begins(line, len(line) > longest or STEP.match(line) is not None):
            found.append((number, [line]))
        else:
            found[-1][1].append(line)
    return found


def pieces(text, size):
    return (text[at : at + size] for at in range(0, len(text), size))


def inked(text):
    return [line for line in text.split("\n") if line.strip()]


@settings(max_examples=300)
@given(st.lists(st.sampled_from(LINES), max_size=14).map("\n".join), st.integers(1, 60), st.sampled_from([24, 10_000]))
def test_pieces_as_lines(text, size, longest):
    subject.MAX_LINE, kept = longest, subject.MAX_LINE
    try:
        found = [(block.first, inked(block.text)) for block in subject.blocks(pieces(text, size))]
    finally:
        subject.MAX_LINE = kept
    assert found == line_by_line(text, longest)


@settings(max_examples=300)
@given(st.lists(st.sampled_from(LINES), max_size=25).map("\n".join), st.integers(1, 60))
def test_a_program_too_long_ends_where_it_would(text, size):
    kept = subject.MAX_LINE, subject.LONGEST_PROGRAM
    subject.MAX_LINE, subject.LONGEST_PROGRAM = 24, 50
    try:
        found = list(subject.blocks(pieces(text, size)))
    finally:
        subject.MAX_LINE, subject.LONGEST_PROGRAM = kept
    assert [block.first for block in found] == [first for first, _ in line_by_line(text, 24)]
    assert all(len(block.text) <= 50 for block in found)


def test_blank_lines_without_end_and_one_line_without_end_are_not_kept():
    cutter = subject._Cutter()
    for piece in ["Title", *["\n" * 500_000] * 4, *["x" * 500_000] * 4, "\n\n[Walk] <bed> (1)\n\nNext\n[Sleep]\n"]:
        found = list(cutter.take(piece))
        assert len(cutter._buffer) <= subject.LONGEST_PROGRAM + 500_000
    assert [(block.first, block.cut) for block in found] == [(1, True)]
    (last,) = cutter.take("", final=True)
    assert (last.first, last.text) == (2_000_005, "Next\n[Sleep]\n")


def test_a_seen_set_counts_and_grows():
    seen = SeenSet()
    keys = [digest(number) for number in range(5_000)]
    assert [seen.add(key) for key in keys] == [0] * 5_000
    assert [seen.add(key) for key in keys[:3]] == [1, 1, 1]
    assert keys[4_999] in seen and digest("other") not in seen and len(seen) == 5_000
    assert digest({"a": 1, "b": 2}) == digest({"b": 2, "a": 1})


def test_ids_of_text_are_known_again_whichever_comes_first():
    texts = [Item(name, "text", "a.txt", {"text": "x"}) for name in ("text:a.txt", "text:a.txt#2")]
    names = ("text:a.txt", "text:a.txt#2", "text:a.txt#3")
    records = [Item(name, "records", "b.jsonl", {"title": name}) for name in names]
    one = Repeated()
    assert [item.reader for item in one.first(texts, "text", "a.txt")] == ["text", "text"]
    assert [item.reader for item in one.first(records, "records", "b.jsonl")] == ["refused", "refused", "records"]
    other = Repeated()
    assert [item.reader for item in other.first(records[:1], "records", "b.jsonl")] == ["records"]
    assert [item.reader for item in other.first(texts, "text", "a.txt")] == ["refused", "text"]


@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("milk.txt", "Fetch milk\n\n[Walk] <kitchen> (1)\n[Open] <fridge> (1)\n"),
        ("milk.jsonl", '{"title": "Fetch milk", "steps": ["[Walk] <kitchen> (1)"]}\n'),
    ],
)
def test_a_text_in_a_folder_and_in_an_archive_of_it_is_one_duplicate(built, write, tmp_path, name, content, order):
    folder = write(f"corpus/{name}", content).parent
    with zipfile.ZipFile(tmp_path / "corpus.zip", "w") as archive:
        archive.writestr(name, content)
    made = built(*[folder, tmp_path / "corpus.zip"][::order])
    made.run("ingest")
    assert len(made.rows("ingest")) == 1
    assert [code for _, code in made.codes("ingest")] == ["DUPLICATE"]


def test_a_program_that_stands_twice_in_a_file_was_written_twice(built, write):
    made = built(write("milk.txt", "Fetch milk\n\n[Walk] <kitchen> (1)\n\nFetch milk\n\n[Walk] <kitchen> (1)\n"))
    made.run("ingest")
    assert (len(made.rows("ingest")), made.codes("ingest")) == (2, [])


def test_only_recent_answers_are_kept_to_compare_with():
    from hearth.pipelines.crowd.copied_answers import Copies

    words = "Walk to the kitchen and open the fridge. Take the milk out and pour a glass of it."
    others = [f"{'other words said here'.replace(' ', f' {n} ')} and some more of them {n}" for n in range(4)]

    def answer(number, text):
        cells = {"WorkerId": "W", "Answer.description": text}
        return Item(f"d{number}", "crowd", "a.csv", {"stage": 1, "cells": cells})

    items = [answer(number, text) for number, text in enumerate([words, *others, words])]
    assert [Copies(recent=9).checked(item).reader for item in items][-1] == "crowd"
    for recent, expected in ((9, "refused"), (2, "crowd")):
        copies = Copies(recent=recent)
        assert [copies.checked(item).reader for item in items][-1] == expected
