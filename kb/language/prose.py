"""Prose: the sentences of plain lines, which may run on over lines, without the greetings of letters."""

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from hearth.kb.language.step_like_lines import is_like_step, sentences

_GREETING = re.compile(r"(?:hi|hello|hey|dear|good (?:morning|evening|day))\b[^.!?:]{0,40}[,!]", re.IGNORECASE)
_FAREWELL = re.compile(
    r"(?:(?:cheers|regards|(?:many )?thanks|thank you|love|yours|sincerely|best|(?:best|kind|warm) (?:regards|wishes)"
    r"|bye|see you)\b[^.!?:]{0,30})[,!.]?",
    re.IGNORECASE,
)
_END = re.compile(r"[.!?][\"'”’)]*(?:\s+|$)")
_OPENING = re.compile(
    r"(?:here is|here's|this is|that is) how (?:i|we|you|he|she|the robot)\b[^:.]{0,60}:\s*", re.IGNORECASE
)
_ROBOT = re.compile(
    r"(?:the|a|our|my) (?:robot|agent|person|man|woman|character|user|human|child|boy|girl)\b", re.IGNORECASE
)
_IT = re.compile(
    r"((?:then|next|after that|finally|now|afterwards|first),?\s+)?(?:it|he|she)\s+(?:then\s+)?(?=[a-z])", re.IGNORECASE
)
_NO_VERB = re.compile(r"(?:is|was|has|does|did|can|could|will|would|may|might|should|must)\b", re.IGNORECASE)
_OPEN = re.compile(r"\b(?:the|a|an|and|to|of|in|on|with|my|your|his|her|into|from)$", re.IGNORECASE)
_SHARE = 0.6
_SHORT = 40
"""Characters of a line at most that nothing runs on from."""


class Sentence(NamedTuple):
    """A sentence, and the index of the line that it begins on."""

    row: int
    text: str


def sentences_of(lines: Sequence[tuple[int, str]]) -> list[Sentence]:
    """Return the sentences of lines, each with its index in the text; those that run on are joined.

    A robot or person that was mentioned is `it` in the next sentences: `it` is left out before its verb.
    """
    found: list[Sentence] = []
    is_about = False
    for first, text in _joined(lines):
        for row, part in _parted(first, text):
            found.append(Sentence(row, _IT.sub(r"\1", part, count=1) if is_about and _acts(part) else part))
            is_about = is_about or _ROBOT.search(part) is not None
    return found


def is_greeting(line: str) -> bool:
    """Return whether a line begins or ends a letter."""
    return _GREETING.fullmatch(line) is not None or is_farewell(line)


def is_farewell(line: str) -> bool:
    """Return whether a line ends a letter, as `Cheers,` does."""
    return _FAREWELL.fullmatch(line) is not None


def is_prose(lines: Sequence[tuple[int, str]]) -> bool:
    """Return whether lines are prose: a sentence runs on over two, or two stand on one, and most are of acts."""
    found = sentences_of(lines)
    if all(len(sentences(text)) < 2 for _, text in _joined(lines)):
        return False
    like = sum(is_like_step(each.text) for each in found)
    return like > 1 and like >= _SHARE * len(found)


def _acts(sentence: str) -> bool:
    """Return whether `it` in a sentence does something, and is not something."""
    found = _IT.match(sentence)
    return found is not None and not _NO_VERB.match(sentence, found.end()) and is_like_step(sentence[found.end() :])


def _joined(lines: Sequence[tuple[int, str]]) -> Iterator[tuple[list[int], str]]:
    """Yield the lines without greetings, those that go on as one: the rows of its words, and the text."""
    rows: list[int] = []
    text = ""
    for row, line in lines:
        words = _OPENING.sub("", line, count=1)
        if text and row == rows[-1] + 1 and goes_on(text, words):
            text = f"{text} {words}"
        else:
            if text:
                yield rows, text
            rows, text = [], words
        rows += [row] * len(words.split())
    if text:
        yield rows, text


def goes_on(text: str, following: str) -> bool:
    """Return whether a line goes on in the next: it ends in no mark, and the next begins small."""
    if _OPEN.search(text):
        return following[:1].islower()
    is_open = text[-1:].isalnum() or text.endswith(",")
    return is_open and following[:1].islower() and len(text) > _SHORT and _END.search(f"{text} {following}") is not None


def _parted(rows: list[int], text: str) -> Iterator[tuple[int, str]]:
    at = 0
    for part in sentences(text):
        yield rows[at], part
        at += len(part.split())
