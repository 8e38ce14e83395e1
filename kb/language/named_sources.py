"""Places from which things are taken, `the cup from the bathroom`: a step has none, so that a plan must go there."""

import re
from collections.abc import Iterator, Sequence
from functools import lru_cache

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.noun_phrases import SOURCE, thing_of
from hearth.schemas.program import Program, Step

_END = re.compile(r"[,.;!]|\s+(?:and|then|to|into|onto|in|on|with|for|using|before|after|while|when|so|if)\b")


def left_out(known: Knowledge, words: str, taken: str, before: Sequence[Step]) -> str:
    """Return a place of a line from which a thing is taken, and at which the plan is not; empty where it is there.

    A place at which the thing usually is says nothing that the home does not: `the milk from the fridge`.

    Args:
        known: the grammar.
        words: the line.
        taken: the class of the thing.
        before: the steps of the plan before the thing is taken.
    """
    if " from " not in words and " out of " not in words and " off " not in words:
        return ""
    there = _there(known, before) | {place.destination for place in known.placements(taken)}
    return next(
        (said for place, said in sources(known, words.lower()) if there.isdisjoint(known.same_class(place))), ""
    )


def sources_of_steps(known: Knowledge, program: Program, lines: Sequence[str]) -> tuple[tuple[int, str], ...]:
    """Return the steps that take a thing from a place that their line names, each with the class of the place.

    A line that names several places says of none of its steps which is meant.
    """
    takes = known.group("takes")
    found: list[tuple[int, str]] = []
    for number, step in enumerate(program.steps):
        at = program.line(number)
        named = {place for place, _ in sources(known, lines[at - 1].lower())} if 0 < at <= len(lines) else set()
        if step.action in takes and step.objects and len(named) == 1:
            found.append((number, named.pop()))
    return tuple(found)


@lru_cache(maxsize=4_096)
def sources(known: Knowledge, words: str) -> tuple[tuple[str, str], ...]:
    """Return the places from which things are taken, each with its words."""
    return tuple(_sources(known, words))


def _sources(known: Knowledge, words: str) -> Iterator[tuple[str, str]]:
    for found in SOURCE.finditer(words):
        end = _END.search(words, found.end())
        at = end.start() if end else len(words)
        if place := thing_of(known, words[found.end() : at].strip()):
            yield place, words[found.start() : at].strip()


def _there(known: Knowledge, before: Sequence[Step]) -> set[str]:
    """Return the classes of things that the plan has named since it last went to a room, and of all that it took."""
    goes, takes = known.group("goes"), known.group("takes")
    found: set[str] = set()
    is_here = True
    for step in reversed(before):
        if is_here or step.action in takes:
            found.update(ref.name for ref in step.objects)
        is_here = is_here and not (step.action in goes and any(known.is_room(ref.name) for ref in step.objects))
    return found
