"""The presence of the people of a game: each person's page leaves a sign in the store while it is open."""

import contextlib
import time

import sqlalchemy as sql
from sqlalchemy.exc import IntegrityError

from hearth.web.play.game_tables import SIGNS
from hearth.web.store import Store

SIGN_EVERY = 1.0
"""Seconds between the signs of a page."""

GONE_AFTER = 4.0
"""Seconds without a sign after which a person counts as gone."""

AWAITED, HERE, GONE = "awaited", "here", "gone"
"""The other of two people: has not come yet, is there, has left."""


def give_sign(store: Store, game: str, agent: int) -> None:
    """Keep that the page of a person is open now."""
    mine = (SIGNS.c.game == game, SIGNS.c.agent == agent)

    def work(connection: sql.Connection) -> None:
        now = time.time()
        if not connection.execute(sql.update(SIGNS).where(*mine).values(at=now)).rowcount:
            connection.execute(sql.insert(SIGNS).values(game=game, agent=agent, at=now))

    with contextlib.suppress(IntegrityError):  # another page of this person gave the first, or the game was deleted
        store.write(work)


def signs(connection: sql.Connection, game: str) -> dict[int, float]:
    """Return when each person of a game gave the last sign, in seconds since 1970."""
    rows = connection.execute(sql.select(SIGNS.c.agent, SIGNS.c.at).where(SIGNS.c.game == game))
    return {int(row.agent): float(row.at) for row in rows}


def presence(sign: float | None) -> str:
    """Return whether a person is there, by the last sign."""
    if sign is None:
        return AWAITED
    return HERE if time.time() - sign < GONE_AFTER else GONE
