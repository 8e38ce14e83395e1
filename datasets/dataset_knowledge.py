"""The knowledge of a dataset: recorded in its manifest; the user's overlay is stored next to the tables."""

import shutil
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from hearth.kb.action_sets import number_of_set
from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import digest, files_of, overlaid
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.files import write_bytes
from hearth.storage.names import inside

FOLDER = "knowledge"
"""Folder of the overlay's files, in a dataset and in the stage that provides knowledge to others."""

FIELD = "knowledge"
"""Field of a manifest: `base`, the digest of our files, and `overlay`, null or the digest of the user's files and, in a
dataset, the path of their copy. Datasets without the field were made with ours."""


def copy_overlay(overlay: str | None, folder: Path) -> None:
    """Copy the user's knowledge files into a folder, replacing those of an earlier build."""
    copy_files(files_of(Path(overlay)) if overlay else [], folder / FOLDER)


def made_with(overlay: str | None, folder: Path) -> dict[str, Any]:
    """Return the manifest's field: the digests of a stage's knowledge, and the path of the overlay's copy, if any."""
    over = {"sha256": digest(Path(overlay))} if overlay else None
    if over and (folder / FOLDER).exists():
        over["path"] = FOLDER
    return {FIELD: {"base": digest(), "overlay": over}}


def copy_files(files: Iterable[Path], folder: Path) -> None:
    """Make a folder hold copies of these files and nothing else; without a file it goes."""
    data = {path.name: path.read_bytes() for path in files}
    shutil.rmtree(folder, ignore_errors=True)
    for name, content in data.items():
        folder.mkdir(exist_ok=True)
        write_bytes(folder / name, content)


def knowledge_of(folder: Path, manifest: dict[str, Any]) -> Knowledge:
    """Return the knowledge that a dataset was made with: ours, extended by the dataset's overlay, with the actions of
    its set.

    Raises:
        HearthError: BAD_JSON, for a malformed manifest field; MISSING_FILE or DAMAGED_FILE, if the overlay's files
            differ from the manifest; every fault of these files.
    """
    known = overlaid(carried(folder, manifest.get(FIELD), FIELD, digest))
    return known.of_set(number_of_set(manifest.get("action_set")))


def carried(folder: Path, recorded: Any, what: str, digest_of: Callable[[Path], str]) -> Path | None:
    """Return the folder of the user's files that a dataset was made with and carries.

    The result is None where it was made with ours alone.

    Args:
        folder: of the dataset.
        recorded: the manifest's field; None, in datasets made before there was one.
        what: the files are of, for messages.
        digest_of: the digest of such a folder.

    Raises:
        HearthError: BAD_JSON, for a malformed field; MISSING_FILE or DAMAGED_FILE, if the files differ from it.
    """
    if recorded is None:
        return None
    try:
        overlay = recorded["overlay"]
        name, wanted = (overlay["path"], overlay["sha256"]) if overlay else ("", "")
        if not isinstance(name, str):
            raise TypeError(f"a path of {type(name).__name__}")
    except (TypeError, KeyError) as error:
        message = f"the manifest does not say which {what}: {type(error).__name__} {error}"
        raise HearthError.of(Code.BAD_JSON, message, file=str(folder)) from error
    if not overlay:
        return None
    again = "fetch or publish the dataset again"
    try:
        path = inside(folder, name)
    except HearthError as error:
        message = f"its {what} lies outside: `{name[:80]}`"
        raise HearthError.of(Code.DAMAGED_FILE, message, file=str(folder)) from error
    if not path.is_dir():
        raise HearthError.of(Code.MISSING_FILE, f"the {what} it was made with", file=str(path), suggestion=again)
    if digest_of(path) != wanted:
        message = f"other files of {what} than the manifest says"
        raise HearthError.of(Code.DAMAGED_FILE, message, file=str(path), suggestion=again)
    return path


def other_base(manifest: dict[str, Any]) -> str:
    """Return a sentence if a dataset's base knowledge differs from this version's; else ""."""
    recorded = manifest.get(FIELD)
    base = recorded.get("base") if isinstance(recorded, dict) else None
    if not base or base == digest():
        return ""
    made = f"the knowledge of Hearth {manifest.get('version')} ({str(base)[:8]})"
    return f"it was made with {made}, which differs from ours ({digest()[:8]})"
