"""Tiers and strengths: names that set other options, which may also be given themselves."""

from collections.abc import Container, Mapping
from typing import Any

from hearth.repair.perturbation_strengths import MILD, strength
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

STANDARD = "standard"
"""The tier of the embedded corpus if nothing else is asked for."""

FIRST = "first"
"""The tier that builds the first part of the embedded corpus."""

TIERS: dict[str, dict[str, int]] = {
    STANDARD: {"homes_each": 2, "variants": 2, "target": 12_000},
    FIRST: {},
    "mini": {"limit": 60, "homes_each": 1, "variants": 1, "pictures": 0, "videos": 0},
    "full": {"homes_each": 2, "variants": 6, "target": 30_000, "pictures": 0, "videos": 0},
    "frames": {"homes_each": 1, "variants": 1, "pictures": 200, "videos": 20},
    "clips": {"homes_each": 0, "variants": 0, "pictures": 0, "videos": 0, "clips": 600},
    "demos": {"homes_each": 1, "variants": 0, "pictures": 0, "videos": 0, "demonstrations": 2_000},
}
"""`standard` has the whole embedded corpus, each program in two homes, and takes minutes; `first` its first part in all
homes, as versions before built it; `mini` is small, for trying things out; `full` has all programs, augmented to
30,000, as text and graphs; `frames` has every program about once, with many pictures and some films; `clips` films 600
programs small, in the homes of their part, as some 26,000 clips of two seconds; `demos` has every program once, and
pictures 2,000 of them from above, with class masks."""


def tiered(tier: str, options: Mapping[str, Any], given: Container[str]) -> dict[str, Any]:
    """Return the options with those of a tier and, where it has none, of their `strength`.

    Options that the user gave are kept.

    `standard` is only a default, so a strength goes before it. A user that wants no pictures wants no films, either.

    Args:
        tier: one of `TIERS`, or "" for none.
        options: the options without a tier.
        given: the names of the options that the user gave.

    Raises:
        HearthError: UNKNOWN_ID, with the names of the tiers or strengths.
    """
    if tier and tier not in TIERS:
        suggestion = f"tiers are {', '.join(TIERS)}"
        raise HearthError.of(Code.UNKNOWN_ID, f"unknown tier `{tier}`", suggestion=suggestion)
    of_strength = strength(options.get("strength", MILD)).options or {}
    of_tier = TIERS[tier] if tier else {}
    implied = {**of_tier, **of_strength} if tier == STANDARD else {**of_strength, **of_tier}
    if "pictures" in given and not options["pictures"]:
        implied["videos"] = 0
    return {**options, **{name: value for name, value in implied.items() if name not in given}}
