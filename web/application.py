"""The server as one ASGI application: rooms, start page, desk, files, and the checks on every request."""

import hmac
import logging
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl

import jinja2
from sqlalchemy.exc import DBAPIError, IntegrityError
from starlette.applications import Starlette
from starlette.datastructures import MutableHeaders
from starlette.exceptions import HTTPException
from starlette.middleware.gzip import GZipMiddleware
from starlette.requests import HTTPConnection, Request
from starlette.responses import HTMLResponse, RedirectResponse, Response
from starlette.routing import BaseRoute, Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocket

from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.spoken_words import spoken
from hearth.web import deadlines, desk_access, sessions, start_pages
from hearth.web.errors_as_faults import fault_of
from hearth.web.handler_threads import DESK_WITHIN, WITHIN, in_thread
from hearth.web.languages import speak_to
from hearth.web.limits import MOST_FIELDS, Rate, usual_rates
from hearth.web.person_socket import Link, nobody
from hearth.web.phrases import direction, language, refused, room_title, say_in_page
from hearth.web.request_body import body_of
from hearth.web.room import Address, Room, Who
from hearth.web.room_registry import ROOMS
from hearth.web.room_request import Visit, Web, by_browser, json_answer, render
from hearth.web.security import Security
from hearth.web.sender_addresses import Network, sender_of
from hearth.web.sessions import Session
from hearth.web.store import Store
from hearth.web.third_party_scripts import FETCHED
from hearth.web.web_errors import WebError

HERE = Path(__file__).resolve().parent

LOG = logging.getLogger("uvicorn.error")

TRY_LATER = 1013
"""The code with which a socket is closed that a busy server can't serve."""


def application(
    store: Store,
    known: Knowledge,
    out: Path,
    desk: str,
    study: Path | None = None,
    films: Path | None = None,
    hosts: Collection[str] = (),
    rooms: Sequence[Room] = ROOMS,
    rates: Mapping[str, Rate] | None = None,
    lab: Network | None = None,
) -> ASGIApp:
    """Return the server.

    Args:
        store: the database.
        known: the knowledge that programs are checked against.
        out: the server's folder.
        desk: the desk's token.
        study: the file of the study.
        films: a dataset whose films people describe.
        hosts: names of a public address by which people come, over https.
        rooms: the rooms of the server.
        rates: limits on the rate of requests; the usual ones if None.
        lab: the network behind which many participants sit, whom limits by address do not count.
    """
    templates = _templates(rooms)
    rates, follows = rates or usual_rates(), tuple(room.opens for room in rooms)
    keeps, studied = tuple(room.keeps for room in rooms), tuple(room.studied for room in rooms)
    common = (store, known, out, templates, sessions.digest(desk), rates, study, bool(hosts), films)
    web = Web(*common, follows, keeps, studied, lab)
    web.written()
    routes: list[BaseRoute] = [_route(web, address) for address in start_pages.ADDRESSES]
    for room in rooms:
        for prefix, addresses in ((f"/{room.name}", room.addresses), (f"/desk/{room.name}", _for_desk(room.desk))):
            routes += [_route(web, address, prefix) for address in addresses]
    routes.append(Mount("/static", _packed(StaticFiles(directory=HERE / "static"))))
    routes.append(Mount("/fetched", _packed(_Fetched(directory=FETCHED, check_dir=False))))
    handlers: dict[Any, Any] = {
        kind: partial(_refused, web) for kind in (WebError, HearthError, HTTPException, DBAPIError, OSError, Exception)
    }
    made = Starlette(routes=routes, exception_handlers=handlers)
    made.router.redirect_slashes = False  # it would send people to the `Host` that they asked for
    return Security(made, hosts)


def _packed(files: StaticFiles) -> ASGIApp:
    """Return files that are sent compressed, and that browsers keep: they ask whether a file is still the same.

    Pages are not compressed: the length of a compressed page betrays its secrets to a person who writes a part of it.
    """

    async def kept(scope: Scope, receive: Receive, send: Send) -> None:
        async def sent(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message)["Cache-Control"] = "no-cache"
            await send(message)

        await files(scope, receive, sent)

    return GZipMiddleware(kept, minimum_size=1_000, compresslevel=6)


class _Fetched(StaticFiles):
    """Scripts of others, which are not there until `make web` was run."""

    async def check_config(self) -> None:
        if not Path(str(self.directory)).is_dir():
            raise HTTPException(404)


def _templates(rooms: Sequence[Room]) -> jinja2.Environment:
    made = jinja2.Environment(
        loader=jinja2.FileSystemLoader(HERE / "templates"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.globals.update(say=say_in_page, refused=refused, room_title=room_title, language=language, direction=direction)
    made.globals["spoken"] = spoken
    made.globals["all_rooms"] = [room for room in rooms if room.listed]
    made.globals["desks"] = [room for room in rooms if room.desk]
    return made


def _for_desk(addresses: Sequence[Address]) -> list[Address]:
    return [Address(each.method, each.path, each.handler, Who.RESEARCHER, each.most) for each in addresses]


def _route(web: Web, address: Address, prefix: str = "") -> BaseRoute:
    if address.method == "SOCKET":
        return WebSocketRoute(prefix + address.path, partial(_connect, web, address))
    return Route(prefix + address.path, _endpoint(web, address), methods=[address.method])


def _endpoint(web: Web, address: Address) -> Callable[[Request], Any]:
    within = DESK_WITHIN if address.who is Who.RESEARCHER else WITHIN

    async def endpoint(request: Request) -> Response:
        deadlines.begin()
        speak_to(web, request)
        # By session, for many people may have one address; a token that is made up is none.
        session = await in_thread(sessions.find, web.store, token_of(request))
        sender = session.id if session else sender_of(request)
        web.rates["request"].check(sender, request.url.path)
        body = await body_of(request, address.most)
        return await in_thread(_answer, web, address, request, session, body, within=within)

    return endpoint


def _answer(web: Web, address: Address, request: Request, session: Session | None, body: bytes) -> Response:
    """Run a handler, in a thread.

    Raises:
        WebError: NO_SESSION or NOT_ALLOWED, if the sender may not ask; errors of the handler.
    """
    if address.who is Who.PERSON and session is None:
        raise nobody()
    if address.who is Who.RESEARCHER and not _is_researcher(web, request):
        raise WebError(Code.NOT_ALLOWED, "desk", "the desk's token", "none, or another")
    is_form = request.headers.get("content-type", "").startswith("application/x-www-form-urlencoded")
    fields = dict(request.query_params)
    if is_form:
        fields = _form(body)
    try:
        return address.handler(Visit(web, request, session, body, fields))  # type: ignore[no-any-return]
    except IntegrityError:
        if session is not None and sessions.find(web.store, session.token) is None:
            raise nobody() from None  # it was deleted after the request had come
        raise


def _form(body: bytes) -> dict[str, str]:
    """Return the fields of a form; of several of one name, the last.

    Raises:
        WebError: BAD_ARGUMENT: there are too many.
    """
    try:
        return dict(parse_qsl(body.decode("utf-8", "replace"), keep_blank_values=True, max_num_fields=MOST_FIELDS))
    except ValueError:
        raise WebError(Code.BAD_ARGUMENT, "form", f"at most {MOST_FIELDS:,} fields", "more") from None


def token_of(asked: HTTPConnection) -> str:
    """Return the token of a session that came with a request.

    A cookie, or `Authorization: Bearer TOKEN` of programs.
    """
    kind, _, given = asked.headers.get("authorization", "").partition(" ")
    return given if kind.lower() == "bearer" else asked.cookies.get(sessions.COOKIE, "")


def _is_researcher(web: Web, request: Request) -> bool:
    kind, _, given = request.headers.get("authorization", "").partition(" ")
    token = given if kind.lower() == "bearer" else request.cookies.get(desk_access.COOKIE, "")
    return hmac.compare_digest(sessions.digest(token), web.desk)


async def _connect(web: Web, address: Address, socket: WebSocket) -> None:
    deadlines.begin(deadlines.OPENS)
    speak_to(web, socket)
    try:
        session = await in_thread(sessions.find, web.store, token_of(socket))
    except HearthError as error:
        await socket.accept()
        await socket.send_json({"type": "error", **fault_of(error).as_json()})
        await socket.close(TRY_LATER)
        return
    await socket.accept()
    if not web.rates["request"].allows(session.id if session else sender_of(socket)):
        fast = WebError(Code.TOO_FAST, "socket", f"at most {web.rates['request'].each_second:g} a second", "more")
        await socket.send_json({"type": "error", **fast.as_json()})
        await socket.close(TRY_LATER)
        return
    if session is None:
        await socket.send_json({"type": "error", **nobody().as_json()})
        await socket.close(4401)
        return
    await address.handler(Link(web, session, socket))


async def _refused(web: Web, asked: Request, error: Exception) -> Response:
    """Return the answer to a request that is refused: a page for browsers, else JSON."""
    fault = fault_of(error)
    if isinstance(error, OSError) and fault.code is Code.INTERNAL_ERROR:
        raise error  # it is ours, and the log is to say where
    if isinstance(error, DBAPIError):  # its text can have what somebody wrote
        LOG.error("the database refused a statement: %s %s", type(error.orig).__name__, type(error).__name__)
    answer = _refusal(web, asked, error, fault)
    if fault.code is Code.TIMED_OUT:  # what is left of a body is not waited for
        answer.headers["Retry-After"], answer.headers["Connection"] = "2", "close"
    return answer


def _address(asked: Request) -> str:
    """Return the requested address with its query, such as the ids of a platform."""
    return asked.url.path + (f"?{asked.url.query}" if asked.url.query and asked.method == "GET" else "")


def _refusal(web: Web, asked: Request, error: Exception, fault: WebError) -> Response:
    status = error.status_code if isinstance(error, HTTPException) else fault.status
    if not by_browser(asked):
        return json_answer(fault.as_json(), status)
    if fault.instead:
        return RedirectResponse(fault.instead, 303)
    begins = fault.code is Code.NO_SESSION
    back, lost = (_address(asked) if begins else "/"), begins and bool(token_of(asked))
    desk = asked.url.path.startswith("/desk")
    page = render(web, "fault.html", None, fault=fault, begins=begins, back=back, lost=lost, desk=desk)
    comes = begins and not lost and asked.method in ("GET", "HEAD")  # a newcomer has done nothing wrong
    return HTMLResponse(page, 200 if comes else status)
