"""Signatures: a short string with every option that changes a score's value."""


def signature(name: str, version: int = 1, /, **options: object) -> str:
    """Return a score's signature: `signature("lcs", norm="max", level="step")` is `lcs|norm:max|level:step|v1`.

    Args:
        name: of the score.
        version: incremented whenever the same input could score differently.
        options: the options that change the score's value, in this order.
    """
    parts = [f"{key}:{_word(value)}" for key, value in options.items()]
    return "|".join([name, *parts, f"v{version}"])


def _word(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return str(value)
