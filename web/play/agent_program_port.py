"""The port where a game waits for somebody's program: with a token, for as long as the game and a page of it."""

from __future__ import annotations

import contextlib
import hmac
import secrets
import threading
import time
from typing import ClassVar, Protocol

import orjson

from hearth.challenges.agent_channels import Listener, SocketChannel
from hearth.schemas.diagnostics import HearthError

MOST_PORTS = 32
"""Ports of a process at once."""

UNWATCHED = 60.0
"""Seconds after which a game's port closes while no page of it is open."""

LOOKS_EVERY = 2.0
"""Seconds between looks at whether the game goes on."""

SHOWN_WITHIN = 5.0
"""Seconds in which a program shows the token."""

MOST_SHOWING = 8
"""Connections of a port that may be about to show it; more wait."""


class Waiting(Protocol):
    """A game that waits for a program."""

    seen: float

    def wants_program(self) -> bool:
        """Return whether it goes on."""

    def take_program(self, channel: SocketChannel) -> None:
        """Let the program at a channel be the helper."""


class ProgramDoor:
    """A port of this machine that is open for a game.

    Attributes:
        port: its number.
        token: what a program sends first, as `{"token": "..."}` on a line.
        closed: whether it is closed.

    Args:
        game: that waits.
    """

    open: ClassVar[set[ProgramDoor]] = set()

    def __init__(self, game: Waiting) -> None:
        self._listener, self._game = Listener(), game
        self.port, self.token, self.closed = self._listener.port, secrets.token_urlsafe(16), False
        self._showing = threading.BoundedSemaphore(MOST_SHOWING)
        ProgramDoor.open.add(self)
        for run in (self._accept, self._watch):
            threading.Thread(target=run, daemon=True).start()

    def _accept(self) -> None:
        """Take the programs that connect and show the token; a silent program delays no other."""
        while not self.closed:
            if not self._showing.acquire(timeout=1.0):
                continue
            try:
                channel = self._listener.accept(1.0)
            except (HearthError, OSError):
                self._showing.release()
                continue
            threading.Thread(target=self._look_at, args=(channel,), daemon=True).start()

    def _look_at(self, channel: SocketChannel) -> None:
        """Let a program in that shows the token, and close the connection of any other."""
        let_in = False
        try:
            with contextlib.suppress(HearthError, OSError):
                if self._is_shown(channel.receive(time.monotonic() + SHOWN_WITHIN)):
                    self._game.take_program(channel)
                    let_in = True
        finally:
            self._showing.release()
            if not let_in:
                channel.close()

    def _is_shown(self, line: bytes) -> bool:
        try:
            found = orjson.loads(line)
        except orjson.JSONDecodeError:
            return False
        given = found.get("token") if isinstance(found, dict) else None
        return isinstance(given, str) and hmac.compare_digest(given.encode(), self.token.encode())

    def _watch(self) -> None:
        """Close the port once the game is over or deleted, or nobody has a page of it open."""
        while not self.closed:
            time.sleep(min(LOOKS_EVERY, UNWATCHED))
            if time.monotonic() - self._game.seen > UNWATCHED or not self._game.wants_program():
                self.close()

    def close(self) -> None:
        """Close the port; may be called again."""
        self.closed = True
        ProgramDoor.open.discard(self)
        self._listener.close()


def program_door(game: Waiting) -> ProgramDoor | None:
    """Open a port for a game; None where too many are open."""
    return ProgramDoor(game) if len(ProgramDoor.open) < MOST_PORTS else None
