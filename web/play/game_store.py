"""Games in the store: begun, joined, decided in, ended. Any process can go on with a game, for all of it is here."""

import math
import secrets
import time
from collections.abc import Mapping
from typing import Any, NamedTuple

import orjson
import sqlalchemy as sql

from hearth.schemas.failures import Code
from hearth.web.play.game_tables import DECISIONS, GAMES, OPENINGS, SEATS
from hearth.web.play.play_trials import PERSON, Trial, read_trial
from hearth.web.sessions import check_tab
from hearth.web.store import Store
from hearth.web.web_errors import WebError


class Stored(NamedTuple):
    """A game as the store has it.

    Attributes:
        id: names it.
        trial: the trial that is played.
        created: seconds since 1970.
        code: the secret by which a second person joins.
        go_on: address to go on to after its end.
        end: why it ended early; None if it did not.
        result: `success`, `ticks`, and `at`, when it was over, in seconds since 1970; None until it is over.
    """

    id: str
    trial: Trial
    created: float
    code: str
    go_on: str
    end: dict[str, Any] | None
    result: dict[str, Any] | None

    @property
    def deadline(self) -> float:
        """Return when its time is over, in seconds since 1970; infinite where it has no limit."""
        return self.created + self.trial.seconds if self.trial.seconds else math.inf

    @property
    def blind(self) -> bool:
        """Return whether it is of a study, whose people do not know which helper they have (thesis 7.5)."""
        return not self.go_on.startswith("/play/")


class Decided(NamedTuple):
    """A decision as the store has it."""

    agent: int
    act: str | None
    at: float


def begin(connection: sql.Connection, session: str, trial: Trial, go_on: str = "/play/") -> str:
    """Begin a game of a session, within a transaction; its id."""
    game = secrets.token_urlsafe(16)
    connection.execute(
        sql.insert(GAMES).values(
            id=game,
            session=session,
            created=time.time(),
            task=trial.task.id,
            trial=orjson.dumps(trial.as_json()).decode(),
            code=secrets.token_urlsafe(16),
            go_on=go_on,
        )
    )
    connection.execute(sql.insert(SEATS).values(game=game, agent=0, session=session))
    return game


def join(connection: sql.Connection, session: str, code: str) -> str:
    """Take the second seat of the game with a code, and return the game's id.

    A person with a seat in the game keeps that seat.

    Raises:
        WebError: UNKNOWN_ID: there is no such game for two; LOCKED: another person has the seat.
    """
    game, people = invited(connection, code)
    if session not in people:
        if len(people) > 1:
            raise WebError(Code.LOCKED, "code", "a free seat", "somebody else has it")
        take_second_seat(connection, game, session)
    return game


def invited(connection: sql.Connection, code: str) -> tuple[str, frozenset[str]]:
    """Return the id of the game with a code, and the sessions that have a seat in it.

    Raises:
        WebError: UNKNOWN_ID: there is no such game for two.
    """
    found = connection.execute(sql.select(GAMES.c.id, GAMES.c.trial).where(GAMES.c.code == code)).first()
    if found is None or read_trial(orjson.loads(found.trial)).helper != PERSON:
        raise WebError(Code.UNKNOWN_ID, "code", "the code of a game for two", "another")
    seats = connection.execute(sql.select(SEATS.c.session).where(SEATS.c.game == found.id))
    return str(found.id), frozenset(str(row.session) for row in seats)


def take_second_seat(connection: sql.Connection, game: str, session: str) -> None:
    """Let a session play the second character of a game, within a transaction."""
    connection.execute(sql.insert(SEATS).values(game=game, agent=1, session=session))


def seat(connection: sql.Connection, game: str, session: str) -> int:
    """Return the character that a session plays in a game.

    Raises:
        WebError: UNKNOWN_ID: none; whether there is such a game is not said.
    """
    query = sql.select(SEATS.c.agent).where(SEATS.c.game == game, SEATS.c.session == session)
    found = connection.execute(query).scalar()
    if found is None:
        raise WebError(Code.UNKNOWN_ID, "game", "a game of this session", "another")
    return int(found)


def stored(connection: sql.Connection, game: str) -> Stored:
    """Return a game; `seat` has checked that the person may see it.

    Raises:
        WebError: UNKNOWN_ID: it was deleted, as one of its people asked.
    """
    row = connection.execute(sql.select(GAMES).where(GAMES.c.id == game)).one_or_none()
    if row is None:
        raise WebError(Code.UNKNOWN_ID, "game", "a game", "one that was deleted")
    return _stored(row)


def games_of(connection: sql.Connection, session: str) -> list[Stored]:
    """Return the games in which a session has a seat, the newest first."""
    query = sql.select(GAMES).join(SEATS, SEATS.c.game == GAMES.c.id).where(SEATS.c.session == session)
    return [_stored(row) for row in connection.execute(query.order_by(GAMES.c.created.desc()))]


def played_before(connection: sql.Connection, task: str) -> int:
    """Return how many games of a task there are."""
    query = sql.select(sql.func.count()).select_from(GAMES).where(GAMES.c.task == task)
    return int(connection.execute(query).scalar_one())


def keep_opening(connection: sql.Connection, game: str, agent: int, tab: str) -> None:
    """Keep that a person opened the page of a game, within a transaction; a tab that comes back is counted once."""
    row = {"game": game, "agent": agent, "tab": tab}
    known = sql.select(OPENINGS.c.tab).where(*(OPENINGS.c[name] == value for name, value in row.items()))
    if connection.execute(known).first() is None:
        connection.execute(sql.insert(OPENINGS).values(**row))


def openings(connection: sql.Connection, game: str, agent: int = 0) -> int:
    """Return how often a person opened the page of a game."""
    query = sql.select(sql.func.count()).select_from(OPENINGS)
    return int(connection.execute(query.where(OPENINGS.c.game == game, OPENINGS.c.agent == agent)).scalar_one())


def games_begun(connection: sql.Connection) -> int:
    """Return how many games there are."""
    return int(connection.execute(sql.select(sql.func.count()).select_from(GAMES)).scalar_one())


def is_full(connection: sql.Connection, game: str) -> bool:
    """Return whether somebody has the second seat of a game."""
    query = sql.select(SEATS.c.session).where(SEATS.c.game == game, SEATS.c.agent == 1)
    return connection.execute(query).first() is not None


def all_games(connection: sql.Connection) -> list[Stored]:
    """Return every game, the oldest first; for researchers."""
    return [_stored(row) for row in connection.execute(sql.select(GAMES).order_by(GAMES.c.created, GAMES.c.id))]


def _stored(row: Any) -> Stored:
    end, result = (None if each is None else orjson.loads(each) for each in (row.end, row.result))
    return Stored(row.id, read_trial(orjson.loads(row.trial)), row.created, row.code, row.go_on, end, result)


def decisions(connection: sql.Connection, game: str, since: int = 0) -> dict[int, list[Decided]]:
    """Return the decisions of the ticks from `since` on, by tick and character."""
    query = sql.select(DECISIONS).where(DECISIONS.c.game == game, DECISIONS.c.tick >= since)
    found: dict[int, list[Decided]] = {}
    for row in connection.execute(query.order_by(DECISIONS.c.tick, DECISIONS.c.agent)):
        found.setdefault(row.tick, []).append(Decided(row.agent, row.act, row.at))
    return found


class Turn(NamedTuple):
    """A tick of a game in which a character decides."""

    game: str
    tick: int
    characters: int


def decide(connection: sql.Connection, turn: Turn, acts: Mapping[int, str | None]) -> None:
    """Accept decisions of a tick, if it is that tick's turn and nobody else has decided for these characters.

    Raises:
        WebError: OUT_OF_ORDER.
    """
    known = decisions(connection, turn.game, max(0, turn.tick - 1))
    complete = turn.tick == 0 or len(known.get(turn.tick - 1, ())) == turn.characters
    taken = any(each.agent in acts for each in known.get(turn.tick, ()))
    if not complete or taken or any(tick > turn.tick for tick in known):
        raise WebError(Code.OUT_OF_ORDER, "tick", "the tick that is to be decided now", str(turn.tick))
    now = time.time()
    rows = [{"game": turn.game, "tick": turn.tick, "agent": n, "act": act, "at": now} for n, act in acts.items()]
    connection.execute(sql.insert(DECISIONS), rows)


def end(connection: sql.Connection, game: str, why: Mapping[str, Any]) -> None:
    """Write why a game ended early; the first reason stays."""
    query = sql.update(GAMES).where(GAMES.c.id == game, GAMES.c.end.is_(None))
    connection.execute(query.values(end=orjson.dumps(why).decode()))


def over(connection: sql.Connection, game: str, success: bool, ticks: int, at: float) -> None:
    """Write that a game is over, and when; an earlier result stays."""
    result = orjson.dumps({"success": success, "ticks": ticks, "at": at}).decode()
    query = sql.update(GAMES).where(GAMES.c.id == game, GAMES.c.result.is_(None))
    connection.execute(query.values(result=result))


def accept(store: Store, session: str, tab: str, turn: Turn, acts: Mapping[int, str | None]) -> None:
    """Accept decisions of a session's tab in one transaction: once this returns, no kill loses them.

    Raises:
        WebError: LOCKED: another tab has this session; OUT_OF_ORDER: it is not that tick's turn.
    """

    def work(connection: sql.Connection) -> None:
        check_tab(connection, session, tab)
        decide(connection, turn, acts)

    store.write(work)
