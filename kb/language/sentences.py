"""Sentences: the steps that one line asks for, which may join several clauses and speak of `it`."""

import re
from collections.abc import Sequence

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.understanding import Candidate, Understood, understand
from hearth.schemas.program import Step

_JOINTS = re.compile(r"(?:,|;)?\s+(?:and then|then|and)\s+|[;,]\s+|\.\s+(?=[A-Z])", re.IGNORECASE)
_PRONOUN = re.compile(r"\b(?:it|them)\b", re.IGNORECASE)


def exact_steps(known: Knowledge, words: str, about: str) -> list[Candidate]:
    """Return the step of which a line is an exact paraphrase, or those of its clauses if each is one; else none.

    Args:
        known: the grammar.
        words: the line.
        about: the thing that `it` is, as `last_thing` gives it.
    """
    whole = understand(known, _resolved(words, about)).meant
    if whole and whole.score == 1:
        return [whole]
    clauses = [clause for clause in _JOINTS.split(words) if clause]
    if len(clauses) < 2:
        return []
    found: list[Candidate] = []
    for clause in clauses:
        meant = understand(known, _resolved(clause, about)).meant
        if meant is None or meant.score < 1:
            return []
        found.append(meant)
        about = meant.names[0].replace("_", " ") if meant.names else about
    return found


def nearest_step(known: Knowledge, words: str, about: str) -> Understood:
    """Return the step that a line as a whole most resembles."""
    return understand(known, _resolved(words, about))


def last_thing(steps: Sequence[Step]) -> str:
    """Return the thing that the last step with an object was about, as a phrase; empty where there is none."""
    return next((step.objects[0].name.replace("_", " ") for step in reversed(steps) if step.objects), "")


def _resolved(words: str, about: str) -> str:
    return _PRONOUN.sub(about, words) if about else words
