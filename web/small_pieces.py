"""Bodies in very small chunks, and sockets with very many frames: refused, as each costs as much as a large one."""

from typing import Any

import h11
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.exceptions import ProtocolError
from websockets.frames import Frame
from websockets.server import ServerProtocol

from hearth.web.limits import BURST_OF_FRAMES, FRAMES_EACH_SECOND, FREE_CHUNKS, LEAST_OF_A_CHUNK, Rate


class Requests(h11.Connection):
    """A connection's requests, whose bodies come in pieces of a sensible size."""

    _pieces = 0
    _bytes = 0

    def next_event(self) -> Any:
        """Return what came next.

        Raises:
            h11.RemoteProtocolError: it is not HTTP, or a body comes in too many pieces.
        """
        event = super().next_event()
        if isinstance(event, h11.Request):
            self._pieces = self._bytes = 0
        elif isinstance(event, h11.Data):
            self._pieces += 1
            self._bytes += len(event.data)
            if self._pieces > FREE_CHUNKS + self._bytes // LEAST_OF_A_CHUNK:
                raise h11.RemoteProtocolError("a body in too many pieces")
        return event


class _Frames(ServerProtocol):
    """A socket's frames, whose number a second is bounded; the connection ends if there are more."""

    def __init__(self, *args: Any, **more: Any) -> None:
        super().__init__(*args, **more)
        self._rate = Rate(FRAMES_EACH_SECOND, BURST_OF_FRAMES)

    def recv_frame(self, frame: Frame) -> None:
        """Take a frame.

        Raises:
            ProtocolError: it is out of order, or one too many.
        """
        if not self._rate.allows(""):
            raise ProtocolError("too many frames")
        super().recv_frame(frame)


class Socket(WebSocketsSansIOProtocol):
    """A connection that became a socket."""

    def __init__(self, *args: Any, **more: Any) -> None:
        super().__init__(*args, **more)
        given = self.conn
        self.conn = _Frames(
            extensions=given.available_extensions, max_size=self.config.ws_max_size, logger=given.logger
        )
