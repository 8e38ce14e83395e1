"""Runs the server on this machine until it is stopped."""

from __future__ import annotations

import socket

import h11
import uvicorn
from starlette.types import ASGIApp
from uvicorn.protocols.http.h11_impl import H11Protocol

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.web.limits import MOST_MESSAGE
from hearth.web.security import HEADERS


class _Protocol(H11Protocol):
    """A protocol that answers requests that are not HTTP with the headers of every other answer."""

    def send_400_response(self, msg: str) -> None:
        headers = [(name.encode(), value.encode()) for name, value in HEADERS.items()]
        headers += [(b"content-type", b"text/plain; charset=utf-8"), (b"connection", b"close")]
        for event in (
            h11.Response(status_code=400, headers=headers, reason=b"Bad Request"),
            h11.Data(data=msg.encode("ascii", "replace")),
            h11.EndOfMessage(),
        ):
            self.transport.write(self.conn.send(event) or b"")
        self.transport.close()


def listening(port: int) -> socket.socket:
    """A socket on 127.0.0.1 that listens; on any free port if `port` is 0.

    Raises:
        HearthError: UNWRITABLE, if the port is taken.
    """
    made = socket.socket()
    made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        made.bind(("127.0.0.1", port))
    except OSError as error:
        made.close()
        message = f"port {port} of 127.0.0.1 can't be used: {str(error.strerror).lower()}"
        raise HearthError.of(Code.UNWRITABLE, message, suggestion="give another with --port, or 0 for any") from error
    made.listen(256)
    return made


def run(app: ASGIApp, where: socket.socket) -> None:
    """Answer on a socket until interrupted."""
    config = uvicorn.Config(
        app,
        http=_Protocol,
        ws="websockets-sansio",
        ws_max_size=4 * MOST_MESSAGE,  # larger ones end the connection; smaller ones are refused with a reason
        access_log=False,
        log_level="warning",
        server_header=False,
        timeout_graceful_shutdown=3,
    )
    uvicorn.Server(config).run(sockets=[where])
