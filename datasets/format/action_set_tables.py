"""The published tables of datasets by their action set."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pyarrow as pa

from hearth.kb.action_sets import LATEST, USUAL, number_of_set
from hearth.schemas.tables import CONSEQUENCE_TABLES, TABLES


def tables_of(action_set: int = USUAL) -> dict[str, pa.Schema]:
    """Return the published tables of datasets of an action set: executions of set 3 have columns of harm."""
    return CONSEQUENCE_TABLES if action_set == LATEST else TABLES


def tables_of_dataset(manifest: Mapping[str, Any]) -> dict[str, pa.Schema]:
    """Return the tables of a dataset, by its manifest."""
    return tables_of(number_of_set(manifest.get("action_set")))
