"""Lines to and from another program: a child process, a loopback socket, or our own standard input and output.

A line that is too long is left out whole and reported; nobody is waited for longer than a deadline. Deadlines are
times of `time.monotonic`. Threads read and write, since pipes can be waited for in no other way on every system.
"""

from __future__ import annotations

import contextlib
import os
import socket
import threading
import time
from collections.abc import Callable, Sequence
from typing import NoReturn

from hearth.challenges.agent_process import end, start
from hearth.challenges.agent_stderr import relay
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

LONGEST_LINE = 65_536
"""Bytes of a line that is read."""

_PIECE = 4096
"""Bytes written at once."""

LOOPBACK = "127.0.0.1"


class Channel:
    """Lines over something that is read and something that is written.

    Args:
        read: gives at most so many bytes, none once the other end is gone; it may wait.
        write: takes some of the bytes, and says how many; it may wait.
        ends: called when reading has ended, and when writing has ended. No other function closes a file that is
            read or written: its number could be another file's by the time that a thread uses it.

    Attributes:
        open: whether the other end is there, as far as sending and receiving have shown.
    """

    def __init__(
        self,
        read: Callable[[int], bytes | None],
        write: Callable[[bytes], int | None],
        ends: tuple[Callable[[], None], Callable[[], None]] = (lambda: None, lambda: None),
    ) -> None:
        self._read, self._write = read, write
        self._received, self._unsent = bytearray(), bytearray()
        self._skipping = False
        self._changed = threading.Condition()
        self.open = True
        self._ended = False
        runs = zip((self._reading, self._writing), ends, strict=True)
        self._threads = [threading.Thread(target=self._to_its_end, args=both, daemon=True) for both in runs]
        for thread in self._threads:
            thread.start()

    def _to_its_end(self, run: Callable[[], None], end: Callable[[], None]) -> None:
        try:
            run()
        finally:
            with contextlib.suppress(OSError):
                end()

    def _reading(self) -> None:
        """Read until the end; more than some lines that nobody asks for are left where they are."""
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._ended or self._room())
                if self._ended:
                    return
            try:
                data = self._read(LONGEST_LINE)
            except (OSError, ValueError):  # closed
                data = None
            with self._changed:
                if not data:
                    self._ended = True
                else:
                    self._received += data
                    if self._skipping:
                        self._skip()
                self._changed.notify_all()

    def _room(self) -> bool:
        return self._skipping or len(self._received) < 2 * LONGEST_LINE

    def _writing(self) -> None:
        """Write the unsent bytes."""
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._ended or bool(self._unsent))
                if self._ended:
                    return
                piece = bytes(self._unsent[:_PIECE])
            try:
                written = self._write(piece) or 0
            except (OSError, ValueError):
                written = -1
            with self._changed:
                self._ended = self._ended or written < 0
                del self._unsent[: max(0, written)]
                self._changed.notify_all()

    def send(self, line: bytes, deadline: float) -> None:
        """Write a line; a rest that can't be written by the deadline is written first the next time.

        Raises:
            HearthError: TIMED_OUT; DISCONNECTED.
        """
        with self._changed:
            self._need_open()
            self._flush(deadline)
            self._unsent += line + b"\n"
            self._changed.notify_all()
            self._flush(deadline)

    def _flush(self, deadline: float) -> None:
        """Wait until all output is sent.

        An agent that has answered and exited had received everything, even if the count says otherwise.
        """
        done = self._changed.wait_for(lambda: self._ended or not self._unsent, _left(deadline))
        if self._unsent and not self._received:
            self._need_open()
        if not done:
            raise HearthError.of(Code.TIMED_OUT, "the agent does not read what it is sent")

    def _skip(self) -> None:
        end = self._received.find(b"\n")
        del self._received[: end + 1 if end >= 0 else len(self._received)]
        self._skipping = end < 0

    def receive(self, deadline: float) -> bytes:
        """Return the next line, without its end.

        Raises:
            HearthError: TIMED_OUT; DISCONNECTED; LINE_TOO_LONG, once for each such line.
        """
        with self._changed:
            while True:
                line = self._line()
                if line is not None:
                    return line
                self._need_open()
                if not self._changed.wait(_left(deadline)):
                    raise HearthError.of(Code.TIMED_OUT, "the agent did not answer in time")

    def _line(self) -> bytes | None:
        """Return a whole line of the received bytes, if there is one."""
        end = self._received.find(b"\n")
        if end > LONGEST_LINE or (end < 0 and len(self._received) > LONGEST_LINE):
            self._skipping = True
            self._skip()
            self._changed.notify_all()
            remedy = f"at most {LONGEST_LINE:,} bytes"
            raise HearthError.of(Code.LINE_TOO_LONG, "an answer that is too long", suggestion=remedy)
        if end < 0:
            return None
        line = bytes(self._received[:end])
        del self._received[: end + 1]
        self._changed.notify_all()
        return line

    def _need_open(self) -> None:
        if self._ended:
            self._gone()

    def _gone(self) -> NoReturn:
        self.open = False
        raise HearthError.of(Code.DISCONNECTED, "the agent is gone")

    def close(self) -> None:
        """End it; may be called again."""
        with self._changed:
            self.open, self._ended = False, True
            self._changed.notify_all()


class SocketChannel(Channel):
    """Lines over a connected socket."""

    def __init__(self, connection: socket.socket) -> None:
        super().__init__(connection.recv, connection.send)
        self._connection = connection

    def close(self) -> None:
        """Close the socket."""
        super().close()
        with contextlib.suppress(OSError):
            self._connection.shutdown(socket.SHUT_RDWR)  # wakes the reader
        for thread in self._threads:
            thread.join()
        self._connection.close()


class ProcessChannel(Channel):
    """Lines to the standard input of a child process and from its standard output.

    Args:
        argv: the program and its arguments; no shell reads them. Its standard error is passed on to ours.

    Raises:
        HearthError: MISSING_FILE: it can't be started.
    """

    def __init__(self, argv: Sequence[str]) -> None:
        if not argv:
            raise HearthError.of(Code.EMPTY, "an agent's command is empty")
        try:
            self.process = start(argv)
        except (OSError, ValueError) as error:
            message = f"the agent can't be started: {getattr(error, 'strerror', None) or error}"
            raise HearthError.of(Code.MISSING_FILE, message, file=argv[0][:200]) from error
        assert self.process.stdin is not None and self.process.stdout is not None
        given, taken = self.process.stdout, self.process.stdin
        self._errors = relay(self.process)
        super().__init__(given.read, taken.write, (given.close, taken.close))

    def close(self, patience: float = 2.0) -> None:
        """Close its input and wait some seconds for its end; then end the process and its children."""
        super().close()
        end(self.process, patience)
        self._errors.join(patience)


class StandardChannel(Channel):
    """Lines to our own standard output and from our own standard input."""

    def __init__(self) -> None:
        super().__init__(lambda most: os.read(0, most), lambda data: os.write(1, data))


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
        """Return the next agent that connects.

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
