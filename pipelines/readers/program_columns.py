"""The choice of a table's program column when no name decides: the column whose cells read as several steps."""

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from hearth.kb.language.numbered_steps import parse_steps
from hearth.kb.language.program_lines import is_plan, lines_of_program
from hearth.kb.language.reading_modes import Fuzzy
from hearth.kb.language.recognition_knowledge import recognition, recognized_cache
from hearth.pipelines.readers.step_texts import numbered, steps_of
from hearth.schemas.diagnostics import HearthError

MOST_CELLS = 12
_LONGEST = 2_000
_NO_WORDS = {"title": "", "description": ""}


class Reading(NamedTuple):
    """Numbers of the steps of some texts: those understood, and the others."""

    understood: int
    faults: int

    @property
    def are_steps(self) -> bool:
        """Return whether at least half is understood, and more than one step."""
        return self.understood > 1 and self.understood >= self.faults


def column_of_steps(columns: Mapping[str, Sequence[str]]) -> str:
    """Return the column whose first cells read as most steps, several a cell; empty if there is none."""
    found = {name: reading_of(cells) for name, cells in columns.items()}
    several = [
        name
        for name, reading in found.items()
        if reading.are_steps and reading.understood + reading.faults > len(_first(columns[name]))
    ]
    return max(several, key=lambda name: found[name].understood, default="")


def reading_of(cells: Iterable[str]) -> Reading:
    """Return how the first of some texts read."""
    readings = list(map(_reading, _first(cells)))
    return Reading(sum(each.understood for each in readings), sum(each.faults for each in readings))


def is_one_step(text: str) -> bool:
    """Return whether a text is one step, and not several on its lines or joined on one."""
    return "\n" not in text.strip() and len(lines_of_program(f"1. {text}")) == 1 == len(steps_of(text))


def _first(cells: Iterable[str]) -> list[str]:
    return [str(cell) for cell in cells if cell.strip()][:MOST_CELLS]


@recognized_cache(maxsize=4096)
def _reading(text: str) -> Reading:
    if len(text) > _LONGEST or " " not in text.strip():
        return Reading(0, 1)
    try:
        steps = steps_of(text)
    except HearthError:
        return Reading(0, 1)
    lines = text if is_plan(steps) else numbered(steps, _NO_WORDS)[0]
    found = parse_steps(lines, 0, "", recognition(), Fuzzy.OFF)
    return Reading(len(found.program.steps), len(found.faults))
