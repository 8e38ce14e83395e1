"""Text of others for a terminal: nothing in it moves the cursor, colors it, turns it around, or ends a line early."""

BIDIRECTIONAL = (0x061C, 0x200E, 0x200F, *range(0x202A, 0x202F), *range(0x2066, 0x206A))
"""Code points that change the direction of the text after them."""

_CODES = (*range(32), *range(127, 160), 0x2028, 0x2029, *BIDIRECTIONAL)
_SHOWN = {code: f"\\x{code:02x}" if code < 256 else f"\\u{code:04x}" for code in _CODES if chr(code) not in "\n\t"}
_GONE = {code: None for code in _CODES if chr(code) not in "\n\r\t"}
_IN_JSON = {code: f"\\u{code:04x}" for code in _CODES if code > 126}


def shown(text: str) -> str:
    """Return the text with control characters and direction marks escaped; line breaks and tabs stay."""
    return text if text.isprintable() else text.translate(_SHOWN)


def without_controls(text: str) -> str:
    """Return the text of a page without those characters, which nobody sees there."""
    return text.translate(_GONE)


def shown_line(value: bytes) -> bytes:
    """Return a JSON document in bytes with those characters as `shown_json` has them: a line of a file for people."""
    return value if value.isascii() and b"\x7f" not in value else shown_json(value.decode()).encode()


def shown_json(document: str) -> str:
    """Return a JSON document with those characters as JSON's own escapes: it says the same."""
    return document if document.isascii() and "\x7f" not in document else document.translate(_IN_JSON)
