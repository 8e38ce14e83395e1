"""The standard descriptors of a process that plays an agent's class: they stay as they are, and are read.

A class runs in our process, and may write to them by their numbers, start programs that do, or close them. During an
episode both outputs lead into a pipe. It is passed on to the standard error as that of an agent's program is: without
control characters, up to `MOST_SAID` characters.
"""

from __future__ import annotations

import codecs
import contextlib
import multiprocessing
import os
import select
import sys
import threading
from types import TracebackType

from hearth.challenges.agent_stderr import MOST_SAID
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.terminal import shown

_LOST = 70
"""Exit status of a worker whose descriptors an agent has closed beyond repair."""

_PIECE = 65_536


class StandardDescriptors:
    """A guard of the descriptors 0, 1 and 2 while an agent's class runs; a context manager."""

    def __enter__(self) -> StandardDescriptors:
        _flush()
        self._lock, self._said, self._ended = threading.Lock(), 0, False
        self._decoder = codecs.getincrementaldecoder("utf-8")("replace")
        self._kept = {number: os.dup(number) for number in range(3)}
        self._reads, writes = os.pipe()
        os.set_blocking(self._reads, False)
        self._own = {0: os.dup(0), 1: writes, 2: writes}
        for number in (1, 2):
            os.dup2(writes, number)
        held = {*self._kept.values(), *self._own.values(), *range(3), self._reads}
        self._identities = {number: _identity(number) for number in held}
        self._reader = threading.Thread(target=self._reading, daemon=True)
        self._reader.start()
        _guards.append(self)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        _guards.remove(self)
        _flush()
        self._need_own()
        for number, kept in self._kept.items():
            os.dup2(kept, number)
        self._ended = True
        self._reader.join()
        self._read()
        for each in {*self._kept.values(), *self._own.values(), self._reads}:
            os.close(each)

    def check(self) -> None:
        """Find out what the agent did to the descriptors, and undo it.

        Raises:
            HearthError: AGENT_FAILED: it closed or replaced one of them, or said too much.
        """
        changed = [number for number in range(3) if _identity(number) != self._identities[number]]
        self._need_own()
        for number in changed:
            os.dup2(self._own[number], number)
        _flush()
        self._read()
        if changed:
            message = f"it closed or replaced the descriptor {changed[0]}, which the whole process shares"
            raise HearthError.of(Code.AGENT_FAILED, message)
        if self._said > MOST_SAID:
            self._said = 0
            raise HearthError.of(Code.AGENT_FAILED, f"it wrote more than {MOST_SAID:,} characters to standard output")

    def _need_own(self) -> None:
        """End a worker whose other descriptors are gone: what it writes may go anywhere, and no result comes of it."""
        changed = any(_identity(each) != found for each, found in self._identities.items() if each > 2)
        if changed and multiprocessing.parent_process() is not None:
            os._exit(_LOST)

    def _reading(self) -> None:
        while not self._ended:
            with contextlib.suppress(OSError, ValueError):
                if select.select([self._reads], [], [], 0.05)[0]:
                    self._read()

    def _read(self) -> None:
        """Pass on all that was written so far."""
        with self._lock, contextlib.suppress(BlockingIOError):
            while data := os.read(self._reads, _PIECE):
                text = shown(self._decoder.decode(data))
                left = MOST_SAID - self._said
                self._said += len(text)
                if left > 0:
                    more = "" if len(text) <= left else "\n... the agent says more, which is left out\n"
                    _write(self._kept[2], f"{text[:left]}{more}".encode())


_guards: list[StandardDescriptors] = []


def check_descriptors() -> None:
    """Check the descriptors where they are guarded; errors as of `StandardDescriptors.check`."""
    if _guards:
        _guards[-1].check()


def _identity(number: int) -> tuple[int, int] | None:
    try:
        found = os.fstat(number)
    except OSError:
        return None
    return found.st_dev, found.st_ino


def _flush() -> None:
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError, AttributeError):
            stream.flush()


def _write(number: int, data: bytes) -> None:
    with contextlib.suppress(OSError):
        while data:
            data = data[os.write(number, data) :]
