"""Text of others for a terminal: nothing in it moves the cursor, colors it, turns it around, or ends a line early."""

import json

BIDIRECTIONAL = (0x061C, 0x200E, 0x200F, *range(0x202A, 0x202F), *range(0x2066, 0x206A))
"""Code points that change the direction of the text after them."""


def escaped(code: int) -> str:
    """Return a code point as an escape: `\\x1b`, `\\u202e`, `\\U000e0041`."""
    return f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"


INVISIBLE = (
    0xAD, 0x180E, 0x200B, *range(0x2060, 0x2065), *range(0x206A, 0x2070), 0xFEFF, *range(0xFFF9, 0xFFFC),
    *range(0x1BCA0, 0x1BCA4), *range(0x1D173, 0x1D17B), *range(0xE0000, 0xE0080),
)  # fmt: skip
"""Code points of which nobody sees anything: marks without a width, and the tags, which spell whole texts. The joiners
U+200C and U+200D are none of them: writing and pictures have them."""

CONTROLS = (*range(32), *range(127, 160), 0x2028, 0x2029, *BIDIRECTIONAL, *INVISIBLE)
"""Code points that are not shown as they are."""

_IN_JSON = {code: json.dumps(chr(code))[1:-1] for code in CONTROLS if code > 126} | {127: "\\u007f"}
_SHOWN = {code: escaped(code) for code in CONTROLS if chr(code) not in "\n\t"}
_GONE = {code: None for code in CONTROLS if chr(code) not in "\n\r\t"}


def shown(text: str) -> str:
    """Return the text with characters escaped that are unseen or move others; line breaks and tabs stay."""
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
