"""Sentences: the steps that one line asks for, which may join several clauses, count things and speak of `it`."""

import re
from collections.abc import Sequence
from functools import lru_cache

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.carry_sentences import is_carrying
from hearth.kb.language.counted_things import numbers
from hearth.kb.language.english_lexicon import is_verb
from hearth.kb.language.nothing_to_do_sentences import STAYS, stays
from hearth.kb.language.noun_phrases import thing_of, things_in
from hearth.kb.language.pronouns import Mentioned, has_pronoun, referred
from hearth.kb.language.reading_modes import Fuzzy
from hearth.kb.language.sentence_openings import verb_phrase
from hearth.kb.language.shortened_nouns import may_repeat
from hearth.kb.language.single_clauses import BETWEEN, COUNT, Asked, clause_steps, first_act
from hearth.kb.language.step_understanding import Candidate, Understood, understand, understand_exactly
from hearth.kb.language.things_in_refused_lines import unread
from hearth.kb.language.trailing_words import changes_act, is_subordinate

_JOINTS = re.compile(
    r"(?:\s*[,;])?\s+(?:and then|then|and|&{1,2}|\+)\s+|\s*[;,]\s*(?:(?:and then|then|and)\s+)?|\.\s+(?=[A-Z])",
    re.IGNORECASE,
)
_PLURAL = re.compile(r"\b[a-z]+es\b")
_OBSERVED = re.compile(
    r"\W*(?:you|i|we|he|she|it|they)(?: can| could)? (?:see|sees|saw|hear|hears|notice|notices)\b", re.IGNORECASE
)
"""A sentence about a person's observation asks for nothing."""

_MINE = r"(?:the|these|those|my|your|his|her|their)"
_TWO_TOOLS = re.compile(r" (?:with|using) (?:[a-z]+ ){1,3}and [a-z]+(?: [a-z]+)?$", re.IGNORECASE)
"""Two tools of one act, `with soap and water`."""

_CLAUSES = 12


def asked_steps(known: Knowledge, words: str, said: Sequence[Mentioned], fuzzy: Fuzzy) -> tuple[Asked, ...]:
    """Return the steps that a line asks for; none where a clause of it is not understood.

    Args:
        known: the grammar.
        words: the line.
        said: the steps before, the last first.
        fuzzy: how far from known words a clause may be; off takes exact readings only.
    """
    if (plain := plain_step(known, words)) and not _is_about_said(known, words, plain[0].meant, said):
        return plain
    if _OBSERVED.match(words):
        return ()
    words = verb_phrase(" ".join(_plurals_of_said(known, words, said).split()))
    whole = clause_steps(known, words, said, Fuzzy.OFF)
    if whole:
        return whole
    clauses = _clauses(words)
    if 1 < len(clauses) <= _CLAUSES and (joined := _joined(known, clauses, said, fuzzy)):
        return joined
    is_one = len(clauses) == 1 or _TWO_TOOLS.search(words) is not None
    return clause_steps(known, words, said, fuzzy) if is_one and fuzzy is not Fuzzy.OFF else ()


@lru_cache(maxsize=65_536)
def plain_step(known: Knowledge, words: str) -> tuple[Asked, ...]:
    """Return the step of a line that reads exactly, whatever was said before: without pronoun and double plural."""
    if _OBSERVED.match(words) or has_pronoun(words) or _double_plurals(known, words) or is_carrying(words):
        return ()
    meant = understand_exactly(known, words).meant
    return (Asked(meant),) if meant else ()


def _is_about_said(known: Knowledge, words: str, meant: Candidate, said: Sequence[Mentioned]) -> bool:
    """Return whether a line that reads by itself may mean something else after the steps before it."""
    if not said:
        return False
    many = numbers(said)
    return any(name in many for name in meant.names) or any(_is_said(each, said) for each in may_repeat(known, words))


def depends(known: Knowledge, words: str) -> frozenset[str]:
    """Return the classes which change what a line means where they were said before; the empty one always does."""
    return may_repeat(known, words) | ({""} if STAYS.match(words) else frozenset())


def _plurals_of_said(known: Knowledge, words: str, said: Sequence[Mentioned]) -> str:
    """Return a line in which a plural that has a meaning of its own is many of a thing said before, as two
    `glasses` are.
    """
    for plural, own, singular, many in _double_plurals(known, words) if said else ():
        if _is_said(many, said) and not _is_said(own, said):
            before, one = (rf"(?:{_MINE} )?", f"each {singular}") if many in numbers(said) else ("", singular)
            words = re.sub(rf"\b(?<!both ){before}{plural}\b", one, words, flags=re.IGNORECASE)
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
    at, speaks = 0, has_pronoun(words)
    while at < len(clauses) <= _CLAUSES:
        now = (
            each.mentioned if isinstance(each, Asked) else unread(known, each)
            for each in reversed(found)
            if speaks or isinstance(each, Asked)
        )
        before = (*filter(None, now), *said)
        if found and isinstance(found[-1], Asked) and stays(known, clauses[at], before):
            found[-1:] = _with_left_out((found[-1],), clauses[at : at + 1])
            at += 1
            continue
        read, size = _longest(known, clauses[at:], before, fuzzy)
        found += read or (clauses[at],)
        at += size
    others = [each for each in found if isinstance(each, str)]
    return () if len(others) == len(found) or any(changes_act(each.lower()) for each in others) else tuple(found)


def _longest(
    known: Knowledge, clauses: list[str], said: Sequence[Mentioned], fuzzy: Fuzzy
) -> tuple[tuple[Asked, ...], int]:
    """Return the steps of the most clauses from the first on that are read together, and how many they are.

    At least 1.
    """
    for size in range(len(clauses), 1, -1):
        if read := _listed(known, clauses[:size], said):
            return read, size
    return clause_steps(known, clauses[0], said, fuzzy), 1


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
        if first := first_act(known, clauses[0], said):
            now = (*(each.mentioned for each in reversed(first)), *said)
            return (*first, *rest) if (rest := _joined(known, clauses[1:], now, fuzzy)) else ()
        spoken = (Mentioned("", (thing,)) for thing in things_in(known, clauses[0].lower()))
        return _without_first(clauses[0], _joined(known, clauses[1:], (*spoken, *said), fuzzy))
    for size in range(1, len(clauses) + 1):
        read = clause_steps(known, clauses[0], said, fuzzy) if size == 1 else _listed(known, clauses[:size], said)
        if not read:
            continue
        if size == len(clauses):
            return read
        now = (*(each.mentioned for each in reversed(read)), *said)
        end = size
        while end < len(clauses) and STAYS.match(clauses[end]) and stays(known, clauses[end], now):
            end += 1
        read = _with_left_out(read, clauses[size:end]) if end > size else read
        if end == len(clauses):
            return read
        if rest := _joined(known, clauses[end:], now, fuzzy):
            return (*read, *rest)
    return ()


def _with_left_out(read: tuple[Asked, ...], clauses: Sequence[str]) -> tuple[Asked, ...]:
    """Return the steps of a line, the last without the clauses behind it."""
    left_out = ", ".join(filter(None, (read[-1].left_out, *clauses)))
    return (*read[:-1], read[-1]._replace(left_out=left_out))


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
        read = clause_steps(known, f"{verb} {each} {tail}".strip(), said, Fuzzy.OFF)
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
    return thing_of(known, _uncounted(words.split())) is not None and not BETWEEN.search(words)


def _uncounted(words: Sequence[str]) -> str:
    return COUNT.sub("", " ".join(words).lower())
