"""A person's own work: seen, taken back to be changed, and withdrawn piece by piece."""

import sqlalchemy as sql
from starlette.responses import Response

from hearth.web.annotate import withdrawal
from hearth.web.annotate.annotate_tables import DRAFT, PROGRAMS, SUBMITTED, TEXTS
from hearth.web.phrases import say
from hearth.web.room_request import Visit
from hearth.web.sessions import nobody
from hearth.web.web_tables import SESSIONS

HERE = "/annotate/mine"
"""The address of the list."""

DONE = ("withdrawn", "gone_on")
"""The phrases by which the list says what was done."""


def own_page(visit: Visit) -> Response:
    """Return a person's descriptions and programs."""
    store, done = visit.web.store, visit.fields.get("done", "")
    texts = store.rows(sql.select(TEXTS).where(TEXTS.c.session == visit.person).order_by(TEXTS.c.created))
    joined = PROGRAMS.join(TEXTS, PROGRAMS.c.text == TEXTS.c.id)
    query = sql.select(PROGRAMS.c.id, PROGRAMS.c.text, PROGRAMS.c.state, TEXTS.c.title).select_from(joined)
    programs = store.rows(query.where(PROGRAMS.c.session == visit.person).order_by(PROGRAMS.c.created))
    said = say("annotate", done) if done in DONE else ""
    return visit.page("annotate/own.html", texts=texts, programs=programs, said=said)


def take_back(visit: Visit) -> Response:
    """Give a program that waits for review back to its author, who changes it."""
    query = sql.update(PROGRAMS).where(
        PROGRAMS.c.session == visit.person, PROGRAMS.c.text == visit.part("text"), PROGRAMS.c.state == SUBMITTED
    )
    values = {"state": DRAFT, "version": PROGRAMS.c.version + 1}
    taken = visit.web.store.write(lambda connection: connection.execute(query.values(values)).rowcount)
    return visit.go(f"/annotate/task/{visit.part('text')}/compose?back=yes" if taken else f"{HERE}?done=gone_on")


def withdraw_program(visit: Visit) -> Response:
    """Delete a person's own program; an accepted one stays, and belongs to nobody."""
    return _withdrawn(visit, PROGRAMS, PROGRAMS.c.text == visit.part("text"))


def withdraw_text(visit: Visit) -> Response:
    """Delete a person's own description; one for which others write programs stays, and belongs to nobody."""
    return _withdrawn(visit, TEXTS, TEXTS.c.id == visit.part("text"))


def _withdrawn(visit: Visit, table: sql.Table, wanted: sql.ColumnElement[bool]) -> Response:
    other = nobody()

    def work(connection: sql.Connection) -> None:
        connection.execute(sql.insert(SESSIONS).values(other))
        own = (table.c.session == visit.person, wanted)
        kept = connection.execute(
            sql.update(table).where(*own, withdrawal.built_on(table, visit.person)).values(session=other["id"])
        )
        connection.execute(sql.delete(table).where(*own))
        if not kept.rowcount:
            connection.execute(sql.delete(SESSIONS).where(SESSIONS.c.id == other["id"]))

    visit.web.store.write(work)
    visit.web.store.erase_traces()
    visit.web.written()
    return visit.go(f"{HERE}?done=withdrawn")
