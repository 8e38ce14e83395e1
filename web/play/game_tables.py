"""The store's tables of games: trials, who plays which character, and every decision that was accepted."""

import sqlalchemy as sql

from hearth.web.web_tables import METADATA, owner

GAMES = sql.Table(
    "play_games",
    METADATA,
    sql.Column("id", sql.Text, primary_key=True, comment="random and unguessable; part of its address"),
    owner(),
    sql.Column("created", sql.Float, nullable=False, comment="seconds since 1970, UTC"),
    sql.Column("task", sql.Text, nullable=False, index=True, comment="id of its task"),
    sql.Column("trial", sql.Text, nullable=False, comment="JSON, see web/play/play_trials.py"),
    sql.Column("code", sql.Text, nullable=False, unique=True, comment="the secret by which a second person joins"),
    sql.Column("go_on", sql.Text, nullable=False, comment="address of ours to go on to after its end"),
    sql.Column("end", sql.Text, comment="JSON: why it ended before its goal and time, if it did"),
    sql.Column("result", sql.Text, comment="JSON: success, ticks and the time, once it is over"),
)
"""A trial that was begun."""


def _game() -> sql.Column[str]:
    return sql.Column("game", sql.Text, sql.ForeignKey("play_games.id", ondelete="CASCADE"), primary_key=True)


SEATS = sql.Table(
    "play_seats",
    METADATA,
    _game(),
    sql.Column("agent", sql.Integer, primary_key=True, comment="the character"),
    owner(),
)
"""The person who plays each character."""

DECISIONS = sql.Table(
    "play_decisions",
    METADATA,
    _game(),
    sql.Column("tick", sql.Integer, primary_key=True, comment="from 0"),
    sql.Column("agent", sql.Integer, primary_key=True, comment="the character"),
    sql.Column("act", sql.Text, comment="as in records, `Grab 41`; null for a character that waits"),
    sql.Column("at", sql.Float, nullable=False, comment="seconds since 1970, UTC, when it was accepted"),
)
"""The attempts of each character in each tick.

A tick is done once every character has a row of it; a row never changes.
"""

SIGNS = sql.Table(
    "play_signs",
    METADATA,
    _game(),
    sql.Column("agent", sql.Integer, primary_key=True, comment="the character"),
    sql.Column("at", sql.Float, nullable=False, comment="seconds since 1970, UTC, when its page was open last"),
)
"""The people of games for two who are present."""

OPENINGS = sql.Table(
    "play_openings",
    METADATA,
    _game(),
    sql.Column("agent", sql.Integer, primary_key=True, comment="the character"),
    sql.Column("tab", sql.Text, primary_key=True, comment="random, another each time that the page is opened"),
)
"""The times that each person opened the page of a game: a reload and another tab are further ones."""

WAITING = sql.Table(
    "play_waiting",
    METADATA,
    owner(),
    sql.Column("since", sql.Float, nullable=False, comment="seconds since 1970, UTC, when the person came"),
    sql.Column("at", sql.Float, nullable=False, comment="the same, when its page was open last"),
    sql.Column("game", sql.Text, nullable=False, comment="in which the person was paired; empty until then"),
    sql.PrimaryKeyConstraint("session"),
)
"""The people in the waiting room, who are to be paired."""
