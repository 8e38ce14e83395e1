"""Games that this process knows: each is replayed from the store, and kept while a person plays it here."""

from __future__ import annotations

import contextlib
import math
import time
from collections import OrderedDict
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

from hearth.challenges.agent_channels import SocketChannel
from hearth.challenges.agent_guard import AgentError
from hearth.challenges.wire_protocol import WireAgent
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.web.deadlines import BoundedLock
from hearth.web.play import game_store
from hearth.web.play.agent_program_port import ProgramDoor, program_door
from hearth.web.play.game_store import Decided, Stored, Turn
from hearth.web.play.games import HELPER, Game
from hearth.web.play.play_trials import PROGRAM
from hearth.web.play.player_presence import AWAITED, HERE, presence, signs
from hearth.web.sessions import check_tab
from hearth.web.store import Store
from hearth.web.web_errors import WebError

if TYPE_CHECKING:
    from hearth.web.play.game_scene_3d import DrawnGame

MOST_GAMES = 300
"""Games that a process keeps; the game unused for longest is forgotten first, and replayed if needed."""

PATIENCE = 15.0
"""Time after which the other of two people waits in a tick, seconds.

It applies if one has decided and the other is there, undecided.
"""

PROGRAM_WITHIN = 10.0
"""Seconds that a helper's program may think about a tick."""


class LiveGame:
    """A game in this process.

    Attributes:
        stored: as it was begun.
        game: as far as this process knows it.
        lock: held by the thread that works with `game`.
        port: where the helper's program is waited for; 0 if it is not.
        seen: when a page of it was open last, by `time.monotonic`.
    """

    def __init__(self, store: Store, stored: Stored, knowledge: Knowledge) -> None:
        self.store, self.stored = store, stored
        self.game = Game(stored.trial, knowledge)
        self.lock = BoundedLock("this game")
        self.waiting_since = 0.0
        self.decided: tuple[int, ...] = ()
        self.signs: dict[int, float] = {}
        self._drawn: dict[int, DrawnGame] = {}
        self.seen = time.monotonic()
        self._door: ProgramDoor | None = None
        self._program: WireAgent | None = None

    @property
    def port(self) -> int:
        """Return where the helper's program is waited for; 0 if it is not."""
        return self._door.port if self._door is not None and not self._door.closed else 0

    @property
    def characters(self) -> int:
        """Return how many there are."""
        return len(self.game.start.agents)

    def other(self, number: int) -> str:
        """Return whether the other of two people is there; "" in a game of one."""
        people = self.game.trial.people
        return presence(self.signs.get(1 - number)) if len(people) > 1 else ""

    def drawn(self, knowledge: Knowledge, number: int) -> DrawnGame:
        """Return the game's scene for the eyes of a character. Hold the lock."""
        if number not in self._drawn:
            from hearth.web.play.game_scene_3d import DrawnGame

            self._drawn[number] = DrawnGame(self.game, knowledge, number)
        return self._drawn[number]

    def sync(self) -> Game:
        """Return the game with every tick that the store has. Hold the lock."""
        game = self.game
        found, row, self.signs = self.store.read(
            lambda connection: (
                game_store.decisions(connection, self.stored.id, game.tick),
                game_store.stored(connection, self.stored.id),
                signs(connection, self.stored.id) if len(game.trial.people) > 1 else {},
            )
        )
        while len(rows := found.get(game.tick, [])) == self.characters:
            game.advance(tuple(each.act for each in rows))
        self._now(found.get(game.tick, []))
        if row.end is not None:
            game.end = row.end
        elif not game.over and time.time() >= row.deadline:
            self._stop(0, Code.TIMED_OUT, "the time for this trial was over")
        return game

    def seconds_left(self) -> float | None:
        """Return the seconds until the game's time is over; None where it has no limit."""
        left = self.stored.deadline - time.time()
        return None if left == math.inf else max(0.0, left)

    def seconds_to_decide(self, number: int) -> float | None:
        """Return the seconds after which a person waits in this tick; None if the other of two has not decided."""
        if self.game.over or len(self.game.trial.people) < 2 or not self.decided or number in self.decided:
            return None
        return max(0.0, self.waiting_since + PATIENCE - time.time())

    def _now(self, rows: list[Decided]) -> None:
        """Record the characters that have decided in the present tick, and the time of the first decision."""
        self.decided = tuple(each.agent for each in rows)
        self.waiting_since = min((each.at for each in rows), default=0.0)

    def decide(self, session: str, tab: str, number: int, tick: int, text: str | None) -> None:
        """Take a person's decision; once this returns, no kill loses it.

        Raises:
            WebError: OUT_OF_ORDER, LOCKED; NOT_ALLOWED: the game is over, or the other of two people has not come yet.
            HearthError: it can't be done now, as far as the person sees; the game is as before.
        """
        with self.lock:
            game = self.sync()
            if game.over:
                raise WebError(Code.NOT_ALLOWED, "act", "a game that is not over", "its end")
            if self.other(number) == AWAITED:
                raise WebError(Code.NOT_ALLOWED, "act", "a game that both people have come to", "the other is awaited")
            if tick != game.tick or number in self.decided:
                raise WebError(Code.OUT_OF_ORDER, "tick", str(game.tick), str(tick))
            acts: dict[int, str | None] = {number: game.read(number, text)}
            try:
                if game.trial.helped and len(game.trial.people) == 1:
                    acts[HELPER] = game.helper_decides()
            except AgentError as error:
                self._stop(HELPER, error.fault.code, error.fault.message)
                return
            turn = Turn(self.stored.id, tick, self.characters)
            game_store.accept(self.store, session, tab, turn, acts)
            if len(acts) == self.characters:
                game.advance(tuple(act for _, act in sorted(acts.items())))  # as the store now has it
                self._written_if_over()
            else:
                self._after()
                self.hurry()

    def _after(self) -> None:
        """Run the complete ticks, and write the result once the game is over."""
        self.sync()
        self._written_if_over()

    def _written_if_over(self) -> None:
        game = self.game
        if game.over:
            success, ticks = game.playing.progress[-1].satisfied, game.tick
            at = min(time.time(), self.stored.deadline)
            self.store.write(lambda connection: game_store.over(connection, self.stored.id, success, ticks, at))
            self.close()

    def leave(self, session: str, tab: str, number: int) -> None:
        """End the game before its goal and time.

        Raises:
            WebError: LOCKED: the tab is not the one that may act.
        """
        with self.lock:
            if not self.sync().over:
                self.store.read(lambda connection: check_tab(connection, session, tab))
                self._stop(number, Code.FINISHED, "the person finished it")

    def _stop(self, number: int, code: Code, message: str) -> None:
        why = {"agent": number, "code": str(code), "message": message[:300]}
        self.store.write(lambda connection: game_store.end(connection, self.stored.id, why))
        self._after()

    def hurry(self) -> None:
        """Let a character wait in this tick if it delays the other too long, or at once if its person has left."""
        with self.lock:
            late: dict[int, str | None] = {n: None for n in self.game.trial.people if n not in self.decided}
            there = any(presence(self.signs.get(n)) == HERE for n in late)
            if not self.decided or self.game.over or (there and time.time() - self.waiting_since < PATIENCE):
                return
            turn = Turn(self.stored.id, self.game.tick, self.characters)
            with contextlib.suppress(WebError):
                self.store.write(lambda connection: game_store.decide(connection, turn, late))
            self._after()

    def listen(self) -> tuple[int, str]:
        """Wait for the helper's program on a port of this machine (docs/examples/agents.md); the port, and its token.

        Port 0 where the game has no program, is over, or too many games of this process have ports.
        """
        with self.lock:
            if self.game.trial.helper != PROGRAM or self.game.over:
                return 0, ""
            if self._door is None or self._door.closed:
                self._door = program_door(self)
            return (self._door.port, self._door.token) if self._door else (0, "")

    def wants_program(self) -> bool:
        """Return whether the game goes on, so that its port stays open."""
        try:
            with self.lock:
                return not self.sync().over
        except WebError:  # it was deleted
            return False
        except HearthError:  # the store is busy
            return True

    def take_program(self, channel: SocketChannel) -> None:
        """Let a program that has shown the token be the helper; the last that came is."""
        with self.lock:
            self._let_go()
            self._program = WireAgent(channel, PROGRAM_WITHIN, limit=self.game.playing.limit)
            self.sync().use(self._program)

    def close(self) -> None:
        """Let go of the helper's program, and close its port."""
        with self.lock:
            door, self._door = self._door, None
            if door is not None:
                door.close()
            self._let_go()

    def _let_go(self) -> None:
        if self._program is not None:
            self._program.end(self.game.playing.progress[-1].satisfied, self.game.tick)
            self._program.channel.close()
            self._program = None


class Games:
    """The games of a store that this process keeps."""

    def __init__(self, store: Store, knowledge: Knowledge) -> None:
        self._store, self._knowledge = store, knowledge
        self._kept: OrderedDict[str, LiveGame] = OrderedDict()
        self._lock = BoundedLock("the room")

    def find(self, game: str, session: str) -> tuple[LiveGame, int]:
        """Return a game of a session, and the character that it plays.

        Raises:
            WebError: UNKNOWN_ID: it has none of that id.
        """
        number = self._store.read(lambda connection: game_store.seat(connection, game, session))
        return self.open(game), number

    def open(self, game: str) -> LiveGame:
        """Return a game, for a person who may see it."""
        with self._lock:
            made = self._kept.get(game)
        if made is None:  # outside the lock: others do not wait for the store and for this home
            stored = self._store.read(lambda connection: game_store.stored(connection, game))
            made = LiveGame(self._store, stored, self._knowledge)
        with self._lock:
            self._kept.setdefault(game, made)
            self._kept.move_to_end(game)
            forgotten = [self._kept.popitem(last=False)[1] for _ in range(len(self._kept) - MOST_GAMES)]
            found = self._kept[game]
        for each in forgotten:
            each.close()
        return found


_GAMES: WeakKeyDictionary[Store, Games] = WeakKeyDictionary()


def games(store: Store, knowledge: Knowledge) -> Games:
    """Return the games of a store that this process keeps."""
    return _GAMES.setdefault(store, Games(store, knowledge))
