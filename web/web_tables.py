"""The store's tables: those that all rooms share, and how a room declares its own."""

import sqlalchemy as sql

METADATA = sql.MetaData()
"""Every table; a room adds its own in a file of its folder, `sql.Table("annotate_answers", METADATA, ...)`."""

SESSIONS = sql.Table(
    "sessions",
    METADATA,
    sql.Column("id", sql.Text, primary_key=True, comment="random; shown to researchers, never a name"),
    sql.Column("token", sql.Text, nullable=False, unique=True, comment="SHA-256 of the token, which is not stored"),
    sql.Column("created", sql.Float, nullable=False, comment="seconds since 1970, UTC"),
    sql.Column("tab", sql.Text, nullable=False, server_default="", comment="the one tab that may act"),
)
"""A person at work: the holder of the token has the session."""


def owner() -> sql.Column[str]:
    """Return the column of a room's table for the session that a row belongs to; the row goes when the session goes."""
    key = sql.ForeignKey("sessions.id", ondelete="CASCADE")
    return sql.Column("session", sql.Text, key, nullable=False, index=True)
