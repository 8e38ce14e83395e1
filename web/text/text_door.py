"""The application of `serve --text`: create, reset, step, observe, admissible and close over HTTP, all in JSON."""

from __future__ import annotations

import asyncio
import secrets
import time
from collections.abc import Awaitable, Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Any
from urllib.parse import parse_qsl

import orjson
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response
from starlette.types import ASGIApp, Receive, Scope, Send

from hearth.schemas.failures import Code
from hearth.version import VERSION
from hearth.web.errors_as_faults import refusal
from hearth.web.limits import MOST_FIELDS, MOST_MESSAGE, Rate, usual_rates
from hearth.web.messages import json_object, text_field
from hearth.web.request_body import body_of
from hearth.web.security import Security
from hearth.web.sender_addresses import sender_of
from hearth.web.text.engine_process import EngineProcess, lost
from hearth.web.text.open_worlds import Offered
from hearth.web.token_gate import TokenGate
from hearth.web.web_errors import WebError

IDLE_SECONDS = 900.0
"""Seconds without a request after which a world is closed."""

LOOK_EVERY = 5.0
"""Seconds between looks at idle worlds."""

Fields = dict[str, Any]


@dataclass
class _World:
    """A world that is open: its process, the start of that process, its last request, and whether a command runs."""

    engine: EngineProcess
    start: int
    used: float
    acting: bool = False
    turn: int = 0


@dataclass(frozen=True)
class _Address:
    """An address: its methods, the fields that a request may have, and the function that answers it."""

    methods: str
    fields: frozenset[str]
    answer: Callable[[Fields], Awaitable[bytes]]


class TextDoor:
    """Worlds that programs play in text.

    Args:
        offered: the episodes that they may begin.
        engines: processes that play them.
        most: worlds that may be open at once.
        rates: limits on the rate of requests; the usual ones if None.
        idle: seconds after which a world is closed.
    """

    def __init__(
        self,
        offered: Offered,
        engines: int,
        most: int,
        rates: Mapping[str, Rate] | None = None,
        idle: float = IDLE_SECONDS,
    ) -> None:
        self._engines = [EngineProcess(offered) for _ in range(engines)]
        self._offered, self._most, self._idle = offered, most, idle
        self._rates = rates or usual_rates()
        self._worlds: dict[str, _World] = {}
        one = frozenset({"id"})
        self._addresses = {
            "/": _Address("GET", frozenset(), self._about),
            "/create": _Address("POST", frozenset({"home", "goal"}), self._create),
            "/reset": _Address("POST", one | {"seed", "index", "data_idx"}, self._reset),
            "/step": _Address("POST", one | {"action", "turn"}, self._step),
            "/observe": _Address("GET POST", one, self._observe),
            "/admissible": _Address("GET POST", one, self._admissible),
            "/close": _Address("POST", one, self._close),
            "/observation": _Address("GET", one, self._observation),  # these two as AgentGym's clients ask
            "/available_actions": _Address("GET", one, self._actions),
        }

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request; with the server's start and end the processes start and end."""
        if scope["type"] == "lifespan":
            await self._live(receive, send)
        elif scope["type"] == "http":
            answer = await self._answered(Request(scope, receive))
            await answer(scope, receive, send)
        else:
            await send({"type": "websocket.close", "code": 4404})

    async def _live(self, receive: Receive, send: Send) -> None:
        await receive()
        try:
            await asyncio.gather(*[engine.start() for engine in self._engines])
        except (OSError, TimeoutError) as error:
            await send({"type": "lifespan.startup.failed", "message": f"no engine process: {error}"})
            return
        looking = asyncio.ensure_future(self._look())
        await send({"type": "lifespan.startup.complete"})
        await receive()
        looking.cancel()
        for engine in self._engines:
            engine.stop()
        await send({"type": "lifespan.shutdown.complete"})

    async def _look(self) -> None:
        """Close idle worlds again and again."""
        while True:
            await asyncio.sleep(min(LOOK_EVERY, self._idle))
            old = time.monotonic() - self._idle
            for name in [name for name, world in self._worlds.items() if world.used < old and not world.acting]:
                await self._ended(name)

    async def _ended(self, name: str) -> None:
        world = self._worlds.pop(name)
        if world.start == world.engine.starts:
            await world.engine.ask("close", name)

    async def _answered(self, request: Request) -> Response:
        try:
            address = self._address(request)
            fields = await _fields(request)
            if unknown := sorted(fields.keys() - address.fields):
                expected = f"no fields but {', '.join(sorted(address.fields)) or 'none'}"
                raise WebError(Code.BAD_ARGUMENT, unknown[0][:40], expected, "another field")
            if request.url.path == "/create":
                self._rates["create"].check(sender_of(request), "/create")
            return Response(await address.answer(fields), media_type="application/json")
        except Exception as error:
            return refusal(error)

    def _address(self, request: Request) -> _Address:
        found = self._addresses.get(request.url.path)
        if found is None:
            raise HTTPException(404)
        if request.method not in found.methods.split():
            raise HTTPException(405)
        return found

    def _world(self, fields: Fields) -> tuple[str, _World]:
        """Return the world of a request.

        Raises:
            WebError: BAD_ARGUMENT, UNKNOWN_ID, TOO_FAST.
        """
        name = text_field(fields, "id", 100)
        world = self._worlds.get(name)
        if world is None:
            raise WebError(Code.UNKNOWN_ID, "id", "a world that is open", "another, or one that was closed")
        if world.start != world.engine.starts:
            del self._worlds[name]
            raise lost()
        self._rates["world"].check(name, "id")
        world.used = time.monotonic()
        return name, world

    async def _about(self, fields: Fields) -> bytes:
        facts = {"hearth": VERSION, "tasks": self._offered.tasks, "limit": self._offered.limit}
        return orjson.dumps({**facts, "worlds": {"open": len(self._worlds), "most": self._most}})

    async def _create(self, fields: Fields) -> bytes:
        if len(self._worlds) >= self._most:
            raise WebError(Code.TOO_FAST, "/create", f"at most {self._most} worlds at once", "one more; close another")
        engine = min(self._engines, key=self._load)
        name = secrets.token_urlsafe(16)
        self._worlds[name] = world = _World(engine, engine.starts, time.monotonic(), acting=True)
        try:
            return await engine.ask("create", name, fields.get("home"), fields.get("goal"))
        except Exception:
            self._worlds.pop(name, None)
            raise
        finally:
            world.acting = False

    def _load(self, engine: EngineProcess) -> int:
        return sum(world.engine is engine for world in self._worlds.values())

    async def _reset(self, fields: Fields) -> bytes:
        index = fields.get("index", fields.get("data_idx"))
        name, world = self._world(fields)
        answer = await self._acted(world, "reset", name, fields.get("seed", 0), index)
        world.turn = 0
        return answer

    async def _step(self, fields: Fields) -> bytes:
        if "action" not in fields:
            raise WebError(Code.BAD_ARGUMENT, "action", "a command, as text", "nothing")
        name, world = self._world(fields)
        if "turn" in fields and fields["turn"] != world.turn:
            raise WebError(Code.CONFLICT, "turn", str(world.turn), f"{fields['turn']!r}"[:40])
        answer = await self._acted(world, "step", name, fields["action"])
        world.turn += 1
        return answer

    async def _acted(self, world: _World, *operation: Any) -> bytes:
        """Change a world; two clients in one episode never do so at once.

        Raises:
            WebError: LOCKED.
        """
        if world.acting:
            raise WebError(Code.LOCKED, "id", "one command at a time", "a second before the first was answered")
        world.acting = True
        try:
            return await world.engine.ask(*operation)
        finally:
            world.acting = False

    async def _observe(self, fields: Fields) -> bytes:
        name, world = self._world(fields)
        return await world.engine.ask("observe", name)

    async def _observation(self, fields: Fields) -> bytes:
        return orjson.dumps(orjson.loads(await self._observe(fields))["observation"])

    async def _actions(self, fields: Fields) -> bytes:
        name, world = self._world(fields)
        return await world.engine.ask("admissible", name)

    async def _admissible(self, fields: Fields) -> bytes:
        return b'{"admissible":' + await self._actions(fields) + b"}"

    async def _close(self, fields: Fields) -> bytes:
        name, _ = self._world(fields)
        await self._ended(name)
        return b'{"closed":true}'


async def _fields(request: Request) -> Fields:
    """Return the fields of a request: of its address, or of a JSON body; an empty body has none.

    Raises:
        WebError: FILE_TOO_LARGE, TIMED_OUT, BAD_JSON, BAD_ARGUMENT.
    """
    if request.method == "GET":
        try:
            return dict(parse_qsl(request.url.query, keep_blank_values=True, max_num_fields=MOST_FIELDS))
        except ValueError:
            raise WebError(Code.BAD_ARGUMENT, "query", f"at most {MOST_FIELDS:,} fields", "more") from None
    body = await body_of(request, MOST_MESSAGE)
    return json_object(body, "body") if body.strip() else {}


def text_application(door: TextDoor, hosts: Collection[str] = (), token: str = "") -> ASGIApp:
    """Return the door behind the checks on every request of the other rooms, and behind a token if there is one."""
    return Security(TokenGate(door, token) if token else door, hosts)
