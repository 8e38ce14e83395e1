"""Sizes of AI2-THOR's models by their ids, from the database in the package `procthor` where it is installed."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

from hearth.interop.scene_graphs.vectors import Vector, vector
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.input_files import read_input

DATABASE = Path("databases") / "asset-database.json"
"""Place of the database in the package."""


class Asset(NamedTuple):
    """A model: its id, and its size as width, height and depth in metres."""

    id: str
    size: Vector


def installed() -> Path | None:
    """Return the database of the installed package `procthor`; None without one."""
    found = find_spec("procthor")
    for folder in (found.submodule_search_locations or ()) if found is not None else ():
        path = Path(folder) / DATABASE
        if path.is_file():
            return path
    return None


def read_assets(path: Path | None) -> dict[str, list[Asset]]:
    """Return the models of each object type, in the file's order; {} without a file.

    Raises:
        HearthError: MISSING_FILE; BAD_JSON; BAD_TABLE: it is no database of models.
    """
    import orjson

    if path is None:
        return {}
    try:
        data: Any = orjson.loads(read_input(path))
    except orjson.JSONDecodeError as error:
        raise HearthError.of(Code.BAD_JSON, f"not JSON: {error}", file=str(path)) from error
    if not isinstance(data, Mapping) or not all(isinstance(each, list) for each in data.values()):
        raise HearthError.of(Code.BAD_TABLE, "not a database of models", file=str(path),
                             suggestion="asset-database.json of the package `procthor`")  # fmt: skip
    return {str(name): [each for each in map(_asset, entries) if each is not None] for name, entries in data.items()}


def _asset(entry: Any) -> Asset | None:
    size = vector(entry.get("boundingBox")) if isinstance(entry, Mapping) else None
    return None if size is None or min(size) <= 0 else Asset(str(entry.get("assetId", "")), size)
