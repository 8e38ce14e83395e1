"""The manifest of a published dataset, which may be a stranger's."""

import re
from pathlib import Path
from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.files import read_json
from hearth.storage.manifest import FORMAT, NAME

_VERSION = re.compile(r"[\w.+/-]{1,64}", re.ASCII)
"""A version is printed, and put into pages and file names: it has no others."""


def published_manifest(folder: Path, asked: str) -> dict[str, Any]:
    """Return the manifest of a folder.

    Args:
        folder: of the dataset.
        asked: the place that the user named, for messages.

    Raises:
        HearthError: MISSING_FILE: there is no dataset; BAD_JSON: it lacks a part that every reader needs;
            UNSUPPORTED_FILE: a newer version wrote it.
    """
    content = read_json(folder / NAME)
    if not isinstance(content, dict) or content.get("stage") != "publish":
        suggestion = "name the folder that `build` gave with --out, or the dataset inside it"
        raise HearthError.of(Code.MISSING_FILE, "no dataset here", file=asked, suggestion=suggestion)
    if not _names_its_form(content):
        message = "its manifest does not name a format, a version and its files"
        remedy = "fetch or publish the dataset again"
        raise HearthError.of(Code.BAD_JSON, message, file=str(folder / NAME), suggestion=remedy)
    if content["format"] > FORMAT:
        message = f"a dataset of format {content['format']}; this version of Hearth reads {FORMAT}"
        raise HearthError.of(Code.UNSUPPORTED_FILE, message, file=asked, suggestion="install a newer Hearth")
    return content


def _names_its_form(manifest: dict[str, Any]) -> bool:
    form = manifest.get("format")
    texts = [manifest.get(name) for name in ("version", "action_set")]
    numbered = isinstance(form, int) and not isinstance(form, bool) and form > 0
    named = all(isinstance(text, str) and _VERSION.fullmatch(text) for text in texts)
    return numbered and named and isinstance(manifest.get("files"), dict)
