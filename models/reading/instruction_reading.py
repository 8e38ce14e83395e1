"""Texts: the acts that a person asks for, in the order in which they are to be done."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.models.reading.clause_marks import DESCRIPTION, marked, with_comma
from hearth.models.reading.clause_matches import plain_words
from hearth.models.reading.clause_reader import MOST_WORDS, ClauseReader, unknown_ban
from hearth.models.reading.hinted_requests import hinted_request
from hearth.models.reading.mentioned_nodes import Scene
from hearth.models.reading.mentions import is_adjective, mentions_in
from hearth.models.reading.misspelled_words import spelled
from hearth.models.reading.rewordings import done_first, orders
from hearth.models.reading.sentence_parts import BAN, PARTS, STATEMENT, is_aside, main_clause
from hearth.models.reading.shorthand import written_out
from hearth.models.reading.spoken_corrections import corrected
from hearth.models.reading.spoken_things import Act, Clause, Spoken
from hearth.models.reading.telegrams import is_unused, names_furniture, request_of
from hearth.schemas.literals import Literal, Name
from hearth.simulation.world.world import World

LONGEST = 4_000
"""Characters that are read of a text, at most; how many words follow is said."""

MOST_PARTS = 14
"""Parts of a sentence, at most; a sentence of more is not read."""

MOST_TRIED = 120
"""Joined parts of a sentence that are tried, at most."""

SUMMED_UP = 3
"""Sentences from which the first may sum up the others."""

_SENTENCES = re.compile(r"\.\.+\s*|…\s*|(?<=[.!?;])\s+|\n+|(?<=[a-z])\. ")
_ALTERNATIVE = re.compile(
    r"(?:or(?: else| maybe| at least| perhaps| rather)?|failing that|if (?:you|there|that|not|it).*|otherwise"
    r"|say|preferably|ideally"
    r"|if need be)\b(?: .*)?"
)
_CHOICE = re.compile(
    r",? or,? (?:else|failing that|otherwise|if (?:there is none|need be)|maybe|perhaps),? (?:on |in |at )?"
    r"|[,;] (?:if (?:you can't find one|there is none|there isn't one|not)|failing that|otherwise),? (?:on |in "
    r"|at )?(?=the |a |an )",
    re.IGNORECASE,
)
_CONTINUED = re.compile(r"(?:\.\.+|…) ?((?:or|and|but|then) )")
_CONTRACTED = re.compile(
    r"\b(here|where|there|what|that|it|he|she|[a-z]+(?=['’]s (?:still |not |all |really |too |so )?(?:open"
    r"|closed|shut|on|off|running|dirty|empty|full|filthy|dusty|coming|where|the place|that|all|so|in"
    r" the|at the|over there|getting|ringing"
    r"|clean|cold|hot|dark|standing|lying)\b))['’]s\b"
)
_PERFECT = re.compile(r"(?:i|we)(?:'ve| have) (?:already |just )?[a-z]+(?:ed|en|ne|ght|ut)\b")
"""The beginning of a statement about the past: `I have taken the letter out`."""

_SUMMARY = re.compile(
    r"(?:washing|doing|making|cooking|cleaning|brushing|setting|getting|preparing|watching|reading|taking|tidying) "
)
"""The beginning of a description that says what it describes."""

_DRESSING = re.compile(r"(?:get |be )?(?:dress|dressed|wear)\b")
_TELEGRAM = re.compile(r"(?P<things>[^,]+), (?:then )?(?P<place>[^,]+?)(?:, (?:go|quick|now|please))?")
_OWN_WISH = re.compile(r"(?:i|we)(?: would|'d|'ll| will)? (?:want|need|like|love|hope|plan|have) to ")
"""The beginning of a wish of the speaker: it asks for nothing where another part asks for something."""

_BEGINNING = re.compile(r"[a-z]+(?: (?:on|into|in|off|up|out|down|away)\b)?")
_NEITHER = re.compile(r"neither (.+?) nor (.+?) (should|must|may|can|has to|needs to) be ")
_TITLE = re.compile(r"(?P<title>[^:]{3,60}): (?P<rest>.+)")
_OBSERVED = re.compile(r"(?:i|we|you|one) (?:can |could )?(?:see|saw|hear|heard|notice|noticed|smell) (?!to\b)")
_SITUATION = re.compile(r"(?:it is|it's|i am|i'm|i can't|i cannot|we are|we're)\b")
"""The beginning of a sentence that may ask for something where it stands alone, as `it is dark in here` does."""
_VERB = re.compile(r"((?:pick up|put down|take out|take off|(?:turn|switch) (?:on|off)|turn|switch|[a-z]+)) ")
_SWITCHED = re.compile(r"(?:turn|switch) (?!on |off ).+ (on|off)")


_MY_PLAN = re.compile(
    r"(?:i|we)(?:'ll| will| am going to| are going to|'m going to|'re going to|'m about to|'re about to) "
    r"|let's (?:eat|go|start|begin|get going|get started)$"
)
_NOT_WITHOUT = re.compile(r"(?:do not|don't|never) .+ (?:without|until|before) ")


class Reading(NamedTuple):
    """The acts that a text asks for in a home.

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
    reader = _Text(ClauseReader(Scene(known, world)), is_long=len(text.split()) > DESCRIPTION)
    whole = _CHOICE.sub(" or ", _CONTINUED.sub(r" \1", written_out(text[:LONGEST])))
    for sentence in _SENTENCES.split(corrected(whole)):
        plain = spelled(known, _CONTRACTED.sub(r"\1 is", " ".join(sentence.lower().split()).strip(' .!?,;:"')))
        if plain:
            reader.sentence(marked(_NEITHER.sub(r"\1 and \2 \3 not be ", plain)))
    is_idle = not reader.unread and not any(clause.acts or clause.forbidden for clause in reader.found)
    wish = STATEMENT.match(whole.lower().strip())
    if is_idle and wish:
        reader.sentence(whole.lower().strip(" .!?")[wish.end() :])  # `I want to hear some music`
    if reader.found and not reader.unread and not any(clause.acts for clause in reader.found) and reader.named:
        reader.sentence(f"bring me {reader.named}")  # `my glasses, please`
    is_nothing = not any(clause.acts or clause.forbidden for clause in reader.found)
    if is_nothing and not wish and (hint := hinted_request(whole)):
        reader = _Text(ClauseReader(Scene(known, world)), is_long=False)
        reader.sentence(hint)  # `I'm thirsty`
    left = len(text[LONGEST:].split())
    reading = reader.reading()
    return reading._replace(unread=(*reading.unread, f"{left:,} more words")) if left else reading


class _Text:
    """The reading of one text, sentence by sentence."""

    def __init__(self, clauses: ClauseReader, *, is_long: bool) -> None:
        self.clauses, self.is_long = clauses, is_long
        self.found: list[Clause] = []
        self.unread: list[str] = []
        self.spoken: tuple[Spoken, ...] = ()
        self.tried = 0
        self.sentences = 0
        self.first = 0
        self.named = ""

    def sentence(self, text: str) -> None:
        """Read a sentence; what it says of the order of its acts is kept."""
        self.tried = 0
        self.sentences += 1
        if self.is_long and self.sentences == 1 and _SUMMARY.match(text):
            self._add((self.clauses.stated(text),))  # `washing the dishes by hand, which I like`
        else:
            self._sentence(text)
        if self.sentences == 1:
            self.first = len(self.found)

    def _sentence(self, text: str) -> None:
        is_one = PARTS.search(text) is None
        if is_one and len(text.split()) > MOST_WORDS:
            self.unread.append(text)
            return
        for read in (self._in_order, self._titled, self._whole, self._read, self._subordinate):
            found = read(text, self.spoken)
            if found is not None:
                self._add(found)
                return
        if (short := _TELEGRAM.fullmatch(text)) and self._is_furniture(short["place"]):
            found = self._put_in(short["place"], short["things"], self.spoken)  # `three books, coffee table`
            if found is not None:
                self._add(found)
                return
        for commas in with_comma(text):
            found = self._in_order(commas, self.spoken) or self._subordinate(commas, self.spoken)
            if found is not None and any(each.acts for each in found):
                self._add(found)
                return
        self._in_part(text)

    def _whole(self, text: str, spoken: tuple[Spoken, ...]) -> tuple[Clause, ...] | None:
        if _OBSERVED.match(text):
            return None
        found = self.clauses.read(text, spoken, steps=PARTS.search(text) is None)
        return (found,) if found else None

    def _in_order(self, text: str, spoken: tuple[Spoken, ...]) -> tuple[Clause, ...] | None:
        """Return the clauses of a sentence with `before` or `after`; what is said first may be what a pronoun means."""
        for first, later in orders(text):
            main = self._read(later, spoken)
            known = (*_all_spoken(main), *spoken)
            texts = (first, f"make sure {first}", done_first(self.clauses.known, first))
            ways = (self._read(each, known) for each in texts if each)
            one = next((each for each in ways if each and any(clause.acts for clause in each)), None)
            two = self._read(later, (*_all_spoken(one), *known)) if one else None
            if one and two and any(each.acts for each in two):
                return (*one, *two)
        return None

    def _titled(self, text: str, spoken: tuple[Spoken, ...]) -> tuple[Clause, ...] | None:
        """Return the clauses behind a title, as in `movie night: close the curtains`."""
        found = _TITLE.fullmatch(text)
        if not found:
            return None
        stated = self.clauses.named(found["title"]) or self.clauses.stated(found["title"])
        read = self._read(found["rest"], (*stated.spoken, *spoken))
        if read and not any(each.acts for each in read):  # `get dressed: pants and a shirt`
            is_named = self.clauses.named(found["title"]) and not self._is_furniture(found["title"])
            if is_named and self._is_furniture(found["rest"]):
                return self._put_in(found["rest"], found["title"], spoken)  # `towel: rack`
            if (placed := self._put_in(found["title"], found["rest"], spoken)) is not None:
                return placed
            start = _BEGINNING.match(found["title"])
            if _DRESSING.match(found["title"]):
                return self._read(f"put on {found['rest']}", spoken)
            alone = self._read(found["title"], spoken)
            is_read = alone is not None and any(each.acts for each in alone)
            return alone if is_read or not start else self._read(f"{start[0]} {found['rest']}", spoken)
        return (stated, *read) if read else None

    def _is_furniture(self, text: str) -> bool:
        """Return whether words name furniture alone."""
        mentions = mentions_in(self.clauses.known, plain_words(text))
        names = [name for each in mentions for name in each.classes[:1]]
        return bool(names) and not any(self.clauses.known.has(name, "GRABBABLE") for name in names)

    def _put_in(self, title: str, rest: str, spoken: tuple[Spoken, ...]) -> tuple[Clause, ...] | None:
        """Return the clauses of things behind the name of their place: `cupboard: one plate, one bowl`."""
        things = re.sub(r", (?=[^,]+$)", " and ", rest)
        ways = (self._read(f"put {things} {word} {title}", spoken) for word in ("in", "on"))
        return next((each for each in ways if each and any(clause.acts for clause in each)), None)

    def _subordinate(self, text: str, spoken: tuple[Spoken, ...]) -> tuple[Clause, ...] | None:
        """Return the clauses of a sentence without that before its comma that says when or why."""
        parts = main_clause(text)
        if not parts:
            return None
        stated = self.clauses.stated(parts[0])
        read = self._read(parts[1], (*stated.spoken, *spoken))
        return (stated, *read) if read else None

    def _add(self, clauses: Sequence[Clause]) -> None:
        clauses = clauses if self.is_long else self._telegraphed(clauses)
        self.found += clauses
        self.spoken = (*_all_spoken(clauses), *self.spoken)[:12]

    def _telegraphed(self, clauses: Sequence[Clause]) -> list[Clause]:
        """Return clauses with the acts that bare names among them stand for."""
        found, known = list(clauses), self.clauses.known
        if len(found) < 2:
            return found
        for at, clause in enumerate(found):
            is_put_next = at + 1 < len(found) and names_furniture(known, found[at + 1])
            if is_unused(clause, found) and not (is_put_next and not names_furniture(known, clause)):
                before = (*_all_spoken(found[:at]), *self.spoken)
                request = request_of(known, clause, before)
                read = self.clauses.read(request, before, steps=False) if request else None
                found[at] = read or clause
        return found

    def _read(self, text: str, spoken: tuple[Spoken, ...]) -> tuple[Clause, ...] | None:
        """Return the clauses of a text; None where a part of it is not understood."""
        pieces = PARTS.split(text)
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
            read = self._one(clause, spoken, verb, is_all=size == len(parts) and not verb)
            if read is None:
                continue
            now = (*_all_spoken((read,)), *spoken)
            rest = self._joined(parts[size:], joints[size:], now, (read.acts and _verb_of(clause)) or verb)
            if rest is not None:
                return (read, *rest)
        return None

    def _one(self, text: str, spoken: tuple[Spoken, ...], verb: str, *, is_all: bool = False) -> Clause | None:
        """Return a clause; one without a verb has that of the clause before, and an aside asks for nothing."""
        is_single = PARTS.search(text) is None
        is_statement = (
            _OBSERVED.match(text)
            or (not is_all and not self.is_long and (_PERFECT.match(text) or _MY_PLAN.match(text)))
            or (not is_all and _SITUATION.match(text) and is_aside(text))
        )
        if is_single and is_statement:
            return self.clauses.stated(text)
        read = self.clauses.read(text, spoken, steps=is_single)
        if read is not None:
            return read
        if verb and not text.startswith(verb) and not is_aside(text):
            read = self.clauses.read(f"{verb} {plain_words(text)}", spoken, steps=False)
        if read is None and is_single:
            read = self._ordered(text, spoken) or self._stated(text, spoken)
        return read

    def _ordered(self, text: str, spoken: tuple[Spoken, ...]) -> Clause | None:
        """Return a part of a sentence that says an order, as `don't go out without a hat` does, as one clause."""
        if not _NOT_WITHOUT.match(text):
            return None
        found = self._in_order(text, spoken)
        return Clause(tuple(act for each in found for act in each.acts), spoken=_all_spoken(found)) if found else None

    def _stated(self, text: str, spoken: tuple[Spoken, ...]) -> Clause | None:
        """Return a part of a sentence that asks for nothing, with the things that it speaks of."""
        if is_aside(text) or (spoken and _ALTERNATIVE.fullmatch(text)):
            if BAN.match(text):
                return Clause(forbidden=unknown_ban(text))
            return self.clauses.stated(text)
        if (named := self.clauses.named(text)) is not None and not self.named:
            self.named = plain_words(text)
        if named is None and re.fullmatch(r"[a-z]+", text) and is_adjective(text):
            return Clause()
        return named

    def _in_part(self, text: str) -> None:
        """Read the parts of a sentence that are understood, and keep the others as they are."""
        pieces = PARTS.split(text)
        parts, joints = pieces[::2], pieces[1::2]
        at, verb = 0, ""
        while at < len(parts):
            for size in range(min(len(parts) - at, 4), 0, -1):
                clause = _glued(parts[at : at + size], joints[at:])
                read = self._one(clause, self.spoken, verb)
                if read is not None:
                    self._add((read,))
                    verb = (read.acts and _verb_of(clause)) or verb
                    break
            else:
                size = 1
                self.unread.append(parts[at].strip())
            at += size

    def reading(self) -> Reading:
        """Return the acts that were read, without those of a first sentence that the others say in more words."""
        found = self.found
        first = {(act.action, act.objects) for clause in found[: self.first] for act in clause.acts}
        later = {(act.action, act.objects) for clause in found[self.first :] for act in clause.acts if act.objects}
        found = found[self.first :] if first & later and self.sentences >= SUMMED_UP else found
        has_acts = any(clause.acts for clause in found)
        unread = tuple(each for each in self.unread if not (has_acts and _OWN_WISH.match(each)))
        return Reading(
            tuple(act for clause in found for act in clause.acts),
            tuple(dict.fromkeys(goal for clause in found for goal in clause.goals)),
            tuple(act for clause in found for act in clause.forbidden),
            unread,
            tuple(self.clauses.missing) if unread else (),
        )


def _glued(parts: Sequence[str], joints: Sequence[str]) -> str:
    text = parts[0]
    for joint, part in zip(joints, parts[1:], strict=False):
        text += joint + part
    return text


def _all_spoken(clauses: Sequence[Clause] | None) -> tuple[Spoken, ...]:
    return tuple(each for clause in reversed(clauses or ()) for each in clause.spoken)


def _verb_of(text: str) -> str:
    if found := _SWITCHED.fullmatch(plain_words(text)):
        return f"turn {found[1]}"
    found = _VERB.match(plain_words(text))
    return found[1] if found else ""
