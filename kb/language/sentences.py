"""Sentences: the steps that one line asks for, which may join several clauses, count things and speak of `it`."""

import re
from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.adjectives import without_adjective
from hearth.kb.language.fuzzy import Fuzzy
from hearth.kb.language.lexicon import is_verb, noun_lemmas
from hearth.kb.language.openings import verb_phrase
from hearth.kb.language.things import thing_of
from hearth.kb.language.trailing import changes_act, shortened
from hearth.kb.language.understanding import Candidate, Understood, understand, understand_exactly
from hearth.schemas.program import Step

_JOINTS = re.compile(
    r"(?:\s*[,;])?\s+(?:and then|then|and|&{1,2}|\+)\s+|\s*[;,]\s*(?:(?:and then|then|and)\s+)?|\.\s+(?=[A-Z])",
    re.IGNORECASE,
)
_PRONOUN = re.compile(r"\b(?:it|them|her|him)\b", re.IGNORECASE)
_THINGS = re.compile(r"\b(?:it|them)\b", re.IGNORECASE)
_PEOPLE = re.compile(r"\b(?:her|him)\b(?=$| (?:on|in|to|with|at)\b)", re.IGNORECASE)
_PLURAL = re.compile(r"\b[a-z]+es\b")
_OBSERVED = re.compile(
    r"\W*(?:you|i|we|he|she|it|they)(?: can| could)? (?:see|sees|saw|hear|hears|notice|notices)\b", re.IGNORECASE
)
"""A sentence about a person's observation asks for nothing."""

_INSIDE = re.compile(r"((?:put|place|drop|set|lay|store)(?:s|ing|ped)?(?: back)? .+?)(?: back)? inside", re.IGNORECASE)
_CLOSING = re.compile(r"(?:close|shut)\b", re.IGNORECASE)
_PERSON = "PERSON"
REMEMBERED = 6
"""Steps of which a pronoun may speak."""

_NUMBERS = ("two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")
_COUNTS = {"both": 2} | {name: n for n, name in enumerate(_NUMBERS, 2)} | {str(n): n for n in range(2, 11)}
_COUNT = re.compile(rf"\b({'|'.join(_COUNTS)})\s+(?:of\s+)?(?:the\s+|my\s+|your\s+)?(?=[a-z])", re.IGNORECASE)
_BETWEEN = re.compile(r"\b(?:in|on|into|onto|with|to|at|inside)\b", re.IGNORECASE)
_LEFT_OUT = 3
_CLAUSES = 12


Mentioned = tuple[str, tuple[str, ...]]
"""A step that was said before: its action and its things."""


class Asked(NamedTuple):
    """A step that a sentence asks for.

    Attributes:
        meant: the step.
        instance: the number of its first thing; two forks are fork 1 and fork 2.
        left_out: words of the sentence that are left out of the step.
    """

    meant: Candidate
    instance: int = 1
    left_out: str = ""

    @property
    def fuzzy(self) -> bool:
        """Return whether words were corrected or left out."""
        return self.meant.score < 1 or bool(self.left_out)


def asked_steps(known: Knowledge, words: str, said: Sequence[Mentioned], fuzzy: Fuzzy) -> tuple[Asked, ...]:
    """Return the steps that a line asks for; none where a clause of it is not understood.

    Args:
        known: the grammar.
        words: the line.
        said: the steps before, the last first, as `said_by` gives them.
        fuzzy: how far from known words a clause may be; off takes exact readings only.
    """
    if _OBSERVED.match(words):
        return ()
    if plain := _plain(known, words):
        return plain
    words = verb_phrase(" ".join(_plurals_of_said(known, words, said).split()))
    whole = _clause(known, words, said, Fuzzy.OFF)
    if whole:
        return whole
    clauses = _clauses(words)
    if 1 < len(clauses) <= _CLAUSES and (joined := _joined(known, clauses, said, fuzzy)):
        return joined
    return _clause(known, words, said, fuzzy) if len(clauses) == 1 and fuzzy is not Fuzzy.OFF else ()


@lru_cache(maxsize=65_536)
def _plain(known: Knowledge, words: str) -> tuple[Asked, ...]:
    """The step of a line that reads exactly, whatever was said before: without pronoun and without double plural."""
    if _PRONOUN.search(words) or _double_plurals(known, words):
        return ()
    meant = understand_exactly(known, words).meant
    return (Asked(meant),) if meant else ()


def _plurals_of_said(known: Knowledge, words: str, said: Sequence[Mentioned]) -> str:
    """A line in which a plural that has a meaning of its own is many of a thing said before, as two `glasses` are."""
    for plural, own, singular, many in _double_plurals(known, words) if said else ():
        if _is_said(many, said) and not _is_said(own, said):
            words = re.sub(rf"\b{plural}\b", singular, words, flags=re.IGNORECASE)
    return words


def _double_plurals(known: Knowledge, words: str) -> list[tuple[str, str, str, str]]:
    """The plurals in a line that are classes of their own, with their class, their singular, and its class."""
    found = []
    for plural in _PLURAL.findall(words.lower()):
        singular = plural.removesuffix("es")
        own, many = known.object_class(plural), known.object_class(singular)
        if own and many and own.name != many.name:
            found.append((plural, own.name, singular, many.name))
    return found


def _is_said(name: str, said: Sequence[Mentioned]) -> bool:
    return any(name in names for _, names in said)


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
        now = tuple((each.meant.action.name, each.meant.names) for each in reversed(found) if isinstance(each, Asked))
        read, size = _longest(known, clauses[at:], (*now, *said), fuzzy)
        found += read or (clauses[at],)
        at += size
    unread = [each for each in found if isinstance(each, str)]
    return () if len(unread) == len(found) or any(changes_act(each.lower()) for each in unread) else tuple(found)


def _longest(
    known: Knowledge, clauses: list[str], said: Sequence[Mentioned], fuzzy: Fuzzy
) -> tuple[tuple[Asked, ...], int]:
    """The steps of the most clauses from the first on that are read together, and how many they are; at least 1."""
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
    return understand(known, next(_referred(known, words, said), words), fuzzy)


def said_by(steps: Sequence[Step]) -> tuple[Mentioned, ...]:
    """Return the last steps, the last first, as pronouns need them."""
    return tuple((step.action, tuple(ref.name for ref in step.objects)) for step in reversed(steps[-REMEMBERED:]))


def _joined(known: Knowledge, clauses: list[str], said: Sequence[Mentioned], fuzzy: Fuzzy) -> tuple[Asked, ...]:
    """The steps of clauses one after another; what shares a verb, as `grab a cup and a plate`, is read together."""
    for size in range(1, len(clauses) + 1):
        read = _clause(known, clauses[0], said, fuzzy) if size == 1 else _listed(known, clauses[:size], said)
        if read and size == len(clauses):
            return read
        if read:
            now = ((each.meant.action.name, each.meant.names) for each in reversed(read))
            if rest := _joined(known, clauses[size:], (*now, *said), fuzzy):
                return (*read, *rest)
    return ()


def _listed(known: Knowledge, parts: list[str], said: Sequence[Mentioned]) -> tuple[Asked, ...]:
    """The steps of one verb for several things: `put the cup`, `the plate on the table`."""
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
    """The steps of one clause: exact, else with words left out, else with misspelled words corrected."""
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
        for clause in _referred(known, shorter, said):
            meant = understand(known, clause, Fuzzy.TYPOS).meant
            if meant and (clause == shorter or _affords(known, meant)):
                return (Asked(meant, left_out=out),)
    return ()


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
    """The exact reading of a clause, of as many things as it counts; `it` is the last thing that affords it."""
    words = _inside_of(words, said)
    found = (understand_exactly(known, clause).meant for clause in _referred(known, words, said))
    readings = [each for each in found if each and (len(each.names) < 2 or each.names[0] != each.names[1])]
    if len(readings) == 1:
        return (Asked(readings[0]),)
    if readings:
        afforded = (each for each in readings if _affords(known, each))
        return (Asked(next(afforded, readings[0])),)
    count = _COUNT.search(words)
    if not count or not count.start() or _BETWEEN.search(words[: count.start()].partition(" ")[2]):
        return ()
    meant = _of_one(known, words[: count.start()], words[count.end() :])
    if meant is None or not meant.names:
        return ()
    return tuple(Asked(meant, number) for number in range(1, _COUNTS[count[1].lower()] + 1))


def _inside_of(words: str, said: Sequence[Mentioned]) -> str:
    """`Put it inside` with the thing that was opened last."""
    put = _INSIDE.fullmatch(words)
    opened = next((names[0] for action, names in said if action == "Open"), None) if put else None
    return f"{put[1]} inside {opened.replace('_', ' ')}" if put and opened else words


def _of_one(known: Knowledge, before: str, counted: str) -> Candidate | None:
    """The step for one of the things that are counted: two `glasses` are glasses to drink from, not spectacles."""
    noun, space, after = counted.partition(" ")
    singular = (lemma for lemma in noun_lemmas(noun.lower()) if lemma != noun and thing_of(known, lemma))
    sentences = (f"{before}{one}{space}{after}" for one in (*singular, noun))
    return next((meant for each in sentences if (meant := understand_exactly(known, each).meant)), None)


def _affords(known: Knowledge, meant: Candidate) -> bool:
    return all(known.affords(meant.action.name, place, name) for place, name in enumerate(meant.names))


def _referred(known: Knowledge, words: str, said: Sequence[Mentioned]) -> Iterator[str]:
    """The sentence with each thing that its pronoun may stand for, the likeliest first; itself where it has none."""
    if not _PRONOUN.search(words):
        yield words
        return
    of_things, of_people = _THINGS.search(words), _PEOPLE.search(words)
    things = _spoken_of(said, is_closed=bool(_CLOSING.match(words))) if of_things or of_people else ()
    if not things:
        yield words
    for thing in things:
        name = thing.replace("_", " ")
        if of_things:
            yield _THINGS.sub(name, words)
        elif known.has(thing, _PERSON):
            yield _PEOPLE.sub(name, words)


def _spoken_of(said: Sequence[Mentioned], *, is_closed: bool) -> tuple[str, ...]:
    """The things of steps, the last first; what was opened, or holds another, comes first where something is closed."""
    opened = [name for action, names in said if is_closed and action == "Open" for name in names]
    places = [names[1] for _, names in said if is_closed and len(names) > 1]
    return tuple(dict.fromkeys((*opened, *places, *(name for _, names in said for name in names))))
