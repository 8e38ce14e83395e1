"""The pages that belong to no room: start, a session's beginning and return, the desk's door."""

from __future__ import annotations

import hmac

from starlette.responses import Response

from hearth.schemas.failures import Code
from hearth.web import desk_access, sessions
from hearth.web.room import Who, get, post
from hearth.web.third_party_scripts import REMEDY, THIRD_PARTY, missing
from hearth.web.visit import Visit, by_browser
from hearth.web.web_errors import WebError

YEAR = 365 * 24 * 3600


def _start(visit: Visit) -> Response:
    lacking = {name: THIRD_PARTY[name].purpose for name in missing()}
    return visit.page("start.html", lacking=lacking, remedy=REMEDY)


def _begin(visit: Visit) -> Response:
    """Start a session, unless there is one, and go on to where the person wanted to go."""
    if visit.session is None:
        visit.web.rates["begin"].check(_sender(visit), "/begin")
    session = visit.session or sessions.start(visit.web.store)
    wanted = visit.field("to", 300)
    return _entered(visit, visit.go(_own_address(wanted)), session.token)


def _come(visit: Visit) -> Response:
    """Return to a session by its link, from another browser or after the cookie has gone."""
    visit.web.rates["token"].check(_sender(visit), "/come")
    session = sessions.find(visit.web.store, visit.part("token"))
    if session is None:
        if by_browser(visit.request):
            return visit.page("link_unknown.html", 401)
        raise WebError(Code.NO_SESSION, "link", "the link of a session", "an unknown one")
    return _entered(visit, visit.go("/"), session.token)


def _mine(visit: Visit) -> Response:
    assert visit.session is not None
    base = str(visit.request.base_url).rstrip("/")
    return visit.page("mine.html", link=f"{base}/come/{visit.session.token}")


def _delete(visit: Visit) -> Response:
    """Delete a session with all that belongs to it, as its person asked."""
    sessions.forget(visit.web.store, visit.person)
    visit.web.written()
    answer = visit.go("/")
    answer.delete_cookie(sessions.COOKIE)
    return answer


def _door(visit: Visit) -> Response:
    return visit.page("desk_door.html", wrong=False)


def _enter(visit: Visit) -> Response:
    """Enter the desk by its token, from the form or from the link that `serve` prints."""
    visit.web.rates["token"].check(_sender(visit), "/desk/enter")
    token = visit.request.path_params.get("token") or visit.field("token", 200)
    if not hmac.compare_digest(sessions.digest(token), visit.web.desk):
        return visit.page("desk_door.html", 403, wrong=True)
    answer = visit.go("/desk")
    secure = visit.web.secure
    answer.set_cookie(desk_access.COOKIE, token, httponly=True, samesite="strict", secure=secure, path="/desk")
    return answer


def _desk(visit: Visit) -> Response:
    return visit.page("desk.html")


def _entered(visit: Visit, answer: Response, token: str) -> Response:
    answer.set_cookie(sessions.COOKIE, token, YEAR, httponly=True, samesite="lax", secure=visit.web.secure)
    return answer


def _sender(visit: Visit) -> str:
    return visit.request.client.host if visit.request.client else ""


def _own_address(wanted: str) -> str:
    """An address of this server; another server's becomes the start page."""
    plain = wanted.isascii() and wanted.isprintable() and "\\" not in wanted
    return wanted if plain and wanted.startswith("/") and not wanted.startswith("//") else "/"


ADDRESSES = (
    get("/", _start, Who.ANYONE),
    post("/begin", _begin, Who.ANYONE),
    get("/come/{token}", _come, Who.ANYONE),
    get("/mine", _mine),
    post("/mine/delete", _delete),
    get("/desk/enter", _door, Who.ANYONE),
    post("/desk/enter", _enter, Who.ANYONE),
    get("/desk/enter/{token}", _enter, Who.ANYONE),
    get("/desk", _desk, Who.RESEARCHER),
)
"""The addresses outside rooms."""
