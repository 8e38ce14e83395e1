"""Phrasings: usual ways of asking for a step, beside the synonyms of actions, and the words that actions know."""

import re
from collections.abc import Iterator

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.lexicon import verb_lemmas
from hearth.kb.language.things import thing_of

_GOING = "go|walk|move|head|come|step|navigate|proceed|return|travel"
_USUAL: tuple[tuple[str, tuple[str, ...]], ...] = (
    (rf"(?:{_GOING})(?: back| over| on| up| down)? (?:to|into|inside) (.+)", ("walk to {0}",)),
    (r"(?:take|get|grab|remove|fetch|pull|pick|lift)(?: up| out)? (.+? (?:out of|out from|off of|off|from) .+)",
     ("grab {0}",)),
    (r"(?:pick|grab) (.+) up", ("grab {0}",)),
    (r"(?:take|get|pull|bring) (?:out (.+)|(.+) out)", ("grab {0}",)),
    (r"(?:turn|switch|shut) (.+) (on|off)", ("switch {1} {0}",)),
    (r"plug (.+) in", ("plug in {0}",)),
    (r"take (.+) off", ("take off {0}",)),
    (r"put (.+) on", ("put on {0}",)),
    (r"put (.+) (?:back|away)", ("put back {0}",)),
    # Nothing is said about a place: the thing is let go of where one is.
    (r"(?:put|set|lay|place) (?:down (.+)|(.+) down)", ("release {0}",)),
    (r"(?:put|place|set|lay) (.+) (?:into|inside of|inside) (.+)", ("put {0} in {1}",)),
    (r"(?:place|set|lay) (.+) in (.+)", ("put {0} in {1}",)),
    (r"(?:put|place|set|lay) (.+) (?:onto|on top of) (.+)", ("put {0} on {1}",)),
    (r"(?:put|set|lay) (.+) down (?:on|onto) (.+)", ("put {0} on {1}",)),
    (r"(?:move|bring|carry|transfer|take) (.+?) (?:on|onto|on top of) (.+)", ("put {0} on {1}",)),
    (r"(?:move|bring|carry|transfer|take) (.+?) (?:in|into|inside) (.+)", ("put {0} in {1}",)),
    (r"fill(?: up)? (.+) with (.+)", ("pour {1} into {0}",)),
    (r"pour (.+) (?:in|onto|on|over) (.+)", ("pour {0} into {1}",)),
    (r"(?:take|have) a seat (?:on|in|at) (.+)", ("sit on {0}",)),
    (r"sit (?:back )?(?:down )?(?:onto|upon) (.+)", ("sit on {0}",)),
)  # fmt: skip
_PATTERNS = tuple((re.compile(pattern), phrases) for pattern, phrases in _USUAL)


_BROUGHT = re.compile(r"(?:move|bring|carry|transfer|take) (.+?)(?: over| back)? to (.+)")
_SURFACE = "SURFACES"


def phrasings(known: Knowledge, text: str) -> Iterator[str]:
    """Yield other words for a clause: its verb without inflection, and the usual phrasings as Hearth says them.

    Args:
        known: the grammar.
        text: a clause in small letters.
    """
    first, space, rest = text.partition(" ")
    for verb in (first, *(lemma for lemma in verb_lemmas(first) if lemma != first)):
        clause = verb + space + rest
        if verb != first:
            yield clause
        for pattern, phrases in _PATTERNS:
            if match := pattern.fullmatch(clause):
                groups = [group for group in match.groups() if group is not None]
                yield from (phrase.format(*groups) for phrase in phrases)
        if (match := _BROUGHT.fullmatch(clause)) and (place := thing_of(known, match[2])):
            # What has a top takes the thing on it; else the thing is put in.
            yield f"put {match[1]} {'on' if known.has(place, _SURFACE) else 'in'} {match[2]}"
