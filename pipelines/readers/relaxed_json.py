"""JSON as people write it by hand: with comments, and commas after the last entry."""

import re

_STRING = r'"[^"\\]*+(?:\\.[^"\\]*+)*+"'
_COMMENTS = re.compile(rf"{_STRING}|(?P<blank>//[^\n]*+|/\*.*?(?:\*/|\Z))", re.DOTALL)
_COMMAS = re.compile(rf"{_STRING}|(?P<blank>,)(?=\s*+[\]}}])", re.DOTALL)
_NOT_SPACE = re.compile(r"\S")


def uncommented(text: str) -> str:
    """Return JSON with its comments as spaces, so that all else keeps its place."""
    return _blanked(_COMMENTS, text) if "//" in text or "/*" in text else text


def strict(text: str) -> str:
    """Return JSON with its comments and its commas before a bracket that closes as spaces."""
    return _blanked(_COMMAS, uncommented(text))


def _blanked(pattern: re.Pattern[str], text: str) -> str:
    return pattern.sub(lambda found: _NOT_SPACE.sub(" ", found[0]) if found["blank"] else found[0], text)
