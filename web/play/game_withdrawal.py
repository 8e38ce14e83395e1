"""Games of two when one of them withdraws: the game stays, with nobody in that seat."""

import sqlalchemy as sql

from hearth.web.play.game_tables import GAMES, SEATS
from hearth.web.web_tables import SESSIONS


def keep(connection: sql.Connection, person: str, nobody: str) -> int:
    """Give seats and games that are shared with a person who is still there to nobody; how many seats.

    Games with nobody else in them are deleted.
    """
    mine = list(connection.execute(sql.select(SEATS.c.game).where(SEATS.c.session == person)).scalars())
    there = sql.select(SESSIONS.c.id).where(SESSIONS.c.created > 0, SESSIONS.c.id != person)
    query = sql.select(SEATS.c.game).where(SEATS.c.game.in_(mine), SEATS.c.session.in_(there))
    shared = list(connection.execute(query).scalars())
    connection.execute(sql.delete(GAMES).where(GAMES.c.id.in_(set(mine) - set(shared))))
    begun = sql.update(GAMES).where(GAMES.c.session == person, GAMES.c.id.in_(shared))
    connection.execute(begun.values(session=nobody))
    seats = sql.update(SEATS).where(SEATS.c.session == person, SEATS.c.game.in_(shared))
    return connection.execute(seats.values(session=nobody)).rowcount
