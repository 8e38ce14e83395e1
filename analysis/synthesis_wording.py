"""The wording of synthetic descriptions: synonyms, pronouns, clauses in another order or with a purpose.

All words are data (`synthesis_words.yaml`); every choice is drawn from the generator that is passed in.
"""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path
from random import Random

from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import derive
from hearth.storage.input_files import load_yaml

WORDS = Path(__file__).parent / "synthesis_words.yaml"

ADJECTIVE, PRONOUN, REORDERED, PURPOSE, ASIDE, TYPO = 0.3, 0.45, 0.05, 0.18, 0.55, 0.1
"""Chances: of an adjective before a noun, of `it` for the last thing, of two clauses in the other order, of a clause of
purpose or time, of a sentence that names no step, of a typing error in a description."""

HELD_OUT = 5
"""One paraphrase of this number is held out: descriptions of the test part use no other, where there is one."""

_LIST = re.compile(r"<(\w+)>")
_SLOT = re.compile(r"\{(\w+)\}")
_THE_SLOT = re.compile(r"(the )?\{(\w+)\}")
_FIRST_IT = re.compile(r"^([^{]*)\bit\b")


@dataclass(frozen=True)
class Wording:
    """The words.

    Attributes:
        synonyms: a phrase of the grammar -> its alternatives.
        nouns: an object -> people's names for it.
        like: adjectives.
        openers, links, endings: beginnings of the first, later and last sentences.
        aims: clauses of purpose and time.
        asides: sentences that name no step.
        lists: the alternatives of `<name>`.
        known: other names of objects.
    """

    synonyms: Mapping[str, Sequence[str]]
    nouns: Mapping[str, Sequence[str]]
    like: Sequence[str]
    openers: Sequence[str]
    links: Sequence[str]
    endings: Sequence[str]
    aims: Sequence[str]
    asides: Sequence[str]
    lists: Mapping[str, Sequence[str]]
    known: Knowledge

    @cached_property
    def _phrases(self) -> re.Pattern[str]:
        found = "|".join(re.escape(each) for each in sorted(self.synonyms, key=lambda each: (-len(each), each)))
        return re.compile(rf"(?<![\w{{])(?:{found})(?!\w)")

    def expanded(self, text: str, chance: Random) -> str:
        """Return a text with an entry of its list for each `<name>`, and for those within."""
        while "<" in text:
            text = _LIST.sub(lambda match: chance.choice(self.lists[match[1]]), text, count=1)
        return text

    def fault(self, text: object, slots: Collection[str]) -> str:
        """Return why a text of a grammar can't be said; "" if it can: it names lists and slots that there are."""
        if not isinstance(text, str):
            return "is not a text"
        unknown = {*_SLOT.findall(text)} - {*slots} | {*_LIST.findall(text)} - self.lists.keys()
        if unknown or "<" in _LIST.sub("", text):
            return f"names what there is not: {', '.join(sorted(unknown)) or '<'}"
        return ""

    def reworded(self, clause: str, chance: Random) -> str:
        """Return a clause with synonyms of its phrases."""
        return self._phrases.sub(lambda match: chance.choice(self.synonyms[match[0]]), clause)

    def noun(self, name: str, chance: Random) -> str:
        """Return a person's word for a thing."""
        return chance.choice(self.nouns.get(name) or (plain(name),))


def load_words(known: Knowledge, path: Path = WORDS) -> Wording:
    """Read the words.

    Raises:
        HearthError: BAD_TABLE, an entry is missing or names an unknown list.
    """
    data = load_yaml(path)
    try:
        like = [word for row in data.pop("like") for word in row]
        found = Wording(**data, like=like, known=known)
        named = {name for text in _texts(data) for name in _LIST.findall(text)}
    except (TypeError, KeyError, AttributeError) as error:
        raise HearthError.of(Code.BAD_TABLE, f"not words of descriptions: {error}", file=str(path)) from error
    if unknown := named - found.lists.keys():
        raise HearthError.of(Code.BAD_TABLE, f"unknown list `{min(unknown)}`", file=str(path))
    return found


def _texts(data: object) -> Iterator[str]:
    if isinstance(data, Mapping):
        for value in data.values():
            yield from _texts(value)
    elif isinstance(data, Sequence) and not isinstance(data, str):
        for value in data:
            yield from _texts(value)
    else:
        yield str(data)


_PLAIN = {"food_food": "food", "coffe_maker": "coffee maker", "ceilinglamp": "ceiling lamp"}


def plain(name: str) -> str:
    """Return the name of a class as words."""
    return _PLAIN.get(name) or name.removeprefix("food_").removeprefix("clothes_").replace("_", " ")


def is_held_out(paraphrase: str) -> bool:
    """Return whether a paraphrase is held out; the same for every seed, so that no corpus has it in training."""
    return derive(0, "paraphrase", paraphrase) % HELD_OUT == 0


def paraphrase(say: Sequence[str], held_out: bool, chance: Random) -> str:
    """One of some paraphrases: held-out ones only, or none of them, as far as there are both kinds."""
    return chance.choice(_of_kind(tuple(say), held_out) or say)


@lru_cache(maxsize=4096)
def _of_kind(say: tuple[str, ...], held_out: bool) -> tuple[str, ...]:
    return tuple(each for each in say if is_held_out(each) == held_out)


def slots_of(template: str, subject: str, objects: Collection[str]) -> set[str]:
    """Return the slots of objects that a clause names: see `Speaker.clause`."""
    return {*_SLOT.findall(_with_subject(template, subject, objects))}


def _with_subject(template: str, subject: str, objects: Collection[str]) -> str:
    return _FIRST_IT.sub(rf"\1the {{{subject}}}", template, count=1) if subject in objects else template


class Speaker:
    """A person who describes a program: remembers the last thing named, and speaks in one grammatical person."""

    def __init__(self, words: Wording, first_person: bool, chance: Random) -> None:
        self.words, self.first, self.chance = words, first_person, chance
        self.names: dict[str, str] = {}
        self.last = ""

    def clause(self, template: str, objects: Mapping[str, str], subject: str = "") -> str:
        """Return a clause with names of its objects, each called the same throughout, or `it` if it was the last one
        named.

        Args:
            template: with slots of objects.
            objects: by slot.
            subject: the slot that an `it` before any slot stands for, since a clause about it may have been left out.
        """
        template = _with_subject(template, subject, objects)
        text = self.words.reworded(template, self.chance)
        found = _THE_SLOT.sub(lambda match: self._named(objects[match[2]], bool(match[1])), text)
        self.last = next((objects[slot] for slot in _SLOT.findall(template)), self.last)
        return self.words.expanded(found, self.chance)

    def _named(self, name: str, definite: bool) -> str:
        chance = self.chance
        if definite and name == self.last and chance.random() < PRONOUN:
            return "them" if self.names.get(name, "").endswith("s") else "it"
        noun = self.names.setdefault(name, self.words.noun(name, chance))
        if not definite:
            return noun
        like = (
            self.words.expanded(chance.choice(self.words.like), chance) + " "
            if name != self.last and chance.random() < ADJECTIVE
            else ""
        )
        whose = chance.choice(("the", "the", "the", "my" if self.first else "your", "that", "our"))
        return f"{whose} {like}{noun}"

    def sentences(self, clauses: Sequence[str], aims: Sequence[str], join: float) -> list[str]:
        """Return the clauses as sentences, some joined, some in the other order, some with a purpose or time."""
        chance, rest = self.chance, list(clauses)
        found: list[str] = []
        aim = chance.randrange(len(rest)) if chance.random() < PURPOSE else -1
        place = 0
        while rest:
            text = self._person(rest.pop(0))
            if place == aim:
                text = f"{text} {self.words.expanded(chance.choice((*aims, *aims, *self.words.aims)), chance)}"
            if rest and chance.random() < REORDERED:
                text = self._reordered(text, self._person(rest.pop(0)))
                place += 1
            elif rest and chance.random() < join:
                text = f"{text}{chance.choice((' and ', ' and then ', ', then ', ' and '))}{self._bare(rest.pop(0))}"
                place += 1
            place += 1
            found.append(self._sentence(text, first=not found, last=not rest))
        if chance.random() < ASIDE:
            aside = _capital(self.words.expanded(chance.choice(self.words.asides), chance))
            found.insert(chance.randrange(1, len(found) + 1), aside)
        return found

    def _person(self, clause: str) -> str:
        return f"I {self._bare(clause)}" if self.first else clause

    def _bare(self, clause: str) -> str:
        """Return a clause without its subject, in the speaker's person."""
        if not self.first:
            return clause
        return _YOU.sub(lambda match: "my" if match[1] else "I am" if match[2] else "I", clause)

    def _reordered(self, earlier: str, later: str) -> str:
        """Two clauses, the later one first."""
        if self.first:
            form = self.chance.choice(("before {b}, {a}", "{b}, but first {a}", "{b} once {a}", "{b} after {a}"))
        else:
            form = self.chance.choice(("before you {b}, {a}", "{b}, but first {a}", "{b} once you {a}"))
        return form.format(a=earlier, b=later)

    def _sentence(self, text: str, *, first: bool, last: bool) -> str:
        words = self.words
        openers = words.openers if first else words.endings if last else words.links
        opener = words.expanded(self.chance.choice(openers), self.chance)
        return f"{_capital(opener + text)}{self.chance.choice('......!')}"


_YOU = re.compile(r"\byou(r?)\b( are\b)?")


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def mistyped(text: str, chance: Random) -> str:
    """Return a text with one typing error: two letters swapped, one left out or one doubled, within a longer word."""
    places = [match.start() for match in re.finditer(r"(?<=\w\w)\w(?=\w\w)", text)]
    if not places:
        return text
    place = chance.choice(places)
    letter, following = text[place], text[place + 1]
    middle = chance.choice((following + letter, following, letter + letter + following))
    return text[:place] + middle + text[place + 2 :]
