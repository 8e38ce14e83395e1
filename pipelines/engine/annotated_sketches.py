"""Annotated sketches of published programs, and what their augmented programs inherit of them (thesis 5.5.1)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from typing import NamedTuple

from hearth.datasets.format.codecs import steps_of
from hearth.repair.sketch import inherited
from hearth.schemas.published_rows import ProgramRow
from hearth.schemas.stage_rows import SketchRow
from hearth.schemas.syntax import print_step

PARENT = "_parent"
"""What the origin of an inherited annotation ends with."""


class Marked(NamedTuple):
    """An annotated program: whose annotation it is, which steps it keeps, and all its steps as text."""

    origin: str
    keep: tuple[bool, ...]
    steps: tuple[str, ...]


def inherited_annotations(programs: Iterable[ProgramRow], annotations: Mapping[str, SketchRow]) -> Iterator[SketchRow]:
    """For each child of an annotated program, the steps that the annotation keeps, wherever they now stand.

    Args:
        programs: with `program_id`, `parent_id` and `steps`; parents come before their children or after them.
        annotations: by program.
    """
    marked: dict[str, Marked] = {}
    children: list[tuple[str, str, tuple[str, ...]]] = []
    for row in programs:
        parent, name = row["parent_id"], row["program_id"]
        if parent is not None and parent in annotations:
            children.append((name, parent, _texts(row)))
        elif name in annotations:
            marked[name] = Marked(annotations[name]["origin"], tuple(annotations[name]["keep"]), _texts(row))
    for name, parent, steps in children:
        own = marked.get(parent)
        if own is not None and len(own.keep) == len(own.steps):
            keep = inherited(own.keep, places(own.steps, steps))
            kept = [step for step, is_kept in zip(steps, keep, strict=True) if is_kept]
            yield {"program_id": name, "origin": own.origin + PARENT, "keep": list(keep), "steps": kept}


def _texts(row: ProgramRow) -> tuple[str, ...]:
    return tuple(map(print_step, steps_of(row["steps"])))


def places(parent: Sequence[str], child: Sequence[str]) -> list[int]:
    """For each step of a child, which of the parent's it is; -1 for a new one."""
    found = [-1] * len(child)
    for first, start, size in SequenceMatcher(None, parent, child, autojunk=False).get_matching_blocks():
        for offset in range(size):
            found[start + offset] = first + offset
    return found
