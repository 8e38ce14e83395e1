"""Reviewers: sessions that the desk invited, for a person can begin as many sessions as it likes."""

import secrets
import time

import sqlalchemy as sql
from starlette.responses import Response

from hearth.schemas.failures import Code
from hearth.web.annotate.annotate_tables import REVIEWERS
from hearth.web.room_request import Visit
from hearth.web.sessions import digest
from hearth.web.start_pages import base_of
from hearth.web.store import Store
from hearth.web.web_errors import WebError


def is_invited(store: Store, person: str) -> bool:
    """Return whether the desk lets a session review."""
    return store.scalar(sql.select(REVIEWERS.c.id).where(REVIEWERS.c.session == person)) is not None


def invite(visit: Visit) -> Response:
    """Make a link for one reviewer, which the page shows once; the store has its digest alone."""
    code = secrets.token_urlsafe(24)
    query = sql.insert(REVIEWERS).values(id=digest(code), created=time.time())
    visit.web.store.write(lambda connection: connection.execute(query))
    return visit.page("annotate/invitation.html", link=f"{base_of(visit)}/annotate/reviewer/{code}")


def invited_page(visit: Visit) -> Response:
    """Ask whether one wants to review."""
    return visit.page("annotate/invited.html", code=visit.part("code"))


def accept_invitation(visit: Visit) -> Response:
    """Make the session that asks the reviewer of an invitation.

    Raises:
        WebError: UNKNOWN_ID: there is no such invitation, or another session has taken it.
    """
    query = sql.update(REVIEWERS).where(REVIEWERS.c.id == digest(visit.part("code")), REVIEWERS.c.session.is_(None))
    query = query.values(session=visit.person)
    if not visit.web.store.write(lambda connection: connection.execute(query).rowcount):
        raise WebError(Code.UNKNOWN_ID, "invitation", "an invitation that nobody has taken", "another")
    return visit.go("/annotate/review")
