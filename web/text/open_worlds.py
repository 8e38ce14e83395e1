"""The worlds of one engine process: each operation of the door on a world of this process, as plain values."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any

import orjson

from hearth.challenges.text_episode import TextEpisode, text_tasks
from hearth.schemas.diagnostics import HearthError
from hearth.storage.parallel import begin
from hearth.web.errors_as_faults import fault_of

DONE, REFUSED = b"+", b"-"
"""The first byte of an answer: the JSON of a value, or that of a fault, follows."""


@dataclass(frozen=True)
class Offered:
    """The episodes that a server offers.

    Attributes:
        tasks: their source, for clients that name no home.
        limit: ticks after which a world ends.
    """

    tasks: str
    limit: int


class OpenWorlds:
    """Worlds by their ids.

    Args:
        offered: the episodes that clients may begin.
    """

    def __init__(self, offered: Offered) -> None:
        self._offered = offered
        self._worlds: dict[str, TextEpisode] = {}
        self._operations: dict[str, Callable[..., Any]] = {
            "create": self._create,
            "reset": self._reset,
            "step": self._step,
            "observe": lambda world: self._worlds[world].turn.as_json(),
            "admissible": lambda world: self._worlds[world].admissible,
            "close": self._close,
        }

    def answer(self, asked: bytes) -> bytes:
        """Return the answer to one operation; every error becomes a fault, which the worlds outlive."""
        operation = ""
        try:
            operation, world, *given = orjson.loads(asked)
            return DONE + orjson.dumps(self._operations[operation](world, *given))
        except Exception as error:
            fault = fault_of(error).as_json()["error"]
            return REFUSED + orjson.dumps({**fault, "place": fault["place"] or f"/{operation}"})

    def _create(self, world: str, home: Any, goal: Any) -> dict[str, Any]:
        if home is None and goal is None:
            made = TextEpisode(tasks=text_tasks(self._offered.tasks), limit=self._offered.limit)
        else:
            made = TextEpisode(home or "", goal or "", limit=self._offered.limit)
        self._worlds[world] = made
        return {"id": world, "instructions": made.instructions, "protocol": made.fingerprint}

    def _reset(self, world: str, seed: Any, index: Any) -> dict[str, Any]:
        return self._worlds[world].reset(seed, index).as_json()

    def _step(self, world: str, action: Any) -> dict[str, Any]:
        return self._worlds[world].step(action).as_json()

    def _close(self, world: str) -> dict[str, Any]:
        del self._worlds[world]
        return {"closed": True}


def serve_worlds(offered: Offered, line: Connection) -> None:
    """Answer operations of a line until its other end is closed; the first answer says that the process is ready."""
    begin()
    worlds = OpenWorlds(offered)
    try:
        text_tasks(offered.tasks)
    except HearthError as error:  # each world that asks for the tasks gets the fault
        del error
    line.send_bytes(DONE)
    while True:
        try:
            asked = line.recv_bytes()
        except (EOFError, OSError):
            return
        line.send_bytes(worlds.answer(asked))
