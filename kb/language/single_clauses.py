"""Clauses: the steps of one clause of a line, which may count things and speak of those of steps before."""

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.adjectives import without_adjective
from hearth.kb.language.carry_sentences import carried, is_carrying
from hearth.kb.language.counted_things import is_some, numbers, plurals, without_all
from hearth.kb.language.english_lexicon import noun_lemmas
from hearth.kb.language.missing_objects import gone_to
from hearth.kb.language.noun_phrases import thing_of, things_in
from hearth.kb.language.pronouns import (
    PRONOUN,
    UNREAD,
    Mentioned,
    count_meant,
    has_pronoun,
    is_hidden,
    referred,
    several,
    with_place,
)
from hearth.kb.language.reading_modes import Fuzzy
from hearth.kb.language.sentence_openings import verb_phrase
from hearth.kb.language.shortened_nouns import may_repeat, said_before
from hearth.kb.language.step_understanding import Candidate, understand, understand_exactly
from hearth.kb.language.trailing_words import changes_act, shortened
from hearth.kb.language.typos import corrected

_NUMBERS = ("two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")
_COUNTS = (
    {"both": 2, "a couple": 2} | {name: n for n, name in enumerate(_NUMBERS, 2)} | {str(n): n for n in range(2, 11)}
)
COUNT = re.compile(rf"\b({'|'.join(_COUNTS)})\s+(?:of\s+)?(?:the\s+|my\s+|your\s+)?(?=[a-z])", re.IGNORECASE)
_ANOTHER = re.compile(r"\b(another|one more|the other|a second)\s+(?=[a-z])", re.IGNORECASE)
_ORDINALS = {"first": 1, "second": 2, "third": 3, "fourth": 4, "fifth": 5}
_ORDINAL = re.compile(rf"\bthe ({'|'.join(_ORDINALS)}|other)\s+(?=[a-z])", re.IGNORECASE)
BETWEEN = re.compile(r"\b(?:in|on|into|onto|with|to|at|inside)\b", re.IGNORECASE)
_FIRST = re.compile(r"(?:after|once|as soon as) (?:having )?((?:you (?:have )?)?[a-z]+(?:ed|ing)? .+)", re.IGNORECASE)
"""A clause that says what is done before another one."""

_LEFT_OUT = 3
_MISSPELLED = 0.9
"""The similarity of a clause that has misspelled words and others that are left out."""


class Asked(NamedTuple):
    """A step that a sentence asks for.

    Attributes:
        meant: the step.
        instance: the number of its first thing; two forks are fork 1 and fork 2.
        left_out: words of the sentence that are left out of the step.
        second: the number of its second thing.
        along: the class of the thing that is carried along.
        added: what the step has and the sentence does not say.
    """

    meant: Candidate
    instance: int = 1
    left_out: str = ""
    second: int = 1
    along: str = ""
    added: str = ""

    @property
    def fuzzy(self) -> bool:
        """Return whether words were corrected, left out or added."""
        return self.meant.score < 1 or bool(self.left_out or self.added)

    @property
    def mentioned(self) -> Mentioned:
        """The step as later pronouns need it."""
        return Mentioned(self.meant.action.name, self.meant.names, self.instance, 0, self.second)


def unclear(known: Knowledge, words: str, said: Sequence[Mentioned]) -> str:
    """Return why the steps before a clause do not say which things it means; empty where they do."""
    if is_hidden(words, said) and (pronoun := PRONOUN.search(words)):
        other = next(each.words for each in said if each.action == UNREAD and not each.names)
        return f"`{pronoun[0]}` may mean a thing of `{other[:60]}`, which could not be read"
    for noun, phrases in said_before(known, words, said)[1].items():
        return f"`{noun}` may mean {' or '.join(f'`{each}`' for each in phrases)}"
    many = numbers(said)
    if count_meant(words) or (many and is_some(known, words, many)):
        return "it does not say which of several things"
    return "it does not say which thing goes with which" if many and len(plurals(known, words, many)) > 1 else ""


def clause_steps(known: Knowledge, words: str, said: Sequence[Mentioned], fuzzy: Fuzzy) -> tuple[Asked, ...]:
    """Return the steps of one clause, which may be about the things of steps before."""
    many = numbers(said)
    if many or _may_speak_of_said(known, words):
        read = _clause_about_said(known, words, said, fuzzy, many)
    else:
        read = _clause_itself(known, words, said, fuzzy)
    if read and read[-1].left_out and _FIRST.fullmatch(read[-1].left_out):
        return _with_first_act(known, read, said)
    return read


@lru_cache(maxsize=65_536)
def _may_speak_of_said(known: Knowledge, words: str) -> bool:
    return bool(may_repeat(known, words)) or is_carrying(words) or count_meant(words) > 0


def _clause_about_said(
    known: Knowledge, words: str, said: Sequence[Mentioned], fuzzy: Fuzzy, many: Mapping[str, Sequence[int]]
) -> tuple[Asked, ...]:
    """Return the steps of a clause in which nouns, plurals or places may be those of steps before."""
    words, are_several = said_before(known, words, said)
    of_many = plurals(known, words, many) if many else set()
    if are_several or len(of_many) > 1 or (many and is_some(known, words, many)):
        return ()
    if (count := count_meant(words)) and count != len(several(known, with_place(known, words, said), said)):
        return ()
    if is_carrying(words) and carried(known, words, said):
        return _carried(known, words, said) if fuzzy is not Fuzzy.OFF else ()
    read = _clause_itself(known, without_all(words) if of_many else words, said, fuzzy)
    return _of_all(read, {name: many[name] for name in of_many})


def _with_first_act(known: Knowledge, read: tuple[Asked, ...], said: Sequence[Mentioned]) -> tuple[Asked, ...]:
    """Return the steps of a clause after those of the words left out, where these say what is done first."""
    first = first_act(known, read[-1].left_out, (*(each.mentioned for each in reversed(read)), *said))
    return (*first, *(each._replace(left_out="") for each in read)) if first else read


def first_act(known: Knowledge, words: str, said: Sequence[Mentioned]) -> tuple[Asked, ...]:
    """Return the steps of a clause that says what is done before another one; none that was said already."""
    found = _FIRST.fullmatch(words)
    read = clause_steps(known, verb_phrase(found[1]), said, Fuzzy.OFF) if found else ()
    done = {(each.action, each.names) for each in said}
    return () if any((each.meant.action.name, each.meant.names) in done for each in read) else read


def _of_all(read: tuple[Asked, ...], many: Mapping[str, Sequence[int]]) -> tuple[Asked, ...]:
    """Return the steps of a clause for each of the things that it names in the plural."""
    names = read[0].meant.names if len(read) == 1 else ()
    at = next((place for place, name in enumerate(names) if name in many), None)
    if at is None or (read[0].instance, read[0].second)[at] != 1:
        return read
    counted = many[names[at]]
    return tuple(read[0]._replace(instance=n) if not at else read[0]._replace(second=n) for n in counted)


def _carried(known: Knowledge, words: str, said: Sequence[Mentioned]) -> tuple[Asked, ...]:
    """Return the walk with a thing that a clause asks for; the thing is left out."""
    walk, thing = carried(known, words, said) or (words, "")
    meant = understand_exactly(known, walk).meant
    along = thing_of(known, thing.lower()) or ""
    return (Asked(meant, left_out=f"with {thing}", along=along),) if meant else ()


def _clause_itself(known: Knowledge, words: str, said: Sequence[Mentioned], fuzzy: Fuzzy) -> tuple[Asked, ...]:
    """Return the steps of one clause: exact, else with words left out, else with misspelled words corrected."""
    if read := _exact(known, words, said):
        return read
    words = verb_phrase(words)
    if fuzzy is Fuzzy.OFF:
        return ()
    if (clause := gone_to(known, words, said)) and (meant := understand_exactly(known, clause).meant):
        return (Asked(meant, added="the place to which the step before goes"),)
    if read := _shortened(known, words.lower(), said, ""):
        return read
    if changes_act(words.lower()):
        return ()
    for shorter, out in ((words, ""), *without_adjective(known, words.lower())):
        for clause in referred(known, shorter, said):
            meant = understand(known, clause, Fuzzy.TYPOS).meant
            if meant and (clause == shorter or (_affords(known, meant) and meant.names[:1] != meant.names[1:])):
                return (Asked(meant, left_out=out),)
    return _corrected(known, words.lower(), said)


def _corrected(known: Knowledge, words: str, said: Sequence[Mentioned]) -> tuple[Asked, ...]:
    """Return the step of a clause with misspelled words, of which others are left out; none where it may be several."""
    sentences = next(iter(corrected(known, words)), ())
    read = {found for each in sentences if each != words and (found := _shortened(known, each, said, ""))}
    found = read.pop() if len(read) == 1 else ()
    return tuple(each._replace(meant=each.meant._replace(score=_MISSPELLED)) for each in found)


def _shortened(
    known: Knowledge, words: str, said: Sequence[Mentioned], left_out: str, depth: int = 0
) -> tuple[Asked, ...]:
    for shorter, out in shortened(known, words):
        without = f"{out} {left_out}".strip()
        read = tuple(each._replace(left_out=without) for each in _exact(known, shorter, said))
        if not read and depth + 1 < _LEFT_OUT:
            read = _shortened(known, shorter, said, without, depth + 1)
        if read:
            return read
    return ()


def _exact(known: Knowledge, words: str, said: Sequence[Mentioned]) -> tuple[Asked, ...]:
    """Return the exact reading of a clause, of as many things as it counts; `it` is the last thing that affords it."""
    words = with_place(known, words, said)
    if many := several(known, words, said):
        meant = [(understand_exactly(known, clause).meant, name, number) for clause, name, number in many]
        steps = tuple(_numbered(each, name, number) for each, name, number in meant if each)
        return steps if len(steps) == len(meant) else ()
    found = (understand_exactly(known, clause).meant for clause in referred(known, words, said))
    readings = [each for each in found if each and (len(each.names) < 2 or each.names[0] != each.names[1])]
    if readings:
        afforded = (each for each in readings if _affords(known, each))
        best = next(afforded, None)
        if best is None and is_hidden(words, said):
            return ()  # a line that was not understood may have named the thing that is meant
        best = best or readings[0]
        return (Asked(best, _number(best, said) if has_pronoun(words) else 1),)
    return _ordered(known, words, said) or _counted(known, words, said) or _of_numbers(known, words)


_NUMBERED = re.compile(r"(?<=[a-z]) (?:#|no\. ?|nr\. ?|number )?([1-9]\d{0,3})(?=$|[ ,.;!])", re.IGNORECASE)


def _of_numbers(known: Knowledge, words: str) -> tuple[Asked, ...]:
    """Return the step of a clause whose things have numbers behind their names: `put cup 2 on table #1`."""
    found = list(_NUMBERED.finditer(words))
    meant = understand_exactly(known, _NUMBERED.sub("", words)).meant if found else None
    if meant is None or not meant.names or len(found) > len(meant.names):
        return ()
    numbers: dict[str, int] = {}
    for each in found:
        before = _NUMBERED.sub("", words[: each.start()]).lower().split()
        ends = (thing_of(known, " ".join(before[-length:])) for length in (3, 2, 1))
        name = next((thing for thing in ends if thing in meant.names), "")
        if not name or name in numbers:
            return ()
        numbers[name] = int(each[1])
    first, second = (*(numbers.get(name, 1) for name in meant.names), 1, 1)[:2]
    return (Asked(meant, instance=first, second=second),)


def _numbered(meant: Candidate, name: str, number: int) -> Asked:
    """Return a step in which the thing of a class has a number: `fill both mugs` has the mugs second."""
    return Asked(meant, second=number) if meant.names[1:] == (name,) != meant.names[:1] else Asked(meant, number)


def _number(meant: Candidate, said: Sequence[Mentioned]) -> int:
    """Return the number of the last thing of a class that was spoken of."""
    return next((each.instance for each in said if each.names[:1] == meant.names[:1]), 1)


def _counted(known: Knowledge, words: str, said: Sequence[Mentioned]) -> tuple[Asked, ...]:
    """Return the steps of a clause that counts its things, as `two forks` and `another cup`."""
    count = COUNT.search(words) or _ANOTHER.search(words)
    if not count or not count.start() or BETWEEN.search(words[: count.start()].partition(" ")[2]):
        return ()
    if BETWEEN.match(words[count.end() :]):
        return ()
    meant = _of_one(known, words[: count.start()], words[count.end() :])
    if meant is None or not meant.names:
        return ()
    if number := _COUNTS.get(count[1].lower()):
        counted = next(iter(things_in(known, words[count.end() :].lower())), meant.names[0])
        return tuple(_numbered(meant, counted, each) for each in range(1, number + 1))
    before = [each.instance for each in said if each.names[:1] == meant.names[:1]]
    if count[1].lower() == "the other":
        return (Asked(meant, other),) if (other := _other(before)) else ()
    return (Asked(meant, max(before, default=0) + 1),)


def _other(said: Sequence[int]) -> int:
    """Return the number of the other one of two things where the first was said last; 0 where it may be either."""
    return 2 if said[:1] == [1] and max(said) <= 2 else 0


def _ordered(known: Knowledge, words: str, said: Sequence[Mentioned]) -> tuple[Asked, ...]:
    """Return the step of a clause with one of several things: `the second cup`, `the other cup`."""
    found = _ORDINAL.search(words)
    if not found or not found.start() or len(_ORDINAL.findall(words)) > 1:
        return ()
    meant = understand_exactly(known, f"{words[: found.start()]}the {words[found.end() :]}").meant
    thing = next(iter(things_in(known, words[found.end() :].lower())), "")
    if not meant or meant.names.count(thing) != 1:
        return ()
    before = [
        number
        for each in said
        for name, number in zip(each.names, (each.instance, each.second), strict=False)
        if name == thing
    ]
    number = _ORDINALS.get(found[1].lower()) or _other(before)
    if not number:
        return ()
    return (Asked(meant, number) if meant.names[0] == thing else Asked(meant, second=number),)


def _of_one(known: Knowledge, before: str, counted: str) -> Candidate | None:
    """Return the step for one of the things that are counted.

    Two `glasses` are glasses to drink from, not spectacles.
    """
    noun, space, after = counted.partition(" ")
    singular = (lemma for lemma in noun_lemmas(noun.lower()) if lemma != noun and thing_of(known, lemma))
    sentences = (f"{before}{one}{space}{after}" for one in (*singular, noun))
    return next((meant for each in sentences if (meant := understand_exactly(known, each).meant)), None)


def _affords(known: Knowledge, meant: Candidate) -> bool:
    return all(known.affords(meant.action.name, place, name) for place, name in enumerate(meant.names))
