"""Ids and versions of published rows: activities, splits, stamps."""

import re
from functools import lru_cache

from hearth.schemas.rng import derive
from hearth.version import ACTION_SET, VERSION

STAMP = {"action_set": ACTION_SET, "dataset_version": VERSION}
"""Version columns of every published row."""

TRAIN = 7
"""Number of activities out of ten that are for training (thesis 5.6)."""


@lru_cache(maxsize=10_000)
def activity_id(title: str) -> str:
    """The activity id of a title: lower case, words joined by underscores."""
    return "_".join(re.findall(r"[^\W_]+", title.lower())) or "untitled"


@lru_cache(maxsize=10_000)
def split_of(activity: str, seed: int) -> str:
    """`train` or `test`, by activity, so that descendants of one program stay together."""
    return "train" if derive(seed, "split", activity) % 10 < TRAIN else "test"
