"""AI2-THOR's object types for classes of ours, with a model of each, and the model that fits a size best."""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from functools import lru_cache
from importlib.resources import files
from typing import NamedTuple

from hearth.interop.procthor.asset_sizes import Asset
from hearth.interop.scene_graphs.class_names import class_of
from hearth.interop.scene_graphs.shape import usual
from hearth.interop.scene_graphs.vectors import Vector
from hearth.kb.knowledge import Knowledge


class ObjectType(NamedTuple):
    """An object type of AI2-THOR: a model of middle size, and further classes of ours that it may show."""

    model: str
    also: tuple[str, ...]


@lru_cache(maxsize=1)
def object_types() -> Mapping[str, ObjectType]:
    """Return the object types that ProcTHOR has models of; from `object_types.csv`."""
    text = (files("hearth.interop.procthor") / "object_types.csv").read_text(encoding="utf-8")
    rows = csv.DictReader(text.splitlines())
    return {row["type"]: ObjectType(row["model"], tuple(row["also"].split())) for row in rows}


@lru_cache(maxsize=8)
def types_of(knowledge: Knowledge) -> Mapping[str, str]:
    """Return the object type of each class of ours that has one: the type that is read as this class.

    Of several types, the one that is called like the class comes first. The rows of the table name further classes.
    """
    found: dict[str, tuple[int, str]] = {}
    for name in object_types():
        meant = class_of(name, usual(), knowledge)
        if meant.name:
            rank = ("name", "other name").index(meant.by) if meant.by in ("name", "other name") else 2
            found[meant.name] = min(found.get(meant.name, (3, "")), (rank, name))
    types = {name: kind for name, (_, kind) in found.items()}
    for kind, (_, also) in object_types().items():
        for name in also:
            types.setdefault(name, kind)
    return types


def model_for(kind: str, size: Vector, assets: Mapping[str, Sequence[Asset]]) -> str:
    """Return the id of the model of a type that fits a size best; a usual one where no sizes are known."""
    known = assets.get(kind)
    if not known:
        return object_types()[kind].model

    def apart(asset: Asset) -> float:
        return sum(abs(one - other) for one, other in zip(asset.size, size, strict=True))

    return min(known, key=lambda asset: (round(apart(asset), 6), asset.id)).id
