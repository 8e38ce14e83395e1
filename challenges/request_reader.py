"""Requests put together from kinds of words, whatever their order: `I'd love a plate on the table, and a lamp on`.

The patterns of `paraphrases.yaml` come first. Every word must be of a kind of `request_words.yaml` or name a thing, and
every thing must end somewhere, so that nothing is left out in silence.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from hearth.challenges.paraphrase_things import UNSAID, Known
from hearth.challenges.request_statements import SWITCHED, Relation, Statements
from hearth.challenges.request_tokens import (
    RefusedError,
    Token,
    for_people,
    is_aside,
    sentences,
    tokens,
    without_reasons,
)
from hearth.kb.knowledge import Knowledge
from hearth.schemas.goals import Goal
from hearth.schemas.literals import HOLDS


def read_request(text: str, known: Known, knowledge: Knowledge, doer: str, relation: Relation) -> Goal | None:
    """Return the goal of a request; None where some of it is not understood.

    Args:
        text: in lower case.
        known: the nouns of things.
        knowledge: of switches, and of the act that opens.
        doer: the agent of the goal.
        relation: gives the relation of a preposition and a place.
    """
    try:
        reading = _Reading(knowledge, doer, relation)
        plain, people = for_people(text)
        rooms = frozenset(word for word, name in known.one.items() if knowledge.is_room(name))
        plain = without_reasons(plain, known, rooms)
        asked = [each for each in re.split(r"(?<=[.!?;])\s+", plain) if not is_aside(each, known)]
        for sentence in sentences(list(tokens(" ".join(asked), known, people))):
            reading.sentence(sentence)
        return reading.goal()
    except RefusedError:
        return None


class _Here(NamedTuple):
    """A place in a sentence.

    Attributes:
        reading: of the request.
        words: of the token.
        before, after: the other tokens of the sentence.
    """

    reading: _Reading
    words: str
    before: list[Token]
    after: list[Token]

    @property
    def next(self) -> str:
        """Return the kinds of the next token; "" at the end."""
        return self.after[0].kind if self.after else ""

    @property
    def follows(self) -> str:
        """Return the kinds of the next token that is no filler; "" at the end."""
        return next((each.kind for each in self.after if each.kind != "filler"), "")


@dataclass
class _Reading(Statements):
    """The reading of a request, token by token."""

    def sentence(self, tokens: list[Token]) -> None:
        """Read a sentence."""
        for n, token in enumerate(tokens):
            before, after = tokens[:n], tokens[n + 1 :]
            self._take(token, before, after)
        self.close(ends=True)

    def _take(self, token: Token, before: list[Token], after: list[Token]) -> None:
        if token.kind == "thing":
            self._thing(token, before)
            return
        kinds = token.kind.split()
        here = _Here(self, token.words, before, after)
        for kind, does in _DOES:
            if kind in kinds and does(here):
                return

    def _prep(self, here: _Here) -> bool:
        """Take a preposition before a thing, which is then the place, or before a word for the last place."""
        if here.next == "thing" and self.mode not in ("turn", "no"):
            return True
        if "it" in here.next.split() and here.words != "on":
            self._at_it(here.words)
            return True
        return False

    def _loose_prep(self, here: _Here) -> bool:
        """Take a preposition without a place: `put one in` says again what was said, `to` and `for` begin a reason."""
        if self.mode == "put" and self.said == "at" and not self.waiting:
            self.mode = ""
        elif here.words not in ("to", "for", "at") or here.next == "thing":
            raise RefusedError
        return True

    def _none(self) -> None:
        self.close()
        self.mode = "no"

    def _clause(self) -> None:
        self.close()
        self.mode = ""

    def _people(self) -> None:
        self._colon()
        self.waits = self.at is not None

    def _either(self) -> None:
        if self.mode not in ("no", "ban", "turn_off"):
            raise RefusedError

    def _rest(self, here: _Here) -> bool:
        if not self._rests(here):
            return False
        self._verb("rest")
        return True

    def _put(self, here: _Here) -> bool:
        if here.words == "stand" and self.waiting:  # `the pot should stand on ...`
            return False
        self._verb("put")
        return True

    def _verb(self, mode: str) -> None:
        self.close()
        self.mode = mode

    def _rests(self, here: _Here) -> bool:
        """Return whether the agent itself is to sit or lie: nothing was named for it, and a place follows at once."""
        if here.words in ("have a seat", "take a seat"):
            return True
        if self.waiting and self.mode not in ("hold", "take"):
            return False
        if here.words in ("get", "get yourself") and not (here.after and here.after[0].words in ("onto", "on")):
            return False
        at = next((each for each in here.after if each.kind != "filler"), None)
        return (at is not None and "prep" in at.kind.split()) or here.words == "get onto"

    def _thing(self, token: Token, before: list[Token]) -> None:
        name, number = token.thing
        if token.words.startswith(("a ", "an ", "one ", "another ", "some ")):
            self.indefinite.add(name)
        is_place = bool(before) and "prep" in before[-1].kind.split() and self.mode not in ("turn_on", "turn_off", "no")
        if self.mode in ("fill", "dress"):
            relation = self.relation("in" if self.mode == "fill" else "on", name)
            if relation is None or number not in (1, UNSAID):
                raise RefusedError
            self.mode, self.at, self.last = "", (relation, name), (relation, name)
            return None
        if self.mode == "rest":
            self.mode = ""
            return self.emit("at", [(("ON", self.doer, name), 1)], one=number)
        if is_place:
            return self._place(before[-1].words, name, number)
        self.named = name
        if self.mode == "open":
            self.mode = ""
            return self.emit("open", [(("OPEN", name), 1)], one=number)
        if self.mode == "ban":
            self.bans.append(name)
            return None
        self.waiting.append((name, number))
        return None

    def _place(self, prep: str, name: str, number: int) -> None:
        relation = self.relation("to" if prep in ("for", "at") else prep, name)
        if relation is None or number not in (1, UNSAID):
            raise RefusedError
        if self.mode == "hold":
            raise RefusedError
        self.last = (relation, name)
        if self.waiting:
            self.placed(*self.last)
            self.mode = "take" if self.mode == "take" else ""
        else:
            self.at = self.last

    def _lit(self, here: _Here) -> bool:
        if self.mode == "no" and here.next == "thing":
            raise RefusedError  # `no plates on the table`
        if self.mode == "turn_off":
            return True  # `turn off all lamps that are on`
        if self.mode == "no":
            self.none_on()
            self.mode = ""
        elif self.waiting:
            last = len(self.waiting) - 1
            if self.mode in ("take", "hold") and last:
                raise RefusedError
            self.lit_or_worn(self.taken())
            self.mode = ""
        elif self.mode == "turn":
            self.mode = "turn_on"
        else:
            raise RefusedError
        return True

    def _dark(self) -> None:
        if self.mode == "turn":
            self.mode = "turn_off"
            return
        if self.waiting:
            if self.mode not in ("", "no", "turn_off"):
                raise RefusedError
            if any(name in self.indefinite for name, _ in self.waiting) and self.mode not in ("no", "turn_off"):
                raise RefusedError
            self.none_on()
        elif self.said != "off":
            raise RefusedError
        self.mode = ""

    def _hand(self) -> None:
        if self.mode in ("no", "turn_on", "turn_off"):
            raise RefusedError
        if self.waiting:
            self.emit("held", [((HOLDS, self.doer, name), number) for name, number in self.taken()])
            self.mode = ""
        elif self.said != "held":
            raise RefusedError

    def _ban(self, here: _Here) -> bool:
        """Take `never open`: of a thing that follows, or of one that was named before `it`."""
        is_named = "it" in here.follows.split()
        if is_named and self.waiting and self.mode == "":
            self.bans += [name for name, _ in self.waiting]
            self.waiting = []
        elif not (is_named and self.bans):
            self._verb("ban")
        return True

    def _banned(self) -> None:
        """Take `off limits` behind the one thing that is not to be opened."""
        if not self.waiting and self.bans and self.mode in ("", "ban"):
            return  # `it mustn't be opened`: of the thing that was forbidden before
        if self.mode or len(self.waiting) != 1 or self.waiting[0][1] not in (1, UNSAID):
            raise RefusedError
        self.bans.append(self.waiting.pop()[0])

    def _shut(self) -> None:
        if self.mode not in ("take", "put") or len(self.waiting) != 1:
            raise RefusedError
        self.bans.append(self.waiting.pop()[0])
        self.mode = ""

    def _open(self, here: _Here) -> bool:
        if "it" in here.next.split() and self.named:
            self.close()
            self.mode = ""
            self.emit("open", [(("OPEN", self.named), 1)])
        elif self.mode == "take" and len(self.waiting) == 1 and here.next != "thing":
            (name, number), self.waiting, self.mode = self.waiting[0], [], ""  # `leave the bin open`
            self.emit("open", [(("OPEN", name), 1)], one=number)
        else:
            self._verb("open")
        return True

    def _at_it(self, prep: str) -> None:
        relation = self.relation(prep, self.last[1]) if self.last is not None else None
        if relation is None or self.last is None or not self.waiting:
            raise RefusedError
        self.placed(relation, self.last[1])
        self.mode = ""

    def _topped(self, words: str) -> None:
        if len(self.waiting) != 1 or self.mode:
            raise RefusedError
        place = self.waiting.pop()[0]
        self.at = self.last = ("INSIDE" if words.startswith("in") else "ON", place)

    def _there(self) -> None:
        if self.waiting and self.last is not None:
            self.placed(*self.last)
        elif self.said != "at":
            raise RefusedError
        self.mode = ""

    def _colon(self) -> None:
        if len(self.waiting) == 1 and not self.mode and self.at is None:  # `Kitchen table: a fork, a bowl`
            place, number = self.waiting[0]
            relation = self.relation("to", place)
            if relation is not None and number in (1, UNSAID):
                self.waiting, self.at, self.last = [], (relation, place), (relation, place)

    def _it(self, words: str) -> None:
        """Take a word for a thing named before; it says nothing new, except where a verb waits for it."""
        if words == "one" and any(number > 1 for _, number in self.waiting):
            raise RefusedError  # `two plates, one on the table`
        if self.mode in ("turn", "turn_on") and not self.waiting and self.said not in ("on", "off"):
            self._turned_it()
        if self.mode in ("take", "hold") and not self.waiting and self.said not in ("held", "at", "on"):
            raise RefusedError

    def _turned_it(self) -> None:
        """Take `turn it`: of the last place where that has a switch, else of the last thing.

        Raises:
            RefusedError: neither has a switch.
        """
        names = [each for each in (self.last[1] if self.last else "", self.named) if each]
        kinds = ((name, self.knowledge.object_class(name)) for name in names)
        found = next((name for name, kind in kinds if kind is not None and SWITCHED & set(kind.properties)), None)
        if found is None:
            raise RefusedError
        self.waiting, self.mode = [(found, 1)], "turned" if self.mode == "turn" else self.mode


def _always(does: Callable[[_Reading], None]) -> Callable[[_Here], bool]:
    """Return a function of a place from one of the reading, for words that always mean the same."""

    def take(here: _Here) -> bool:
        does(here.reading)
        return True

    return take


def _begins(mode: str) -> Callable[[_Here], bool]:
    """Return the function of a verb."""
    return _always(lambda reading: reading._verb(mode))


def _turns(here: _Here) -> bool:
    here.reading._verb("turn" if here.words in ("turn", "switch") else "turn_on")
    return True


_DOES: tuple[tuple[str, Callable[[_Here], bool]], ...] = (
    (":", _always(_Reading._colon)),
    ("no", _always(_Reading._none)),
    ("ban", lambda here: here.reading._ban(here)),
    ("clause", _always(_Reading._clause)),
    ("prep", lambda here: here.reading._prep(here)),
    ("fill", _begins("fill")),
    ("dress", _begins("dress")),
    ("people", _always(_Reading._people)),
    ("or", _always(_Reading._either)),
    ("lit", lambda here: here.reading._lit(here)),
    ("dark", _always(_Reading._dark)),
    ("turn_on", _turns),
    ("turn_off", _begins("turn_off")),
    ("hand", _always(_Reading._hand)),
    ("shut", _always(_Reading._shut)),
    ("open", lambda here: here.reading._open(here)),
    ("topped", lambda here: _always(lambda reading: reading._topped(here.words))(here)),
    ("there", _always(_Reading._there)),
    ("banned", _always(_Reading._banned)),
    ("wear", _begins("wear")),
    ("rest", lambda here: here.reading._rest(here)),
    ("hold", _begins("hold")),
    ("take", _begins("take")),
    ("put", lambda here: here.reading._put(here)),
    ("it", lambda here: _always(lambda reading: reading._it(here.words))(here)),
    ("prep", lambda here: here.reading._loose_prep(here)),
)
"""The reading of each kind of words, in the order in which kinds of the same words are tried."""
