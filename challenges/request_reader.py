"""Requests put together from kinds of words, `I'd love a plate on the table, and a floor lamp on`, whatever their order.

The patterns of `paraphrases.yaml` come first. Every word must be of a kind of `request_words.yaml` or name a thing, and
every thing must end somewhere, so that nothing is left out in silence.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Any, NamedTuple

from hearth.challenges.instruction_object_names import EVERY
from hearth.challenges.paraphrase_things import UNSAID, Known, things
from hearth.kb.knowledge import Knowledge
from hearth.schemas.goals import Goal, Joined
from hearth.schemas.literals import HOLDS, Literal, Name
from hearth.schemas.yaml_limits import packaged

LONGEST_NAME = 7
"""Words of a thing with its number, at most."""

_SWITCHED = frozenset({"HAS_SWITCH", "LIGHTABLE"})

_WORDS = re.compile(r"[a-z0-9'-]+|[,.:;!?]")
_END = frozenset(".;!?")

Counted = list[tuple[str, int]]


class Token(NamedTuple):
    """Some words of a request: their kind, and the thing that they name, if it is `thing`."""

    kind: str
    words: str
    thing: tuple[str, int] = ("", 0)


class _Refused(Exception):
    """A request that is not understood whole."""


@cache
def _phrases() -> Mapping[str, tuple[str, ...]]:
    """Return the kinds of each phrase, in the order of the file."""
    found: dict[str, tuple[str, ...]] = {}
    data: Mapping[str, Any] = packaged("hearth.challenges", "request_words.yaml")
    for kind, phrases in data.items():
        for phrase in phrases:
            found[phrase] = (*found.get(phrase, ()), kind)
    return found


def read_request(text: str, known: Known, knowledge: Knowledge, doer: str, relation: Relation) -> Goal | None:
    """Return the goal of a request; None where some of it is not understood.

    Args:
        text: in lower case.
        known: the nouns of things.
        knowledge: for what is switched on, and the act that opens.
        doer: the agent of the goal.
        relation: gives the relation of a preposition and a place.
    """
    try:
        reading = _Reading(knowledge, doer, relation)
        for sentence in _sentences(list(_tokens(_WORDS.findall(text.replace("each and every", "every")), known))):
            reading.sentence(sentence)
        return reading.goal()
    except _Refused:
        return None


Relation = Callable[[str, str], str | None]


def _tokens(words: list[str], known: Known) -> Iterator[Token]:
    """Yield the kinds of words, the longest phrase or name first; a name with its number before a phrase as long.

    Raises:
        _Refused: a word is of no kind.
    """
    at, phrases = 0, _phrases()
    while at < len(words):
        for length in range(min(LONGEST_NAME, len(words) - at), 0, -1):
            phrase = " ".join(words[at : at + length])
            named = things(phrase, known) if not re.search(r"[,.:;!?]|\b(?:and|or|nor|with)\b", phrase) else None
            if named and len(named) == 1 and (length > 1 or phrase not in phrases):
                yield Token("thing", phrase, named[0])
                break
            if phrase in phrases or (length == 1 and not phrase[0].isalnum()):
                yield Token(" ".join(phrases.get(phrase, (phrase,))), phrase)
                break
        else:
            raise _Refused
        at += length


def _sentences(tokens: list[Token]) -> Iterator[list[Token]]:
    part: list[Token] = []
    for token in tokens:
        if token.kind in _END:
            yield part
            part = []
        else:
            part.append(token)
    yield part


@dataclass
class _Reading:
    """The reading of a request, token by token.

    Attributes:
        knowledge: of things.
        doer: the agent.
        relation: of a preposition and a place.
        counts: the literals so far.
        bans: things that are never opened.
        waiting: things that were named, and of which nothing is said yet.
        mode: what is to be done with things that follow.
        at: the place of things that follow, where it was said before them.
        last: the last place, and the last thing.
        said: the kind of the last statement.
        waits: whether the place may wait for things of the next sentence, `Table for two.`
    """

    knowledge: Knowledge
    doer: str
    relation: Relation
    counts: list[tuple[Literal[Name], int]] = field(default_factory=list)
    bans: list[str] = field(default_factory=list)
    waiting: Counted = field(default_factory=list)
    mode: str = ""
    at: tuple[str, str] | None = None
    last: tuple[str, str] | None = None
    named: str = ""
    said: str = ""
    waits: bool = False

    def sentence(self, tokens: list[Token]) -> None:
        """Read a sentence."""
        for n, token in enumerate(tokens):
            before, after = tokens[:n], tokens[n + 1 :]
            self._take(token, before, after)
        self._close(ends=True)

    def _take(self, token: Token, before: list[Token], after: list[Token]) -> None:
        kinds = set(token.kind.split())
        follows = next((each for each in after if each.kind != "filler" or each.words == "and"), None)
        next_one = after[0] if after else None
        if token.kind == "thing":
            self._thing(token, before, next_one)
        elif token.kind == ":":
            self._colon()
        elif "no" in kinds:
            self._close()
            self.mode = "no"
        elif "ban" in kinds:
            self._ban(follows)
        elif "clause" in kinds:
            self._close()
            self.mode = ""
        elif "prep" in kinds and next_one is not None and next_one.kind == "thing" and self.mode not in ("turn", "no"):
            pass  # the thing that follows is the place
        elif "fill" in kinds or "dress" in kinds:
            self._verb("fill" if "fill" in kinds else "dress")
        elif "people" in kinds:
            self._colon()
            self.waits = self.at is not None
        elif "or" in kinds and self.mode not in ("no", "ban", "turn_off"):
            raise _Refused
        elif "prep" in kinds and token.words not in ("on",) and next_one is not None and "it" in next_one.kind.split():
            self._at_it(token.words)
        elif "lit" in kinds:
            self._lit(token.words, next_one)
        elif "dark" in kinds:
            self._dark()
        elif "turn_on" in kinds and token.words not in ("turn", "switch"):
            self._verb("turn_on")
        elif "turn_on" in kinds:
            self._verb("turn")
        elif "turn_off" in kinds:
            self._verb("turn_off")
        elif "hand" in kinds:
            self._hand()
        elif "shut" in kinds:
            self._shut()
        elif "open" in kinds:
            self._open(next_one)
        elif "topped" in kinds:
            self._topped(token.words)
        elif "there" in kinds:
            self._there()
        elif "rest" in kinds and self._rests(token, before, after):
            self._verb("rest")
        elif "hold" in kinds:
            self._verb("hold")
        elif "take" in kinds:
            self._verb("take")
        elif "put" in kinds and not (token.words == "stand" and self.waiting):
            self._verb("put")
        elif "it" in kinds:
            self._it(token.words)
        elif "prep" in kinds:
            if self.mode == "put" and self.said == "at" and not self.waiting:
                self.mode = ""  # `put one in`
            elif token.words not in ("to", "for", "at") or (next_one and next_one.kind == "thing"):
                raise _Refused

    def _verb(self, mode: str) -> None:
        self._close()
        self.mode = mode

    def _rests(self, token: Token, before: list[Token], after: list[Token]) -> bool:
        """Return whether the agent itself is to sit or lie: nothing was named for it, and a place follows at once."""
        if token.words in ("have a seat", "take a seat", "get yourself"):
            return True
        if self.waiting and self.mode not in ("hold", "take"):
            return False
        if token.words == "get" and not (after and after[0].words in ("onto", "on")):
            return False
        at = next((each for each in after if each.kind != "filler"), None)
        return (at is not None and "prep" in at.kind.split()) or token.words in ("get onto",)

    def _thing(self, token: Token, before: list[Token], next_one: Token | None) -> None:
        name, number = token.thing
        is_place = bool(before) and "prep" in before[-1].kind.split() and self.mode not in ("turn_on", "turn_off", "no")
        if self.mode in ("fill", "dress"):
            relation = self.relation("in" if self.mode == "fill" else "on", name)
            if relation is None or number not in (1, UNSAID):
                raise _Refused
            self.mode, self.at, self.last = "", (relation, name), (relation, name)
            return None
        if self.mode == "rest":
            self.mode = ""
            return self._emit("at", [(("ON", self.doer, name), 1)], one=number)
        if is_place:
            return self._place(before[-1].words, name, number)
        self.named = name
        if self.mode == "open":
            self.mode = ""
            return self._emit("open", [(("OPEN", name), 1)], one=number)
        if self.mode == "ban":
            self.bans.append(name)
            return None
        self.waiting.append((name, number))
        return None

    def _place(self, prep: str, name: str, number: int) -> None:
        relation = self.relation("to" if prep in ("for", "at") else prep, name)
        if relation is None or number not in (1, UNSAID):
            raise _Refused
        if self.mode == "hold":
            raise _Refused
        self.last = (relation, name)
        if self.waiting:
            self._placed(*self.last)
            self.mode = "take" if self.mode == "take" else ""
        else:
            self.at = self.last

    def _placed(self, relation: str, place: str) -> None:
        self._emit("at", [((relation, name, place), number) for name, number in self._taken()])

    def _taken(self) -> Counted:
        """Return what waits, which no longer does.

        Raises:
            _Refused: nothing waits, or a number is not said.
        """
        found, self.waiting = self.waiting, []
        if not found or any(number in (UNSAID, EVERY) for _, number in found):
            raise _Refused
        return found

    def _emit(self, said: str, facts: list[tuple[tuple[str, ...], int]], one: int = 1) -> None:
        if one not in (1, UNSAID):
            raise _Refused
        self.counts += [(Literal.of(*fact), number) for fact, number in facts]
        self.said = said

    def _close(self, *, ends: bool = False) -> None:
        """End a clause: what waits goes where the words before it said."""
        if self.mode in ("hold", "take") and self.waiting:
            self._emit("held", [((HOLDS, self.doer, name), number) for name, number in self._taken()])
        elif self.mode == "turn_on" and self.waiting:
            self._switched(self._taken())
        elif self.mode == "turn_off" and self.waiting:
            self._none_on()
        elif self.at is not None and self.waiting and self.mode in ("", "put"):
            self._placed(*self.at)
            self.at, self.waits = None, False
        elif self.mode in ("put", "turn", "ban", "rest") and self.waiting:
            raise _Refused
        if ends and self.at is not None and not self.waits:
            raise _Refused  # a place, and nothing that goes there
        if ends:
            self.mode = ""

    def _need_switches(self, found: Counted) -> None:
        """Refuse things that are neither switched nor lit: `take the plates off`."""
        for name, _ in found:
            kind = self.knowledge.object_class(name)
            if kind is None or not _SWITCHED & set(kind.properties):
                raise _Refused

    def _switched(self, found: Counted) -> None:
        self._need_switches(found)
        self._emit("on", [(("ON", name), number) for name, number in found])

    def _none_on(self) -> None:
        """Say of what waits that none of it is on.

        Raises:
            _Refused: a number of things is named, `two lamps`.
        """
        found, self.waiting = self.waiting, []
        if not found or any(number > 1 for _, number in found):
            raise _Refused
        self._need_switches(found)
        self.counts += [(Literal("ON", (name,), True), 1) for name, _ in found]
        self.said = "off"

    def _lit(self, words: str, next_one: Token | None) -> None:
        if self.mode == "no" and next_one is not None and next_one.kind == "thing":
            raise _Refused  # `no plates on the table`
        if self.mode == "no":
            self._none_on()
            self.mode = ""
        elif self.waiting:
            last = len(self.waiting) - 1
            if self.mode in ("take", "hold") and last:
                raise _Refused
            self._switched(self._taken())
            self.mode = ""
        elif self.mode == "turn":
            self.mode = "turn_on"
        else:
            raise _Refused

    def _dark(self) -> None:
        if self.mode == "turn":
            self.mode = "turn_off"
            return
        if self.waiting:
            if self.mode not in ("", "no", "turn_off"):
                raise _Refused
            if any(number == 1 for _, number in self.waiting) and self.mode not in ("no", "turn_off"):
                raise _Refused
            self._none_on()
        elif self.said != "off":
            raise _Refused
        self.mode = ""

    def _hand(self) -> None:
        if self.mode == "no":
            raise _Refused
        if self.waiting:
            self._emit("held", [((HOLDS, self.doer, name), number) for name, number in self._taken()])
            self.mode = ""
        elif self.said != "held":
            raise _Refused

    def _ban(self, follows: Token | None) -> None:
        if follows is not None and "it" in follows.kind.split() and self.waiting and self.mode == "":
            self.bans += [name for name, _ in self.waiting]
            self.waiting = []
            return
        if follows is not None and "it" in follows.kind.split() and self.bans:
            return
        self._close()
        self.mode = "ban"

    def _shut(self) -> None:
        if self.mode not in ("take", "put") or len(self.waiting) != 1:
            raise _Refused
        self.bans.append(self.waiting.pop()[0])
        self.mode = ""

    def _open(self, next_one: Token | None) -> None:
        if next_one is not None and "it" in next_one.kind.split() and self.named:
            self._close()
            self.mode = ""
            self._emit("open", [(("OPEN", self.named), 1)])
        elif self.mode == "take" and len(self.waiting) == 1 and (next_one is None or next_one.kind != "thing"):
            (name, number), self.waiting, self.mode = self.waiting[0], [], ""  # `leave the bin open`
            self._emit("open", [(("OPEN", name), 1)], one=number)
        else:
            self._verb("open")

    def _at_it(self, prep: str) -> None:
        relation = self.relation(prep, self.last[1]) if self.last is not None else None
        if relation is None or self.last is None or not self.waiting:
            raise _Refused
        self._placed(relation, self.last[1])
        self.mode = ""

    def _topped(self, words: str) -> None:
        if len(self.waiting) != 1 or self.mode:
            raise _Refused
        place = self.waiting.pop()[0]
        self.at = self.last = ("INSIDE" if words.startswith("in") else "ON", place)

    def _there(self) -> None:
        if self.waiting and self.last is not None:
            self._placed(*self.last)
        elif self.said != "at":
            raise _Refused
        self.mode = ""

    def _colon(self) -> None:
        if len(self.waiting) == 1 and not self.mode and self.at is None:  # `Kitchen table: a fork, a bowl`
            place, number = self.waiting[0]
            relation = self.relation("to", place)
            if relation is not None and number in (1, UNSAID):
                self.waiting, self.at, self.last = [], (relation, place), (relation, place)

    def _it(self, words: str) -> None:
        """Take a word for what was named; it says nothing new, but where a verb waits for it."""
        if words == "one" and any(number > 1 for _, number in self.waiting):
            raise _Refused  # `two plates, one on the table`
        if self.mode in ("take", "hold") and not self.waiting and self.said not in ("held", "at", "on"):
            raise _Refused

    def goal(self) -> Goal | None:
        """Return the goal; None where nothing is asked, something waits, or one thing is asked twice."""
        literals = [literal for literal, _ in self.counts]
        bans = list(dict.fromkeys(self.bans))
        if self.waiting or len(set(literals)) < len(literals) or not (literals or bans):
            return None
        opens = self.knowledge.achiever("OPEN")
        parts = tuple(Joined("not", (Goal.of(Literal.of(opens, name)),)) for name in bans)
        return Goal(tuple(self.counts), parts)
