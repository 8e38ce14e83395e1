"""Answers of language models to the interface's tasks, as values."""

from __future__ import annotations

import json
import re
from typing import Any

Pairs = list[tuple[str, list[str]]]
"""Actions in order, each with its arguments: keys of the models' objects repeat."""


def unfenced(text: str) -> str:
    """Return an answer without its fence and the marks of its end."""
    plain = text.replace("<|eot_id|>", "").strip()
    if plain.startswith("```json"):
        plain = plain[7:]
    return plain.strip().strip("`").strip().replace("\n", "").replace("'", '"')


def json_answer_of(text: str) -> Any:
    """Return the JSON value of an answer, None where it is none; of repeated keys the last counts."""
    try:
        return json.loads(unfenced(text))
    except (ValueError, RecursionError):
        return None


class _Object(list[Any]):
    """The members of a JSON object, in order, repeated keys too."""


def plan_of(text: str) -> Pairs | None:
    """Return the actions of an answer in their order; None where it is no object of lists of names."""
    try:
        found = json.loads(unfenced(text), object_pairs_hook=_Object)
    except (ValueError, RecursionError):
        return None
    if not isinstance(found, _Object):
        return None
    plan: Pairs = []
    for action, arguments in found:
        if not isinstance(arguments, list) or not all(isinstance(each, str) for each in arguments):
            return None
        plan.append((action, [each for each in arguments if each]))
    return plan


_MEMBER = re.compile(r'"(\w+)"\s*:\s*(\[[^\]]+\])')


def plan_as_scored(text: str) -> Pairs | None:
    """Return the actions of an answer as the interface's scorer finds them: by a pattern, which passes over every
    action with an empty list of arguments, such as `"STANDUP": []`, and needs no whole JSON.
    """
    plan: Pairs = []
    for action, arguments in _MEMBER.findall(re.sub(r"\s+", " ", unfenced(text))):
        try:
            found = json.loads(arguments)
        except ValueError:
            return None
        plan.append((action, [str(each) for each in found if each != ""]))
    return plan


def subgoals_of(text: str) -> list[str] | None:
    """Return the subgoals of an answer; None where it has none that can be read."""
    match = re.search(r"{[^{}]*}", text.strip().replace("}}", "}"), re.DOTALL)
    try:
        found = json.loads(match[0]) if match else None
    except (ValueError, RecursionError):
        return None
    if not isinstance(found, dict) or not isinstance(found.get("output"), list):
        return None
    return [each.strip() for each in found["output"] if isinstance(each, str) and each.strip()]
