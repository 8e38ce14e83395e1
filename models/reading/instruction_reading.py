"""Texts: the acts that a person asks for, in the order in which they are to be done."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.models.reading.clause_reader import Act, Clause, ClauseReader, Spoken, plain_words
from hearth.models.reading.request_table import words
from hearth.models.reading.scene import Scene
from hearth.schemas.literals import Literal, Name
from hearth.simulation.world.world import World

LONGEST = 4_000
"""Characters that are read of a text, at most."""

MOST_PARTS = 14
"""Parts of a sentence, at most; a sentence of more is not read."""

MOST_TRIED = 120
"""Joined parts of a sentence that are tried, at most."""

_SENTENCES = re.compile(r"(?<=[.!?;])\s+|\n+|(?<=[a-z])\. ")
_PARTS = re.compile(r"(,? and then |,? then |;? and also |,? and |,? but |,? plus |[;,:] (?:and )?| - | – |\. )")
_FIRST = re.compile(
    r"(?:after|once|when|as soon as|having) (?:you(?:'ve| have| are|'re)? (?:have )?(?:finished |done )?)?(.+?), (?:then )?(.+)"
)
_LATER = re.compile(r"before (?:you )?(.+?), (.+)")
_AFTER = re.compile(r"(.+?),? (?:after|once|as soon as|but first|but before that) (?:you(?:'ve| have)? |having )?(.+)")
_BEFORE = re.compile(r"(.+?),? before (?:you )?(.+)")
_STATEMENT = re.compile(r"(?:i|we)(?: would|'d| will|'ll)? (?:want|need|like|love|have|wish|expect|ask)(?: for)?(?: you)? to ")
_VERB = re.compile(r"((?:pick up|put down|take out|take off|turn|switch|[a-z]+)) ")


class Reading(NamedTuple):
    """What a text asks for in a home.

    Attributes:
        acts: in order.
        goals: what is to hold at the end besides their effects.
        forbidden: acts that are not to be done.
        unread: parts that are not understood.
        missing: things that were named, and that the home lacks.
    """

    acts: tuple[Act, ...] = ()
    goals: tuple[Literal[Name], ...] = ()
    forbidden: tuple[Act, ...] = ()
    unread: tuple[str, ...] = ()
    missing: tuple[str, ...] = ()


def read_text(text: str, known: Knowledge, world: World | None = None) -> Reading:
    """Return what a text asks for.

    Args:
        text: one or more sentences in English.
        known: the knowledge of the world.
        world: where it is to be done; None where only classes matter.
    """
    reader = _Text(ClauseReader(Scene(known, world)))
    for sentence in _SENTENCES.split(text[:LONGEST].replace("\u2019", "'")):
        plain = " ".join(sentence.lower().split()).strip(" .!?,;:\"")
        if plain:
            reader.sentence(plain)
    return reader.reading()


class _Text:
    """The reading of one text, sentence by sentence."""

    def __init__(self, clauses: ClauseReader) -> None:
        self.clauses = clauses
        self.found: list[Clause] = []
        self.unread: list[str] = []
        self.spoken: tuple[Spoken, ...] = ()
        self.tried = 0

    def sentence(self, text: str) -> None:
        """Read a sentence; what it says of the order of its acts is kept."""
        self.tried = 0
        if (whole := self.clauses.read(text, self.spoken, steps=_PARTS.search(text) is None)) is not None:
            self._add((whole,))
            return
        for first, later in _ordered(text):
            one = self._read(first, self.spoken)
            two = self._read(later, (*_all_spoken(one), *self.spoken)) if one else None
            if one and two:
                self._add((*one, *two))
                return
        found = self._read(text, self.spoken)
        if found is not None:
            self._add(found)
            return
        if parts := _main(text):
            told = self.clauses.told(parts[0])
            if (found := self._read(parts[1], (*told.spoken, *self.spoken))) is not None:
                self._add((told, *found))
                return
        self._in_part(text)

    def _add(self, clauses: Sequence[Clause]) -> None:
        self.found += clauses
        self.spoken = (*_all_spoken(clauses), *self.spoken)[:12]

    def _read(self, text: str, spoken: tuple[Spoken, ...]) -> tuple[Clause, ...] | None:
        """Return the clauses of a text; None where a part of it is not understood."""
        pieces = _PARTS.split(text)
        return self._joined(pieces[::2], pieces[1::2], spoken, "") if len(pieces) < 2 * MOST_PARTS else None

    def _joined(
        self, parts: Sequence[str], joints: Sequence[str], spoken: tuple[Spoken, ...], verb: str
    ) -> tuple[Clause, ...] | None:
        """Return the clauses of parts; the first of as many parts as are read together."""
        if not parts:
            return ()
        for size in range(len(parts), 0, -1):
            self.tried += 1
            if self.tried > MOST_TRIED:
                return None
            clause = _glued(parts[:size], joints)
            read = self._one(clause, spoken, verb)
            if read is None:
                continue
            now = (*_all_spoken((read,)), *spoken)
            rest = self._joined(parts[size:], joints[size:], now, _verb_of(clause) or verb)
            if rest is not None:
                return (read, *rest)
        return None

    def _one(self, text: str, spoken: tuple[Spoken, ...], verb: str) -> Clause | None:
        """Return a clause; one without a verb has that of the clause before, and an aside asks for nothing."""
        read = self.clauses.read(text, spoken, steps=_PARTS.search(text) is None)
        if read is None and verb and not text.startswith(verb):
            read = self.clauses.read(f"{verb} {plain_words(text)}", spoken)
        return self.clauses.told(text) if read is None and is_aside(text) else read

    def _in_part(self, text: str) -> None:
        """Read the parts of a sentence that are understood, and keep the others as they are."""
        pieces = _PARTS.split(text)
        parts, joints = pieces[::2], pieces[1::2]
        at, verb = 0, ""
        while at < len(parts):
            for size in range(min(len(parts) - at, 4), 0, -1):
                clause = _glued(parts[at : at + size], joints[at:])
                read = self._one(clause, self.spoken, verb)
                if read is not None:
                    self._add((read,))
                    verb = _verb_of(clause) or verb
                    break
            else:
                size = 1
                self.unread.append(parts[at].strip())
            at += size

    def reading(self) -> Reading:
        """Return what was read."""
        found = self.found
        return Reading(
            tuple(act for clause in found for act in clause.acts),
            tuple(dict.fromkeys(goal for clause in found for goal in clause.goals)),
            tuple(act for clause in found for act in clause.forbidden),
            tuple(self.unread),
            tuple(self.clauses.missing) if self.unread else (),
        )


def _glued(parts: Sequence[str], joints: Sequence[str]) -> str:
    text = parts[0]
    for joint, part in zip(joints, parts[1:], strict=False):
        text += joint + part
    return text


def _all_spoken(clauses: Sequence[Clause] | None) -> tuple[Spoken, ...]:
    return tuple(each for clause in reversed(clauses or ()) for each in clause.spoken)


def _ordered(text: str) -> list[tuple[str, str]]:
    """Return a sentence with `before` or `after` as what is done first and what is done later."""
    found = []
    if match := _FIRST.fullmatch(text):
        found.append((match[1], match[2]))
    if match := _LATER.fullmatch(text):
        found.append((match[2], match[1]))
    if match := _AFTER.fullmatch(text):
        found.append((match[2], match[1]))
    if match := _BEFORE.fullmatch(text):
        found.append((match[1], match[2]))
    return found


_SUBORDINATE = re.compile(
    r"(?:after|once|when|before|as soon as|if|while|since|because|as|whenever|in case|now that|to|in order to|for|at|in) "
    r"(.+?), (.+)"
)


def _main(text: str) -> tuple[str, str] | None:
    """Return the clause of a sentence that says when or why, and what stands behind its comma; None without one."""
    found = _SUBORDINATE.fullmatch(text)
    return (found[1], found[2]) if found else None


def is_aside(text: str) -> bool:
    """Return whether a clause asks for nothing."""
    if _PARTS.search(text) or _STATEMENT.match(text):
        return False
    return words().asides.fullmatch(text) is not None


def _verb_of(text: str) -> str:
    found = _VERB.match(plain_words(text))
    return found[1] if found else ""
