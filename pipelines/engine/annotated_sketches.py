"""Annotated sketches of published programs, and those that their augmented programs inherit (thesis 5.5.1)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from typing import Any, NamedTuple, cast

from hearth.datasets.format.row_conversion import steps_of
from hearth.repair.sketch import inherited
from hearth.schemas.failures import Code
from hearth.schemas.published_rows import ProgramRow
from hearth.schemas.stage_rows import RejectRow, SketchRow
from hearth.schemas.syntax import print_step
from hearth.storage.rejects import Reject

PARENT = "_parent"
"""Ending of the origin of an inherited annotation."""


ANNOTATED = ("kind", "program_id", "place", "description_id", "keep", "text")
"""Columns of an annotation, among those that `ingest` reads."""


class Annotations(NamedTuple):
    """Annotated sketches of published programs, and faults of those that do not fit their program."""

    rows: list[SketchRow]
    rejects: list[RejectRow]


def fitting(given: Iterable[Mapping[str, Any]], steps_of: Callable[[list[str]], Mapping[str, int]]) -> Annotations:
    """Return the annotations of programs that are published; the id of a description names its program.

    Args:
        given: rows of `ingest`, with the columns `ANNOTATED`.
        steps_of: how many steps each of these programs has, by id; those that are not published are left out.
    """
    found = Annotations([], [])
    rows = list(given)
    steps = steps_of(sorted({str(row["description_id"]) for row in rows})) if rows else {}
    for row in rows:
        name = str(row["description_id"])
        if name not in steps:
            continue
        if len(row["keep"]) != steps[name]:
            found.rejects.append(_unfit(row, steps[name]))
            continue
        origin = "written" if name.startswith("written:") else "people"
        kept = row["text"].removesuffix("\n").split("\n")
        found.rows.append({"program_id": name, "origin": origin, "keep": row["keep"], "steps": kept})
    return found


def _unfit(row: Mapping[str, Any], steps: int) -> RejectRow:
    """Return an annotation whose flags are not as many as the steps of its program."""
    message = f"not a sketch of {row['description_id']}: flags {len(row['keep']):,}, steps of the program {steps:,}"
    remedy = "set a flag for each step of the program"
    fault = Reject.of(Code.BAD_JSON, message, file=row["place"], suggestion=remedy)
    origin = {"stage": "publish", "record_id": row["program_id"], "partial": True, "fault": 0}
    return cast(RejectRow, {**origin, **fault.rows()[0]})


class Marked(NamedTuple):
    """An annotated program: whose annotation it is, which steps it keeps, and all its steps as text."""

    origin: str
    keep: tuple[bool, ...]
    steps: tuple[str, ...]


def inherited_annotations(programs: Iterable[ProgramRow], annotations: Mapping[str, SketchRow]) -> Iterator[SketchRow]:
    """Yield for each child of an annotated program the steps that the annotation keeps, at their present places.

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
    """Return for each step of a child the place of the same step in the parent; -1 for a new one."""
    found = [-1] * len(child)
    for first, start, size in SequenceMatcher(None, parent, child, autojunk=False).get_matching_blocks():
        for offset in range(size):
            found[start + offset] = first + offset
    return found
