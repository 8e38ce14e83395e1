"""Folders at URLs, as fsspec opens and lists them. Listed names never lead outside the local copy."""

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import library
from hearth.storage.files import TEMPORARY
from hearth.storage.names import leaves

_URL = re.compile(r"([a-z][a-z0-9+.-]+):/{1,2}(?=[^/])(.+)", re.DOTALL)


def url_of(path: str | Path) -> str | None:
    """Return the URL that a path is meant as, also where a `Path` has swallowed a slash of it.

    The result is None for a plain path.
    """
    match = _URL.fullmatch(str(path))
    return f"{match[1]}://{match[2].rstrip('/')}" if match and len(match[1]) > 1 else None


def filesystem(url: str) -> tuple[Any, str]:
    """fsspec's file system of a URL, and the path in it.

    Raises:
        HearthError: UNSUPPORTED_FILE: a kind of store that is unknown or lacks its package.
    """
    core = library("fsspec.core")
    try:
        fs, root = core.url_to_fs(url)
    except (ImportError, ValueError) as error:
        suggestion = "install the package it names, or check the URL's beginning"
        raise HearthError.of(Code.UNSUPPORTED_FILE, str(error), file=url, suggestion=suggestion) from None
    return fs, str(root).rstrip("/")


def listed(fs: Any, root: str) -> dict[str, dict[str, Any]]:
    """Return a store's entries below a folder, by names within it, sorted; none where the folder does not exist.

    Raises:
        HearthError: DAMAGED_FILE: a name leaves the folder, or a link leads out of it.
    """
    try:
        found = fs.find(root, detail=True)
    except FileNotFoundError:
        return {}
    infos = {}
    files = {path: info for path, info in found.items() if info.get("type") != "directory"}
    for path, info in sorted(files.items()):
        name = path.removeprefix(f"{root}/")
        destination = info.get("destination")
        outside = destination is not None and not Path(path).resolve().is_relative_to(Path(root).resolve())
        if name == path or leaves(name) or outside:
            raise HearthError.of(Code.DAMAGED_FILE, f"`{path[:200]!a}` leaves the folder", file=root)
        infos[name] = info
    return infos


def get(fs: Any, source: str, target: Path) -> None:
    """Fetch a file, whole or not at all."""
    target.parent.mkdir(parents=True, exist_ok=True)
    temporary = target.with_name(f".{target.name}.{os.getpid()}{TEMPORARY}")
    fs.get_file(source, str(temporary))
    temporary.replace(target)


@contextmanager
def reported(url: str) -> Iterator[None]:
    """Raises a store's errors as HearthError."""
    try:
        yield
    except HearthError:
        raise
    except FileNotFoundError as error:
        raise HearthError.of(Code.MISSING_FILE, "no such file or folder in the store", file=url) from error
    except Exception as error:  # every store has errors of its own
        message = f"the store does not do what was asked: {type(error).__name__}: {error}"
        suggestion = "check its address and your right to write there; what is complete stays, run the command again"
        raise HearthError.of(Code.UNWRITABLE, message, file=url, suggestion=suggestion) from error
