"""Signatures: a short string with every option that changes a score's value."""

VERSION = "v1"
"""Incremented whenever the same input could score differently."""


def signature(name: str, **options: object) -> str:
    """`signature("lcs", norm="max", level="step")` is `lcs|norm:max|level:step|v1`; options stay in the order given."""
    parts = [f"{key}:{_word(value)}" for key, value in options.items()]
    return "|".join([name, *parts, VERSION])


def _word(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return str(value)
