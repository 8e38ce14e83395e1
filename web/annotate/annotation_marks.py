"""Marks on existing items: sketches of programs (thesis 5.5.1), their completeness (3.4.1), films in words (4.4)."""

import secrets
import time
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import orjson
import sqlalchemy as sql
from starlette.responses import FileResponse, Response

from hearth.analysis.completeness_ratings import SAID
from hearth.datasets.damage_faults import using
from hearth.datasets.dataset import Dataset
from hearth.schemas.failures import Code
from hearth.schemas.rng import rng
from hearth.schemas.syntax import print_lines
from hearth.storage.names import inside
from hearth.web.annotate import annotated_programs
from hearth.web.annotate.annotate_tables import MARKS
from hearth.web.annotate.collected_files import write_collected
from hearth.web.annotate.descriptions import lacks
from hearth.web.annotate.program_draft import stored
from hearth.web.room_request import Visit
from hearth.web.store import Row
from hearth.web.web_errors import WebError

SKETCH, COMPLETENESS, FILM = "sketch", "completeness", "film"


KINDS = {".webm": "video/webm", ".mp4": "video/mp4"}
"""Types of films by the endings of their files; a dataset could call any file a film."""


class Film(NamedTuple):
    """A film of an execution, and the program that was filmed."""

    id: str
    path: Path
    program: str


@lru_cache(maxsize=2)
def films_of(dataset: Path) -> dict[str, Film]:
    """Return the films of a published dataset by the id of their execution; one of each program."""
    opened = Dataset.open(dataset)
    query = """SELECT min(v.execution_id), min_by(v.file, v.execution_id), e.program_id
        FROM videos v JOIN executions e USING (execution_id) GROUP BY e.program_id ORDER BY 1"""
    found = {}
    for execution, file, program in opened.rows(query)[1]:
        path = inside(opened.folder, str(file))
        if path.suffix in KINDS and path.is_file():
            with using(opened.folder):  # it may be of a program that there is not
                lines = "\n".join(print_lines(opened[program].program.unbound()))
            found[execution] = Film(execution, path, lines)
    return found


def sketch_page(visit: Visit) -> Response:
    """Return the next accepted program, each step with a box."""
    return _program_page(visit, SKETCH, "annotate/sketch.html")


def keep_sketch(visit: Visit) -> Response:
    """Store which steps are the activity itself."""
    row = _accepted(visit)
    count = len(stored(row["draft"]).blocks)
    kept = [bool(visit.fields.get(f"keep {number}")) for number in range(count)]
    if not any(kept):
        raise WebError(Code.BAD_ARGUMENT, "steps", "at least one step that is the activity", "none")
    _keep(visit, SKETCH, row["id"], kept)
    return visit.go("/annotate/sketch")


def rating_page(visit: Visit) -> Response:
    """Return the next accepted program, to be graded."""
    return _program_page(visit, COMPLETENESS, "annotate/rate.html", grades={int(each): SAID[each] for each in SAID})


def keep_rating(visit: Visit) -> Response:
    """Store a grade of completeness."""
    row, grade = _accepted(visit), visit.field("grade", 5)
    if grade not in {str(int(each)) for each in SAID}:
        raise WebError(Code.BAD_ARGUMENT, "grade", "1, 2 or 3", grade)
    _keep(visit, COMPLETENESS, row["id"], int(grade))
    return visit.go("/annotate/rate")


def film_page(visit: Visit) -> Response:
    """Return the next film."""
    return _film_page(visit, 200, "", "", ())


def keep_film(visit: Visit) -> Response:
    """Store the description of a film, or ask politely for the missing parts."""
    film = _film(visit)
    title, description = visit.field("title").strip(), visit.field("description").strip()
    if wishes := lacks(title, description):
        return _film_page(visit, 400, title, description, wishes, film)
    _keep(visit, FILM, film.id, {"title": title, "description": description, "program": film.program})
    return visit.go("/annotate/film")


def film_file(visit: Visit) -> Response:
    """Return the film itself."""
    path = _film(visit).path
    return FileResponse(path, media_type=KINDS[path.suffix])


def _films(visit: Visit) -> dict[str, Film]:
    return films_of(visit.web.films) if visit.web.films else {}


def _film(visit: Visit) -> Film:
    films = _films(visit)
    if visit.part("film") not in films:
        raise WebError(Code.UNKNOWN_ID, "film", "a film of this server", visit.part("film")[:40])
    return films[visit.part("film")]


def _film_page(
    visit: Visit, status: int, title: str, description: str, wishes: tuple[str, ...], film: Film | None = None
) -> Response:
    films, done = _films(visit), _marked(visit, FILM)
    left = sorted(films.keys() - done)
    film = film or (films[rng(0, "film", visit.person, len(done)).choice(left)] if left else None)
    values = {"title": title, "description": description, "wishes": wishes}
    return visit.page("annotate/film.html", status, film=film, left=len(left), done=len(done), **values)


def _program_page(visit: Visit, kind: str, template: str, **values: Any) -> Response:
    done = _marked(visit, kind)
    left = [row for row in annotated_programs.accepted(visit.web.store, visit.person) if row["id"] not in done]
    row = left[0] if left else None
    draft = stored(row["draft"]) if row else None
    words = [block.words(visit.web.known, draft) for block in draft.blocks] if draft else []
    return visit.page(template, program=row, words=words, left=len(left), done=len(done), **values)


def _accepted(visit: Visit) -> Row:
    """Return the accepted program of the address, by another person.

    Raises:
        WebError: UNKNOWN_ID.
    """
    rows = annotated_programs.accepted(visit.web.store, visit.person)
    found = next((row for row in rows if row["id"] == visit.part("program")), None)
    if found is None:
        raise WebError(Code.UNKNOWN_ID, "program", "an accepted program of somebody else", visit.part("program")[:40])
    return found


def _marked(visit: Visit, kind: str) -> set[str]:
    """Return the items that a person has marked in one way."""
    query = sql.select(MARKS.c.subject).where(MARKS.c.session == visit.person, MARKS.c.kind == kind)
    return set(visit.web.store.read(lambda connection: connection.execute(query).scalars().all()))


def _keep(visit: Visit, kind: str, subject: str, value: Any) -> None:
    """Store a mark, instead of the person's earlier one on the same."""
    same = (MARKS.c.session == visit.person, MARKS.c.kind == kind, MARKS.c.subject == subject)
    row = {
        "id": secrets.token_hex(8),
        "session": visit.person,
        "kind": kind,
        "subject": subject,
        "value": orjson.dumps(value).decode(),
        "created": time.time(),
    }

    def write(connection: sql.Connection) -> None:
        connection.execute(sql.delete(MARKS).where(*same))
        connection.execute(sql.insert(MARKS).values(row))

    visit.web.store.write(write)
    write_collected(visit.web)
