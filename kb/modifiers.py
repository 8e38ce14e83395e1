"""Modifiers of steps (thesis 2.3.3), which say how something is done: `[Grab] <cup> (1) {hand=left speed=slow}`."""

import re
from collections.abc import Iterator
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.schemas.program import Step

_NUMBER = r"-?[0-9]{1,5}(?:\.[0-9]{1,6})?"


class Modifier(NamedTuple):
    """A modifier.

    Attributes:
        form: of its values, a regular expression.
        example: of a value, in messages.
        groups: of the actions that take it; empty: all actions do.
        means: what it asks for.
    """

    form: str
    example: str
    groups: tuple[str, ...]
    means: str


SPEEDS = {"slow": 0.5, "normal": 1.0, "fast": 2.0}
"""Factors of the speed of motions in films."""

MODIFIERS: dict[str, Modifier] = {
    "at": Modifier(f"{_NUMBER},{_NUMBER}", "3,2", ("walks", "puts"), "where to stand, or to put it: metres x,z"),
    "facing": Modifier(_NUMBER, "90", ("walks",), "the way to look afterwards: degrees from +z towards +x"),
    "hand": Modifier("left|right", "left", ("takes", "frees_hand", "hand"), "the hand that does it"),
    "speed": Modifier("|".join(SPEEDS), "slow", (), "how fast its motions are in films"),
}

ModifierFault = tuple[str, str, str]
"""The words at fault, a message and a remedy."""


def faults(step: Step, knowledge: Knowledge) -> Iterator[ModifierFault]:
    """Faults of a step's modifiers."""
    seen: set[str] = set()
    for name, value in step.modifiers:
        found, known = f"{name}={value}", MODIFIERS.get(name)
        if known is None:
            yield found, f"unknown modifier `{name[:40]}`", f"modifiers are {', '.join(MODIFIERS)}"
        elif name in seen:
            yield found, f"a second `{name}`", "keep one"
        elif not re.fullmatch(known.form, value):
            yield found, f"`{value[:40]}` is not a value of `{name}`", f"write {name}={known.example}: {known.means}"
        elif known.groups and not any(step.action in knowledge.group(group) for group in known.groups):
            yield found, f"[{step.action}] takes no `{name}`", f"leave it out: `{name}` says {known.means}"
        seen.add(name)


def value(step: Step, name: str) -> str:
    """Return the value of a modifier, or ''."""
    return next((given for each, given in step.modifiers if each == name), "")


def numbers(step: Step, name: str) -> tuple[float, ...]:
    """Return the numbers of a modifier; none where the step does not have it."""
    return tuple(map(float, value(step, name).split(","))) if value(step, name) else ()
