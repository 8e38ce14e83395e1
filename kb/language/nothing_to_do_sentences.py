"""Sentences that ask for nothing, because a thing is as they say: `leave it there` after it was put down."""

import re
from collections.abc import Sequence

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.noun_phrases import thing_of
from hearth.kb.language.pronouns import PRONOUN, Mentioned, within_reach
from hearth.kb.language.sentence_openings import verb_phrase

_VERB = r"(?:leave|leaves|leaving|left|keep|keeps|let|lets)"
STAYS = re.compile(rf"(?:(?:and|then|please|just|now) )*{_VERB}\b", re.IGNORECASE)
"""The beginning of a sentence that may ask for nothing."""

_PLACE = r"(?:in|on|into|inside|on top of) (?:the |my |your )?(?P<place>.+?)"
_HOW = (
    r"(?P<there>there|here|in there|on there|inside|in it|on it)|(?P<state>on|off|open|closed|shut|plugged in)"
    rf"|alone|be|in place|as (?:it|they) (?:is|are)|where (?:it|they) (?:is|are)|{_PLACE}"
)
_STAYING = re.compile(
    rf"{_VERB} (?P<thing>.+?)"
    rf"(?: (?:stay|sit|rest|remain|stand|lie|running)s?)?(?: (?:{_HOW}))?"
    r"(?: (?:for|until|overnight|while)(?: .+)?| for now)?"
)
_STATES = {"on": "ON", "off": "OFF", "open": "OPEN", "closed": "CLOSED", "shut": "CLOSED", "plugged in": "PLUGGED_IN"}
_WAYS = "goes"


def stays(known: Knowledge, words: str, said: Sequence[Mentioned]) -> bool:
    """Return whether a clause asks that a thing stay where, or as, the last act on it has left it.

    Args:
        known: the grammar.
        words: the clause.
        said: the steps before, the last first.
    """
    if not STAYS.match(words):
        return False
    found = _STAYING.fullmatch(verb_phrase(words).lower().strip(" .,!"))
    last = _last_act(known, found["thing"], said) if found else None
    if not found or not last:
        return False
    relation, state = known.relation_of(last.action), known.state_of(last.action)
    if found["state"]:
        return state == _STATES[found["state"]]
    if found["place"]:
        return bool(relation) and thing_of(known, found["place"]) == last.names[-1]
    return bool(relation) or (bool(state) and not found["there"])


def _last_act(known: Knowledge, words: str, said: Sequence[Mentioned]) -> Mentioned | None:
    """Return the last act on a thing; on the last thing where a pronoun stands for it."""
    acts = [each for each in within_reach(said) if each.names and each.action not in known.group(_WAYS)]
    if PRONOUN.fullmatch(words):
        return acts[0] if acts else None
    name = thing_of(known, words)
    return next((each for each in acts if each.names[0] == name), None) if name else None
