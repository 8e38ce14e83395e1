"""Lines to and from somebody else: a child process, a loopback socket, or our own standard input and output.

A line that is too long is left out whole and reported; nobody is waited for longer than a deadline. Deadlines are
times of `time.monotonic`. It needs `select` on pipes, which Windows lacks.
"""

from __future__ import annotations

import contextlib
import os
import select
import signal
import socket
import subprocess
import time
from collections.abc import Sequence
from typing import NoReturn

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

LONGEST_LINE = 65_536
"""Bytes of a line that is read."""

_PIECE = 4096
"""Bytes written at once: as much as a pipe takes without waiting when `select` reports it writable."""

LOOPBACK = "127.0.0.1"


class Channel:
    """Lines over two file descriptors.

    Attributes:
        open: whether the other end is there, as far as is known.
    """

    def __init__(self, read: int, write: int) -> None:
        self._read, self._write = read, write
        self._received, self._unsent = bytearray(), bytearray()
        self._skipping = False
        self.open = True

    def send(self, line: bytes, deadline: float) -> None:
        """Write a line. What can't be written by the deadline is written first the next time.

        Raises:
            HearthError: TIMED_OUT; DISCONNECTED.
        """
        self._need_open()
        self._flush(deadline)
        self._unsent += line + b"\n"
        self._flush(deadline)

    def _flush(self, deadline: float) -> None:
        """Write what is unsent, and meanwhile read: an agent that writes may not read before it is read."""
        while self._unsent:
            room = self._skipping or len(self._received) < 2 * LONGEST_LINE
            readable, writable, _ = select.select([self._read] if room else [], [self._write], [], _left(deadline))
            if not (readable or writable):
                raise HearthError.of(Code.TIMED_OUT, "the agent does not read what it is sent")
            if readable:
                self._pull()
            if writable:
                self._push()

    def _push(self) -> None:
        try:
            del self._unsent[: os.write(self._write, self._unsent[:_PIECE])]
        except OSError:
            self._gone()

    def _pull(self) -> None:
        """Read what has come; of a line that is too long nothing is kept."""
        try:
            data = os.read(self._read, LONGEST_LINE)
        except OSError:
            data = b""
        if not data:
            self._gone()
        self._received += data
        if self._skipping:
            self._skip()

    def _skip(self) -> None:
        end = self._received.find(b"\n")
        del self._received[: end + 1 if end >= 0 else len(self._received)]
        self._skipping = end < 0

    def receive(self, deadline: float) -> bytes:
        """The next line, without its end.

        Raises:
            HearthError: TIMED_OUT; DISCONNECTED; LINE_TOO_LONG, once for each such line.
        """
        while True:
            line = self._line()
            if line is not None:
                return line
            self._need_open()
            if not select.select([self._read], [], [], _left(deadline))[0]:
                raise HearthError.of(Code.TIMED_OUT, "the agent did not answer in time")
            self._pull()

    def _line(self) -> bytes | None:
        """A whole line of what was received, if there is one."""
        end = self._received.find(b"\n")
        if end > LONGEST_LINE or (end < 0 and len(self._received) > LONGEST_LINE):
            self._skipping = True
            self._skip()
            remedy = f"at most {LONGEST_LINE:,} bytes"
            raise HearthError.of(Code.LINE_TOO_LONG, "an answer that is too long", suggestion=remedy)
        if end < 0:
            return None
        line = bytes(self._received[:end])
        del self._received[: end + 1]
        return line

    def _need_open(self) -> None:
        if not self.open:
            self._gone()

    def _gone(self) -> NoReturn:
        self.open = False
        raise HearthError.of(Code.DISCONNECTED, "the agent is gone")

    def close(self) -> None:
        """End it; may be called again."""
        self.open = False


class SocketChannel(Channel):
    """Lines over a connected socket."""

    def __init__(self, connection: socket.socket) -> None:
        super().__init__(connection.fileno(), connection.fileno())
        self._connection = connection

    def close(self) -> None:
        """Close the socket."""
        super().close()
        self._connection.close()


class ProcessChannel(Channel):
    """Lines to the standard input of a child process and from its standard output.

    Args:
        argv: the program and its arguments; no shell reads them. Its standard error stays ours.

    Raises:
        HearthError: MISSING_FILE: it can't be started.
    """

    def __init__(self, argv: Sequence[str]) -> None:
        if not argv:
            raise HearthError.of(Code.EMPTY, "an agent's command is empty")
        try:
            self.process = subprocess.Popen(
                list(argv), stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0, start_new_session=True
            )
        except (OSError, ValueError) as error:
            message = f"the agent can't be started: {getattr(error, 'strerror', None) or error}"
            raise HearthError.of(Code.MISSING_FILE, message, file=argv[0][:200]) from error
        assert self.process.stdin is not None and self.process.stdout is not None
        super().__init__(self.process.stdout.fileno(), self.process.stdin.fileno())

    def close(self, patience: float = 2.0) -> None:
        """Close its input and wait some seconds for its end; then end it and what it started."""
        super().close()
        for pipe in (self.process.stdin, self.process.stdout):
            if pipe is not None and not pipe.closed:
                with contextlib.suppress(OSError):
                    pipe.close()
        for number in (None, signal.SIGTERM, signal.SIGKILL):
            if number is not None:
                with contextlib.suppress(ProcessLookupError, PermissionError):
                    os.killpg(self.process.pid, number)
            with contextlib.suppress(subprocess.TimeoutExpired):
                self.process.wait(patience)
                return


class Listener:
    """Waits on a port of this machine for one agent after another; other machines can't reach it.

    Args:
        port: 0 takes any that is free.
    """

    def __init__(self, port: int = 0) -> None:
        try:
            self._socket = socket.create_server((LOOPBACK, port))
        except (OSError, OverflowError) as error:
            raise HearthError.of(Code.BAD_ARGUMENT, f"port {port} can't be listened on: {error}") from error
        self.port: int = self._socket.getsockname()[1]

    def accept(self, wait: float) -> SocketChannel:
        """The next agent that connects.

        Raises:
            HearthError: TIMED_OUT: none did within these seconds.
        """
        self._socket.settimeout(wait)
        try:
            connection, _ = self._socket.accept()
        except TimeoutError:
            raise HearthError.of(Code.TIMED_OUT, f"no agent connected to port {self.port} in {wait:g} s") from None
        connection.settimeout(None)
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return SocketChannel(connection)

    def close(self) -> None:
        """Stop listening."""
        self._socket.close()


def _left(deadline: float) -> float:
    return max(0.0, deadline - time.monotonic())
