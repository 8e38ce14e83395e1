"""The socket of a game's page: `hello` and `act` in, the game out (docs/playing.md has all messages)."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.web import deadlines, sessions
from hearth.web.handler_threads import in_thread
from hearth.web.messages import int_field, text_field
from hearth.web.person_socket import Link
from hearth.web.play.game_messages import Telling
from hearth.web.play.game_store import is_full, keep_opening
from hearth.web.play.live_games import PATIENCE, LiveGame, games
from hearth.web.play.play_trials import PERSON, PROGRAM, SIZE
from hearth.web.play.player_presence import SIGN_EVERY, give_sign
from hearth.web.web_errors import WebError

if TYPE_CHECKING:
    from hearth.web.play.game_scene_3d import DrawnGame

LOOKS_EVERY = {PERSON: 0.3}
"""Seconds between reads of others' decisions from the store, by helper; another server may have received them."""

USUALLY = 2.0

END_AFTER = 0.05
"""Seconds after the end of a game's time at which its page learns of it."""

LONGEST_ACT = 500
"""Characters of an instruction."""


class Page:
    """A page that plays a game.

    Args:
        link: its socket.
        live: the game.
        number: the character that its person plays.
    """

    def __init__(self, link: Link, live: LiveGame, number: int) -> None:
        self.link, self.live, self.number = link, live, number
        self.telling = Telling(live.game, number)
        self.tab = ""
        self._told: tuple[Any, ...] = ()
        self._sign = 0.0
        self._sending = asyncio.Lock()

    async def take(self, message: dict[str, Any]) -> None:
        """Answer a message.

        Raises:
            WebError: it is refused; nothing changed then.
            HearthError: the same, by the engine.
        """
        kind = message["type"]
        if kind == "hello":
            self.tab = text_field(message, "tab", 60)
            if message.get("again") is not True:  # a page that comes back does not take the session from a newer one
                await in_thread(self._open)
            async with self._sending:
                await self.link.send(await in_thread(self._begin))
        elif kind == "act":
            await self.tell(self._act, int_field(message, "tick", 0, 100_000), _act_of(message))
        elif kind == "finish":
            await self.tell(self._finish)
        elif kind in ("picture", "pick") and self.live.game.trial.interface == "stream":
            await self._show(message)
        else:
            raise WebError(Code.BAD_ARGUMENT, "type", "hello, act, finish, picture or pick", kind[:40])

    async def _show(self, message: dict[str, Any]) -> None:
        """Send a picture, or the thing at one of its pixels."""
        if message["type"] == "picture":
            await self.link.send_bytes(await in_thread(self._picture))
            return
        x, y = (int_field(message, name, 0, size - 1) for name, size in zip("xy", SIZE, strict=True))
        await self.link.send({"type": "picked", "id": await in_thread(self._pick, x, y)})

    def _open(self) -> None:
        """Make this page's tab the one that may act, and keep that the page was opened."""
        sessions.take_tab(self.link.web.store, self.link.session.id, self.tab)
        where = self.live.stored.id, self.number, self.tab
        self.link.web.store.write(lambda connection: keep_opening(connection, *where))

    def _begin(self) -> dict[str, Any]:
        with self.live.lock:
            self._signed()
            self.telling.game = self.live.sync()
            port, token = self.live.listen() if self.live.game.trial.helper == PROGRAM else (0, "")
            self._told = self._state()
            begun = {**self.telling.begin(), **self._unnamed()}
            return {
                **begun,
                "port": port,
                "token": token,
                "code": self._code(),
                "left": self.live.seconds_left(),
                **self._waiting(),
                **self._scene(),
            }

    def _unnamed(self) -> dict[str, str]:
        """Return the helper of a study's trial, without its name."""
        helped = "somebody" if self.live.stored.trial.helped else "none"
        return {"helper": helped} if self.live.stored.blind else {}

    def _scene(self) -> dict[str, Any]:
        """Return the differences in 3D, for pages that draw them."""
        if self.live.game.trial.interface != "visual":
            return {}
        return {"drawn": self._drawn().as_json()}

    def _drawn(self) -> DrawnGame:
        return self.live.drawn(self.link.web.known, self.number)

    def _picture(self) -> bytes:
        with self.live.lock:
            self.live.sync()
            return self._drawn().jpeg()

    def _pick(self, x: int, y: int) -> int:
        with self.live.lock:
            return self._drawn().pick(x, y)

    def _code(self) -> str:
        """Return the code that the first of two people gives the second; "" once somebody has the second seat."""
        if self.live.game.trial.helper != PERSON or self.number != 0:
            return ""
        taken = self.link.web.store.read(lambda connection: is_full(connection, self.live.stored.id))
        return "" if taken else self.live.stored.code

    def _act(self, tick: int, text: str | None) -> dict[str, Any] | None:
        with self.live.lock:
            self.live.decide(self.link.session.id, self.tab, self.number, tick, text)
            return self._new()

    def _finish(self) -> dict[str, Any] | None:
        with self.live.lock:
            self.live.leave(self.link.session.id, self.tab, self.number)
            return self._new()

    def _state(self) -> tuple[Any, ...]:
        game = self.live.game
        return game.tick, game.over, self.live.decided, self.live.other(self.number)

    def _waiting(self) -> dict[str, Any]:
        other = self.live.other(self.number)
        return {
            "decided": list(self.live.decided),
            "go_on": self.live.stored.go_on,
            "other": other,
            "patience": PATIENCE,
            "decide_within": self.live.seconds_to_decide(self.number),
        }

    def _signed(self) -> None:
        """Keep from time to time that this person is there, for the other of two."""
        if self.live.game.trial.helper == PERSON and time.monotonic() - self._sign > SIGN_EVERY:
            give_sign(self.link.web.store, self.live.stored.id, self.number)
            self._sign = time.monotonic()

    def _news(self) -> dict[str, Any] | None:
        """Return others' actions since the last message, if there are any."""
        self.live.seen = time.monotonic()
        with self.live.lock:
            if self._told:
                self._signed()
            self.live.sync()
            self.live.hurry()
            return self._new() if self._told else None

    def _new(self) -> dict[str, Any] | None:
        """Return the news for the page; None if there are none. The caller holds the lock."""
        if self._state() == self._told:
            return None
        self._told = self._state()
        return {**self.telling.tick(), **self._waiting(), **self._scene()}

    async def tell(self, done: Callable[..., dict[str, Any] | None], *given: Any) -> None:
        """Call a function, and send the resulting news."""
        async with self._sending:
            if (news := await in_thread(done, *given)) is not None:
                await self.link.send(news)
                if self.live.game.trial.interface == "stream":
                    await self.link.send_bytes(await in_thread(self._picture))

    def _until_next_look(self) -> float:
        """Return the seconds until others' decisions are looked at again; never past the end of the game's time."""
        usual, left = LOOKS_EVERY.get(self.live.game.trial.helper, USUALLY), self.live.seconds_left()
        return usual if left is None or left <= 0 or self.live.game.over else min(usual, left + END_AFTER)

    async def watch(self) -> None:
        """Send others' decisions, until cancelled."""
        while True:
            await asyncio.sleep(self._until_next_look())
            deadlines.begin()
            try:
                await self.tell(self._news)
            except HearthError:  # the store is busy: the next look finds it
                continue
            except WebError as fault:  # the game was deleted, as its other person asked
                await self.link.refuse(fault)
                with contextlib.suppress(RuntimeError):
                    await self.link.socket.close(4404)
                return


def _act_of(message: dict[str, Any]) -> str | None:
    return None if message.get("act", "") is None else text_field(message, "act", LONGEST_ACT)


async def live(link: Link) -> None:
    """Serve a page until it goes."""
    web = link.web
    deadlines.begin(deadlines.OPENS)
    try:
        found = games(web.store, web.known).find
        game, number = await in_thread(found, str(link.socket.path_params["game"]), link.session.id)
    except WebError as fault:
        await link.refuse(fault)
        await link.socket.close(4404)
        return
    except HearthError as error:
        await link.refuse(refusal(error))
        await link.socket.close(1013)
        return
    page = Page(link, game, number)
    watching = asyncio.create_task(page.watch())
    try:
        while (message := await link.receive()) is not None:
            deadlines.begin(deadlines.OPENS if message["type"] == "hello" else deadlines.ACTS)
            try:
                await page.take(message)
            except WebError as fault:
                await link.refuse(fault)
            except HearthError as error:
                await link.refuse(refusal(error))
    finally:
        watching.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await watching


def refusal(error: HearthError) -> WebError:
    """Return why the engine refuses a decision, as an answer."""
    fault = error.diagnostics[0]
    return WebError(fault.code, "act", fault.suggestion or "one of the legal instructions", fault.message)
