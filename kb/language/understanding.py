"""Language understanding: the step that a sentence means, with a score and alternatives."""

import re
from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.phrases import Parse, parses
from hearth.kb.records import Action
from hearth.kb.spelling import key_of
from hearth.schemas.brief import brief

ACCEPTED = 0.75
"""The similarity from which the nearest valid instruction is accepted as the meaning."""

MARGIN = 0.03
"""The least difference between the best and the second similarity; below it a sentence is ambiguous."""

_WEAK = 0.5
_HEADS = 8
_NAMES = 4
_SHOWN = 3
_FILLER = re.compile(r"(?:then|next|first|finally|now|please|and|afterwards|after that|you|i|we)\b[\s,]*")
_ARTICLE = re.compile(r"\b(?:the|a|an|some|my|your|his|her|their)\b ")


class Candidate(NamedTuple):
    """A valid instruction that a sentence may mean, and its similarity: 1 for an exact paraphrase."""

    score: float
    action: Action
    names: tuple[str, ...]

    def __repr__(self) -> str:
        return brief(self)


class Understood(NamedTuple):
    """The meaning of a sentence; `meant` is None where no candidate is near or two are equally near."""

    meant: Candidate | None
    candidates: tuple[Candidate, ...]

    def __repr__(self) -> str:
        return brief(self)

    @property
    def ambiguous(self) -> bool:
        """Whether several candidates are near enough."""
        return self.meant is None and bool(self.candidates) and self.candidates[0].score >= ACCEPTED


@lru_cache(maxsize=65_536)
def understand(knowledge: Knowledge, sentence: str) -> Understood:
    """The instruction a sentence means.

    Templates and synonyms are tried first and score 1. For what remains, the valid instructions whose beginning and
    objects are spelt most like the sentence are compared with it by edit distance, spaces and articles left out.

    Examples:
        >>> meant = hearth.understand(known, "Then turn on the TV").meant
        >>> meant.action.name, meant.names, meant.score
        ('SwitchOn', ('television',), 1.0)
    """
    cleaned = _cleaned(sentence)
    exact = _exact(knowledge, cleaned)
    if exact:
        return Understood(exact[0], exact)
    found = tuple(sorted(_near(knowledge, cleaned), key=lambda each: (-each.score, each.action.id, each.names)))
    near = tuple({(each.action.name, each.names): each for each in reversed(found)}.values())
    near = tuple(sorted(near, key=lambda each: -each.score))[:_SHOWN]
    sure = bool(near) and near[0].score >= ACCEPTED and (len(near) < 2 or near[0].score - near[1].score >= MARGIN)
    return Understood(near[0] if sure else None, near)


def _cleaned(sentence: str) -> str:
    text = " ".join(sentence.strip().rstrip(".!;,").lower().replace("_", " ").split())
    while match := _FILLER.match(text):
        if match.end() == len(text):
            break
        text = text[match.end() :]
    return text


def _exact(knowledge: Knowledge, text: str) -> tuple[Candidate, ...]:
    """The exact paraphrases about known objects; those that afford the action first."""
    known = [parse for parse in parses(knowledge, text) if all(map(knowledge.object_class, parse[1]))]
    known.sort(key=lambda parse: not _afforded(knowledge, parse))
    return tuple(Candidate(1.0, *parse) for parse in known[:_SHOWN])


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
    """A paraphrase with the known objects nearest to the words that follow."""
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
    """The known objects whose names are spelt most like the words, as (spelling, class)."""
    from rapidfuzz import process
    from rapidfuzz.distance import Levenshtein

    thing = knowledge.object_class(words)
    if thing:
        return ((words, thing.name),)
    names = knowledge.object_spellings
    scorer = Levenshtein.normalized_similarity
    close = process.extract(key_of(words), list(names), scorer=scorer, limit=_NAMES, score_cutoff=_WEAK)
    return tuple((key, names[key]) for key, _, _ in close)
