"""A person's socket: messages in are checked, faults are answered, and the room gets only valid messages."""

import asyncio
from contextlib import suppress
from typing import Any

import orjson
from starlette.websockets import WebSocket, WebSocketDisconnect

from hearth.schemas.failures import Code
from hearth.web.limits import QUIET_SECONDS
from hearth.web.messages import Inbox
from hearth.web.room_request import Web
from hearth.web.sessions import Session
from hearth.web.web_errors import WebError


class Link:
    """A socket of a session.

    Attributes:
        web: the common state of all handlers.
        session: whose it is.
        socket: for the address's parts, and for closing.
    """

    def __init__(self, web: Web, session: Session, socket: WebSocket) -> None:
        self.web, self.session, self.socket = web, session, socket
        self._inbox = Inbox()

    async def receive(self) -> dict[str, Any] | None:
        """Return the next message that is in order.

        Each that is not gets a fault as its answer. None once it is closed.
        """
        while True:
            try:
                # A page says hello at once; later a person may think for as long as the socket answers pings.
                async with asyncio.timeout(None if self._inbox.last else QUIET_SECONDS):
                    came = await self.socket.receive()
            except (WebSocketDisconnect, RuntimeError):
                return None
            except TimeoutError:
                await self._end(4408)
                return None
            if came["type"] == "websocket.disconnect":
                return None
            raw = came.get("text")
            try:
                return self._inbox.take(raw if raw is not None else came.get("bytes") or b"")
            except WebError as fault:
                await self.refuse(fault)

    async def _end(self, code: int) -> None:
        with suppress(WebSocketDisconnect, RuntimeError):
            await self.socket.close(code)

    async def send(self, message: dict[str, Any]) -> None:
        """Send a message; nothing happens if the other side has gone."""
        try:
            await self.socket.send_text(orjson.dumps(message).decode())
        except (WebSocketDisconnect, RuntimeError):
            return

    async def send_bytes(self, data: bytes) -> None:
        """Send bytes; nothing happens if the other side has gone."""
        with suppress(WebSocketDisconnect, RuntimeError):
            await self.socket.send_bytes(data)

    async def refuse(self, fault: WebError) -> None:
        """Send a fault: `{"type": "error", "error": {...}, "next": the number of the next message}`."""
        await self.send({"type": "error", **fault.as_json(), "next": self._inbox.last + 1})


def nobody() -> WebError:
    """Return the refusal for a sender without a session."""
    return WebError(Code.NO_SESSION, "session", "the token of a session", "none, or an unknown one")
