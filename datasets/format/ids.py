"""Ids and versions of published rows: activities, splits, stamps."""

import re
from functools import lru_cache

from hearth.kb.action_sets import USUAL, name_of_set
from hearth.schemas.rng import derive
from hearth.version import VERSION


def stamp(action_set: int = USUAL) -> dict[str, str]:
    """Return the version columns of every published row, by the number of the action set."""
    return {"action_set": name_of_set(action_set), "dataset_version": VERSION}


STAMP = stamp()
"""Version columns of rows of the usual action set."""


TRAIN, VALIDATION = 7, 1
"""Shares of train, validation and test: 7, 1 and 2 of ten activities (thesis 5.6: 7:3)."""


OURS = r"^(?:crowd|written)(:3[DP][0-9]{4}[0-9A-Z]{5})\b"
"""Ids of the embedded corpus, for Python and DuckDB. Until 0.1 they said `crowd`; a platform's have 30 characters."""


def current_id(name: str) -> str:
    """Return the id that a record, or a row made of it, has in this version."""
    return re.sub(OURS, r"written\1", name)


def names_of(name: str) -> tuple[str, ...]:
    """Return an id as it is, as this version has it, and as 0.1 had it."""
    return tuple(dict.fromkeys((name, current_id(name), re.sub(OURS, r"crowd\1", name))))


@lru_cache(maxsize=10_000)
def activity_id(title: str) -> str:
    """Return the activity id of a title: lower case, words joined by underscores."""
    return "_".join(re.findall(r"[^\W_]+", title.lower())) or "untitled"


@lru_cache(maxsize=10_000)
def split_of(activity: str, seed: int) -> str:
    """`train`, `validation` or `test`, by activity, so that descendants of one program stay together."""
    decile = derive(seed, "split", activity) % 10
    return "train" if decile < TRAIN else "validation" if decile < TRAIN + VALIDATION else "test"
