"""The researcher's view of annotating: the contributions, the missing blocks, the files."""

from collections import Counter
from typing import Any

import sqlalchemy as sql
from starlette.responses import Response

from hearth.pipelines.checks import free_text_steps
from hearth.schemas.failures import Code
from hearth.web.annotate import collected_files, withdrawal
from hearth.web.annotate.annotate_tables import DRAFT, MARKS, PROGRAMS, REVIEWS, TEXTS
from hearth.web.annotate.desk_queue import SIGNS, queue
from hearth.web.annotate.program_draft import SPECIAL, stored
from hearth.web.room_request import Visit
from hearth.web.store import Store
from hearth.web.web_errors import WebError

RATINGS = "ratings.csv"


def overview(visit: Visit) -> Response:
    """Counts, the texts of special blocks, and the files."""
    store = visit.web.store
    files = [name for name, data in collected_files.collected(store).items() if data]
    values: dict[str, Any] = {"counts": counts(store), "specials": special_texts(store), "files": [*files, RATINGS],
                              "queue": queue(store), "meanings": SIGNS}  # fmt: skip
    return visit.page("annotate/desk.html", **values)


def download(visit: Visit) -> Response:
    """Return a file of the accepted contributions, or the sheet of grades."""
    name = visit.part("file")
    files = collected_files.collected(visit.web.store)
    data = collected_files.ratings_sheet(visit.web.store).encode() if name == RATINGS else files.get(name, b"")
    if not data:
        raise WebError(Code.UNKNOWN_ID, "file", ", ".join((*files, RATINGS)), name[:40])
    headers = {"Content-Disposition": f'attachment; filename="{name}"'}
    return Response(data, media_type="application/json" if name.endswith(".json") else "text/csv", headers=headers)


def erase(visit: Visit) -> Response:
    """Delete a description or a program, as somebody asked who is in it; the files follow.

    Raises:
        WebError: UNKNOWN_ID.
    """
    name = visit.field("id", 100).strip()
    if not withdrawal.erase(visit.web.store, name):
        raise WebError(Code.UNKNOWN_ID, "id", "the id of a description or a program", name[:40])
    visit.web.written()
    return visit.go("/desk/annotate/")


def counts(store: Store) -> dict[str, int]:
    """Return the number of rows of each kind."""

    def read(connection: sql.Connection) -> dict[str, int]:
        groups = ((PROGRAMS, PROGRAMS.c.state, "programs: {}"), (REVIEWS, REVIEWS.c.verdict, "reviews: {}"),
                  (MARKS, MARKS.c.kind, "marks: {}"))  # fmt: skip
        found = {"descriptions": connection.execute(sql.select(sql.func.count()).select_from(TEXTS)).scalar_one()}
        for table, column, label in groups:
            query: Any = sql.select(column, sql.func.count()).select_from(table).group_by(column).order_by(column)
            found.update({label.format(name): number for name, number in connection.execute(query)})
        return found

    return store.read(read)


def special_texts(store: Store) -> list[tuple[str, int, bool]]:
    """Return the texts of special blocks in programs that were handed in, most frequent first (thesis 3.3).

    Returns:
        The text in lower case, its number, and whether the special-blocks file has steps for it.
    """
    query = sql.select(PROGRAMS.c.draft).where(PROGRAMS.c.state != DRAFT)
    drafts = store.read(lambda connection: connection.execute(query).scalars().all())
    texts = Counter(
        " ".join(block.text.lower().split())
        for draft in drafts
        for block in stored(draft).blocks
        if block.action == SPECIAL
    )
    return [(text, number, text in free_text_steps.blocks()) for text, number in sorted(texts.items(), key=_by_number)]


def _by_number(pair: tuple[str, int]) -> tuple[int, str]:
    return -pair[1], pair[0]
