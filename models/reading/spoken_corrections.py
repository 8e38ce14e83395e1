"""Requests in which people correct themselves: `on the desk... actually, on the shelf` asks for the shelf alone."""

from __future__ import annotations

import re

from hearth.kb.language.english_lexicon import is_noun, is_verb

_CORRECTION = re.compile(
    r"(?P<first>.+?)\s*(?:\.\.+|\u2026|[,;.!?]| - | \u2013 | \u2014 )\s*(?:oh |uh |um |well,? |hm+,? |sorry,? |no,? )*"
    r"(?:actually|no,? wait|wait,? no|wait|sorry|i mean(?:t)?|make (?:that|it)|or rather|scratch that"
    r"|strike that|on second thoughts?|no(?=,))[,:.]*(?:\s+(?:no|i mean|make (?:that|it)|not"
    r" that))*[,:.]*\s+(?P<then>.+)",
    re.IGNORECASE,
)
_PREPOSITION = re.compile(
    r"(?:in|into|on|onto|to|under|next to|be[s]ide|from|with|at|for|behind|near)\b", re.IGNORECASE
)
_LAST = re.compile(r"(.*(?<!\w)(?:in|into|on|onto|to|under|be[s]ide|from|with|at|for|behind|near)) .+", re.IGNORECASE)
_NOUNS = re.compile(r"(?:not )?(?:the|a|an|my|your|our|both|all|two|three|one|some)\b", re.IGNORECASE)
_QUALIFIED = re.compile(r"(?:just|only|please|then|better|rather|instead|do) ", re.IGNORECASE)


def corrected(text: str) -> str:
    """Return a request without the part that its speaker took back; the text itself where none is."""
    found = _CORRECTION.fullmatch(text.strip())
    if not found or "\n" in text:
        return text
    first, then = found["first"].strip(), found["then"].strip()
    if _PREPOSITION.match(then):
        return _with_tail(first, then)
    if _NOUNS.match(then):
        last = _LAST.fullmatch(first)
        return f"{last[1]} {then}" if last else f"{first.split(' ', 1)[0]} {then}"
    plain = _QUALIFIED.sub("", then)
    verb = re.split(r"[ ,.!]", plain, maxsplit=1)[0].lower()
    if not is_verb(verb) or (is_noun(verb) and " " not in plain):
        return text
    return f"{_said_of(first)} {then}"


def _with_tail(first: str, then: str) -> str:
    """Return a clause with another place: its own, or the last one, goes."""
    word = then.split(" ", 1)[0].lower()
    at = first.lower().rfind(f" {word} ")
    if at >= 0:
        return f"{first[:at]} {then}"
    last = _LAST.fullmatch(first)
    return f"{last[1].rpartition(' ')[0]} {then}" if last and " " in last[1] else f"{first} {then}"


def _said_of(first: str) -> str:
    """Return a sentence that only names what was spoken of, for the pronouns of the next."""
    return f"There is {first.split(' ', 1)[1]}." if " " in first else ""
