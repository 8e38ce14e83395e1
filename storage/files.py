"""Files that are either whole or absent: temporary names, fsync, rename; and their hashes."""

import hashlib
import os
import stat
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Any

import orjson

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.terminal import shown_line
from hearth.storage.input_files import read_input

LARGEST_JSON = 256 << 20
"""Bytes of a manifest; it has a line for each of a dataset's files."""

TEMPORARY = ".tmp"


def is_temporary(name: str) -> bool:
    """Return whether a file's name is that of a half-written file, or of a file that a library keeps next to one."""
    return TEMPORARY in Path(name).suffixes


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a temporary name next to `path`; on success it is fsynced and takes the place of `path`.

    Files that a user names are written by `storage.chosen_files`.

    Raises:
        HearthError: UNWRITABLE: a pipe, a device or a socket has this name.
    """
    need_replaceable(path)
    temporary = path.with_name(f".{path.name}.{os.getpid()}{TEMPORARY}")
    try:
        yield temporary
        commit(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def need_replaceable(path: Path) -> None:
    """Refuse a name that a pipe, a device or a socket has; errors as of `replacing`."""
    try:
        mode = path.lstat().st_mode
    except (OSError, ValueError):
        return
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode) or stat.S_ISLNK(mode)):
        message = "a pipe, a device or a socket has the name of this file"
        raise HearthError.of(Code.UNWRITABLE, message, file=str(path), suggestion="move it away")


def commit(temporary: Path, path: Path) -> None:
    """Fsync a written file and rename it into place."""
    with temporary.open("rb+") as file:
        os.fsync(file.fileno())
    temporary.replace(path)
    sync_folder(path.parent)


def sync_folder(folder: Path) -> None:
    """Make renames in a folder last through a power cut."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def drop_temporary(files: Iterable[Path]) -> None:
    """Remove those of some files that a stopped process had written in part."""
    for leftover in [path for path in files if is_temporary(path.name)]:
        leftover.unlink(missing_ok=True)


def write_bytes(path: Path, data: bytes) -> None:
    """Write a whole file, or none."""
    with replacing(path) as temporary:
        temporary.write_bytes(data)


def write_json(path: Path, value: Any) -> None:
    """Write JSON that people can read, keys in the order given."""
    write_bytes(path, shown_line(orjson.dumps(value, option=orjson.OPT_INDENT_2 | orjson.OPT_APPEND_NEWLINE)))


def read_json(path: Path) -> Any | None:
    """Return the JSON of a file; None when it is absent, not a regular file, too large or not JSON."""
    try:
        return orjson.loads(read_input(path, LARGEST_JSON))
    except (HearthError, orjson.JSONDecodeError):
        return None


def file_digest(path: Path) -> str:
    """SHA-256 of a file's bytes, as hexadecimal; read once a process while the file stays as it is."""
    stat = path.stat()
    return _file_digest(path, stat.st_size, stat.st_mtime_ns)


@lru_cache(maxsize=100_000)
def _file_digest(path: Path, size: int, changed: int) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def tree_digest(path: Path) -> str:
    """SHA-256 over a file, or over the names and bytes of all files of a folder, hidden ones left out.

    Raises:
        HearthError: MISSING_FILE.
    """
    if path.is_file():
        return file_digest(path)
    if not path.is_dir():
        raise HearthError.of(Code.MISSING_FILE, "no such file or folder", file=str(path))
    return files_digest(walk(path), path)


def files_digest(files: Iterable[Path], folder: Path) -> str:
    """SHA-256 over the names and bytes of files of a folder, in the order given."""
    digest = hashlib.sha256()
    for file in files:
        name = file.relative_to(folder).as_posix()
        digest.update(f"{name}\0{file_digest(file)}\n".encode("utf-8", "surrogateescape"))
    return digest.hexdigest()


SERVED = ".server"
"""Folder of `serve`'s store, in the folder of the files that it collects."""


def walk(folder: Path) -> Iterator[Path]:
    """Yield the files under a folder in the order of their names, hidden ones and links that leave it left out."""
    return (path for path in _visible(folder) if path.is_file() and not _not_followed(path, folder))


def links_not_followed(folder: Path) -> Iterator[Path]:
    """Yield the links under a folder that `walk` leaves out: those to folders, and those that leave it."""
    return (path for path in _visible(folder) if _not_followed(path, folder))


def _visible(folder: Path) -> Iterator[Path]:
    for path in sorted(folder.rglob("*"), key=lambda p: p.relative_to(folder).as_posix()):
        if not any(part.startswith(".") for part in path.relative_to(folder).parts):
            yield path


def _not_followed(path: Path, folder: Path) -> bool:
    # Links to folders are not entered, so that only a file that is one itself can lead outside.
    return path.is_symlink() and (path.is_dir() or not path.resolve().is_relative_to(folder.resolve()))


def value_digest(value: Any) -> str:
    """SHA-256 of a JSON value, keys sorted.

    Raises:
        HearthError: BAD_JSON: parts stand deeper in one another than JSON is written; it is read four times as deep.
    """
    try:
        return hashlib.sha256(orjson.dumps(value, option=orjson.OPT_SORT_KEYS)).hexdigest()
    except orjson.JSONEncodeError as error:
        if "Recursion" not in str(error):
            raise
        raise HearthError.of(Code.BAD_JSON, "its values stand too deep in one another") from error
