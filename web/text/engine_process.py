"""A process in which worlds are played, seen from the server: it asks without waiting for one another's answers."""

from __future__ import annotations

import asyncio
from collections import deque
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from typing import Any

import orjson

from hearth.schemas.failures import Code
from hearth.storage.parallel import context
from hearth.web.deadlines import busy
from hearth.web.handler_threads import MOST_WAITING, WITHIN
from hearth.web.text.open_worlds import DONE, Offered, serve_worlds
from hearth.web.web_errors import WebError

WINDOW = 64 * 1024
"""Bytes of questions that are sent before their answers come: fewer than a line holds, so that no end ever waits."""

READY_WITHIN = 120.0
"""Seconds that a process may take to start: others use the machine, too."""

Answer = asyncio.Future[bytes]


def lost() -> WebError:
    """Return the fault of a world whose process ended."""
    return WebError(Code.UNKNOWN_ID, "id", "a world that is open", "one whose process ended; create another")


class EngineProcess:
    """A process with some of the worlds.

    Args:
        offered: the episodes that it can begin.

    Attributes:
        starts: how often the process was started; worlds of an earlier start are lost.
    """

    def __init__(self, offered: Offered) -> None:
        self._offered = offered
        self.starts = 0
        self._waiting: deque[tuple[bytes, Answer]] = deque()
        self._sent: deque[tuple[int, Answer]] = deque()
        self._unanswered = 0

    async def start(self) -> None:
        """Start the process, and wait until it can answer."""
        loop = asyncio.get_running_loop()
        self._line, other = Pipe()
        made: Any = context()
        self._process = made.Process(target=serve_worlds, args=(self._offered, other), daemon=True)
        await loop.run_in_executor(None, self._process.start)
        other.close()
        self.starts += 1
        self._sent.append((0, ready := loop.create_future()))
        loop.add_reader(self._line.fileno(), self._readable, self._line)
        await asyncio.wait_for(ready, READY_WITHIN)

    async def ask(self, *operation: Any) -> bytes:
        """Return the JSON that answers an operation.

        Raises:
            WebError: the fault of the operation; UNKNOWN_ID: the process ended.
            HearthError: TIMED_OUT: too many wait, or no answer came in time; the process is started anew.
        """
        if len(self._waiting) >= MOST_WAITING:
            raise busy("the server")
        answer: Answer = asyncio.get_running_loop().create_future()
        self._waiting.append((orjson.dumps(operation), answer))
        self._send()
        try:
            async with asyncio.timeout(WITHIN):
                got = await asyncio.shield(answer)
        except TimeoutError:
            self._process.kill()  # its worlds wait for one that does not end
            raise busy("the server") from None
        if got[:1] != DONE:
            raise WebError(**{**(fault := orjson.loads(got[1:])), "code": Code[fault["code"]]})
        return got[1:]

    def _send(self) -> None:
        while self._waiting:
            size = len(self._waiting[0][0])
            if self._unanswered and self._unanswered + size > WINDOW:
                return
            asked, answer = self._waiting.popleft()
            self._sent.append((size, answer))
            self._unanswered += size
            try:
                self._line.send_bytes(asked)
            except OSError:  # it ended; the reader sees that
                return

    def _readable(self, line: Connection) -> None:
        try:
            got = line.recv_bytes()
        except (EOFError, OSError):
            self._ended(line)
            return
        size, answer = self._sent.popleft()
        self._unanswered -= size
        if not answer.done():
            answer.set_result(got)
        self._send()

    def _ended(self, line: Connection) -> None:
        """Refuse what waits for a process that ended, and start another."""
        asyncio.get_running_loop().remove_reader(line.fileno())
        line.close()
        left = [answer for _, answer in (*self._sent, *self._waiting)]
        self._sent.clear()
        self._waiting.clear()
        self._unanswered = 0
        for answer in left:
            if not answer.done():
                answer.set_exception(lost())
        self._starting = asyncio.ensure_future(self.start())

    def stop(self) -> None:
        """End the process."""
        asyncio.get_running_loop().remove_reader(self._line.fileno())
        self._line.close()
        self._process.terminate()
