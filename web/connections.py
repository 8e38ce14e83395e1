"""Connections to the server: ended when nothing comes or goes for too long, few enough for the limit of open files."""

from __future__ import annotations

import asyncio
import re
import socket
import struct
from typing import Any, ClassVar

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

from hearth.web.limits import MOST_CONNECTIONS, QUIET_SECONDS
from hearth.web.security import HEADERS
from hearth.web.small_pieces import Requests

LOOK_EVERY = 1.0
"""Seconds between looks at all connections."""

NEWEST_KEPT = 1.0
"""Seconds that a connection may be quiet before a newer one takes its place at the limit."""

HELD_FILES = 150
"""Open files that connections leave to the store, to pages and to those that the kernel accepts at once."""

KERNEL_QUEUE = 64
"""Connections that the kernel keeps until they are accepted."""

_HEAD_ENDS = re.compile(rb"\n\r?\n")
_LOOSE = re.compile(rb"(?<!\r)\n|\n[ \t]|\r(?!\n)")
"""Ends of lines that h11 takes and other servers do not, or the other way round; headers that go on in a next line."""

_LENGTHS = re.compile(rb"(?im)^(content-length|transfer-encoding)[ \t]*:([^\r\n]*)")


class Connection(H11Protocol):
    """A connection: HTTP, until it becomes a socket.

    Attributes:
        quiet_since: when the wait for the next request began, by the loop's clock.
    """

    open: ClassVar[set[Connection]] = set()
    """Every connection of this process, sockets too."""

    most: ClassVar[int] = MOST_CONNECTIONS
    """Connections that may be open at once."""

    quiet_since: float
    _seen: Any = None
    _unsent: tuple[int, float] = (0, 0.0)

    def __init__(self, *args: Any, **more: Any) -> None:
        super().__init__(*args, **more)
        self.conn = Requests(h11.SERVER, self.conn._max_incomplete_event_size)

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Take a connection; at the limit it takes the place of the one that has been quiet longest, or is refused."""
        super().connection_made(transport)
        self.quiet_since = self.loop.time()
        if len(Connection.open) >= Connection.most and not self._makes_room():
            self._drop()
            return
        Connection.open.add(self)

    def connection_lost(self, exc: Exception | None) -> None:
        """Forget the connection."""
        Connection.open.discard(self)
        super().connection_lost(exc)

    def handle_events(self) -> None:
        """Read what came; refuse a request of which a proxy may see another end, or other headers."""
        head = self.conn.trailing_data[0] if self.conn.their_state is h11.IDLE else b""
        if _LOOSE.search(_head(head)):
            self.send_400_response("Lines of a head end in CRLF, and no header goes on in the next line.")
            return
        if _is_ambiguous(head):
            self.send_400_response("Exactly one of Content-Length and Transfer-Encoding.")
            return
        super().handle_events()

    def send_400_response(self, msg: str) -> None:
        """Answer what is not HTTP with the headers of every other answer; after half an answer, end the connection."""
        if self.cycle is not None and not self.cycle.response_complete:  # its handler has nothing more to say here
            self.cycle.disconnected = True
            self.cycle.message_event.set()
        if self.conn.our_state not in (h11.IDLE, h11.SEND_RESPONSE):
            self._drop()
            return
        headers = [(name.encode(), value.encode()) for name, value in HEADERS.items()]
        headers += [(b"content-type", b"text/plain; charset=utf-8"), (b"connection", b"close")]
        for event in (
            h11.Response(status_code=400, headers=headers, reason=b"Bad Request"),
            h11.Data(data=msg.encode("ascii", "replace")),
            h11.EndOfMessage(),
        ):
            self.transport.write(self.conn.send(event) or b"")
        self.transport.close()

    def look(self, now: float) -> None:
        """End the connection if it asks nothing, or reads nothing, for too long."""
        unsent, since = self.transport.get_write_buffer_size(), self._unsent[1]
        if unsent != self._unsent[0]:
            self._unsent = unsent, now
        elif unsent and now - since > QUIET_SECONDS:
            self._drop()
        if self.transport.is_closing():
            if not unsent:
                Connection.open.discard(self)
        elif self._is_waiting(now) and now - self.quiet_since > QUIET_SECONDS:
            self.transport.close()

    def _is_waiting(self, now: float) -> bool:
        """Return whether the server waits for a request; a socket and a request that is answered do not count."""
        if self.transport.get_protocol() is not self:
            return False
        if self.cycle is not self._seen or (self.cycle is not None and not self.cycle.response_complete):
            self._seen, self.quiet_since = self.cycle, now
            return False
        return True

    def _drop(self) -> None:
        """End the connection at once; the kernel keeps nothing that was to be sent."""
        made = self.transport.get_extra_info("socket")
        if made is not None:
            made.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.transport.abort()

    def _makes_room(self) -> bool:
        """Return whether the connection that has been quiet longest was ended for this one."""
        now = self.loop.time()
        quiet = [each for each in Connection.open if not each.transport.is_closing() and each._is_waiting(now)]
        oldest = min(quiet, key=lambda each: each.quiet_since, default=None)
        if oldest is None or now - oldest.quiet_since < NEWEST_KEPT:
            return False
        oldest._drop()
        Connection.open.discard(oldest)
        return True


def _head(data: bytes) -> bytes:
    """Return the lines of a request's head, as far as the empty line after them; nothing before it has come whole."""
    end = _HEAD_ENDS.search(data)
    return data[: end.end()] if end else b""


def _is_ambiguous(head: bytes) -> bool:
    """Return whether a request's head has two lengths, or chunks in a version of HTTP that has none."""
    lines = _head(head)
    found = _LENGTHS.findall(lines)
    old = lines.partition(b"\n")[0].rstrip().endswith(b"HTTP/1.0")
    return len(found) > 1 or any(b"," in value or (old and name[:1] in b"tT") for name, value in found)


async def watch() -> None:
    """Look at all connections again and again, until cancelled."""
    loop = asyncio.get_running_loop()
    while True:
        await asyncio.sleep(LOOK_EVERY)
        for each in tuple(Connection.open):
            each.look(loop.time())


def affordable() -> int:
    """Return the connections that the limit of open files allows, once it is as high as this user may set it."""
    try:
        import resource
    except ImportError:  # no such limit on this system
        return MOST_CONNECTIONS
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = MOST_CONNECTIONS + HELD_FILES
    if soft < wanted and (hard == resource.RLIM_INFINITY or hard > soft):
        soft = wanted if hard == resource.RLIM_INFINITY else min(wanted, hard)
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
    return max(8, min(MOST_CONNECTIONS, soft - HELD_FILES))
