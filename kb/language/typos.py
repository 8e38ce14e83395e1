"""Typos: sentences with their misspelled words corrected. A word that is English is never corrected."""

from functools import lru_cache
from itertools import islice, product

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.english_lexicon import inflections, is_english

_SHORTEST = 4
_USUAL = {"second", "seconds", "minute", "minutes", "hour", "hours", "until", "with", "from", "into", "onto", "then"}
"""Words around those of actions and objects."""

_SMALL = {
    "teh": "the",
    "hte": "the",
    "thw": "the",
    "adn": "and",
    "nad": "and",
    "ot": "to",
    "wiht": "with",
    "fomr": "from",
}
"""Usual misspellings of the words that are too short to be corrected."""

_LONG = 7
_MOST = 32


def corrected(known: Knowledge, text: str) -> tuple[tuple[str, ...], ...]:
    """Return the sentences that one may have meant to type, in groups from the fewest edits to the most.

    Each word is corrected by itself: by one edit (a letter more, less or other, or two that changed places) in words of
    4 to 6 letters, by up to two in longer ones. Nothing is returned where a word has no correction.
    """
    choices = [_choices(known, word) for word in text.split()]
    if not all(choices):
        return ()
    found: dict[int, list[str]] = {}
    for chosen in islice(product(*choices), _MOST):
        found.setdefault(sum(edits for edits, _ in chosen), []).append(" ".join(word for _, word in chosen))
    return tuple(tuple(found[edits]) for edits in sorted(found))


def near_words(known: Knowledge, word: str) -> tuple[str, ...]:
    """Return the words of ours that a word may be when it is misspelled; itself if it is right."""
    return tuple(spelt for _, spelt in _choices(known, word))


@lru_cache(maxsize=65_536)
def _choices(known: Knowledge, word: str) -> tuple[tuple[int, str], ...]:
    """Return the words that one may be, with the number of edits; itself if it is right."""
    from rapidfuzz import process
    from rapidfuzz.distance import OSA

    words = _words(known)
    if word in _SMALL:
        return ((1, _SMALL[word]),)
    if not word.isalpha() or is_english(word):
        return ((0, word),)
    if len(word) < _SHORTEST:
        turned = tuple((1, known) for known in words if len(known) == len(word) and _is_turned(word, known))
        return turned or ((0, word),)
    allowed = 1 if len(word) < _LONG else 2
    near = process.extract(word, words, scorer=OSA.distance, limit=None, score_cutoff=allowed)
    return tuple(sorted((int(edits), spelt) for spelt, edits, _ in near if len(spelt) >= _SHORTEST))


def _is_turned(word: str, known: str) -> bool:
    """Return whether two letters of a word changed places: `dgo`."""
    return any(word[:n] + word[n + 1] + word[n] + word[n + 2 :] == known for n in range(len(word) - 1))


@lru_cache(maxsize=8)
def _words(known: Knowledge) -> dict[str, str]:
    """All words of actions and objects, and the names of objects run together."""
    said = [words for action in known.actions.values() for words in (action.template, *action.words)]
    names = [name for thing in known.objects for name in known.same_class(thing)]
    words = {word for text in (*said, *names) for word in text.lower().replace("_", " ").split() if "{" not in word}
    words |= {form for word in words if word.isalpha() for form in inflections(word)}
    return {word: word for word in sorted(words | _USUAL | set(known.object_spellings))}
