"""Signatures: everything about a score that changes its value, in one short string beside it."""

from __future__ import annotations

VERSION = "v1"
"""Raised whenever the same input could score differently."""


def signature(name: str, **options: object) -> str:
    """`signature("lcs", norm="max", level="step")` is `lcs|norm:max|level:step|v1`; options stay in the order given."""
    parts = [f"{key}:{_word(value)}" for key, value in options.items()]
    return "|".join([name, *parts, VERSION])


def _word(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return str(value)
