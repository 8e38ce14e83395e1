"""Refusals: why a text has no program, with the part of it that was understood."""

from __future__ import annotations

from hearth.kb.language.english_lexicon import foreign_language
from hearth.models.reading.instruction_reading import Reading
from hearth.schemas.failures import Code, Failure

_SHOWN = 60
_LOOKED_AT = 300
"""Characters of a part by which its language is known."""

MOST_UNREAD = 6
"""Words of a description that are not understood, for each word that asks for something, at most."""


def refusal(reading: Reading, *, is_long: bool) -> Failure | None:
    """Return why a reading gives no program; None where it does.

    Args:
        reading: of a text.
        is_long: whether the text is a description, of which a part may be left out.
    """
    if not reading.acts:
        if reading.missing:
            return Failure(Code.UNBOUND, names=reading.missing[:1], expected=f"{reading.missing[0]} in the home",
                           actual="none")  # fmt: skip
        if language := foreign_language([part[:_LOOKED_AT] for part in reading.unread[:3]]):
            return Failure(Code.NOT_UNDERSTOOD, expected="a request in English", actual=language)
        part = reading.unread[0] if reading.unread else ""
        actual = f"`{part[:_SHOWN]}`" if part else "none"
        return Failure(Code.NOT_UNDERSTOOD, expected="something to do in a home", actual=actual)
    if reading.unread and (not is_long or _is_mostly_unread(reading)):
        part = reading.unread[0]
        if reading.missing:
            return Failure(Code.UNBOUND, names=reading.missing[:1], expected=f"{reading.missing[0]} in the home",
                           actual=f"none, for `{part[:_SHOWN]}`")  # fmt: skip
        return Failure(Code.NOT_UNDERSTOOD, expected="something to do in a home", actual=f"`{part[:_SHOWN]}`")
    return None


def _is_mostly_unread(reading: Reading) -> bool:
    """Return whether most of a description is in words of which nothing is understood."""
    unread = sum(len(part.split()) for part in reading.unread)
    read = sum(len(words.split()) for words in dict.fromkeys(act.words for act in reading.acts))
    return unread > MOST_UNREAD * max(read, 1)
