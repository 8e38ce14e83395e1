"""Runs the server on this machine until it is stopped."""

import asyncio
import socket

import uvicorn
from starlette.types import ASGIApp

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.web.connections import KERNEL_QUEUE, Connection, affordable, watch
from hearth.web.limits import MOST_MESSAGE, QUIET_SECONDS
from hearth.web.log_limits import limit_logs
from hearth.web.small_pieces import Socket


class _Server(uvicorn.Server):
    """Looks at its connections while it runs."""

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Begin to answer."""
        limit_logs()
        Connection.most = affordable()
        await super().startup(sockets)
        self._watching = asyncio.create_task(watch())

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Answer no more."""
        self._watching.cancel()
        await super().shutdown(sockets)


def listening(port: int, host: str = "127.0.0.1") -> socket.socket:
    """Return a socket that listens on an address of this machine; on any free port if `port` is 0.

    Raises:
        HearthError: UNWRITABLE, if the port is taken, or the machine does not have the address.
    """
    made = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        made.bind((host, port))
    except OSError as error:
        made.close()
        message = f"port {port} of {host} can't be used: {str(error.strerror).lower()}"
        raise HearthError.of(Code.UNWRITABLE, message, suggestion="give another with --port, or 0 for any") from error
    made.listen(KERNEL_QUEUE)
    return made


def run(app: ASGIApp, where: socket.socket, proxy: str = "") -> None:
    """Answer on a socket until interrupted.

    Args:
        app: what answers.
        where: the socket.
        proxy: the address of the proxy whose word on a visitor's address counts; the socket's address counts if "".
    """
    config = uvicorn.Config(
        app,
        http=Connection,
        ws=Socket,
        ws_max_size=4 * MOST_MESSAGE,  # larger ones end the connection; smaller ones are refused with a reason
        ws_ping_interval=0.3 * QUIET_SECONDS,
        ws_ping_timeout=0.7 * QUIET_SECONDS,
        access_log=False,
        log_level="warning",
        server_header=False,
        backlog=KERNEL_QUEUE,
        proxy_headers=bool(proxy),
        forwarded_allow_ips=proxy or "",
        timeout_graceful_shutdown=3,
    )
    _Server(config).run(sockets=[where])
