"""The knowledge of a dataset: recorded in its manifest; the user's overlay is stored beside the tables."""

import shutil
from pathlib import Path
from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import digest, files_of, overlaid
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.files import write_bytes

FOLDER = "knowledge"
"""Folder of the overlay's files, in a dataset and in the stage that provides knowledge to others."""

FIELD = "knowledge"
"""Field of a manifest: `base`, the digest of our files, and `overlay`, null or the digest of the user's files and, in a
dataset, the path of their copy. Datasets without the field were made with ours."""


def copy_overlay(overlay: str | None, folder: Path) -> None:
    """Copy the user's knowledge files into a folder, replacing those of an earlier build."""
    target = folder / FOLDER
    files = {path.name: path.read_bytes() for path in files_of(Path(overlay))} if overlay else {}
    shutil.rmtree(target, ignore_errors=True)
    for name, data in files.items():
        target.mkdir(exist_ok=True)
        write_bytes(target / name, data)


def made_with(overlay: str | None, folder: Path) -> dict[str, Any]:
    """The manifest's field: the digests of a stage's knowledge, and the path of the overlay's copy, if any."""
    over = {"sha256": digest(Path(overlay))} if overlay else None
    if over and (folder / FOLDER).exists():
        over["path"] = FOLDER
    return {FIELD: {"base": digest(), "overlay": over}}


def knowledge_of(folder: Path, manifest: dict[str, Any]) -> Knowledge:
    """The knowledge that a dataset was made with: ours, extended by the dataset's overlay.

    Raises:
        HearthError: BAD_JSON, for a malformed manifest field; MISSING_FILE or DAMAGED_FILE, if the overlay's files
            differ from the manifest; every fault of these files.
    """
    recorded = manifest.get(FIELD)
    if recorded is None:
        return overlaid(None)
    try:
        overlay = recorded["overlay"]
        path, wanted = (folder / overlay["path"], overlay["sha256"]) if overlay else (None, "")
    except (TypeError, KeyError) as error:
        message = f"the manifest does not say which knowledge: {type(error).__name__} {error}"
        raise HearthError.of(Code.BAD_JSON, message, file=str(folder)) from error
    if path is not None:
        _check(path, wanted, folder)
    return overlaid(path)


def _check(path: Path, wanted: str, folder: Path) -> None:
    again = "fetch or publish the dataset again"
    if not path.resolve().is_relative_to(folder.resolve()):
        raise HearthError.of(Code.DAMAGED_FILE, f"its knowledge lies outside: `{path}`", file=str(folder))
    if not path.is_dir():
        raise HearthError.of(Code.MISSING_FILE, "the knowledge it was made with", file=str(path), suggestion=again)
    if digest(path) != wanted:
        message = "other files of knowledge than the manifest says"
        raise HearthError.of(Code.DAMAGED_FILE, message, file=str(path), suggestion=again)


def other_base(manifest: dict[str, Any]) -> str:
    """A sentence if a dataset's base knowledge differs from this version's; else ""."""
    recorded = manifest.get(FIELD)
    base = recorded.get("base") if isinstance(recorded, dict) else None
    if not base or base == digest():
        return ""
    made = f"the knowledge of Hearth {manifest.get('version')} ({str(base)[:8]})"
    return f"it was made with {made}, which differs from ours ({digest()[:8]})"
