"""Withdrawal of a person: the works on which others built stay, without the person; the desk can erase the rest."""

import sqlalchemy as sql

from hearth.web.annotate.annotate_tables import ACCEPTED, PROGRAMS, REVIEWS, TEXTS
from hearth.web.annotate.annotated_programs import EMPTY
from hearth.web.store import Store
from hearth.web.web_tables import SESSIONS


def keep(connection: sql.Connection, person: str, nobody: str) -> int:
    """Give accepted programs, and descriptions for which there are programs of others, to nobody; how many.

    A program in which nothing was set yet keeps no description, nor does one that goes with
    this person: descriptions of nobody that only they were for go, too. What the person wrote to authors as a reviewer
    goes; the verdicts stay with the programs.
    """
    reviewed = sql.select(REVIEWS.c.program).where(REVIEWS.c.session == person)
    connection.execute(sql.update(PROGRAMS).where(PROGRAMS.c.id.in_(reviewed)).values(note=""))
    accepted = sql.update(PROGRAMS).where(PROGRAMS.c.session == person, PROGRAMS.c.state == ACCEPTED)
    programs = connection.execute(accepted.values(session=nobody)).rowcount
    used = sql.select(PROGRAMS.c.text).where(PROGRAMS.c.session != person, PROGRAMS.c.draft != EMPTY)
    gone = sql.select(SESSIONS.c.id).where(SESSIONS.c.created == 0)
    mine = sql.select(PROGRAMS.c.text).where(PROGRAMS.c.session == person)
    left = (TEXTS.c.session.in_(gone), TEXTS.c.id.in_(mine), TEXTS.c.id.not_in(used))
    connection.execute(sql.delete(TEXTS).where(*left))
    built_on = sql.update(TEXTS).where(TEXTS.c.session == person, TEXTS.c.id.in_(used))
    return programs + connection.execute(built_on.values(session=nobody)).rowcount


def built_on(table: sql.Table, person: str) -> sql.ColumnElement[bool]:
    """Return the condition of rows on which others built: accepted programs, and descriptions with programs to keep."""
    if table is PROGRAMS:
        return PROGRAMS.c.state == ACCEPTED
    others = sql.and_(PROGRAMS.c.session != person, PROGRAMS.c.draft != EMPTY)
    return TEXTS.c.id.in_(sql.select(PROGRAMS.c.text).where(others | (PROGRAMS.c.state == ACCEPTED)))


def erase(store: Store, name: str) -> int:
    """Delete a description or a program by its id, with all that belongs to it; how many there were."""

    def work(connection: sql.Connection) -> int:
        return sum(connection.execute(sql.delete(each).where(each.c.id == name)).rowcount for each in (TEXTS, PROGRAMS))

    found = store.write(work)
    store.erase_traces()
    return found
