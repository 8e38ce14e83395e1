"""Names that come with data, as names of files: the only place where one becomes a path."""

import hashlib
import os
from collections.abc import Container
from itertools import chain, count
from pathlib import Path, PurePosixPath

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

LONGEST = 200
"""Characters of a file's name; most systems allow 255 bytes, and endings are added."""


def leaves(name: str) -> bool:
    """Return whether a name, as an archive or a store lists it, points outside the folder that it is given for."""
    path = PurePosixPath(name.replace("\\", "/"))
    return path.is_absolute() or ".." in path.parts or (len(name) > 1 and name[1] == ":")


def numbered(name: str, taken: Container[str]) -> str:
    """Return a name, with the least number from 2 on with which it is not taken, if it is: `a~2`."""
    names = chain([name], (f"{name}~{number}" for number in count(2)))
    return next(each for each in names if each not in taken)


def inside(folder: Path, name: str) -> Path:
    """Return the path of a name within a folder; the name may have folders of its own.

    Raises:
        HearthError: DAMAGED_FILE: the name is empty or leaves the folder, by itself or by a link on the way.
    """
    path = folder / name
    if not name.strip("/.") or leaves(name) or "\0" in name or not _fits(path) or not _stays(path, folder):
        message = f"`{name[:LONGEST]!a}` is not the name of a file in this folder"
        raise HearthError.of(Code.DAMAGED_FILE, message, file=str(folder), suggestion="fetch or write the data again")
    return path


def _fits(path: Path) -> bool:
    """Return whether systems have such names: not too long, and without half a character as JSON may have it."""
    try:
        return all(len(os.fsencode(part)) <= 255 for part in path.parts)
    except UnicodeEncodeError:
        return False


def _stays(path: Path, folder: Path) -> bool:
    try:
        return path.resolve().is_relative_to(folder.resolve())
    except (OSError, ValueError, RuntimeError):
        return False


def file_name(text: str) -> str:
    """Return an id as the name of a file on every system, still readable: other characters become `%` and their code.

    It is one name of one folder, whatever the id: never empty, `.`, `..` or longer than systems allow.
    """
    name = "".join(char if char.isascii() and (char.isalnum() or char in "-_.+@") else f"%{ord(char):02x}"
                   for char in text)  # fmt: skip
    if not name.strip("."):
        name = "%2e" * len(name) or "%"
    if len(name) > LONGEST:
        name = f"{name[: LONGEST - 17]}~{hashlib.sha256(text.encode('utf-8', 'surrogatepass')).hexdigest()[:16]}"
    return name
