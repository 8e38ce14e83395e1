"""Reading instructions in the wordings of `instruction_wordings.yaml` back as goals."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cache
from typing import NamedTuple

from hearth.challenges.instruction_object_names import EVERY, Nouns, nouns, wordings
from hearth.challenges.instruction_writer import SEPARATOR
from hearth.challenges.paraphrase_reader import read_paraphrase
from hearth.envs.compact_text import IN_SHORT
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal, Joined
from hearth.schemas.literals import AGENT, Literal, Name
from hearth.simulation.world.home import Home

LONGEST = 20_000
"""Characters of an instruction, at most."""

DEEPEST = 20
"""Brackets within one another, at most."""


def read_instruction(text: str, home: Home | Knowledge, doer: str = AGENT, names: frozenset[str] = frozenset()) -> Goal:
    """Return the goal of an instruction (see `instruction_writer.instruction`).

    Args:
        text: in the wordings of the file; after somebody's own words and `In short:`, the rest is read.
        home: a home, or the knowledge, for the names of things.
        doer: the agent of the goal that is asked.
        names: of a challenge; where two names have one noun, these come first.

    Raises:
        HearthError: SYNTAX: no wording fits, or the nearest part that is not understood.

    Examples:
        >>> from hearth.challenges.instruction_reader import read_instruction
        >>> str(read_instruction("Please put two plates on the dining table.", known))
        'ON(plate, dining_table): 2'
    """
    knowledge = home.knowledge if isinstance(home, Home) else home
    reader = _Reader(nouns(knowledge, names), knowledge, doer)
    whole = text.rpartition(IN_SHORT)[2].strip()
    if len(whole) > LONGEST:
        raise HearthError.of(Code.SYNTAX, f"the instruction has {len(whole):,} characters; {LONGEST:,} are read")
    faults: list[HearthError] = []
    for pattern in _frames():
        if match := pattern.fullmatch(whole):
            try:
                return reader.goal(_lowered(match["clauses"]), 0)
            except HearthError as fault:
                faults.append(fault)
    found = read_paraphrase(whole, knowledge, doer, names)
    if found is not None:
        return found
    raise faults[0] if faults else HearthError.of(Code.SYNTAX, "the instruction is empty")


def _lowered(text: str) -> str:
    return text[:1].lower() + text[1:]


@cache
def _frames() -> tuple[re.Pattern[str], ...]:
    """Return the frames as patterns, the longest first."""
    data = wordings()
    found = {frame for pool in data["frames"].values() for kind in pool.values() for frame in kind}
    found |= {frame for pools in data["family_frames"].values() for pool in pools.values() for frame in pool}
    ordered = sorted(found, key=lambda frame: (-len(frame), frame))
    return tuple(re.compile(_pattern(frame), re.IGNORECASE | re.DOTALL) for frame in ordered)


class _Wording(NamedTuple):
    """A wording of a clause: its key, and the pattern of its text."""

    key: str
    pattern: re.Pattern[str]


@cache
def _clauses() -> tuple[_Wording, ...]:
    """Return the wordings of all clauses, the most particular first."""
    data = wordings()["clauses"]
    every = {(t, key) for key, pools in data.items() for pool in pools.values() for kind in pool.values() for t in kind}
    ordered = sorted(every, key=lambda each: (-len(re.sub(r"\{\w+\}", "", each[0])), each))
    return tuple(_Wording(key, re.compile(_pattern(text))) for text, key in ordered)


@cache
def _other() -> Mapping[str, re.Pattern[str]]:
    data = wordings()["other"]
    flat = {name: text for name, text in data.items() if isinstance(text, str)}
    joined = {f"joined {word}": text for word, text in data["joined"].items()}
    return {name: re.compile(_pattern(text), re.DOTALL) for name, text in {**flat, **joined}.items()}


_VARIABLE = r"\w+(?: \(any [\w-]+\))?"

_SLOTS = {
    "variable": _VARIABLE,
    "other": _VARIABLE,
    "ticks": "[0-9]{1,5}",
    "number": "[0-9]{1,5}",
    "are": "is|are",
    "sit": "sit or lie|sit|lie",
    "who": r"anybody|person \w+",
}
"""The patterns of slots that hold less than any text."""


def _pattern(template: str) -> str:
    """Return a template as a regular expression; slots are named groups."""
    pieces = re.split(r"\{(\w+)\}", template)
    filled = (f"(?P<{name}>{_SLOTS.get(name, '.+')})" for name in pieces[1::2])
    return "".join(re.escape(piece) + next(filled, "") for piece in pieces[::2])


def _called(text: str | None) -> tuple[str, str]:
    """Return the variable of a slot, and the class of its things or ""."""
    if not text:
        return "", ""
    name, _, kind = text.partition(" (any ")
    return f"?{name}", kind.removesuffix(")")


class _Reader(NamedTuple):
    nouns: Nouns
    knowledge: Knowledge
    doer: str

    def goal(self, text: str, depth: int) -> Goal:
        """Return the goal of some clauses."""
        if depth > DEEPEST:
            raise HearthError.of(Code.SYNTAX, f"more than {DEEPEST} brackets are within one another")
        found = Goal()
        for piece in _split(text, SEPARATOR):
            found &= self._one(piece, depth)
        return found

    def _one(self, text: str, depth: int) -> Goal:
        other = _other()
        if match := other["fact"].fullmatch(text):
            return Goal((_fact(match["text"]),))
        if match := other["act"].fullmatch(text):
            return Goal.of(self._act(match["act"]))
        if match := other["never"].fullmatch(text):
            return Goal(parts=(Joined("not", (Goal.of(self._act(match["act"])),)),))
        for join in wordings()["other"]["joined"]:
            match = other[f"joined {join}"].fullmatch(text)
            if match and (parts := _bracketed(match["parts"])) is not None:
                slots = match.groupdict()
                (variable, kind), second = _called(slots.get("variable")), _called(slots.get("other"))
                ticks, number = (int(slots.get(name) or 0) for name in ("ticks", "number"))
                goals = tuple(self.goal(part, depth + 1) for part in parts)
                return Goal(parts=(Joined(join, goals, variable, ticks, kind, number, second),))
        return Goal(self._clause(text))

    def _clause(self, text: str) -> tuple[tuple[Literal[Name], int], ...]:
        for key, pattern in _clauses():
            match = pattern.fullmatch(text)
            if match and (found := self._literals(key, match.groupdict())) is not None:
                return found
        raise HearthError.of(
            Code.SYNTAX, f"`{text[:80]}` is not understood", suggestion="as in `put two plates on the table`"
        )

    def _literals(self, key: str, slots: Mapping[str, str]) -> tuple[tuple[Literal[Name], int], ...] | None:
        """Return the literals of a clause; None where its slots do not name things."""
        negated, name, about = _key(key)
        place = self.nouns.place(slots["place"]) if "place" in slots else None
        who = self.nouns.place(slots["who"]) if "who" in slots else self.doer
        listing = slots.get("things") or slots.get("every")
        things = self.nouns.things(listing) if listing else None
        if (listing and things is None) or ("place" in slots and place is None) or who is None:
            return None
        if things is None:
            return ((Literal(name, (who, place), negated), 1),) if place is not None else None
        if any((number == EVERY) != negated for _, number in things) or (
            about == "who" and not str(who).startswith(AGENT)
        ):
            return None
        terms = (_terms(about, who, self.doer if about == "body" else place, thing) for thing, _ in things)
        numbers = (number or 1 for _, number in things)
        return tuple((Literal(name, each, negated), number) for each, number in zip(terms, numbers, strict=True))

    def _act(self, text: str) -> Literal[Name]:
        """Return the action of its paraphrase."""
        for action in self.knowledge.actions.values():
            template = action.template[0].lower() + action.template[1:]
            match = re.fullmatch(re.sub(r"\\\{\d\\\}", "(.+)", re.escape(template)), text)
            terms = [self.nouns.place(words) for words in match.groups()] if match else [None]
            if None not in terms:
                return Literal(action.name, tuple(term for term in terms if term is not None))
        raise HearthError.of(Code.SYNTAX, f"`{text[:80]}` is not an action", suggestion="as in `open the fridge`")


def _terms(about: str, who: Name, place: Name | None, thing: Name) -> tuple[Name, ...]:
    """Return the terms of a clause's literal about one thing."""
    if not about:
        return (thing,)
    return (who, thing) if place is None else (thing, place)


def _key(key: str) -> tuple[bool, str, str]:
    words = key.split(" ")
    negated = words[0] == "not"
    name, *about = words[negated:]
    return negated, name, about[0] if about else ""


def _split(text: str, separator: str) -> Iterator[str]:
    """Yield the pieces of a text between separators that are not in brackets."""
    depth = start = 0
    for place, letter in enumerate(text):
        depth += (letter == "(") - (letter == ")")
        if depth == 0 and text.startswith(separator, place):
            yield text[start:place]
            start = place + len(separator)
    yield text[start:]


def _bracketed(text: str) -> list[str] | None:
    """Return what is in the brackets of a list of bracketed texts; None if it is none."""
    pieces = list(_split(text, ", "))
    return [each[1:-1] for each in pieces] if all(each[:1] == "(" and each[-1:] == ")" for each in pieces) else None


_FACT = re.compile(r"(not )?\[?(\w+)\]?(?:\(([^()]*)\))?(?:: (\d+))?")


def _fact(text: str) -> tuple[Literal[Name], int]:
    """Return a literal as goals print it."""
    match = _FACT.fullmatch(text)
    if match is None:
        raise HearthError.of(Code.SYNTAX, f"`{text[:80]}` is not a literal", suggestion="as in `FACING(agent, fridge)`")
    terms = [each.strip() for each in (match[3] or "").split(",") if each.strip()]
    found = tuple(int(each) if each.isascii() and each.isdigit() else each for each in terms)
    return Literal(match[2], found, bool(match[1])), int(match[4] or 1)
