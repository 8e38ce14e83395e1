"""Nouns said again without what stood before them: after `the dog food`, `the food` is the dog food."""

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.english_lexicon import noun_lemmas
from hearth.kb.language.noun_phrases import thing_of
from hearth.kb.language.pronouns import Mentioned

_LONGEST = 3
_ARTICLES = frozenset(("the", "this", "that", "these", "those", "my", "your", "his", "her", "their", "our"))
_THE = f"(?:{'|'.join(sorted(_ARTICLES))})"
_NAMED = re.compile(rf"\b({_THE}) ([a-z]+)\b(?:(?= ([a-z]+))|(?=[^ ]|$))", re.IGNORECASE)
_WITHIN = frozenset(
    ("for", "of", "in", "on", "with", "to", "at", "from", "the", "a", "an", "and", "into", "onto", "up")
)
"""Words that are in no compound: the head of `basket for clothes` is not `clothes`."""

_GRAB = "Grab"
_NONE: frozenset[str] = frozenset()


def said_before(known: Knowledge, words: str, said: Sequence[Mentioned]) -> tuple[str, dict[str, list[str]]]:
    """Return a clause in which a noun that ends a compound said before is that compound, and the nouns of several.

    A thing that was said by the noun itself keeps it, and so does what is grabbed: nothing is grabbed twice.

    Args:
        known: the grammar.
        words: the clause.
        said: the steps before, the last first.
    """
    several: dict[str, list[str]] = {}
    for the, noun, classes in _nouns(known, words):
        if not any(name in classes for each in said for name in each.names):
            continue
        found = _compounds_of(known, noun.lower(), said)
        if len(found) > 1:
            several[noun] = sorted(found.values())
        for name, phrase in found.items() if len(found) == 1 else ():
            full = f"{phrase.rpartition(' ')[0]} {noun}"
            if not _is_grabbed_again(known, words, name, said):
                words = re.sub(rf"\b{the} {noun}\b", f"{the} {full}", words, count=1)
    return words, several


@lru_cache(maxsize=65_536)
def _nouns(known: Knowledge, words: str) -> tuple[tuple[str, str, frozenset[str]], ...]:
    """Return the nouns of a clause that may end a compound said before: article, noun, and the classes of compounds."""
    found = []
    for the, noun, after in _NAMED.findall(words):
        if after and thing_of(known, f"{noun} {after}".lower()):
            continue
        heads = _singular(noun.lower())
        classes = frozenset(name for head in heads for name in _by_head(known).get(head, ()))
        own = thing_of(known, noun.lower())
        if classes - {own}:
            found.append((the, noun, classes - {own}))
    return tuple(found)


def _is_grabbed_again(known: Knowledge, words: str, name: str, said: Sequence[Mentioned]) -> bool:
    from hearth.kb.language.step_understanding import understand_exactly

    meant = understand_exactly(known, words).meant
    last = next((each for each in said if name in each.names), None)
    return meant is not None and last is not None and meant.action.name == last.action == _GRAB


def _compounds_of(known: Knowledge, noun: str, said: Sequence[Mentioned]) -> dict[str, str]:
    """Return the classes said before in compounds that end in a noun, with these; none where it was said itself."""
    own = thing_of(known, noun)
    if own is not None and any(own in each.names for each in said):
        return {}
    lemmas = {noun, *noun_lemmas(noun)}
    found: dict[str, str] = {}
    for each in said:
        for head, name, phrase in _compounds(known, each.words.lower(), each.names):
            if name != own and not lemmas.isdisjoint((head, *noun_lemmas(head))):
                found.setdefault(name, phrase)
    return found


@lru_cache(maxsize=4096)
def _compounds(known: Knowledge, words: str, names: tuple[str, ...]) -> tuple[tuple[str, str, str], ...]:
    """Return the head, the class and the words of each compound in a line.

    The names of classes are compounds, too.
    """
    tokens = [token for each in words.split() if (token := each.strip(".,;:!?\"'()"))]
    found = []
    for at in range(len(tokens)):
        for size in range(2, min(_LONGEST, len(tokens) - at) + 1):
            phrase = tokens[at : at + size]
            name = thing_of(known, " ".join(phrase)) if _WITHIN.isdisjoint(phrase) else None
            if name in names:
                found.append((phrase[-1], name, " ".join(phrase)))
    spelt = ((name, name.replace("_", " ")) for name in names if "_" in name)
    return (*found, *((phrase.rpartition(" ")[2], name, phrase) for name, phrase in spelt))


def _singular(noun: str) -> set[str]:
    """Return what may be the singular of a noun, and the noun; most lines need no lexicon for more."""
    return {noun, noun.removesuffix("s"), noun.removesuffix("es")}


def may_repeat(known: Knowledge, words: str) -> frozenset[str]:
    """Return the classes that nouns of a line may mean where a compound of them was said before."""
    nouns = () if _ARTICLES.isdisjoint(words.lower().split()) else _nouns(known, words)
    return frozenset().union(*(classes for _, _, classes in nouns)) if nouns else _NONE


@lru_cache(maxsize=8)
def _by_head(known: Knowledge) -> Mapping[str, frozenset[str]]:
    """Return the classes that have a compound as a name, by its last word in the singular."""
    found: dict[str, set[str]] = {}
    for name, head in _heads(known):
        for word in _singular(head):
            found.setdefault(word, set()).add(name)
    return {head: frozenset(names) for head, names in found.items()}


def _heads(known: Knowledge) -> Iterator[tuple[str, str]]:
    for name in known.objects:
        for spelt in known.same_class(name):
            words = spelt.replace("_", " ").split()
            if len(words) > 1:
                yield name, words[-1]
