"""A form that steps are written in: how its texts are recognized, and which lines of them are steps."""

import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

from hearth.kb.language.plan_lines import PlanLine
from hearth.kb.language.refusals import Refusal


class Placed(NamedTuple):
    """A line of a plan, or a part of one, with the index of the line of the text that it stands on."""

    row: int
    line: PlanLine


class Form(NamedTuple):
    """One way of writing steps.

    Attributes:
        fits: whether the lines of a text, or the first of them, are written so.
        lines: the steps, headings and notes of a text.
        is_step: whether a line is a step.
        begins: matches a line with which a program begins, once the one above has steps or such a line of its own; of
            lines that differ in the first group, each belongs to one beginning.
    """

    fits: Callable[[Sequence[str]], bool]
    lines: Callable[[Sequence[str]], list[Placed]]
    is_step: Callable[[str], bool]
    begins: re.Pattern[str]


def step(row: int, text: str, indent: int = 0) -> Placed:
    """Return a step of a form in which every step counts."""
    return Placed(row, PlanLine(" ".join(text.split()), 1, indent, numbered=True))


def note(row: int, text: str) -> Placed:
    """Return a line that explains, and is counted as such."""
    return Placed(row, PlanLine(" ".join(text.split()), 0, 1))


def remark(row: int, text: str) -> Placed:
    """Return a line that is counted and never read as a step, such as a game's answer."""
    return Placed(row, PlanLine(" ".join(text.split()), None, 1))


def refused(row: int, text: str, why: Refusal) -> Placed:
    """Return a line for which the plan is refused."""
    return Placed(row, PlanLine(" ".join(text.split()), 1, numbered=True, why=why))


def title(row: int, text: str) -> Placed:
    """Return a title."""
    return Placed(row, PlanLine(f"Task: {text}", None, 0, heading=True))
