"""Bytes that people's editors write."""

import pytest

from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.text_decoding import decode

TEXT = "Café\n“Sit”\n\n[Walk] <bed> (1)\n"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "cp1252"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_encodings_and_line_ends(encoding, end):
    text = f"Tea, then: {TEXT}" if encoding.endswith("e") else TEXT
    assert decode(text.replace("\n", end).encode(encoding)) == text


@pytest.mark.parametrize(
    ("data", "line"),
    [
        (b"one\ntwo\n\xff\xfe\xfd", 3),
        (b"\x89PNG\r\n\x1a\n", 1),
        ("Café: é".encode() + "é".encode("latin-1"), 1),
        ("Чай\n".encode("koi8-r"), 1),
        ("one\nテレビ".encode("shift-jis"), 2),
        (b"one\ntw\x00o\n", 2),
        (b"\xff\xfeo", 1),
        (b"PK\x03\x04\x00\x00", 1),
    ],
)
def test_what_is_no_text_is_a_fault_with_its_line(data, line):
    fault = decode(data, "a.txt")
    assert isinstance(fault, Diagnostic)
    assert (fault.code, fault.file, fault.line) == (Code.NOT_TEXT, "a.txt", line)
    assert fault.suggestion


def test_nothing_is_text():
    assert decode(b"") == ""
