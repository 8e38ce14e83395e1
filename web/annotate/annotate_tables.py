"""The contributions of annotators, by the session that made them (thesis 3.3)."""

import sqlalchemy as sql

from hearth.web.web_tables import METADATA, owner

DRAFT, SUBMITTED, RETURNED, ACCEPTED = "draft", "submitted", "returned", "accepted"
"""States of a program: at work, waiting for a second person, back with its author, done."""


def _text(name: str, comment: str, default: str | None = None) -> sql.Column[str]:
    return sql.Column(name, sql.Text, nullable=False, server_default=default, comment=comment)


def _when() -> sql.Column[float]:
    return sql.Column("created", sql.Float, nullable=False, comment="seconds since 1970, UTC")


TEXTS = sql.Table(
    "annotate_texts",
    METADATA,
    sql.Column("id", sql.Text, primary_key=True, comment="the HITId of the answer"),
    owner(),
    _text("scene", "the room that was drawn, of the eight"),
    _text("title", "of the activity"),
    _text("description", "in sentences, for another person"),
    _when(),
)
"""Stage one: titles and descriptions."""

PROGRAMS = sql.Table(
    "annotate_programs",
    METADATA,
    sql.Column("id", sql.Text, primary_key=True, comment="the HITId of the answer"),
    owner(),
    sql.Column("text", sql.Text, sql.ForeignKey("annotate_texts.id", ondelete="CASCADE"), nullable=False, index=True),
    _text("draft", "rooms, props and steps as JSON"),
    sql.Column("version", sql.Integer, nullable=False, comment="grows by one with each change of the draft"),
    _text("state", "draft, submitted, returned or accepted"),
    _text("note", "what the reviewer wrote", ""),
    _when(),
    sql.UniqueConstraint("session", "text", name="annotate_one_program"),
)
"""Stage two: programs, one of each person for a description."""

REVIEWS = sql.Table(
    "annotate_reviews",
    METADATA,
    sql.Column("id", sql.Text, primary_key=True),
    owner(),
    sql.Column("program", sql.Text, sql.ForeignKey("annotate_programs.id", ondelete="CASCADE"), nullable=False),
    _text("verdict", "accept, mend or return"),
    _text("note", "for the author"),
    _text("before", "the draft as it was submitted"),
    _when(),
)
"""The judgments of reviewers on programs."""

QUALIFIED = sql.Table(
    "annotate_tests",
    METADATA,
    sql.Column("id", sql.Text, primary_key=True),
    owner(),
    sql.Column("right", sql.Integer, nullable=False, comment="right answers"),
    sql.Column("passed", sql.Boolean, nullable=False),
    _when(),
)
"""Qualification tests that were taken."""

REVIEWERS = sql.Table(
    "annotate_reviewers",
    METADATA,
    sql.Column("id", sql.Text, primary_key=True, comment="SHA-256 of the invitation's code, which is not stored"),
    sql.Column(
        "session", sql.Text, sql.ForeignKey("sessions.id", ondelete="CASCADE"), index=True, comment="null until taken"
    ),
    _when(),
)
"""Invitations to review, each for one session."""

MARKS = sql.Table(
    "annotate_marks",
    METADATA,
    sql.Column("id", sql.Text, primary_key=True),
    owner(),
    _text("kind", "sketch, completeness or film"),
    _text("subject", "the id of the program or film"),
    _text("value", "as JSON: the steps that are kept, the grade, or the title and description"),
    _when(),
    sql.UniqueConstraint("session", "kind", "subject", name="annotate_one_mark"),
)
"""Marks on accepted programs and films: sketches (5.5.1), completeness (3.4.1), descriptions of films (4.4)."""
