"""Lines that are not understood: the things that they name, of which later pronouns may speak."""

from collections.abc import Sequence
from functools import lru_cache

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.english_lexicon import is_english, is_noun, is_verb
from hearth.kb.language.noun_phrases import thing_of
from hearth.kb.language.pronouns import UNREAD, Mentioned
from hearth.kb.language.sentence_openings import verb_phrase

_NO_NAMES = frozenset((
    "", "back", "bit", "down", "he", "her", "him", "hour", "hours", "i", "it", "minute", "minutes", "moment",
    "not", "off", "out", "please", "second", "seconds", "she", "sure", "that", "them", "these", "they", "this",
    "those", "time", "times", "up", "us", "we", "while", "you",
))  # fmt: skip
"""Words that the lexicon has as nouns, and that name no thing in a step."""

_LONGEST = 3
"""Words of a name at most."""

_ARTICLES = frozenset(("the", "a", "an", "some", "my", "your", "his", "her", "their", "our", "these", "those"))
_LINKS = frozenset(("about", "and", "at", "by", "for", "from", "in", "into", "of", "on", "onto", "to", "using", "with"))
_BEING = frozenset(("be", "is", "are", "was", "were", "gets", "looks", "very", "quite", "make", "until"))
"""Words before an adjective that the lexicon may have as a noun: `make sure it is warm`."""

_MARKS = ".,;:!?()[]<>\"'`*"


@lru_cache(maxsize=65_536)
def unread(known: Knowledge, words: str) -> Mentioned | None:
    """Return what a line that is not understood leaves for pronouns; None where it names no thing.

    One known thing and no other noun is what a pronoun may mean. Where the line names several things, or one that
    Hearth does not know, the mention has no thing.
    """
    text = verb_phrase(words).lower().replace("_", " ")
    tokens = [token for each in text.split() if (token := each.strip(_MARKS)) not in _NO_NAMES]
    is_order = bool(tokens) and is_verb(tokens[0])
    things, others = _things_and_others(known, tokens[is_order:])
    if len(things) == 1 and not others:
        return Mentioned(UNREAD, things, words=words)
    return Mentioned(UNREAD, (), words=words) if things or others else None


def _things_and_others(known: Knowledge, tokens: Sequence[str]) -> tuple[tuple[str, ...], list[str]]:
    """Return the classes that some words name, each once, and the words that may name something else.

    Words between an article and a thing say which one it is.
    """
    things: list[str] = []
    others: list[str] = []
    modifiers: list[str] = []
    at, is_after_article = 0, False
    while at < len(tokens):
        sizes = range(min(_LONGEST, len(tokens) - at), 0, -1)
        phrases = ((size, thing_of(known, " ".join(tokens[at : at + size]))) for size in sizes)
        size, name = next(((size, name) for size, name in phrases if name), (1, None))
        is_article = tokens[at] in _ARTICLES
        if name or is_article or tokens[at] in _LINKS:
            others += [] if name and is_after_article and not is_article else modifiers
            things += [name] if name else []
            modifiers, is_after_article = [], is_article and not name
        elif (
            tokens[at] not in _NO_NAMES and tokens[at - 1] not in _BEING and (is_after_article or _is_name(tokens[at]))
        ):
            modifiers.append(tokens[at])
        at += size
    return tuple(dict.fromkeys(things)), others + modifiers


def _is_name(word: str) -> bool:
    return word.isalpha() and (is_noun(word) or not is_english(word))
