"""The episodes of an MCP server: one for each session, or by a name that only its client knows."""

from __future__ import annotations

import secrets
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from hearth.challenges.text_episode import EpisodeTurn, TextEpisode, text_tasks
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

IDLE_SECONDS = 900.0
"""Seconds without a call after which an episode is closed."""


@dataclass
class _Kept:
    """An episode that is open: its name and session, its last call, and the lock of the call that runs."""

    name: str
    episode: TextEpisode
    session: str | None
    used: float
    lock: threading.Lock = field(default_factory=threading.Lock)


class SessionEpisodes:
    """Episodes of clients.

    Args:
        tasks: the source of the tasks that are drawn where a client names no home.
        limit: ticks after which an episode ends.
        most: episodes that may be open at once.
        idle: seconds without a call after which an episode is closed.
    """

    def __init__(self, tasks: str, limit: int, most: int, idle: float = IDLE_SECONDS) -> None:
        self._tasks, self._limit, self._most, self._idle = tasks, limit, most, idle
        self._kept: dict[str, _Kept] = {}
        self._lock = threading.Lock()

    def begin(self, session: str | None, home: str, goal: str, seed: int) -> tuple[str, str, EpisodeTurn]:
        """Begin an episode, in place of the one that the session has.

        Args:
            session: the client's; None where the transport has no sessions.
            home: the name of a home; "" for a task of the server.
            goal: in that home.
            seed: of the start, or of the task.

        Returns:
            The episode's name, how to act, and the first turn.

        Raises:
            HearthError: TOO_FAST: too many are open; the faults of `TextEpisode`.
        """
        if home or goal:
            episode = TextEpisode(home, goal, limit=self._limit)
        else:
            episode = TextEpisode(tasks=text_tasks(self._tasks), limit=self._limit)
        turn = episode.reset(seed)
        name = secrets.token_urlsafe(16)
        with self._lock:
            self._forget(session)
            if len(self._kept) >= self._most:
                self._kept = {each: kept for each, kept in self._kept.items() if not kept.episode.turn.done}
            if len(self._kept) >= self._most:
                message = f"{self._most} episodes are open"
                raise HearthError.of(Code.TOO_FAST, message, suggestion="try again when others have ended")
            self._kept[name] = _Kept(name, episode, session, time.monotonic())
        return name, episode.instructions, turn

    def _forget(self, session: str | None) -> None:
        """Close the episode of a session, and those that are idle."""
        old = time.monotonic() - self._idle
        for name, kept in list(self._kept.items()):
            if kept.used < old or (session is not None and kept.session == session):
                del self._kept[name]

    @contextmanager
    def of(self, session: str | None, name: str) -> Iterator[tuple[str, TextEpisode]]:
        """Give one call at a time an episode with its name.

        Args:
            session: the client's.
            name: of the episode; "" for that of the session.

        Raises:
            HearthError: OUT_OF_ORDER: the session has begun none; UNKNOWN_ID: no episode of that name; LOCKED: another
                call has it.
        """
        kept = self._found(session, name)
        if not kept.lock.acquire(blocking=False):
            message = "another call of this episode is not answered yet"
            raise HearthError.of(Code.LOCKED, message, suggestion="one call at a time")
        try:
            kept.used = time.monotonic()
            yield kept.name, kept.episode
        finally:
            kept.lock.release()

    def _found(self, session: str | None, name: str) -> _Kept:
        with self._lock:
            self._forget(None)
            if name:
                if name in self._kept:
                    return self._kept[name]
                message = "there is no episode of this name, or it was closed"
                raise HearthError.of(Code.UNKNOWN_ID, message, suggestion="begin one with the tool `home`")
            mine = [kept for kept in self._kept.values() if session is not None and kept.session == session]
        if not mine:
            remedy = "begin one with the tool `home`" + ("" if session else ", and give its `episode`")
            raise HearthError.of(Code.OUT_OF_ORDER, "no episode has begun", suggestion=remedy)
        return mine[-1]
