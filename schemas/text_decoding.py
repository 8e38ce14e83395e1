"""Bytes to text: what people's editors and spreadsheets write, or a diagnostic."""

import re

from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code

LOOKED_AT = 64
"""Bytes at the beginning of a text from which its encoding is recognised."""

_MARKS = {b"\xff\xfe": "utf-16-le", b"\xfe\xff": "utf-16-be", b"\xef\xbb\xbf": "utf-8"}
_WIDE = re.compile(rb"(?:[\t\n\r -~]\x00){3}|(\x00[\t\n\r -~]){3}")
_NOT_WESTERN = re.compile(
    rb"[\x80-\xff]{3}|[\x81-\x84\x86-\x89\x8b\x8d\x8f\x90\x98\x9b\x9d\xa2\xa4-\xa6\xa8\xaa\xac\xad\xaf\xb1\xb5\xb6"
    rb"\xb8\xb9\xd0\xd7\xde\xf0\xf7\xfe\xff]"
)


def encoding_of(start: bytes) -> tuple[str, int]:
    """Return the encoding that the first bytes of a text show, UTF-16 or else UTF-8, and the length of a byte-order
    mark.
    """
    for mark, name in _MARKS.items():
        if start.startswith(mark):
            return name, len(mark)
    wide = _WIDE.match(start)
    return ("utf-16-be" if wide[1] else "utf-16-le") if wide else "utf-8", 0


def western(text: str) -> str:
    """Return a text with bytes that are not UTF-8, read as Windows-1252, of which Latin-1 is a part.

    Unchanged if it is not.

    It is read so if all else is ASCII, and these bytes are letters or signs of western languages, two in a row at most.

    Args:
        text: decoded with the error handler `surrogateescape`.
    """
    if text.isascii():
        return text
    try:
        data = text.encode("ascii", "surrogateescape")
    except UnicodeEncodeError:
        return text
    return text if _NOT_WESTERN.search(data) else data.decode("cp1252")


def decode(data: bytes, file: str = "") -> str | Diagnostic:
    """UTF-8, UTF-16 or Windows-1252, with or without a byte-order mark; line ends become `\\n`; else NOT_TEXT."""
    encoding, mark = encoding_of(data[:LOOKED_AT])
    try:
        text = western(data[mark:].decode(encoding, "surrogateescape" if encoding == "utf-8" else "strict"))
        text.encode()
    except (UnicodeDecodeError, UnicodeEncodeError) as error:
        start = error.start if isinstance(error, UnicodeDecodeError) else len(text[: error.start].encode())
        line = data.count(b"\n", 0, start) + 1
        message = f"byte {start + mark + 1:,} is not {encoding.upper()} text"
        return Diagnostic(Code.NOT_TEXT, message, file, line, suggestion="save the file as UTF-8")
    if "\x00" in text:
        line = text.count("\n", 0, text.index("\x00")) + 1
        return Diagnostic(Code.NOT_TEXT, "a NUL character", file, line, suggestion="save the file as UTF-8 text")
    return text.replace("\r\n", "\n").replace("\r", "\n")
