"""Parts of sentences: where they are cut, which part says when or why, and which asks for nothing."""

from __future__ import annotations

import re

from hearth.models.reading.clause_matches import plain_words
from hearth.models.reading.clause_reader import TAKEN_BACK
from hearth.models.reading.request_table import words
from hearth.models.reading.statements import FORBIDS, is_statement

PARTS = re.compile(
    r"(,? and (?:only )?then |,? (?:only )?then |,? (?:and )?(?:afterwards|after that),? "
    r"|;? and also |,? and |,? but |,? plus "
    r"|, so (?!that\b)| so (?=(?:please|put|turn|switch|open|close|get|take|bring|grab|go|sit|shut"
    r"|can|could|would|make|let's|lock"
    r"|wash|wipe|clean|unplug) )|,? and so (?!on\b|that\b)"
    r"|[;,:] (?:and )?| - | – | — |\. )"
)
"""Cuts between parts of a sentence."""

STATEMENT = re.compile(
    r"(?:i|we)(?: would|'d| will|'ll)? (?:want|need|like|love|wish|expect|ask)(?: for)?(?: you)? to "
)
"""The beginning of a wish of the speaker for somebody to do something, or to do it oneself."""


_WISH = re.compile(
    r"(?:i|we)(?: would|'d)? (?:want|need|like|have|love) to (?:see|watch|read|sleep|rest|relax|eat|drink|work"
    r"|know|hear|listen|be|cook|feel"
    r"|write|sit|lie|play|enjoy|study)\b"
)
_REASON = re.compile(r"((?:i|we|you|they|he|she|it|the|my|our|your|there|this|that)\b.+?), so (?!that\b)(.+)")
_SUBORDINATE = re.compile(
    r"(?:after|once|when|before|as soon as|if|while|since|because|as|whenever|in case|now that|to|in order to"
    r"|for|at|in|from|on|with|by|over|under|inside) "
    r"(.+?), (.+)"
)


def main_clause(text: str) -> tuple[str, str] | None:
    """Return the clause of a sentence that says when or why, and the rest behind its comma; None without one."""
    found = _SUBORDINATE.fullmatch(text) or _REASON.fullmatch(text)
    return (found[1], found[2]) if found else None


BAN = re.compile(r"(?:do not|don't|never|without|not|no need to) ")
"""The beginning of an aside that says what is not to be done."""


def is_aside(text: str) -> bool:
    """Return whether a clause asks for nothing."""
    if PARTS.search(text) or (STATEMENT.match(text) and not _WISH.match(text)):
        return False
    if text in TAKEN_BACK or (FORBIDS.search(text) and not BAN.match(text)):
        return False
    plain = plain_words(text)
    if any(words().asides.fullmatch(each) for each in dict.fromkeys((text, plain)) if each):
        return True
    return any(is_statement(each) for each in dict.fromkeys((text, plain)) if each)
