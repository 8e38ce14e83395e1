"""Bytes to text: what people's editors write, or a diagnostic."""

from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code

_MARKS = {b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16", b"\xef\xbb\xbf": "utf-8-sig"}


def decode(data: bytes, file: str = "") -> str | Diagnostic:
    """UTF-8 with or without a byte-order mark, or UTF-16 with one; line ends become `\\n`; else NOT_TEXT."""
    encoding = next((name for mark, name in _MARKS.items() if data.startswith(mark)), "utf-8")
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        message = f"byte {error.start + 1:,} is not {encoding.upper()} text"
        return Diagnostic(Code.NOT_TEXT, message, file, line, suggestion="save the file as UTF-8")
    if "\x00" in text:
        line = text.count("\n", 0, text.index("\x00")) + 1
        return Diagnostic(Code.NOT_TEXT, "a NUL character", file, line, suggestion="save the file as UTF-8 text")
    return text.replace("\r\n", "\n").replace("\r", "\n")
