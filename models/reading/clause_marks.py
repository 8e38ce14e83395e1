"""Marks of clauses that writers leave out: the comma behind a clause that says when, and apostrophes."""

from __future__ import annotations

import re
from collections.abc import Iterator

from hearth.kb.language.english_lexicon import verb_lemmas
from hearth.models.reading.request_table import table_words

DESCRIPTION = 25
"""Words from which a text is a description: what is not understood of it is left out, and not refused."""

MOST_COMMAS = 6
"""Places of a comma that are tried."""

_UNMARKED = re.compile(
    r"^((?:when|once|after|before|as soon as|while|if|since|because)"
    r" (?:i|we|you|they|he|she|it|everything|everyone|that|this|the [a-z]+|my [a-z]+|her [a-z]+|his [a-z]+) [^,]+?),?"
    r" ((?:i|we|he|she|you) (?!am\b|are\b|is\b|will\b|have\b|has\b).+)$"
)
"""A sentence whose first clause says when, without a comma behind it: `when I come home I shut the door`."""

_DOING = re.compile(r"^((?:after|before|while|when) [a-z]+ing(?: [^,]{1,40}?)?),? ((?:i|we|he|she|you|they) .+)$")
_DONE = re.compile(
    r"^((?:once|when|after|as soon as) (?:everything|all|this|that|it) is (?:in (?:it's|it is|its"
    r"|their) place|done|finished|ready"
    r"|over|clean|tidy)),? (.+)$"
)
_TOOL = re.compile(r"^(with (?:the|a|an|my|some) [a-z]+(?: [a-z]+)?) (?:i|we|he|she|you) (.+)$")
_THERE_NEEDS = re.compile(r"^there(?: is| are|'s) (.+?) (?:that|which) (needs?|wants?|has to|have to|must|should) ")
_WHERE = re.compile(
    r"^(?:not .+? - )?(.+?) (?:is|are) (?:where (.+?) (?:belongs?|goes|go|should go|lives?)|the"
    r" (?:right )?place for (.+))$"
)
_OFF = re.compile(r"\b((?:turn|switch|put|shut)(?:s|ed|ing)? (?:the |it|that )(?:[a-z]+ ){0,3}?)of(?= again|$|,| and )")
_DONE_WITH = re.compile(
    r"^((?:when|once|after|as soon as) (?:you|you're|your|you are|we|we're|i|i'm) (?:(?:are|am|have|'ve) )?"
    r"(?:done|finished|through) with [a-z ]+?),? ((?:it|they|put|that|this|place|take|bring|wash|throw)\b.+)$"
)
_MAY_I = re.compile(
    r"^(?:please )?(?:can|could|may|might) (?:i|we) (?:please )?have (?!to\b|a (?:look|seat|go|try"
    r"|word)\b|.+ (?:on|in) |.*\b(?:music|light|quiet|fun|lunch|dinner|breakfast))"
)
_FOR_ME = re.compile(r"^((?:please )?(?:put|set|lay|stick|leave|place)) me ")
_COUNTED = re.compile(r"^(.+?),? (?:please,? )?(two|three|four|five|six|both|all)(?: of (?:them|those)| pairs)(, .+)?$")
_ELLIPTICAL = re.compile(r"^(need|want|fancy) (?=my |the |a |an |some )")
_BODY = re.compile(r"\b(your|my) (face|hands?|hair|feet|body)\b(.+?)\b(dry|pat|rub)( off)? (?:it|them)\b")
_SPOT = re.compile(
    r"\b(in|on|at|into|onto|to) the (?:very |right in the )?(?:middle|center|centre|edge|corner|end|foot|head|side"
    r"|left side|right side|back|front|bottom) of (?=the |my |your |our |a |an |this |that )"
)
"""A part of a place: a thing in the middle of a table lies on the table."""

_WHEN = re.compile(r"^(?:after|before|once|when|while|as soon as) ")


def marked(text: str) -> str:
    """Return a sentence in small letters with the comma behind its first clause, where it is certain."""
    text = _OFF.sub(r"\1off", _THERE_NEEDS.sub(r"\1 \2 ", text))
    text = _ELLIPTICAL.sub(r"i \1 ", text)
    text = _DONE_WITH.sub(r"\1, \2", _FOR_ME.sub(r"\1 ", _MAY_I.sub("bring me ", text)))
    if found := _COUNTED.match(text):
        text = f"{_with_number(found[1], found[2])}{found[3] or ''}"
    text = _SPOT.sub(r"\1 ", _BODY.sub(r"\1 \2\3\4\5 \1 \2", text))
    if found := _WHERE.match(text):
        return f"put {found[2] or found[3]} to {found[1]}"
    for pattern in (_UNMARKED, _DOING, _DONE, _TOOL):
        text = pattern.sub(r"\1, \2", text)
    return text


def _with_number(text: str, number: str) -> str:
    """Return a clause with the number that is said behind it: `put two glasses on the table`."""
    first, _, rest = text.partition(" ")
    return f"{first} {number} {rest}" if first in table_words() and first in verb_lemmas(first) else f"{number} {text}"


def with_comma(text: str) -> Iterator[str]:
    """Yield a sentence with a comma before each verb that may begin its main clause: `after eating wash the plate`."""
    if "," in text or not _WHEN.match(text):
        return
    found = text.split()
    places = [at for at in range(2, len(found)) if found[at] in table_words() and found[at] in verb_lemmas(found[at])]
    for at in places[:MOST_COMMAS]:
        yield f"{' '.join(found[:at])}, {' '.join(found[at:])}"
