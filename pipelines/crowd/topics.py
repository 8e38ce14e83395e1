"""Topics: whether a text mentions the objects that its program uses, and whether it describes an activity."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING

from hearth.pipelines.checks.findings import Finding
from hearth.schemas.failures import Code
from hearth.schemas.program import Program
from hearth.schemas.yaml_limits import packaged

if TYPE_CHECKING:
    from hearth.kb.knowledge import Knowledge

FILE = "pipelines/crowd/off_topic.yaml"

_COMMON_DEPTH = 3
"""Kinds with fewer kinds above them (device, artefact) are too general to relate two things."""

_COMPOUND = 5
"""Letters from which a word matches the beginning of a longer one: chess, chessboard."""

_ENOUGH = 2
"""Different phrases of one kind from which a text is not a description of an activity."""


def off_topic(program: Program, known: Knowledge) -> Iterator[Finding]:
    """Yield a text that mentions none of the objects that the program uses, nor anything related to them.

    Related are: another name, a kind of the object, an object of the same kind, a stand-in, and its usual container.
    """
    used = {ref.name for step in program.steps for ref in step.objects if not known.is_room(ref.name)}
    if not used or not program.description:
        return
    text = f"{program.title} {program.description}"
    words, things = set(stems(text)), mentioned(text, known)
    if not any(_named(name, words, known) or _related(name, things, known) for name in sorted(used)):
        shown = ", ".join(sorted(used)[:3])
        yield Finding(Code.OFF_TOPIC, -1, f"the text mentions none of the objects used ({shown})", found=shown)


def _named(name: str, words: set[str], known: Knowledge) -> bool:
    names = (*known.same_class(name), *known.ancestors(name)[:2])
    own = {part for each in names for part in stems(each.replace("_", " "))}
    if not own.isdisjoint(words):
        return True
    return any(part.startswith(word) for part in own for word in words if len(word) >= _COMPOUND)


def _related(name: str, things: set[str], known: Knowledge) -> bool:
    kinds = known.ancestors(name)
    for other in things:
        if other in known.stand_ins(name) or name in known.stand_ins(other):
            return True
        if len(kinds) > _COMMON_DEPTH and known.ancestors(other)[:1] == kinds[:1]:
            return True
    return any(place.destination in things and place.relation == "IN" for place in known.placements(name))


def mentioned(text: str, known: Knowledge) -> set[str]:
    """Return the classes, without rooms, that a text names in one or two words."""
    words = re.findall(r"[a-z]+", text.lower())
    found: set[str] = set()
    for name in (*words, *("_".join(pair) for pair in pairwise(words))):
        thing = known.object_class(name) or known.object_class(name.removesuffix("s"))
        if thing is not None and not known.is_room(thing.name):
            found.add(thing.name)
    return found


def no_activity(text: str) -> tuple[str, list[str]] | None:
    """Return the kind of a text that is not a description (advertising, a message to the requester), and its
    phrases.
    """
    plain = " ".join(re.findall(r"[a-z0-9%']+|[.:/@]", text.lower()))
    for kind, phrases in _kinds().items():
        matches = [match[0] for pattern in phrases if (match := pattern.search(plain))]
        if len(matches) >= _ENOUGH:
            return kind, matches
    return None


@cache
def _kinds() -> dict[str, tuple[re.Pattern[str], ...]]:
    data = packaged("hearth", FILE)
    return {
        kind: tuple(re.compile(rf"(?<![a-z])(?:{phrase})(?![a-z])") for phrase in phrases)
        for kind, phrases in data.items()
    }


_ENDINGS = ((re.compile("sses$"), "ss"), (re.compile("(?<=[^s])s$"), ""), (re.compile("(?<=[a-z]{3})(?:ing|ed)$"), ""),
            (re.compile("(?<=[a-z]{3})e$"), ""), (re.compile(r"([bdgmnprt])\1$"), r"\1"))  # fmt: skip


def stem(word: str) -> str:
    """Return a word without its plural or common verb endings: `dish` for `dishes`, `read` for `reading`."""
    for ending, instead in _ENDINGS:
        word = ending.sub(instead, word)
    return word


def stems(text: str) -> Iterator[str]:
    """Yield the stems of a text's words."""
    return map(stem, re.findall(r"[a-z]+", text.lower()))
