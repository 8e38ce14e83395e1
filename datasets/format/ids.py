"""Names that published rows get: activities, splits, and the versions they belong to."""

from __future__ import annotations

import re
from functools import lru_cache

from hearth.schemas.rng import derive
from hearth.version import ACTION_SET, VERSION

STAMP = {"action_set": ACTION_SET, "dataset_version": VERSION}
"""What every published row belongs to."""

TRAIN = 7
"""Of ten activities, how many are for training (thesis 5.6)."""


@lru_cache(maxsize=10_000)
def activity_id(title: str) -> str:
    """An activity's name from a title as written: lower case, words joined by underscores."""
    return "_".join(re.findall(r"[^\W_]+", title.lower())) or "untitled"


@lru_cache(maxsize=10_000)
def split_of(activity: str, seed: int) -> str:
    """`train` or `test`, by activity, so that what was made of one program stays together."""
    return "train" if derive(seed, "split", activity) % 10 < TRAIN else "test"
