"""The store's tables of studies: their files, their places, their events, and the games of their trials."""

import sqlalchemy as sql

from hearth.web.web_tables import METADATA, owner

STUDIES = sql.Table(
    "study_studies",
    METADATA,
    sql.Column("name", sql.Text, primary_key=True, comment="as in its file"),
    sql.Column("text", sql.Text, nullable=False, comment="its file, which does not change once it has begun"),
    sql.Column("salt", sql.Text, nullable=False, comment="secret; ids in exported tables are hashed with it"),
)
"""A study that people take part in."""

PLACES_TAKEN = sql.Table(
    "study_places",
    METADATA,
    sql.Column("study", sql.Text, sql.ForeignKey("study_studies.name"), primary_key=True),
    sql.Column("number", sql.Integer, primary_key=True, comment="from 0, in the order in which people joined"),
    sql.Column("place", sql.Integer, nullable=False, comment="which place of the study"),
    sql.Column("at", sql.Float, nullable=False, comment="seconds since 1970, UTC"),
    sql.Column(
        "session", sql.Text, sql.ForeignKey("sessions.id", ondelete="SET NULL"), comment="who; null if forgotten"
    ),
)
"""The person who took each place."""

HAPPENED = sql.Table(
    "study_events",
    METADATA,
    sql.Column("study", sql.Text, sql.ForeignKey("study_studies.name"), primary_key=True),
    sql.Column("session", sql.Text, sql.ForeignKey("sessions.id", ondelete="CASCADE"), primary_key=True),
    sql.Column("number", sql.Integer, primary_key=True, comment="from 0, of the person's events in the study"),
    sql.Column("kind", sql.Text, nullable=False, comment="one of KINDS of studies/events.py"),
    sql.Column("at", sql.Float, nullable=False, comment="seconds since 1970, UTC"),
    sql.Column("data", sql.Text, nullable=False, comment="JSON"),
)
"""The actions of a person; a row never changes."""

TRIAL_GAMES = sql.Table(
    "study_games",
    METADATA,
    owner(),
    sql.Column("study", sql.Text, nullable=False),
    sql.Column("number", sql.Integer, nullable=False, comment="of the person's events at which the game was begun"),
    sql.Column("game", sql.Text, sql.ForeignKey("play_games.id", ondelete="CASCADE"), primary_key=True),
    sql.UniqueConstraint("session", "study", "number"),
)
"""The game of a trial or of a practice."""
