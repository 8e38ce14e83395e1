"""VirtualHome's Unity protocol over HTTP: requests of clients, answered one after the other."""

from __future__ import annotations

import logging
from functools import partial
from typing import Any

from starlette.applications import Starlette
from starlette.requests import Request as HttpRequest
from starlette.responses import Response
from starlette.routing import Route
from starlette.types import ASGIApp

from hearth.interop.virtualhome.protocol_actions import Simulator
from hearth.interop.virtualhome.protocol_messages import MOST_REQUEST, Reply, read_request, refusal
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.terminal import shown
from hearth.web import deadlines
from hearth.web.handler_threads import DESK_WITHIN, in_thread
from hearth.web.request_body import body_of
from hearth.web.room_request import json_answer
from hearth.web.security import Security
from hearth.web.web_errors import WebError

LOG = logging.getLogger("uvicorn.error")

LONGEST_LINE = 400
"""Characters of a line of the log."""

PATIENCE = 25.0
"""Seconds that a request waits while others are answered: clients of Unity wait for 30."""


class UnityServer:
    """A simulator that several clients share; each of their requests is answered whole before the next.

    Args:
        simulator: what answers.
    """

    def __init__(self, simulator: Simulator) -> None:
        self._simulator = simulator
        self._lock = deadlines.BoundedLock("the simulator")

    def answer(self, body: bytes) -> dict[str, Any]:
        """Return the reply to the body of a request, in a thread; a refusal is a line of the log, too."""
        number, action = "", "a request"
        try:
            request = read_request(body)
            number, action = request.id, request.action
            with self._lock:
                reply = self._simulator.answer(request)
        except HearthError as error:
            reply = refusal(error)
        except Exception:
            LOG.exception("a request of the Unity protocol was not answered")
            reply = Reply(False, f"Hearth itself failed; its log says where ({Code.INTERNAL_ERROR})")
        if not reply.success:
            _log_refusal(action, reply.message)
        return reply.as_json(number)


def _log_refusal(action: str, message: str) -> None:
    """Write a refusal into the log: most methods of the published client keep its message to themselves."""
    # The whole text is the form of the line: the log writes few lines of one form a minute.
    LOG.warning(shown(" ".join(f"refused {action}: {message}".split()))[:LONGEST_LINE])


async def _endpoint(server: UnityServer, request: HttpRequest) -> Response:
    """Answer a request; what is refused is a reply, too, as clients of Unity expect."""
    deadlines.begin(PATIENCE)
    try:
        body = await body_of(request, MOST_REQUEST)
        return json_answer(await in_thread(server.answer, body, within=DESK_WITHIN))
    except WebError as error:
        found = f"expected {error.expected}, found {error.actual} ({error.code})"
        _log_refusal("a request", f"{error.place}: {found}")
        answer = json_answer(Reply(False, f"{error.place}: {found}").as_json(""))
        answer.headers["Connection"] = "close"
        return answer
    except HearthError as error:
        reply = refusal(error)
        _log_refusal("a request", reply.message)
        return json_answer(reply.as_json(""))


def unity_application(simulator: Simulator) -> ASGIApp:
    """Return a server that speaks the protocol at its root, for programs of this machine alone."""
    server = UnityServer(simulator)
    made = Starlette(routes=[Route("/", partial(_endpoint, server), methods=["POST"])])
    made.router.redirect_slashes = False
    return Security(made)
