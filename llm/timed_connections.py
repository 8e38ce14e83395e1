"""Connections to chat servers that end with the time of their request: heads and bodies, however slowly they come."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from typing import Any

from hearth.schemas.optional_libraries import library

SLICE = 0.25
"""Seconds after which a wait looks whether the command was asked to stop."""

stopping = threading.Event()
"""The flag of a command that was asked to stop: requests of other threads end with it."""

_now = threading.local()


def pause(seconds: float) -> None:
    """Wait, but no longer than until the command is asked to stop."""
    stopping.wait(seconds)


@contextmanager
def asking(pool: Executor) -> Iterator[None]:
    """Let the requests of a pool's threads end at once where the command is asked to stop, or fails."""
    try:
        yield
    except BaseException:
        with stopped():
            pool.shutdown(wait=True, cancel_futures=True)
        raise


@contextmanager
def stopped() -> Iterator[None]:
    """Let the requests of all threads end at once while their threads are waited for."""
    stopping.set()
    try:
        yield
    finally:
        stopping.clear()


@contextmanager
def within(seconds: float) -> Iterator[None]:
    """Give the requests of this thread a time, for all that they send and receive."""
    _now.until = time.monotonic() + seconds
    try:
        yield
    finally:
        _now.until = None


def client(**settings: Any) -> Any:
    """Return a client whose connections end with the time that `within` gives."""
    made = library("httpx2").Client(**settings)
    for transport in {made._transport, *made._mounts.values()} - {None}:
        transport._pool._network_backend = _Backend(transport._pool._network_backend)
    return made


def _left(limit: float | None, late: type[Exception]) -> float | None:
    """Return the seconds that are left of the time of this thread's request.

    Raises:
        late: none is.
    """
    until = getattr(_now, "until", None)
    if stopping.is_set():
        raise late("the command was asked to stop")
    if until is None:
        return limit
    left: float = until - time.monotonic()
    if left <= 0:
        raise late("not whole in its time")
    return left if limit is None else min(left, limit)


class _Backend:
    """The library's way to connect, with streams that know the time."""

    def __init__(self, own: Any) -> None:
        self._own = own

    def connect_tcp(self, host: str, port: int, timeout: float | None = None, **more: Any) -> _Stream:
        """Connect within the time that is left."""
        limit = _left(timeout, library("httpcore2").ConnectTimeout)
        return _Stream(self._own.connect_tcp(host, port, timeout=limit, **more))

    def __getattr__(self, name: str) -> Any:
        return getattr(self._own, name)


class _Stream:
    """A connection whose every read and write ends with the time of the request."""

    def __init__(self, own: Any) -> None:
        self._own = own

    def read(self, max_bytes: int, timeout: float | None = None) -> bytes:
        """Return bytes, as soon as some are there."""
        late = library("httpcore2").ReadTimeout
        until = None if timeout is None else time.monotonic() + timeout
        while True:
            left = _left(None if until is None else max(0.001, until - time.monotonic()), late)
            try:
                data: bytes = self._own.read(max_bytes, timeout=SLICE if left is None else min(left, SLICE))
                return data
            except late:
                if left is not None and left <= SLICE:
                    raise

    def write(self, buffer: bytes, timeout: float | None = None) -> None:
        """Send bytes within the time that is left."""
        self._own.write(buffer, timeout=_left(timeout, library("httpcore2").WriteTimeout))

    def start_tls(self, ssl_context: Any, server_hostname: str | None = None, timeout: float | None = None) -> _Stream:
        """Return the stream over TLS."""
        limit = _left(timeout, library("httpcore2").ConnectTimeout)
        return _Stream(self._own.start_tls(ssl_context, server_hostname, limit))

    def __getattr__(self, name: str) -> Any:
        return getattr(self._own, name)
