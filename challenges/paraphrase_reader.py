"""Goals as people say them, read by the patterns of `paraphrases.yaml`; what is not understood whole is refused."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import cache
from typing import NamedTuple

from hearth.challenges.instruction_object_names import EVERY, NUMBERS, Counted
from hearth.challenges.paraphrase_things import UNSAID, Known, known_nouns, patterns, place, things
from hearth.challenges.request_reader import read_request
from hearth.kb.knowledge import Knowledge
from hearth.schemas.goals import Goal, Joined
from hearth.schemas.literals import HOLDS, Literal, Name

LONGEST = 800
"""Characters of a paraphrase, at most: each separator may be one between clauses or one between things."""

MOST_TRIED = 4_000
"""Pieces of a text that are tried as clauses, at most."""

_SENTENCES = re.compile(r"[.!?;]+(?:\s+|$)")
_SEPARATORS = re.compile(r",? and then |, then |,? and |,? but |, so |, |: | while (?=never|not )| without ")
_SOME = re.compile(r"(?:^|, |and |or )(?:a|an|another|some|one) ")
_ON = re.compile(r"\b(?:on|onto|upon|top|over(?! to))\b")

_OFF = frozenset({"off", "off_it", "off_too", "neither"})
_PLACING = frozenset({"put", "put_it", "bare", "fill", "lay"})

Counts = tuple[tuple[Literal[Name], int], ...]


class Clause(NamedTuple):
    """A clause as it is understood.

    Attributes:
        kind: of the patterns.
        counts: literals of the goal.
        parts: other parts of the goal.
        named: things that the next clause may call `it`.
        waits: whether it only names things, should the next clause say more of `it`.
    """

    kind: str
    counts: Counts = ()
    parts: tuple[Joined, ...] = ()
    named: Counted = ()
    waits: bool = False


Clauses = tuple[Clause, ...]


def read_paraphrase(text: str, knowledge: Knowledge, doer: str, names: frozenset[str] = frozenset()) -> Goal | None:
    """Return the goal of an instruction in a person's words; None where some of it is not understood."""
    if len(text) > LONGEST:
        return None
    text = text.lower().replace("\u2019", "'")
    reader = _Paraphrase(known_nouns(knowledge, names), knowledge, doer)
    return reader.goal(text) or read_request(text, reader.known, knowledge, doer, reader.relation)


def _joined(clauses: list[Clause]) -> Goal | None:
    """Return the goal of clauses; None where nothing is asked, or something named is left open."""
    goal = Goal()
    if any(clause.kind == "mention" for clause in clauses):
        return None
    for clause in clauses:
        if {literal for literal, _ in clause.counts} & {literal for literal, _ in goal}:
            return None
        goal &= Goal(clause.counts, clause.parts)
    return goal if goal.counts or goal.parts else None


@cache
def _patterns() -> tuple[tuple[str, re.Pattern[str]], ...]:
    data = patterns()
    slots = {**data["slots"], **data["verbs"]}
    named = {name: f"(?P<{name}>.+?)" for name in ("things", "place", "lamp")} | {"prep": f"(?P<prep>{slots['prep']})"}
    found = []
    for kind, texts in data["clauses"].items():
        for text in texts:
            filled = re.sub(r"\{(\w+)\}", lambda slot: named.get(slot[1]) or slots[slot[1]], text)
            found.append((str(kind), re.compile(filled)))
    return tuple(found)


@cache
def _trimmed() -> tuple[re.Pattern[str], re.Pattern[str], re.Pattern[str]]:
    data = patterns()
    courtesy, openings, endings = ("|".join(data[name]) for name in ("courtesy", "openings", "endings"))
    return (
        re.compile(rf"\b(?:{courtesy})\b"),
        re.compile(rf"^(?:(?:{openings})\b,? ?)+"),
        re.compile(rf",? (?:{endings})$"),
    )


@cache
def _asks() -> re.Pattern[str]:
    """Return a pattern of the words with which something is asked."""
    verbs = "|".join(patterns()["verbs"].values())
    return re.compile(rf"\b(?:{verbs}|turn|switch|open|opening|never|not|don't|without|no|off|on|out|it|them)\b(?!')")


@cache
def _tells() -> re.Pattern[str]:
    """Return a pattern of the beginnings of sentences that tell something."""
    return re.compile(rf"{patterns()['asides_begin']}\b")


def _plain(text: str) -> str:
    """Return a clause without courtesy, without openings such as `could you`, and without the reason at its end."""
    courtesy, openings, endings = _trimmed()
    text = re.sub(r"(?: ?,)+", ",", " ".join(courtesy.sub(" ", text).split()))
    return endings.sub("", openings.sub("", text.strip(" ,:"))).strip(" ,:")


class _Paraphrase:
    """The reading of one text."""

    def __init__(self, known: Known, knowledge: Knowledge, doer: str) -> None:
        self.known, self.knowledge, self.doer = known, knowledge, doer
        self.people, self.tried = 1, 0

    def goal(self, text: str) -> Goal | None:
        """Return the goal of a text in lower case; None where some of it is not understood."""
        clauses: list[Clause] = []
        for sentence in _SENTENCES.split(text):
            if not sentence.strip():
                continue
            found = self.clauses(" ".join(sentence.split()), tuple(clauses))
            if found is None:
                return None
            clauses = list(found)
        return _joined(clauses)

    def clauses(self, text: str, before: Clauses) -> Clauses | None:
        """Return the clauses before and those of a text; the fewest that leave no word over, or None."""
        text = _plain(text)
        if not text:
            return before
        self.tried += 1
        if self.tried > MOST_TRIED:
            return None
        if (whole := self._one(text, before)) is not None:
            return whole
        for match in _SEPARATORS.finditer(text):
            left, right = text[: match.start()], text[match.end() :]
            if match[0] == " without ":
                right = f"without {right}"
            first = self._one(_plain(left), before)
            if first is not None and (rest := self.clauses(right, first)) is not None:
                return rest
        return None

    def _one(self, text: str, before: Clauses) -> Clauses | None:
        """Return the clauses before and this one; None where no pattern fits."""
        if people := re.fullmatch(patterns()["people"], text):
            self.people = NUMBERS.index(people["people"])
            return before
        if self._is_aside(text):
            return before
        for kind, pattern in _patterns():
            match = pattern.fullmatch(text)
            if match and (found := self._read(kind, match, before)) is not None:
                return found
        return None

    def _is_aside(self, text: str) -> bool:
        """Return whether a text tells why: it names no thing and asks for nothing."""
        if any(re.fullmatch(aside, text) for aside in patterns()["asides"]):
            return True
        words = re.findall(r"[a-z']+", text)
        pairs = [" ".join(words[i : i + n]) for n in (1, 2, 3) for i in range(len(words) - n + 1)]
        named = any(each in self.known.one or each in self.known.many for each in pairs)
        return bool(_tells().match(text)) and not named and not _asks().search(text)

    def _read(self, kind: str, match: re.Match[str], before: Clauses) -> Clauses | None:
        slots = match.groupdict()
        people = NUMBERS.index(slots["people"]) if slots.get("people") else self.people
        some = things(slots["things"], self.known, people) if "things" in slots else ()
        at = place(slots["place"], self.known) if "place" in slots else ""
        if some is None or at is None:
            return None
        if kind not in _OFF and re.search(r"\b(?:or|nor)\b", slots.get("things") or ""):
            return None  # one of two things is another goal
        if kind not in _OFF and any(number in (UNSAID, EVERY) for _, number in some):
            return None
        return _READERS[kind](self, _Said(kind, some, at, slots, before))

    def relation(self, prep: str, at: str) -> str | None:
        """Return the relation of a preposition; `to` means the one that the place has, where it has one alone.

        None means that nothing is put there: `a cup in your hands` is held.
        """
        kind = self.knowledge.object_class(at)
        if kind is not None and "BODY_PART" in kind.properties:
            return None
        if _ON.search(prep):
            return "ON"
        if prep.rpartition(" ")[2] != "to":
            return "INSIDE"
        relations = {each.relation for each in self.knowledge.holds(at) if each.relation != "NEARBY"}
        return None if len(relations) != 1 else "ON" if relations == {"ON"} else "INSIDE"

    def held(self, some: Counted) -> Counts:
        """Return that the agent holds some things."""
        return tuple((Literal.of(HOLDS, self.doer, name), number) for name, number in some)

    def lamp(self, said: _Said) -> Counts | None:
        """Return that the lamp of a clause is on."""
        some = things(said.slots["lamp"] or "", self.known)
        return None if some is None or len(some) != 1 or some[0][1] != 1 else ((Literal.of("ON", some[0][0]), 1),)

    def never(self, at: str) -> Joined:
        """Return that something is never opened."""
        return Joined("not", (Goal.of(Literal.of(self.knowledge.achiever("OPEN"), at)),))


class _Said(NamedTuple):
    """A clause whose slots name things."""

    kind: str
    things: Counted
    place: str
    slots: Mapping[str, str | None]
    before: Clauses

    def then(self, counts: Counts = (), parts: tuple[Joined, ...] = (), *, waits: bool = False) -> Clauses:
        """Return the clauses before and this one."""
        return (*self.before, Clause(self.kind, counts, parts, self.things, waits))

    def at(self, relation: str | None) -> Clauses | None:
        """Return the clauses before and that the things are at the place."""
        if relation is None:
            return None
        return self.then(tuple((Literal.of(relation, name, self.place), number) for name, number in self.things))

    def antecedent(self) -> tuple[Clauses, Counted] | None:
        """Return what `it` stands for, and the clauses before without the one that only named it."""
        if not self.before or not self.before[-1].named:
            return None
        last = self.before[-1]
        return (self.before[:-1] if last.waits else self.before), last.named


def _put(reader: _Paraphrase, said: _Said) -> Clauses | None:
    return said.at(reader.relation(said.slots["prep"] or "", said.place))


def _put_it(reader: _Paraphrase, said: _Said) -> Clauses | None:
    found = said.antecedent()
    if found is None or not said.before[-1].waits:
        return None
    return _put(reader, said._replace(before=found[0], things=found[1]))


def _bare(reader: _Paraphrase, said: _Said) -> Clauses | None:
    """Return a clause without a verb: the first, or one after another that says where things go."""
    follows = not said.before or said.before[-1].kind in _PLACING
    return _put(reader, said) if follows else None


def _there(reader: _Paraphrase, said: _Said) -> Clauses | None:
    return said.before if said.before and said.before[-1].kind in _PLACING else None


def _get_it(reader: _Paraphrase, said: _Said) -> Clauses | None:
    found = said.antecedent()
    if found is not None and said.before[-1].kind == "get":  # says it again
        return said.before
    if found is None or said.before[-1].kind not in ("mention", "seek"):
        return None
    return said._replace(before=found[0], things=found[1], kind="get").then(reader.held(found[1]))


def _look(reader: _Paraphrase, said: _Said) -> Clauses | None:
    lamp = reader.lamp(said)
    return None if lamp is None else said.then((*reader.held(said.things), *lamp))


def _look_it(reader: _Paraphrase, said: _Said) -> Clauses | None:
    lit = bool(said.before) and said.before[-1].kind == "on"
    return said.then(reader.held(said.things)) if lit else None


def _off(reader: _Paraphrase, said: _Said) -> Clauses | None:
    """Return that none of some things is to be on; a number of them is said in no such clause."""
    if any(number > 1 for _, number in said.things) or _SOME.search(said.slots.get("things") or ""):
        return None
    return said.then(tuple((Literal("ON", (name,), True), 1) for name, _ in said.things))


def _off_it(reader: _Paraphrase, said: _Said) -> Clauses | None:
    found = said.antecedent()
    if found is None or not said.before[-1].waits:
        return None
    return _off(reader, said._replace(before=found[0], things=found[1]))


_READERS: dict[str, Callable[[_Paraphrase, _Said], Clauses | None]] = {
    "put": _put,
    "put_it": _put_it,
    "bare": _bare,
    "there": _there,
    "fill": lambda reader, said: said.at("INSIDE"),
    "lay": lambda reader, said: said.at("ON"),
    "get": lambda reader, said: said.then(reader.held(said.things)),
    "seek": lambda reader, said: said.then(reader.held(said.things), waits=True),
    "get_it": _get_it,
    "mention": lambda reader, said: said.then(waits=True),
    "look": _look,
    "look_it": _look_it,
    "on": lambda reader, said: said.then(tuple((Literal.of("ON", name), number) for name, number in said.things)),
    "off": _off,
    "off_it": _off_it,
    "off_too": lambda reader, said: _off(reader, said) if said.before and said.before[-1].kind in _OFF else None,
    "neither": _off,
    "never": lambda reader, said: said.then(parts=(reader.never(said.place),)),
}
"""The reading of each kind of pattern."""
