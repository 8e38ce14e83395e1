"""Goal interpretation: precision, recall and F1 of the states, relations and actions that a model reads in a task."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from hearth.interop.eai.answer_texts import json_answer_of
from hearth.interop.eai.task_worlds import task_world
from hearth.interop.eai.wheel import Answer, Wheel
from hearth.kb.knowledge import Knowledge

KINDS = ("state", "relation", "action")


class Counts(NamedTuple):
    """Facts that are right, wrong and left out."""

    right: int = 0
    wrong: int = 0
    missed: int = 0

    def plus(self, other: Counts) -> Counts:
        """Return the sum with others."""
        return Counts(self.right + other.right, self.wrong + other.wrong, self.missed + other.missed)

    def scores(self) -> tuple[float, float, float]:
        """Return precision, recall and F1, per cent."""
        precision = self.right / (self.right + self.wrong) if self.right + self.wrong else 0.0
        recall = self.right / (self.right + self.missed) if self.right + self.missed else 0.0
        f1 = 2 * precision * recall / (precision + recall) if precision + recall else 0.0
        return round(100 * precision, 2), round(100 * recall, 2), round(100 * f1, 2)


Read = dict[str, Counts]
"""Counts by kind of fact."""


def judged(wheel: Wheel, answer: Answer, knowledge: Knowledge) -> tuple[Read | None, Read]:
    """Return the counts of an answer by the interface's rules and by ours.

    The interface leaves an answer out that is no JSON (None here); ours counts all its goals as missed. The interface
    lets several predicted actions match one of the goal; ours lets each be matched once.
    """
    there = task_world(wheel, answer.task, knowledge)
    task = there.task
    states = {(row["id"], row["state"]) for row in task.states}
    relations = {(row["from_id"], row["relation_type"], row["to_id"]) for row in task.relations}
    found = json_answer_of(answer.text)
    nothing = {
        "state": Counts(missed=len(states)),
        "relation": Counts(missed=len(relations)),
        "action": Counts(missed=len(task.actions)),
    }
    if not isinstance(found, dict):
        return None, nothing
    names = there.names
    rows = _rows(found, "node goals", ("name", "state"), names)
    of_states = [(names[row["name"]], str(row["state"])) for row in rows]
    fields = ("from_name", "to_name", "relation")
    of_relations = [
        (names[row["from_name"]], str(row["relation"]), names[row["to_name"]])
        for row in _rows(found, "edge goals", fields, names)
    ]
    actions = [str(row["action"]).upper() for row in _rows(found, "action goals", ("action",), None)]
    shared = {"state": _matched(of_states, states), "relation": _matched(of_relations, relations)}
    return shared | {"action": _loosely(actions, task.actions)}, shared | {"action": _strictly(actions, task.actions)}


def _rows(found: dict[str, Any], key: str, fields: tuple[str, ...], names: Any) -> list[dict[str, Any]]:
    """Return the rows of an answer that have all fields, each once, and name things of the task."""
    given = found.get(key)
    rows = [row for row in given if isinstance(row, dict)] if isinstance(given, list) else []
    once = {repr(sorted(row.items(), key=str)): row for row in rows}.values()
    whole = [row for row in once if all(isinstance(row.get(name), str) for name in fields)]
    if names is None:
        return whole
    return [row for row in whole if all(row[name] in names for name in fields if name.endswith("name"))]


def _matched(found: list[Any], wanted: set[Any]) -> Counts:
    right = sum(each in wanted for each in found)
    return Counts(right, len(found) - right, len(wanted) - right)


def _loosely(found: list[str], wanted: Iterable[str]) -> Counts:
    options = [each.upper().split("|") for each in wanted]
    right = sum(any(action in option for option in options) for action in found)
    return Counts(right, len(found) - right, len(options) - right)


def _strictly(found: list[str], wanted: Iterable[str]) -> Counts:
    left = [[word.strip() for word in each.upper().split("|")] for each in wanted]
    count, right = len(left), 0
    for action in found:
        match = next((option for option in left if action in option), None)
        if match is not None:
            left.remove(match)
            right += 1
    return Counts(right, len(found) - right, count - right)


def totals(judgements: Iterable[tuple[Read | None, Read]]) -> tuple[Read, Read]:
    """Return the sums over answers, by the interface's rules and by ours, with `all`."""
    theirs = dict.fromkeys(KINDS, Counts())
    ours = dict(theirs)
    for one, other in judgements:
        for kind in KINDS:
            theirs[kind] = theirs[kind].plus(one[kind]) if one else theirs[kind]
            ours[kind] = ours[kind].plus(other[kind])
    for each in (theirs, ours):
        each["all"] = each["state"].plus(each["relation"]).plus(each["action"])
    return theirs, ours
