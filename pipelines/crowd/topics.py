"""What words are about: whether a text speaks of the things that its program uses, or of an activity at all."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from importlib.resources import files
from itertools import pairwise
from typing import TYPE_CHECKING

from hearth.pipelines.checks.findings import Finding
from hearth.schemas.failures import Code
from hearth.schemas.program import Program

if TYPE_CHECKING:
    from hearth.kb.knowledge import Knowledge

FILE = "pipelines/crowd/off_topic.yaml"

_COMMON_DEPTH = 3
"""Kinds that have fewer kinds above them (device, artefact) say too little to make two things alike."""

_COMPOUND = 5
"""Letters from which a word counts as part of a longer one: chess, chessboard."""

_TELLING = 2
"""Different phrases of one kind from which a text is taken to be no activity."""


def off_topic(program: Program, known: Knowledge) -> Iterator[Finding]:
    """A text that mentions none of the objects that the program uses, nor anything that tells of them.

    Of them tell: another name, what they are a kind of, a thing of the same kind or one that stands in for them, the
    place where they are usually kept.
    """
    used = {ref.name for step in program.steps for ref in step.objects if not known.is_room(ref.name)}
    if not used or not program.description:
        return
    text = f"{program.title} {program.description}"
    words, things = set(stems(text)), mentioned(text, known)
    if not any(_named(name, words, known) or _told(name, things, known) for name in sorted(used)):
        shown = ", ".join(sorted(used)[:3])
        yield Finding(Code.OFF_TOPIC, -1, f"the text mentions none of the objects used ({shown})", found=shown)


def _named(name: str, words: set[str], known: Knowledge) -> bool:
    names = (*known.same_class(name), *known.ancestors(name)[:2])
    own = {part for each in names for part in stems(each.replace("_", " "))}
    if not own.isdisjoint(words):
        return True
    return any(part.startswith(word) for part in own for word in words if len(word) >= _COMPOUND)


def _told(name: str, things: set[str], known: Knowledge) -> bool:
    kinds = known.ancestors(name)
    for other in things:
        if other in known.stand_ins(name) or name in known.stand_ins(other):
            return True
        if len(kinds) > _COMMON_DEPTH and known.ancestors(other)[:1] == kinds[:1]:
            return True
    return any(place.destination in things and place.relation == "IN" for place in known.placements(name))


def mentioned(text: str, known: Knowledge) -> set[str]:
    """The classes of things, rooms aside, that a text names in one word or two."""
    words = re.findall(r"[a-z]+", text.lower())
    found: set[str] = set()
    for name in (*words, *("_".join(pair) for pair in pairwise(words))):
        thing = known.object_class(name) or known.object_class(name.removesuffix("s"))
        if thing is not None and not known.is_room(thing.name):
            found.add(thing.name)
    return found


def no_activity(text: str) -> tuple[str, list[str]] | None:
    """What a text is instead of a description (advertising, words to whoever gave the task), and what tells so."""
    plain = " ".join(re.findall(r"[a-z0-9%']+|[.:/@]", text.lower()))
    for kind, phrases in _kinds().items():
        told = [match[0] for pattern in phrases if (match := pattern.search(plain))]
        if len(told) >= _TELLING:
            return kind, told
    return None


@cache
def _kinds() -> dict[str, tuple[re.Pattern[str], ...]]:
    import yaml

    data = yaml.safe_load((files("hearth") / FILE).read_text("utf-8"))
    return {
        kind: tuple(re.compile(rf"(?<![a-z])(?:{phrase})(?![a-z])") for phrase in phrases)
        for kind, phrases in data.items()
    }


_ENDINGS = ((re.compile("sses$"), "ss"), (re.compile("(?<=[^s])s$"), ""), (re.compile("(?<=[a-z]{3})(?:ing|ed)$"), ""),
            (re.compile("(?<=[a-z]{3})e$"), ""), (re.compile(r"([bdgmnprt])\1$"), r"\1"))  # fmt: skip


def stem(word: str) -> str:
    """A word without its plural or common verb endings: `dishes` meets `dish`, `plates` `plate`, `reading` `read`."""
    for ending, instead in _ENDINGS:
        word = ending.sub(instead, word)
    return word


def stems(text: str) -> Iterator[str]:
    """The stems of a text's words."""
    return map(stem, re.findall(r"[a-z]+", text.lower()))
