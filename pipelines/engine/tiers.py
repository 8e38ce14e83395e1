"""Tiers: how much a dataset holds, by a name. A tier only stands for other options, which may be given beside it."""

from __future__ import annotations

from collections.abc import Container, Mapping
from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

TIERS: dict[str, dict[str, int]] = {
    "mini": {"limit": 60, "homes_each": 1, "variants": 1, "pictures": 0, "videos": 0},
    "full": {"homes_each": 2, "variants": 6, "target": 30_000, "pictures": 0, "videos": 0},
    "frames": {"homes_each": 1, "variants": 1, "pictures": 200, "videos": 20},
}
"""`mini` is a small one to try things out; `full` is all programs, augmented to 30,000, as text and graphs; `frames` is
every program about once, with many pictures and some films."""


def tiered(tier: str, options: Mapping[str, Any], given: Container[str]) -> dict[str, Any]:
    """Options as a tier has them, but for those that were given.

    Args:
        tier: one of `TIERS`, or "" for none.
        options: as they would be without.
        given: the names of those that someone chose.

    Raises:
        HearthError: UNKNOWN_ID, naming the tiers that there are.
    """
    if not tier:
        return dict(options)
    if tier not in TIERS:
        suggestion = f"tiers are {', '.join(TIERS)}"
        raise HearthError.of(Code.UNKNOWN_ID, f"no tier is called `{tier}`", suggestion=suggestion)
    return {**options, **{name: value for name, value in TIERS[tier].items() if name not in given}}
