"""A form that steps are written in: how its texts are recognized, and which lines of them are steps."""

import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

from hearth.kb.language.plan_lines import PlanLine


class Placed(NamedTuple):
    """A line of a plan, or a part of one, with the index of the line of the text that it stands on."""

    row: int
    line: PlanLine


class Form(NamedTuple):
    """One way of writing steps.

    Attributes:
        fits: whether the lines of a text, or the first of them, are written so.
        lines: the steps, headings and notes of a text.
        begins: matches the line with which the next program begins once a program has steps.
    """

    fits: Callable[[Sequence[str]], bool]
    lines: Callable[[Sequence[str]], list[Placed]]
    begins: re.Pattern[str]


def step(row: int, text: str, indent: int = 0) -> Placed:
    """Return a step of a form in which every step counts."""
    return Placed(row, PlanLine(" ".join(text.split()), 1, indent, numbered=True))


def title(row: int, text: str) -> Placed:
    """Return a title."""
    return Placed(row, PlanLine(f"Task: {text}", None, 0, heading=True))


def written(action: str, objects: Sequence[str]) -> str:
    """Return a step in the syntax of programs: objects are names, with their instance behind a blank if they have one."""
    return " ".join([f"[{action}]", *(f"<{name}> ({number or 1})" for name, number in map(_numbered, objects))])


def _numbered(name: str) -> tuple[str, str]:
    words, _, last = name.strip().rpartition(" ")
    return (words, last) if words and last.isdecimal() and int(last) else (name.strip(), "")
