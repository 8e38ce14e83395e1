"""Marks by which the line above plain steps is their title, and those that leave it open."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.english_lexicon import is_verb
from hearth.kb.language.recognition_knowledge import recognition
from hearth.kb.language.refusals import Refusal

if TYPE_CHECKING:
    from hearth.kb.language.forms.form import Placed

GOES = re.compile(
    r"(?:then |now )?(?:walk|go|head|move|run)s? (?:over |back )?(?:to|into|in|towards?)\b", re.IGNORECASE
)
_GOES_THERE = re.compile(rf"{GOES.pattern} (?:the|my|your|his|her)\b", re.IGNORECASE)
_GERUND = re.compile(r"([a-z]{2,}ing)(?: [\w'’-]+){0,5}[.:]?", re.IGNORECASE)
_NO_GERUND = frozenset(("bring", "ring", "sing", "swing", "cling", "string", "spring", "fling", "sting", "wring"))
_PART = re.compile(
    r"(?:in|at|on|to|from|after|before|with|for|by|when|once|if|first|second|third|then|next|finally|last|step|phase|part"
    r"|section|stage|day|note|now|prep\w*|get\w* ready|finish\w*|start\w*|begin\w*|end|ending|wrap\w*|set ?up"
    r"|clean\w* up|afterwards|later)\b",
    re.IGNORECASE,
)
_POSTURE = re.compile(r"[a-z]+ (?:up|down|off|on|out|around|over|away|back|in)\b", re.IGNORECASE)
"""A step before a walk, `Stand up`, `Put on slippers`."""

_THE = re.compile(r" (?:the|my|your|his|her|a|an) ", re.IGNORECASE)
_WORD = re.compile(r"[a-z]+")
_FEW = 5


def is_gerund(text: str) -> bool:
    """Return whether a line names an activity, `Watching TV`."""
    found = _GERUND.fullmatch(text)
    return found is not None and found[1].lower() not in _NO_GERUND and is_verb(found[1].lower())


def goes_there(text: str, below: Sequence[str]) -> bool:
    """Return whether a line walks to a place, `Walk to the fridge`, from which the lines below it go on."""
    return _GOES_THERE.match(text) is not None and not (below and GOES.match(below[0]))


def is_part(text: str) -> bool:
    """Return whether a line with a colon names a part of a plan, `In the kitchen:`, `Bedroom:`, and not a plan."""
    words = text.rstrip(": ").lower()
    return _PART.match(words) is not None or recognition().is_room(words.removeprefix("the ").replace(" ", "_"))


def doubted(placed: Sequence[Placed], plain: Iterable[int]) -> Iterator[tuple[int, Refusal]]:
    """Yield the first lines of later paragraphs of steps that may be the titles of plans of their own.

    The plan is refused where the first paragraph begins with such a line, too.
    """
    paragraphs = list(_paragraphs(placed, plain))
    first, *others = ([placed[n].line.text for n in part] for part in paragraphs)
    may_first = _may_be_title(first)
    if may_first and not any(map(_may_be_title, others)) and not _moves_things(first[0]):
        yield paragraphs[0][0], _FIRST
    for part, texts in zip(paragraphs[1:], others, strict=True):
        if _may_be_title(texts):
            yield part[0], _TWO if may_first else _ONE


_TWO = Refusal(
    "two plans, or one: this line and the first one may be titles or steps", "write `Task:` before each title"
)
_ONE = Refusal(
    "this may be the title of another plan; it is read as a step", "write `Task:` before a title", is_warning=True
)


def are_titles(first: Sequence[str], second: Sequence[str]) -> bool:
    """Return whether two paragraphs of steps begin with titles, as `Make tea` and `Watch TV`, which move no thing."""
    return all(texts and _may_be_title(texts) and not _moves_things(texts[0]) for texts in (first, second))


def _moves_things(text: str) -> bool:
    return text.split(maxsplit=1)[0].lower() in _moves(recognition())


@lru_cache(maxsize=8)
def _moves(known: Knowledge) -> frozenset[str]:
    """Return the verbs of actions that only bring other actions about: to take, to put, to open, to find."""
    names = known.group("goes") | known.group("takes") | known.group("puts") | known.group("operates")
    said = (words for name in names for words in (known.actions[name].template, *known.actions[name].words))
    return frozenset(words.split()[0].lower() for words in said)


_FIRST = Refusal(
    "this may be the title of the plan; it is read as a step", "write `Task:` before a title", is_warning=True
)


def _paragraphs(placed: Sequence[Placed], plain: Iterable[int]) -> Iterator[list[int]]:
    """Part the indices of lines where a blank line stands."""
    part: list[int] = []
    for n in plain:
        if part and any(not placed[k].line.text for k in range(part[-1] + 1, n)):
            yield part
            part = []
        part.append(n)
    if part:
        yield part


def _may_be_title(texts: Sequence[str]) -> bool:
    """Return whether the first of some lines may be their title: it is short, and they go somewhere."""
    first, *below = texts
    if (
        len(below) < 2
        or len(first.split()) > _FEW
        or _POSTURE.match(first)
        or GOES.match(first)
        or not GOES.match(below[0])
    ):
        return False
    are_marked = sum(_THE.search(line) is not None for line in below) == len(below) and not _THE.search(first)
    words = set(_WORD.findall(first.lower()))
    is_done = any(words <= set(_WORD.findall(line.lower())) for line in below)
    return are_marked or is_done or first.split()[0].lower() == "make"
