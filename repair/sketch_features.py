"""Features of a step for a learned sketch: the action and its object, the steps around it, its effects, and the text.

Names are features of their own (`Grab soap`); numbers are counts and places; both stand in one mapping.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.repair.activity_steps import action_phrases, asked, clauses, names_in_text, stems, takes_back
from hearth.schemas.program import Program, Step

MOST = 4
"""Counts from here on are one feature of the linear part."""


class StepFeatures(NamedTuple):
    """The features of a step.

    Attributes:
        names: each is there or not; the first of them are `RATED`, in that order.
        numbers: by name; truth is 1.
    """

    names: tuple[str, ...]
    numbers: Mapping[str, float]


RATED = ("action", "instruction", "object", "then", "after", "used_in", "used_by", "ends", "said")
"""Names of which the share of steps kept is a number for trees."""


def features(program: Program, ruled: Sequence[bool], knowledge: Knowledge) -> list[StepFeatures]:
    """Return the features of every step.

    Args:
        program: with instances as counters.
        ruled: the program's sketch as the repairs infer it (`sketch`).
        knowledge: of its actions and objects.
    """
    seen = _Seen(program, knowledge)
    flags = zip(ruled, asked(program, knowledge), strict=True)
    return [seen.step(number, *map(float, pair)) for number, pair in enumerate(flags)]


class _Seen:
    """A program and its text, read once for all steps."""

    def __init__(self, program: Program, knowledge: Knowledge) -> None:
        self.program, self.steps, self.known = program, program.steps, knowledge
        self.title, self.text = stems(program.title), stems(program.description)
        self.clauses = clauses(program)
        preparing = knowledge.group("preparation")
        self.acting = [number for number, step in enumerate(self.steps) if step.action not in preparing]

    def step(self, number: int, ruled: float, wanted: float) -> StepFeatures:
        """Return the features of one step; `ruled` and `wanted`: what repairs and the text's words say of it."""
        step = self.steps[number]
        numbers = {"ruled": ruled, "asked": wanted, **self._place(number), **self._object(number), **self._words(step)}
        numbers["takes_back"] = float(takes_back(self.program, number, self.known))
        return StepFeatures(tuple(self._names(number, numbers)), numbers)

    def _place(self, number: int) -> dict[str, float]:
        step, steps = self.steps[number], self.steps
        before = sum(place < number for place in self.acting)
        return {
            "steps_before": number,
            "steps_after": len(steps) - 1 - number,
            "acting_before": before,
            "acting_after": sum(place > number for place in self.acting),
            "acting": len(self.acting),
            "action_before": sum(other.action == step.action for other in steps[:number]),
            "action_after": sum(other.action == step.action for other in steps[number + 1 :]),
            "same_before": float(_same(step) in map(_same, steps[:number])),
            "same_after": float(_same(step) in map(_same, steps[number + 1 :])),
            "clauses": len(self.clauses),
            "words": len(self.text),
        }

    def _object(self, number: int) -> dict[str, float]:
        """Uses of its first object before and after, and whether its effect is undone."""
        step, known = self.steps[number], self.known
        uses = self._uses(number)
        before, after = [n for n in uses if n < number], [n for n in uses if n > number]
        acting = set(self.acting)
        state = known.state_of(step.action)
        later = {known.state_of(self.steps[place].action) for place in after} - {"", state}
        first = [place for place in after if place in acting]
        return {
            "uses_before": len(before),
            "uses_after": len(after),
            "acts_before": sum(place in acting for place in before),
            "acts_after": len(first),
            "distance": first[0] - number if first else -1,
            "taken_before": float(any(self.steps[place].action in known.group("takes") for place in before)),
            "put_after": float(any(self.steps[place].action in known.group("puts") for place in after)),
            "undone": float(bool(state and later)),
        }

    def _uses(self, number: int) -> list[int]:
        first = self.steps[number].objects[:1]
        return [n for n, step in enumerate(self.steps) if n != number and any(ref in step.objects for ref in first)]

    def _words(self, step: Step) -> dict[str, float]:
        """Return whether title and description have its verb and its objects."""
        phrases = action_phrases(step.action, self.known)
        objects = [names_in_text(ref.name, self.known) for ref in step.objects]
        first = objects[0] if objects else frozenset()
        second = objects[1] if len(objects) > 1 else frozenset()
        where = next((place for place, clause in enumerate(self.clauses) if first & clause), -1)
        return {
            "verb_in_title": float(any(phrase <= self.title for phrase in phrases)),
            "verb_in_text": float(any(phrase <= clause for phrase in phrases for clause in self.clauses)),
            "object_in_title": float(bool(first & self.title)),
            "object_in_text": float(bool(first & self.text)),
            "second_in_text": float(bool(second & (self.text | self.title))),
            "clause": where / len(self.clauses),
        }

    def _names(self, number: int, numbers: Mapping[str, float]) -> list[str]:
        """Return the action, alone and with its objects, its neighbours and each of the numbers."""
        step = self.steps[number]
        names = [ref.name for ref in step.objects]
        after = next((n for n in self.acting if n > number), None)
        before = next((n for n in reversed(self.acting) if n < number), None)
        uses = [n for n in self._uses(number) if n in self.acting]
        around = {
            "then": self._action(after) + ("=" if after in uses else ""),
            "after": self._action(before),
            "used_in": self._action(next((n for n in uses if n > number), None)),
            "used_by": self._action(next((n for n in reversed(uses) if n < number), None)),
            "ends": self._action(self.acting[-1] if self.acting else None),
            "said": " ".join([*names[:1], *(name for name in _SAID if numbers[name])]),
        }
        found = [step.action, " ".join([step.action, *names]), f"has {names[0] if names else '-'}"]
        found += [f"{step.action} {name}:{value}" for name, value in around.items()]
        found += [f"{step.action} {name}" for name in names[:1] if len(names) > 1]
        for name, value in numbers.items():
            if name in _COUNTED or (name in _FLAGS and value):
                label = f"{name}={min(int(value), MOST)}" if name in _COUNTED else name
                found += [label, f"{step.action} {label}"]
        return found

    def _action(self, number: int | None) -> str:
        return "-" if number is None else self.steps[number].action


_SAID = ("verb_in_text", "object_in_title", "object_in_text")

_COUNTED = frozenset({
    "uses_after", "acts_before", "acts_after", "acting", "acting_before", "acting_after", "action_before",
    "action_after",
})  # fmt: skip

_FLAGS = frozenset({
    "ruled", "asked", "takes_back", "same_before", "same_after", "taken_before", "put_after", "undone", "verb_in_title",
    "verb_in_text", "object_in_title", "object_in_text", "second_in_text",
})  # fmt: skip

NUMBERS = _COUNTED | _FLAGS | {"steps_before", "steps_after", "clauses", "words", "uses_before", "distance", "clause"}
"""The names of all numbers of a step."""


def _same(step: Step) -> tuple[str, tuple[tuple[str, int], ...]]:
    return step.action, tuple(ref.key for ref in step.objects)
