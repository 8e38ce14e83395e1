"""Language understanding: the step that a sentence means, with a score and alternatives."""

import re
from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Action
from hearth.kb.language.english_lexicon import verb_lemmas
from hearth.kb.language.idioms import is_exchange, is_idiom
from hearth.kb.language.noun_phrases import is_taken_from, thing_of
from hearth.kb.language.phrasings import phrasings
from hearth.kb.language.reading_modes import Fuzzy
from hearth.kb.language.sentence_openings import verb_phrase
from hearth.kb.language.step_phrases import Parse, parses, say
from hearth.kb.language.suggestions import hints
from hearth.kb.language.typos import corrected
from hearth.kb.spelling import key_of
from hearth.schemas.short_repr import brief

ACCEPTED = 0.75
"""The similarity from which the nearest valid instruction is accepted as the meaning where `fuzzy` is loose."""

MARGIN = 0.03
"""The least difference between the best and the second similarity; below it a sentence is ambiguous."""

_WEAK = 0.5
_HEADS = 8
_NAMES = 4
_SHOWN = 3
_GRAB = "Grab"
_TAKES = "takes"
_POINTED = re.compile(r"point(?:s|ing|ed)? (?!at |to ).+ (?:at|to|towards?) .+")
"""A thing is pointed at another; only the other is an object of the step."""

_OTHERWISE = {"take": "sit", "have": "sit", "insert": "put"} | dict.fromkeys(("hop", "climb", "jump", "crawl"), "get")
"""Verbs that mean the act of another: a seat is taken to sit, and one climbs out of bed as one gets out of it."""

_ARTICLE = re.compile(r"\b(?:the|a|an|some|my|your|his|her|their)\b ")


class Candidate(NamedTuple):
    """A valid instruction that a sentence may mean, and its similarity: 1 for an exact paraphrase."""

    score: float
    action: Action
    names: tuple[str, ...]

    def __repr__(self) -> str:
        return brief(self)


class Understood(NamedTuple):
    """The meaning of a sentence.

    Attributes:
        meant: the step; None where no reading is allowed or several are equally near.
        candidates: the readings, or the steps that may be meant where there is none, best first.
        ambiguous: whether several readings are equally near.
        unknown: a word that names neither a known action nor a known object; empty where there are candidates.
        is_action: whether that word is a verb.
    """

    meant: Candidate | None
    candidates: tuple[Candidate, ...]
    ambiguous: bool = False
    unknown: str = ""
    is_action: bool = False

    def __repr__(self) -> str:
        return brief(self)


@lru_cache(maxsize=65_536)
def understand(knowledge: Knowledge, sentence: str, fuzzy: Fuzzy = Fuzzy.TYPOS) -> Understood:
    """Return the instruction a sentence means.

    Templates, synonyms, inflections and usual phrasings score 1. Then misspelled words are corrected, unless `fuzzy` is
    off; a word that is English is never taken for another. With `loose`, the valid instruction whose spelling is
    nearest is accepted. What else is said means nothing; its candidates are steps with the same verb about things that
    may be meant, as `hints` finds them.

    Examples:
        >>> meant = hearth.understand(known, "Then turn on the TV").meant
        >>> meant.action.name, meant.names, meant.score
        ('SwitchOn', ('television',), 1.0)
    """
    read = understand_exactly(knowledge, sentence)
    if read.candidates:
        return read
    cleaned = _cleaned(sentence)
    if fuzzy is not Fuzzy.OFF:
        read = _without_typos(knowledge, cleaned)
    if read.candidates:
        return read
    near = _nearest(knowledge, cleaned) if fuzzy is Fuzzy.LOOSE else ()
    if near and near[0].score >= ACCEPTED:
        is_sure = len(near) < 2 or near[0].score - near[1].score >= MARGIN
        return Understood(near[0] if is_sure else None, near, not is_sure)
    hint = hints(knowledge, cleaned)
    steps = tuple(Candidate(_similar(cleaned, say(*step)), *step) for step in hint.steps)
    return Understood(None, steps, False, hint.unknown, hint.is_action)


@lru_cache(maxsize=65_536)
def understand_exactly(knowledge: Knowledge, sentence: str) -> Understood:
    """Return the meaning of a sentence by templates, synonyms, inflections and usual phrasings; no near candidates."""
    cleaned = _cleaned(sentence)
    exact = _exact(knowledge, cleaned)
    if not exact or not _afforded(knowledge, (exact[0].action, exact[0].names)):
        otherwise = _exact_otherwise(knowledge, cleaned, is_inflected=not exact)
        if not exact or (otherwise.meant and _afforded(knowledge, (otherwise.meant.action, otherwise.meant.names))):
            return otherwise
    return Understood(exact[0], exact)


def _exact_otherwise(knowledge: Knowledge, text: str, *, is_inflected: bool = True) -> Understood:
    """Return the reading of a sentence by its inflections and usual phrasings.

    Several where its places may be either's.
    """
    read = _readings(knowledge, text, is_inflected=is_inflected)
    sure = [parse for parse in read if _afforded(knowledge, parse)]
    found = tuple(Candidate(1.0, *parse) for parse in sure or read)[:_SHOWN]
    is_sure = len({each.action.arity for each in found}) < 2 and len({each.names for each in found}) < 2
    return Understood(found[0] if found and is_sure else None, found, bool(found) and not is_sure)


def _readings(knowledge: Knowledge, text: str, *, is_inflected: bool = True) -> tuple[Parse, ...]:
    """Return the steps that some words mean when the things in them are read as `thing_of` does, the likeliest first.

    Where no wording is of things that afford the act, the first with the same verb counts, as in exact readings, and
    that of a verb which means no other act.
    """
    unlikely: tuple[Parse, ...] = ()
    first = text.partition(" ")[0]
    for phrasing in (text, *phrasings(knowledge, text, is_inflected=is_inflected)):
        found = (_with_things(knowledge, parse) for parse in _acts(knowledge, phrasing))
        read = tuple(dict.fromkeys(parse for parse in found if parse))
        if any(_afforded(knowledge, parse) for parse in read):
            return read
        if read and not unlikely and _is_same_verb(first, phrasing.partition(" ")[0]):
            unlikely = read
    return unlikely[:1]


def _is_same_verb(said: str, verb: str) -> bool:
    """Return whether a verb is the one that was said, or one that means no other act; forms need the lexicon."""
    lemmas = (said,) if verb in (said, _OTHERWISE.get(said)) else (said, *verb_lemmas(said))
    return verb in lemmas or verb in map(_OTHERWISE.get, lemmas)


def _with_things(knowledge: Knowledge, parse: Parse) -> Parse | None:
    """Return a parse with classes for its things; where a thing is taken from means nothing to other acts."""
    action, names = parse
    said = [name.replace("_", " ") for name in names]
    if action.name not in knowledge.group(_TAKES) and any(is_taken_from(knowledge, each) for each in said):
        return None
    things = [thing_of(knowledge, each) for each in said]
    return (action, tuple(thing for thing in things if thing)) if all(things) else None


def _without_typos(knowledge: Knowledge, text: str) -> Understood:
    """Return the readings of the sentence with the fewest letters corrected."""
    for sentences in corrected(knowledge, text):
        found: dict[tuple[str, tuple[str, ...]], Candidate] = {}
        unlikely = dict(found)
        for sentence in sentences:
            exact = _exact(knowledge, sentence)[:1]
            for each in exact or _exact_otherwise(knowledge, sentence).candidates:
                spelt = Candidate(min(_similar(text, sentence), 0.999), each.action, each.names)
                if _afforded(knowledge, (each.action, each.names)):
                    found.setdefault((each.action.name, each.names), spelt)
                elif exact:
                    unlikely.setdefault((each.action.name, each.names), spelt)
        found = found or unlikely
        if found:
            near = tuple(sorted(found.values(), key=lambda each: -each.score))
            return Understood(near[0] if len(near) == 1 else None, near[:_SHOWN], len(near) > 1)
    return Understood(None, ())


def _nearest(knowledge: Knowledge, text: str) -> tuple[Candidate, ...]:
    found = tuple(sorted(_near(knowledge, text), key=lambda each: (-each.score, each.action.id, each.names)))
    near = tuple({(each.action.name, each.names): each for each in reversed(found)}.values())
    return tuple(sorted(near, key=lambda each: -each.score))[:_SHOWN]


def _cleaned(sentence: str) -> str:
    return " ".join(verb_phrase(sentence).lower().replace("_", " ").split())


def _exact(knowledge: Knowledge, text: str) -> tuple[Candidate, ...]:
    """Return the exact paraphrases about known objects; those that afford the action first."""
    known = [parse for parse in _acts(knowledge, text) if all(map(knowledge.object_class, parse[1]))]
    known.sort(key=lambda parse: not _afforded(knowledge, parse))
    return tuple(Candidate(1.0, *parse) for parse in known[:_SHOWN])


def _acts(knowledge: Knowledge, text: str) -> tuple[Parse, ...]:
    """Return the steps that some words mean; what an idiom takes, as in `take a shower`, is not grabbed."""
    if _POINTED.fullmatch(text) or is_exchange(text):
        return ()
    found = (parse for parse in parses(knowledge, text) if parse[0].name != _GRAB or not is_idiom(text))
    return tuple(found)


def _afforded(knowledge: Knowledge, parse: Parse) -> bool:
    action, names = parse
    return all(knowledge.affords(action.name, place, name) for place, name in enumerate(names))


class _Paraphrase(NamedTuple):
    """A paraphrase of an action: the words before its first object and between its objects."""

    head: str
    between: str
    action: Action


@lru_cache(maxsize=8)
def _paraphrases(knowledge: Knowledge) -> dict[str, tuple[_Paraphrase, ...]]:
    """Paraphrases by their first words, so that each beginning is compared once."""
    found: dict[str, list[_Paraphrase]] = {}
    for action in knowledge.actions.values():
        templates = [action.template.lower(), *(f"{words} {{0}}" if action.arity else words for words in action.words)]
        tail = action.template.lower().partition("{0}")[2].strip()
        for template in templates:
            head, _, rest = template.partition("{0}")
            between = (rest.strip() or tail if action.arity > 1 else "").replace("{1}", "").strip()
            found.setdefault(head.strip(), []).append(_Paraphrase(head.strip(), between, action))
    return {head: tuple(dict.fromkeys(alike)) for head, alike in found.items()}


def _near(knowledge: Knowledge, text: str) -> Iterator[Candidate]:
    from rapidfuzz import process
    from rapidfuzz.distance import Levenshtein

    words = text.split()
    paraphrases = _paraphrases(knowledge)
    for size in range(1, min(4, len(words)) + 1):
        guess, rest = " ".join(words[:size]), " ".join(words[size:])
        scorer = Levenshtein.normalized_similarity
        heads = process.extract(guess, list(paraphrases), scorer=scorer, limit=_HEADS, score_cutoff=_WEAK)
        for head, _, _ in heads:
            for paraphrase in paraphrases[head]:
                yield from _filled(knowledge, text, paraphrase, rest)


def _filled(knowledge: Knowledge, text: str, paraphrase: _Paraphrase, rest: str) -> Iterator[Candidate]:
    """Yield a paraphrase with the known objects nearest to the words that follow."""
    if paraphrase.action.arity == 0:
        yield Candidate(_similar(text, paraphrase.head), paraphrase.action, ())
        return
    parts = [rest] if paraphrase.action.arity == 1 else [*map(str.strip, rest.split(f" {paraphrase.between} ", 1))]
    if len(parts) != paraphrase.action.arity:
        return
    guesses = [_objects(knowledge, _ARTICLE.sub("", f"{part} ").strip()) for part in parts]
    if not all(guesses):
        return
    for first in guesses[0]:
        for second in guesses[1] if len(guesses) > 1 else [None]:
            chosen = [first, *([second] if second else [])]
            names = tuple(name for _, name in chosen)
            objects = f" {paraphrase.between} ".join(spelt for spelt, _ in chosen)
            if _afforded(knowledge, (paraphrase.action, names)):
                yield Candidate(_similar(text, f"{paraphrase.head} {objects}"), paraphrase.action, names)


def _similar(text: str, phrase: str) -> float:
    from rapidfuzz.distance import Levenshtein

    one, other = (key_of(_ARTICLE.sub("", each)) for each in (text, phrase))
    return round(Levenshtein.normalized_similarity(one, other), 3)


@lru_cache(maxsize=65_536)
def _objects(knowledge: Knowledge, words: str) -> tuple[tuple[str, str], ...]:
    """Return the known objects whose names are spelt most like the words, as (spelling, class)."""
    from rapidfuzz import process
    from rapidfuzz.distance import Levenshtein

    thing = knowledge.object_class(words)
    if thing:
        return ((words, thing.name),)
    names = knowledge.object_spellings
    scorer = Levenshtein.normalized_similarity
    close = process.extract(key_of(words), list(names), scorer=scorer, limit=_NAMES, score_cutoff=_WEAK)
    return tuple((key, names[key]) for key, _, _ in close)
