"""The user's own homes of a dataset: recorded in its manifest; their files are stored next to the tables."""

from pathlib import Path
from typing import Any

from hearth.datasets.dataset_knowledge import carried, copy_files
from hearth.homes.library import files_of
from hearth.storage.files import files_digest

FOLDER = "own_homes"
"""Folder of the homes' files, in a dataset and in the stage that provides homes to others; `homes` is a table."""

FIELD = "homes"
"""Field of a manifest: `overlay`, null or the digest of the user's files and, in a dataset, the path of their copy."""


def digest(directory: Path) -> str:
    """SHA-256 of the names and bytes of a directory's homes; errors as of `files_of`."""
    return files_digest(files_of(directory), directory)


def copy_homes(homes: str | None, folder: Path) -> None:
    """Copy the user's homes into a folder, replacing those of an earlier build."""
    copy_files(files_of(Path(homes)) if homes else [], folder / FOLDER)


def homes_used(homes: str | None, folder: Path) -> dict[str, Any]:
    """Return the manifest's field: the digest of the user's homes, and the path of their copy, if any."""
    over = {"sha256": digest(Path(homes))} if homes else None
    if over and (folder / FOLDER).exists():
        over["path"] = FOLDER
    return {FIELD: {"overlay": over}}


def own_homes(folder: Path, manifest: dict[str, Any]) -> Path | None:
    """Return the folder of the user's homes that a dataset carries, None if it has none; errors as of `carried`."""
    return carried(folder, manifest.get(FIELD), FIELD, digest)
