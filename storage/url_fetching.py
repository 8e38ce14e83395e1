"""Files and folders at URLs, fetched before they are read; a dataset that is replaced meanwhile is of one version.

Copies are in a folder that is removed when the process ends; within a process only changed files are fetched again.

A store cannot exchange two folders in one step. While a build replaces the dataset `publish`, the new one is complete
in `.publish` before the first file of the old one changes, and goes when the last one has (`Store.replace`). So either
the one or the other is whole at any moment, as its manifest shows: it has the size and the SHA-256 of every file.

fsspec's own caching does not serve here: it keeps files under hashes of their names, or all in one folder, where a
dataset is read by the names of its tables and parts.
"""

import atexit
import os
import shutil
import tempfile
import threading
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path, PurePosixPath
from typing import Any

from hearth.storage.files import file_digest, read_json, value_digest, write_json
from hearth.storage.folder_exchange import beside, put_in_place, start_from
from hearth.storage.manifest import NAME, UNHASHED
from hearth.storage.names import inside
from hearth.storage.remote import filesystem, get, listed, reported, url_of

_FETCHED = ".fetched.json"
_ROUNDS = 10
"""Times that a dataset is fetched, if builds replace it each time."""

_one_at_a_time = threading.Lock()


def fetched(path: str | Path) -> Path:
    """Return the local path of a file or folder to be read; from a store it is fetched, of a build only its dataset.

    Raises:
        HearthError: MISSING_FILE, or the store cannot be reached.
    """
    url = url_of(path)
    if url is None:
        return Path(path)
    with reported(url), _one_at_a_time:
        fs, root = filesystem(url)
        copy = _temporary_folder(os.getpid()) / f"hearth-{os.getuid()}-read-{value_digest(url)[:16]}"
        fs.invalidate_cache()
        if fs.isfile(root):
            name = PurePosixPath(root).name
            _update(fs, {name: fs.info(root)}, copy)
            return inside(copy, name)
        dataset = next((folder for folder in (root, f"{root}/publish") if any(_manifests(fs, folder))), None)
        if dataset is not None:
            _fetch_dataset(fs, dataset, copy)
        elif infos := listed(fs, root):
            _update(fs, infos, copy)
        else:
            raise FileNotFoundError(url)
        return copy


def _places(folder: str) -> tuple[str, ...]:
    """Return the possible places of a dataset: its folder and, while a build replaces it, the folder next to it."""
    path = PurePosixPath(folder)
    return (folder, str(path.with_name(f".{path.name}"))) if len(path.parts) > 1 else (folder,)


def _manifests(fs: Any, folder: str) -> Iterator[bool]:
    return (fs.exists(f"{place}/{NAME}") for place in _places(folder))


def _fetch_dataset(fs: Any, folder: str, copy: Path) -> None:
    """Make the copy one version of a dataset; if the store's stays as it is and is not whole, copy the files there."""
    before = None
    for _ in range(_ROUNDS):
        fs.invalidate_cache()
        found = [listed(fs, place) for place in _places(folder)]
        if any(NAME in infos and _update(fs, infos, copy, check=True) for infos in found):
            return
        now = [_versions(infos) for infos in found]
        if now == before:
            break
        before = now
    _update(fs, listed(fs, folder), copy)


def _update(fs: Any, infos: dict[str, dict[str, Any]], copy: Path, check: bool = False) -> bool:
    """Make the copy hold these files, in one step; those that are as they were are not fetched again.

    Args:
        fs: the file system.
        infos: the files by name.
        copy: the local folder.
        check: only if all files are as the manifest among them says.

    Returns:
        Whether it was done.
    """
    known, now, following = read_json(copy / _FETCHED) or {}, _versions(infos), beside(copy)
    if known.get("files") == now and known.get("whole") in (True, check):
        return True
    kept = {name for name, version in now.items() if known.get("files", {}).get(name) == version}
    shutil.rmtree(following, ignore_errors=True)
    start_from(copy, [inside(copy, name) for name in kept])
    said: dict[str, tuple[Any, Any]] = {}
    try:
        for name in sorted(now, key=lambda name: (name != NAME, name)):
            path = inside(following, name)
            if name not in kept:
                get(fs, infos[name]["name"], path)
            if check and name == NAME:
                said = _said(path)
                if any(infos.get(listed, {}).get("size", size) != size for listed, (size, _) in said.items()):
                    return False
            if name in said and (path.stat().st_size, file_digest(path)) != said[name]:
                return False
    except FileNotFoundError:
        if not check:
            raise
        return False
    if said and now.keys() - UNHASHED != said.keys() - UNHASHED:
        return False
    write_json(following / _FETCHED, {"files": now, "whole": check})
    put_in_place(copy)
    return True


def _said(manifest: Path) -> dict[str, tuple[Any, Any]]:
    """Return the size and digest of each file by a manifest; nothing of files with other entries."""
    content = read_json(manifest)
    files = content.get("files") if isinstance(content, dict) else None
    entries = files.items() if isinstance(files, dict) else ()
    return {name: (entry.get("bytes"), entry.get("sha256")) for name, entry in entries if isinstance(entry, dict)}


def _versions(infos: dict[str, dict[str, Any]]) -> dict[str, str]:
    """Return the version of each file that is not hidden."""
    return {name: _version(info) for name, info in sorted(infos.items()) if not name.rsplit("/", 1)[-1].startswith(".")}


def _version(info: dict[str, Any]) -> str:
    """Return a digest that changes when a file in a store is written anew."""
    return value_digest([str(info.get(key)) for key in ("size", "ETag", "etag", "mtime", "created", "LastModified")])


@lru_cache(maxsize=1)
def _temporary_folder(process: int) -> Path:
    """Return a folder of this process, closed to others and removed when it ends, for copies that are only read."""
    folder = Path(tempfile.mkdtemp(prefix="hearth-"))
    atexit.register(_remove, folder, process)
    return folder


def _remove(folder: Path, process: int) -> None:
    if os.getpid() == process:  # a process forked from it runs the same exit
        shutil.rmtree(folder, ignore_errors=True)
