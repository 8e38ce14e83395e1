"""The pages that belong to no room: start, a session's beginning and return, the desk's door."""

import hmac

from starlette.responses import Response

from hearth.schemas.failures import Code
from hearth.web import desk_access, sessions
from hearth.web.phrases import language, script
from hearth.web.room import Who, get, post
from hearth.web.room_request import Visit, by_browser
from hearth.web.security import own_address, scheme_of
from hearth.web.sender_addresses import is_of_lab, sender_of
from hearth.web.third_party_scripts import REMEDY, THIRD_PARTY, missing
from hearth.web.web_errors import WebError

YEAR = 365 * 24 * 3600

COME = "/come"

COMING = "hearth_come"
"""The cookie with the token of a link that was opened, until its person has answered."""

MINUTES_TO_COME = 10
"""Minutes for that answer."""


def _start(visit: Visit) -> Response:
    lacking = {name: THIRD_PARTY[name].purpose for name in missing()}
    deleted = visit.session is None and visit.fields.get("deleted") == "yes"
    return visit.page("start.html", lacking=lacking, remedy=REMEDY, deleted=deleted)


def _begin(visit: Visit) -> Response:
    """Start a session, unless there is one, and go on to where the person wanted to go."""
    if visit.session is None and not is_of_lab(_sender(visit), visit.web.lab):
        visit.web.rates["begin"].check(_sender(visit), "/begin")
    session = visit.session or sessions.start(visit.web.store)
    wanted = visit.field("to", 1_000)
    return _entered(visit, visit.go(own_address(wanted)), session.token)


def _come(visit: Visit) -> Response:
    """Take the token of a session's link out of the address, and ask whether that session is to be opened here."""
    visit.web.rates["token"].check(_sender(visit), "/come")
    token = visit.part("token")
    if sessions.find(visit.web.store, token) is None:
        return _unknown(visit)
    answer, secure = visit.go(COME), visit.web.secure
    answer.set_cookie(COMING, token, MINUTES_TO_COME * 60, httponly=True, samesite="lax", secure=secure, path=COME)
    return answer


def _unknown(visit: Visit) -> Response:
    if by_browser(visit.request):
        return visit.page("link_unknown.html", 401)
    raise WebError(Code.NO_SESSION, "link", "the link of a session", "an unknown one")


def _coming(visit: Visit) -> Response:
    """Ask whether the session of a link is to be opened here; the address has no token any more."""
    coming = sessions.find(visit.web.store, visit.request.cookies.get(COMING, ""))
    return visit.page("come.html", coming=coming.id) if coming else visit.go("/")


def _came(visit: Visit) -> Response:
    """Open the session of a link, as its person confirmed; another that this browser had is replaced."""
    visit.web.rates["token"].check(_sender(visit), COME)
    coming = sessions.find(visit.web.store, visit.request.cookies.get(COMING, ""))
    answer = _unknown(visit) if coming is None else _entered(visit, visit.go("/"), coming.token)
    answer.delete_cookie(COMING, path=COME)
    return answer


def _mine(visit: Visit) -> Response:
    assert visit.session is not None
    studied = any(takes_part(visit.web, visit.person) for takes_part in visit.web.studied)
    return visit.page("mine.html", link=f"{base_of(visit)}{COME}/{visit.session.token}", studied=studied)


def _delete(visit: Visit) -> Response:
    """Delete a session with all that belongs to it, as its person asked, except works on which others built."""
    sessions.withdraw(visit.web.store, visit.person, visit.web.keeps)
    visit.web.written()
    answer = visit.go("/?deleted=yes")
    answer.delete_cookie(sessions.COOKIE)
    answer.headers["Clear-Site-Data"] = '"storage"'  # what a page kept of an unfinished text goes, too
    return answer


def _privacy(visit: Visit) -> Response:
    """Return the page on stored data of persons."""
    return visit.page("privacy.html")


def _phrases(visit: Visit) -> Response:
    """Return the sentences that scripts say."""
    return Response(script(language()), media_type="text/javascript")


def _door(visit: Visit) -> Response:
    return visit.page("desk_door.html", wrong=visit.fields.get("wrong") == "yes")


def _enter(visit: Visit) -> Response:
    """Enter the desk by its token, from the form or from the link that `serve` prints."""
    visit.web.rates["token"].check(_sender(visit), "/desk/enter")
    token = visit.request.path_params.get("token") or visit.field("token", 200)
    if not hmac.compare_digest(sessions.digest(token), visit.web.desk):
        if "token" in visit.request.path_params:  # it may be right but for a letter: it leaves the address bar
            return visit.go("/desk/enter?wrong=yes")
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
    return sender_of(visit.request)


def base_of(visit: Visit) -> str:
    """Return the address of this server as its people have it: by https where they come by a public name."""
    host = visit.request.headers.get("host", "")
    return f"{scheme_of(host)}://{host}"


ADDRESSES = (
    get("/", _start, Who.ANYONE),
    post("/begin", _begin, Who.ANYONE),
    get("/come/{token}", _come, Who.ANYONE),
    get(COME, _coming, Who.ANYONE),
    post(COME, _came, Who.ANYONE),
    get("/privacy", _privacy, Who.ANYONE),
    get("/phrases.js", _phrases, Who.ANYONE),
    get("/mine", _mine),
    post("/mine/delete", _delete),
    get("/desk/enter", _door, Who.ANYONE),
    post("/desk/enter", _enter, Who.ANYONE),
    get("/desk/enter/{token}", _enter, Who.ANYONE),
    get("/desk", _desk, Who.RESEARCHER),
)
"""The addresses outside rooms."""
