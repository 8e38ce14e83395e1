"""Sentences: the steps that one line asks for, which may join several clauses, count things and speak of `it`."""

import re
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.adjectives import without_adjective
from hearth.kb.language.lexicon import is_verb, noun_lemmas
from hearth.kb.language.noun_phrases import thing_of, things_in
from hearth.kb.language.pronouns import PRONOUN, Mentioned, referred, several, with_place
from hearth.kb.language.reading_modes import Fuzzy
from hearth.kb.language.sentence_openings import verb_phrase
from hearth.kb.language.step_understanding import Candidate, Understood, understand, understand_exactly
from hearth.kb.language.trailing_words import changes_act, is_subordinate, shortened
from hearth.kb.language.typos import corrected

_JOINTS = re.compile(
    r"(?:\s*[,;])?\s+(?:and then|then|and|&{1,2}|\+)\s+|\s*[;,]\s*(?:(?:and then|then|and)\s+)?|\.\s+(?=[A-Z])",
    re.IGNORECASE,
)
_PLURAL = re.compile(r"\b[a-z]+es\b")
_OBSERVED = re.compile(
    r"\W*(?:you|i|we|he|she|it|they)(?: can| could)? (?:see|sees|saw|hear|hears|notice|notices)\b", re.IGNORECASE
)
"""A sentence about a person's observation asks for nothing."""

_NUMBERS = ("two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")
_COUNTS = (
    {"both": 2, "a couple": 2} | {name: n for n, name in enumerate(_NUMBERS, 2)} | {str(n): n for n in range(2, 11)}
)
_COUNT = re.compile(rf"\b({'|'.join(_COUNTS)})\s+(?:of\s+)?(?:the\s+|my\s+|your\s+)?(?=[a-z])", re.IGNORECASE)
_ANOTHER = re.compile(r"\b(another|one more|the other|a second)\s+(?=[a-z])", re.IGNORECASE)
_ORDINALS = {"first": 1, "second": 2, "third": 3, "fourth": 4, "fifth": 5}
_ORDINAL = re.compile(rf"\bthe ({'|'.join(_ORDINALS)}|other)\s+(?=[a-z])", re.IGNORECASE)
_BETWEEN = re.compile(r"\b(?:in|on|into|onto|with|to|at|inside)\b", re.IGNORECASE)
_TWO_TOOLS = re.compile(r" (?:with|using) (?:[a-z]+ ){1,3}and [a-z]+(?: [a-z]+)?$", re.IGNORECASE)
"""Two tools of one act, `with soap and water`."""

_LEFT_OUT = 3
_CLAUSES = 12
_MISSPELLED = 0.9
"""The similarity of a clause that has misspelled words and others that are left out."""


class Asked(NamedTuple):
    """A step that a sentence asks for.

    Attributes:
        meant: the step.
        instance: the number of its first thing; two forks are fork 1 and fork 2.
        left_out: words of the sentence that are left out of the step.
        second: the number of its second thing.
    """

    meant: Candidate
    instance: int = 1
    left_out: str = ""
    second: int = 1

    @property
    def fuzzy(self) -> bool:
        """Return whether words were corrected or left out."""
        return self.meant.score < 1 or bool(self.left_out)

    @property
    def mentioned(self) -> Mentioned:
        """The step as later pronouns need it."""
        return Mentioned(self.meant.action.name, self.meant.names, self.instance, 0, self.second)


def asked_steps(known: Knowledge, words: str, said: Sequence[Mentioned], fuzzy: Fuzzy) -> tuple[Asked, ...]:
    """Return the steps that a line asks for; none where a clause of it is not understood.

    Args:
        known: the grammar.
        words: the line.
        said: the steps before, the last first.
        fuzzy: how far from known words a clause may be; off takes exact readings only.
    """
    if plain := plain_step(known, words):
        return plain
    if _OBSERVED.match(words):
        return ()
    words = verb_phrase(" ".join(_plurals_of_said(known, words, said).split()))
    whole = _clause(known, words, said, Fuzzy.OFF)
    if whole:
        return whole
    clauses = _clauses(words)
    if 1 < len(clauses) <= _CLAUSES and (joined := _joined(known, clauses, said, fuzzy)):
        return joined
    is_one = len(clauses) == 1 or _TWO_TOOLS.search(words) is not None
    return _clause(known, words, said, fuzzy) if is_one and fuzzy is not Fuzzy.OFF else ()


@lru_cache(maxsize=65_536)
def plain_step(known: Knowledge, words: str) -> tuple[Asked, ...]:
    """Return the step of a line that reads exactly, whatever was said before: without pronoun and double plural."""
    if _OBSERVED.match(words) or PRONOUN.search(words) or _double_plurals(known, words):
        return ()
    meant = understand_exactly(known, words).meant
    return (Asked(meant),) if meant else ()


def _plurals_of_said(known: Knowledge, words: str, said: Sequence[Mentioned]) -> str:
    """Return a line in which a plural that has a meaning of its own is many of a thing said before, as two
    `glasses` are.
    """
    for plural, own, singular, many in _double_plurals(known, words) if said else ():
        if _is_said(many, said) and not _is_said(own, said):
            words = re.sub(rf"\b{plural}\b", singular, words, flags=re.IGNORECASE)
    return words


def _double_plurals(known: Knowledge, words: str) -> list[tuple[str, str, str, str]]:
    """Return the plurals in a line that are classes of their own, with their class, their singular, and its class."""
    found = []
    for plural in _PLURAL.findall(words.lower()):
        singular = plural.removesuffix("es")
        own, many = known.object_class(plural), known.object_class(singular)
        if own and many and own.name != many.name:
            found.append((plural, own.name, singular, many.name))
    return found


def _is_said(name: str, said: Sequence[Mentioned]) -> bool:
    return any(name in each.names for each in said)


def asked_in_part(known: Knowledge, words: str, said: Sequence[Mentioned], fuzzy: Fuzzy) -> tuple[Asked | str, ...]:
    """Return what a line asks for, clause by clause: the steps of those that are understood, and the words of others.

    Nothing is returned where no clause is understood, and where one of the others may change the act of the line, as
    `open the fridge, but not the freezer` does.
    """
    if _OBSERVED.match(words):
        return ()
    clauses = _clauses(verb_phrase(" ".join(_plurals_of_said(known, words, said).split())))
    found: list[Asked | str] = []
    at = 0
    while at < len(clauses) <= _CLAUSES:
        now = tuple(each.mentioned for each in reversed(found) if isinstance(each, Asked))
        read, size = _longest(known, clauses[at:], (*now, *said), fuzzy)
        found += read or (clauses[at],)
        at += size
    unread = [each for each in found if isinstance(each, str)]
    return () if len(unread) == len(found) or any(changes_act(each.lower()) for each in unread) else tuple(found)


def _longest(
    known: Knowledge, clauses: list[str], said: Sequence[Mentioned], fuzzy: Fuzzy
) -> tuple[tuple[Asked, ...], int]:
    """Return the steps of the most clauses from the first on that are read together, and how many they are.

    At least 1.
    """
    for size in range(len(clauses), 1, -1):
        if read := _listed(known, clauses[:size], said):
            return read, size
    return _clause(known, clauses[0], said, fuzzy), 1


def _clauses(words: str) -> list[str]:
    return [clause for clause in _JOINTS.split(words) if clause]


def nearest_steps(known: Knowledge, words: str, said: Sequence[Mentioned], fuzzy: Fuzzy) -> Understood:
    """Return what a line as a whole is understood as, and the nearest steps as hints."""
    if _OBSERVED.match(words):
        return Understood(None, ())
    return understand(known, next(referred(known, words, said), words), fuzzy)


def _joined(known: Knowledge, clauses: list[str], said: Sequence[Mentioned], fuzzy: Fuzzy) -> tuple[Asked, ...]:
    """Return the steps of clauses one after another.

    What shares a verb, as `grab a cup and a plate`, is read together.
    """
    if fuzzy is not Fuzzy.OFF and len(clauses) > 1 and is_subordinate(known, clauses[0].lower()):
        spoken = (Mentioned("", (thing,)) for thing in things_in(known, clauses[0].lower()))
        return _without_first(clauses[0], _joined(known, clauses[1:], (*spoken, *said), fuzzy))
    for size in range(1, len(clauses) + 1):
        read = _clause(known, clauses[0], said, fuzzy) if size == 1 else _listed(known, clauses[:size], said)
        if read and size == len(clauses):
            return read
        if read:
            now = (each.mentioned for each in reversed(read))
            if rest := _joined(known, clauses[size:], (*now, *said), fuzzy):
                return (*read, *rest)
    return ()


def _without_first(clause: str, read: tuple[Asked, ...]) -> tuple[Asked, ...]:
    """Return the steps of a line without the clause before them, which says when or how they are done."""
    return (read[0]._replace(left_out=f"{clause} {read[0].left_out}".rstrip()), *read[1:]) if read else ()


def _listed(known: Knowledge, parts: list[str], said: Sequence[Mentioned]) -> tuple[Asked, ...]:
    """Return the steps of one verb for several things: `put the cup`, `the plate on the table`."""
    first, last = parts[0].split(), parts[-1].split()
    middle = [part for part in parts[1:-1] if thing_of(known, part.lower())]
    if len(middle) != len(parts) - 2:
        return ()
    start = next((n for n in range(1, len(first)) if thing_of(known, _uncounted(first[n:]))), 0)
    end = next((n for n in range(len(last), 0, -1) if _is_bare(known, " ".join(last[:n]).lower())), 0)
    if not start or not end:
        return ()
    verb, tail = " ".join(first[:start]), " ".join(last[end:])
    if len(last) == 1 and is_verb(last[0].lower()) and not _are_of_a_kind(known, " ".join(first[start:]), last[0]):
        return ()  # `walk to the kitchen, fly` asks for another act
    found: list[Asked] = []
    for each in (" ".join(first[start:]), *middle, " ".join(last[:end])):
        read = _clause(known, f"{verb} {each} {tail}".strip(), said, Fuzzy.OFF)
        if not read:
            return ()
        found += read
    return tuple(found)


def _are_of_a_kind(known: Knowledge, one: str, other: str) -> bool:
    """Return whether two things are of one category."""
    names = (thing_of(known, _uncounted(words.split())) for words in (one, other))
    return len({known.objects[name].category if name else "" for name in names}) == 1


def _is_bare(known: Knowledge, words: str) -> bool:
    """Return whether words are a thing without the place where it is."""
    return thing_of(known, _uncounted(words.split())) is not None and not _BETWEEN.search(words)


def _uncounted(words: Sequence[str]) -> str:
    return _COUNT.sub("", " ".join(words).lower())


def _clause(known: Knowledge, words: str, said: Sequence[Mentioned], fuzzy: Fuzzy) -> tuple[Asked, ...]:
    """Return the steps of one clause: exact, else with words left out, else with misspelled words corrected."""
    if read := _exact(known, words, said):
        return read
    words = verb_phrase(words)
    if fuzzy is Fuzzy.OFF:
        return ()
    if read := _shortened(known, words.lower(), said, ""):
        return read
    if changes_act(words.lower()):
        return ()
    for shorter, out in ((words, ""), *without_adjective(known, words.lower())):
        for clause in referred(known, shorter, said):
            meant = understand(known, clause, Fuzzy.TYPOS).meant
            if meant and (clause == shorter or _affords(known, meant)):
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
        meant = [(understand_exactly(known, clause).meant, number) for clause, number in many]
        return tuple(Asked(each, number) for each, number in meant if each) if all(each for each, _ in meant) else ()
    found = (understand_exactly(known, clause).meant for clause in referred(known, words, said))
    readings = [each for each in found if each and (len(each.names) < 2 or each.names[0] != each.names[1])]
    if readings:
        afforded = (each for each in readings if _affords(known, each))
        best = readings[0] if len(readings) == 1 else next(afforded, readings[0])
        return (Asked(best, _number(best, said) if PRONOUN.search(words) else 1),)
    return _ordered(known, words, said) or _counted(known, words, said)


def _number(meant: Candidate, said: Sequence[Mentioned]) -> int:
    """Return the number of the last thing of a class that was spoken of."""
    return next((each.instance for each in said if each.names[:1] == meant.names[:1]), 1)


def _counted(known: Knowledge, words: str, said: Sequence[Mentioned]) -> tuple[Asked, ...]:
    """Return the steps of a clause that counts its things, as `two forks` and `another cup`."""
    count = _COUNT.search(words) or _ANOTHER.search(words)
    if not count or not count.start() or _BETWEEN.search(words[: count.start()].partition(" ")[2]):
        return ()
    meant = _of_one(known, words[: count.start()], words[count.end() :])
    if meant is None or not meant.names:
        return ()
    if number := _COUNTS.get(count[1].lower()):
        return tuple(Asked(meant, each) for each in range(1, number + 1))
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
