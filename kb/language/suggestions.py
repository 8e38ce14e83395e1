"""Hints for a sentence that is not understood: the steps that may be meant, or the word that Hearth does not know."""

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from itertools import islice, product
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge, grouped
from hearth.kb.language.english_lexicon import is_english, is_noun, is_verb, noun_lemmas, verb_lemmas
from hearth.kb.language.noun_phrases import bare_words, thing_of
from hearth.kb.language.phrasings import PHRASED, phrasings
from hearth.kb.language.step_phrases import Parse, first_words, parses
from hearth.kb.language.trailing_words import changes_act
from hearth.kb.spelling import key_of

_SHOWN = 3
_MOST_WORDS = 12
_NAME_WORDS = 3
_SHORTEST_ENGLISH = 5
_SHORTEST = 4
_LONG = 7
_NAME = re.compile(r"[a-z][a-z'’-]*(?: [a-z][a-z'’-]*)*")
_TOOL = re.compile(r"(.+?) (?:with|using|by|by means of|through) (.+)")
"""A thing, and the tool with which, or the way in which, something is done to it."""

_JOINED = frozenset((
    "a", "and", "are", "at", "by", "down", "everything", "for", "from", "in", "into", "is", "it", "no", "not", "of",
    "off", "on", "onto", "or", "out", "over", "something", "that", "the", "them", "then", "this", "to", "under", "up",
    "with",
))  # fmt: skip
"""Words that are in no name of a thing."""

_OF_TWO_KINDS = frozenset(("dish",))
"""Kinds whose names mean other things as well: dishes are washed up, and are no food."""


class Hints(NamedTuple):
    """Help with a sentence that is not understood.

    Attributes:
        steps: steps with the same verb, about things that may be meant; at most three.
        unknown: a word of the sentence that names neither a known object nor a known action.
        is_action: whether that is a verb.
    """

    steps: tuple[Parse, ...] = ()
    unknown: str = ""
    is_action: bool = False


def hints(known: Knowledge, text: str) -> Hints:
    """Return the hints for a clause in small letters."""
    words = text.split()
    if not words or len(words) > _MOST_WORDS or changes_act(text):
        return Hints()
    found = [parse for phrasing in (text, *phrasings(known, text)) for parse in parses(known, phrasing)]
    if (tool := _tool_of(known, found)) and thing_of(known, tool) is None and _is_name(tool):
        return Hints(unknown=tool)
    if tool:
        found = [(action, _without_tool(names)) for action, names in found]
        if known_step := next(filter(lambda parse: _is_afforded(known, parse), found), None):
            return Hints((_with_classes(known, known_step),))
    lacking = [(action, names, _unknown(known, names)) for action, names in found]
    lacking = sorted((each for each in lacking if each[2]), key=lambda each: len(each[2]))
    steps = dict.fromkeys(step for action, names, _ in lacking for step in _steps(known, (action, names)))
    if steps:
        return Hints(tuple(islice(steps, _SHOWN)))
    nouns = (bare_words(name) for _, _, unknown in lacking for name in unknown)
    if noun := next(filter(_is_name, nouns), ""):
        return Hints(unknown=noun)
    is_act = not found and is_verb(words[0]) and thing_of(known, text) is None
    is_unknown_verb = is_act and not _is_known_verb(known, words[0])
    return Hints(unknown=words[0], is_action=True) if is_unknown_verb else Hints()


def _tool_of(known: Knowledge, found: Sequence[Parse]) -> str:
    """Return the tool with which, or the way in which, a thing is acted on; empty where a sentence has none."""
    ends = (_TOOL.fullmatch(names[-1].replace("_", " ")) for _, names in found if names)
    parts = (match for match in ends if match and (_is_name(bare_words(match[1])) or thing_of(known, match[1])))
    return next((bare_words(match[2]) for match in parts), "")


def _without_tool(names: tuple[str, ...]) -> tuple[str, ...]:
    match = _TOOL.fullmatch(names[-1].replace("_", " ")) if names else None
    return (*names[:-1], match[1]) if match else names


def _with_classes(known: Knowledge, parse: Parse) -> Parse:
    action, names = parse
    return action, tuple(thing_of(known, name.replace("_", " ")) or name for name in names)


def _is_afforded(known: Knowledge, parse: Parse) -> bool:
    action, names = _with_classes(known, parse)
    return all(
        thing_of(known, name.replace("_", " ")) and known.affords(action.name, place, name)
        for place, name in enumerate(names)
    )


def _is_known_verb(known: Knowledge, word: str) -> bool:
    verbs = {word, *verb_lemmas(word)}
    return not verbs.isdisjoint(first_words(known)) or not verbs.isdisjoint(PHRASED)


def _unknown(known: Knowledge, names: tuple[str, ...]) -> tuple[str, ...]:
    said = (name.replace("_", " ") for name in names)
    return tuple(name for name in said if thing_of(known, name) is None)


def _is_name(words: str) -> bool:
    """Return whether words are a name of a thing, and not a part of a sentence."""
    parts = words.split()
    if not parts or len(parts) > _NAME_WORDS or not _NAME.fullmatch(words) or not _JOINED.isdisjoint(parts):
        return False
    return is_noun(parts[-1]) or not is_english(parts[-1])


def _steps(known: Knowledge, parse: Parse) -> Iterator[Parse]:
    """Yield the step with each thing that an unknown name of it may mean, where the thing affords it."""
    action, names = parse
    choices = [_meant(known, name.replace("_", " ")) for name in names]
    for chosen in product(*choices):
        if all(known.affords(action.name, place, name) for place, name in enumerate(chosen)):
            yield action, chosen


@lru_cache(maxsize=4096)
def _meant(known: Knowledge, words: str) -> tuple[str, ...]:
    """Return the class that words name.

    Else those spelt alike, that which their last words name, and those of their kind or with their last word.
    """
    thing = thing_of(known, words)
    if thing:
        return (thing,)
    bare = bare_words(words)
    parts = bare.split()
    is_name = _JOINED.isdisjoint(parts)
    ends = (" ".join(parts[n:]) for n in range(1, len(parts) if is_name else 0))
    heads = (name for end in ends if (name := thing_of(known, end)))
    last = parts[-1] if is_name and parts else ""
    alike = tuple(_of_kind(known, bare)) or _of_head(known, last)
    found = (*_spelt_alike(known, bare), *islice(heads, 1), *alike)
    return tuple(dict.fromkeys(found))


def _spelt_alike(known: Knowledge, words: str) -> Iterator[str]:
    """Classes that are a typo away; a word that is English is taken for a long one with the same beginning alone."""
    from rapidfuzz import process
    from rapidfuzz.distance import OSA

    key, is_right = key_of(words), is_english(words)
    if len(key) < (_SHORTEST_ENGLISH if is_right else _SHORTEST):
        return
    allowed = 1 if is_right or len(key) < _LONG else 2
    spellings = known.object_spellings
    near = process.extract(key, list(spellings), scorer=OSA.distance, limit=None, score_cutoff=allowed)
    for spelt, _, _ in sorted(near, key=lambda each: each[1]):
        if spelt[0] == key[0] or not is_right:
            yield spellings[spelt]


@lru_cache(maxsize=8)
def _by_head(known: Knowledge) -> Mapping[str, tuple[str, ...]]:
    """Return the classes of several words by the last one, as two are counters."""
    return grouped((head, name) for name in known.objects if (head := name.rpartition("_")[2]) != name)


def _of_head(known: Knowledge, noun: str) -> tuple[str, ...]:
    """Return the classes of one kind that end with a noun which names none itself."""
    if not noun or thing_of(known, noun):
        return ()
    named = (name for each in (noun, *noun_lemmas(noun)) for name in _by_head(known).get(each, ()))
    names = tuple(dict.fromkeys(known.objects[name].same_as or name for name in named))
    return names if len({known.objects[name].hypernym for name in names}) == 1 else ()


def _of_kind(known: Knowledge, words: str) -> Iterator[str]:
    """Classes that are of the kind which words name, as forks are of cutlery."""
    kinds = {name.replace(" ", "_") for name in (words, *noun_lemmas(words))}.intersection(known.kinds)
    kinds -= _OF_TWO_KINDS
    return (name for name in known.objects if kinds.intersection(known.ancestors(name))) if kinds else iter(())
