"""The waiting room of Play: a person who comes alone is paired with the next, or plays with a helper instead."""

from __future__ import annotations

import time
from typing import Any, NamedTuple

import sqlalchemy as sql
from starlette.responses import Response

from hearth.challenges.result_files import MOST_SEEDS
from hearth.kb.knowledge import Knowledge
from hearth.web.play import game_store
from hearth.web.play.game_tables import WAITING
from hearth.web.play.play_trials import PERSON, published, trial
from hearth.web.play.player_presence import GONE_AFTER
from hearth.web.room_request import Visit

CHALLENGE, SPLIT, TASKS = "wah", "test-1", 20
"""The tasks of pairs: one after the other, from the first again after the last."""

STAND_IN = "hp"
"""The helper that stands in for a person."""

PATIENCE_FOR_A_PARTNER = 60.0
"""Seconds after which somebody who waits is offered the stand-in."""


class Waiting(NamedTuple):
    """Somebody in the waiting room.

    Attributes:
        since: when the person came, in seconds since 1970.
        game: in which the person was paired; "" until then.
    """

    since: float
    game: str


def wait(connection: sql.Connection, session: str, knowledge: Knowledge) -> Waiting:
    """Give a sign of a person who waits, and pair the person with the one who has waited longest, in a transaction."""
    now = time.time()
    mine = _row(connection, session)
    if mine is None or (not mine.game and now - mine.at > GONE_AFTER):  # a person who was away waits from now on
        leave(connection, session)
        connection.execute(sql.insert(WAITING).values(session=session, since=now, at=now, game=""))
        mine = _row(connection, session)
    assert mine is not None
    connection.execute(sql.update(WAITING).where(WAITING.c.session == session).values(at=now))
    game = mine.game or _paired(connection, session, now, knowledge)
    return Waiting(mine.since, game)


def _paired(connection: sql.Connection, session: str, now: float, knowledge: Knowledge) -> str:
    """Begin a game with the person who has waited longest, and return its id; "" if nobody waits."""
    others = sql.select(WAITING.c.session).where(
        WAITING.c.session != session, WAITING.c.game == "", WAITING.c.at > now - GONE_AFTER
    )
    first = connection.execute(others.order_by(WAITING.c.since, WAITING.c.session)).scalar()
    if first is None:
        return ""
    game = begun(connection, str(first), PERSON, knowledge)
    game_store.take_second_seat(connection, game, session)
    for each in (first, session):
        connection.execute(sql.update(WAITING).where(WAITING.c.session == each).values(game=game))
    return game


def begun(connection: sql.Connection, session: str, helper: str, knowledge: Knowledge) -> str:
    """Begin the next task of pairs for a session, with a person or the stand-in; the game's id."""
    task = published(CHALLENGE, SPLIT, game_store.games_begun(connection) % TASKS)
    seed = game_store.played_before(connection, task.id) % MOST_SEEDS
    return game_store.begin(connection, session, trial(task, knowledge, helper, seed=seed))


def leave(connection: sql.Connection, session: str) -> None:
    """Take somebody out of the waiting room."""
    connection.execute(sql.delete(WAITING).where(WAITING.c.session == session))


def _row(connection: sql.Connection, session: str) -> Any:
    return connection.execute(sql.select(WAITING).where(WAITING.c.session == session)).one_or_none()


def pair_page(visit: Visit) -> Response:
    """Return the page on which one waits; waiting itself begins by a post of its script."""
    return visit.page("play/pair.html", patience=int(PATIENCE_FOR_A_PARTNER))


def look(visit: Visit) -> Response:
    """Return how long one has waited, or the address of the game in which one was paired."""
    found = visit.web.store.write(lambda connection: wait(connection, visit.person, visit.web.known))
    if found.game:
        visit.web.store.write(lambda connection: leave(connection, visit.person))
        return visit.answer({"go": f"/play/game/{found.game}"})
    return visit.answer({"waited": int(time.time() - found.since), "patience": int(PATIENCE_FOR_A_PARTNER)})


def with_stand_in(visit: Visit) -> Response:
    """Begin a game with the stand-in; a person who was paired meanwhile plays with the other."""

    def work(connection: sql.Connection) -> str:
        mine = _row(connection, visit.person)
        leave(connection, visit.person)
        return str(mine.game) if mine and mine.game else begun(connection, visit.person, STAND_IN, visit.web.known)

    return visit.go(f"/play/game/{visit.web.store.write(work)}")


def stop_waiting(visit: Visit) -> Response:
    """Go back to the room; a game in which one was paired meanwhile is gone on with."""

    def work(connection: sql.Connection) -> str:
        mine = _row(connection, visit.person)
        leave(connection, visit.person)
        return f"game/{mine.game}" if mine and mine.game else ""

    return visit.go(f"/play/{visit.web.store.write(work)}")
