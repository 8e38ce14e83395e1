"""The accepted contributions, as the files that `ingest` reads: batches of both stages, sketches, described films.

The files follow from the store: they are written after each acceptance and when the server starts, and can be deleted.
"""

import io
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import orjson
import sqlalchemy as sql
from filelock import FileLock

from hearth.analysis.completeness_ratings import COLUMNS, HELP
from hearth.analysis.spreadsheet_cells import sheet_of
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.csv_files import rows_writer
from hearth.storage.files import write_bytes
from hearth.web.annotate import annotated_programs
from hearth.web.annotate.annotate_tables import MARKS
from hearth.web.annotate.program_draft import stored
from hearth.web.room_request import Web
from hearth.web.store import Row, Store, private

PLATFORM = "hearth"

DESCRIPTIONS = (
    "HITId", "WorkerId", "Platform", "AssignmentStatus", "Input.scene", "Answer.title", "Answer.description",
)  # fmt: skip
PROGRAMS = (
    "HITId", "WorkerId", "Platform", "AssignmentStatus", "Input.description_id", "Input.title", "Input.description",
    "Answer.rooms", "Answer.props", "Answer.program",
)  # fmt: skip


def write_collected(web: Web) -> None:
    """Write all files of accepted contributions, each whole or not at all; no file without contributions."""
    with FileLock(private(web.out) / "collected.lock"):
        for name, data in collected(web.store).items():
            path = web.out / name
            if data:
                write_bytes(path, data)
            else:
                path.unlink(missing_ok=True)


def collected(store: Store) -> dict[str, bytes]:
    """Return the files by name; empty where there is nothing for one."""
    accepted = annotated_programs.accepted(store)
    marks = _marks(store)
    described = {row["text"]: row for row in reversed(accepted)}
    films = [mark for mark in marks if mark["kind"] == "film"]
    return {
        "descriptions.csv": _table(DESCRIPTIONS, map(_description, reversed(described.values()))),
        "programs.csv": _table(PROGRAMS, map(_program, accepted)),
        "sketches.json": _sketches(accepted, marks),
        "films.csv": _table(("program_id", "title", "description", "program"), map(_film, films)),
    }


def _table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> bytes:
    """CSV; empty without rows."""
    listed = list(rows)
    out = io.StringIO(newline="")
    rows_writer(out)([header, *listed])
    return out.getvalue().encode() if listed else b""


def _description(row: Row) -> tuple[str, ...]:
    return row["text"], row["writer"], PLATFORM, "Approved", row["scene"], row["title"], row["description"]


def _program(row: Row) -> tuple[str, ...]:
    draft = stored(row["draft"])
    quantities = [", ".join(f"{name}*{count}" for name, count in each.items()) for each in (draft.rooms, draft.props)]
    who = (row["id"], row["session"], PLATFORM, "Approved")
    return *who, row["text"], row["title"], row["description"], *quantities, "\n".join(draft.lines())


def _film(mark: Row) -> tuple[str, ...]:
    value = _marked(mark)
    return f"film:{mark['id']}", *(str(value.get(name, "")) for name in ("title", "description", "program"))


_KINDS: Mapping[str, type] = {"sketch": list, "completeness": int, "film": dict}
"""The type of a mark's value, by the mark's kind."""


def _marked(mark: Row) -> Any:
    """Return the value of a mark.

    Raises:
        HearthError: DAMAGED_FILE: it is none, as in a store that was changed by hand.
    """
    try:
        value = orjson.loads(mark["value"])
    except orjson.JSONDecodeError:
        value = None
    if not isinstance(value, _KINDS[mark["kind"]]):
        message = f"the mark {str(mark['id'])[:40]} of the store has another value than those of `{mark['kind']}`"
        raise HearthError.of(Code.DAMAGED_FILE, message)
    return value


def _marks(store: Store) -> list[Row]:
    query = sql.select(MARKS).order_by(MARKS.c.created, MARKS.c.id)
    return store.rows(query)


def _sketches(accepted: Sequence[Row], marks: Iterable[Row]) -> bytes:
    """Return the steps that are the activity, in the form of the release's annotations.

    The first mark of each program counts.
    """
    programs = {row["id"]: row for row in accepted}
    first = {mark["subject"]: mark for mark in reversed(list(marks)) if mark["kind"] == "sketch"}
    answers: list[list[int]] = []
    inputs: list[dict[str, Any]] = []
    for subject in sorted(first.keys() & programs.keys()):
        row, kept = programs[subject], _marked(first[subject])
        lines = stored(row["draft"]).lines()
        if len(kept) == len(lines) and any(kept):
            answers.append([int(flag) for flag in kept])
            steps = [line for line, flag in zip(lines, kept, strict=True) if flag]
            about = {"title": str(row["title"]), "descr": str(row["description"])}
            inputs.append({**about, "prog": steps, "prefix": f"crowd:{subject}"})
    return orjson.dumps({"answer": answers, "represent": [1] * len(answers), "input": inputs}) if answers else b""


def ratings_sheet(store: Store) -> str:
    """Return the grades of completeness, as the sheet that `corpus completeness --sheet` reads."""
    programs = {row["id"]: row for row in annotated_programs.accepted(store)}
    rows: list[tuple[object, ...]] = [(*COLUMNS[:-1], f"rating ({HELP})")]
    for mark in _marks(store):
        if mark["kind"] == "completeness" and mark["subject"] in programs:
            row = programs[mark["subject"]]
            steps = "\n".join(stored(row["draft"]).lines())
            about = (f"crowd:{row['id']}", row["title"], row["description"], steps)
            rows.append((*about, mark["session"], str(_marked(mark))))
    return sheet_of(rows)
