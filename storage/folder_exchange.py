"""A folder takes the place of another in one step: a reader that opens it finds the old or the new one, never none."""

import ctypes
import os
import shutil
import sys
from collections.abc import Callable, Iterable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

from hearth.storage.files import TEMPORARY, sync_folder

_HERE = -100
"""The kernel's `AT_FDCWD`: paths start where the process is."""

_EXCHANGE = 2
"""The kernel's `RENAME_EXCHANGE`."""


def beside(folder: Path) -> Path:
    """Return where the next version of a folder is written."""
    return _real(folder).with_name(f".{folder.name}")


def away(folder: Path) -> Path:
    """Return where the version before stands for a moment, on systems that cannot exchange two folders in one step."""
    return _real(folder).with_name(f".{folder.name}.old")


def _real(folder: Path) -> Path:
    """Return the folder that a link leads to: the link stays."""
    return folder.resolve() if folder.is_symlink() else folder


def start_from(folder: Path, files: Iterable[Path]) -> None:
    """Make the folder for the next version, with these files of the present one in it; they share their bytes.

    Nothing may write into these files: a changed file must be written anew and renamed.
    """
    following = beside(folder)
    if following.exists():
        return
    following.mkdir(parents=True)
    for path in files:
        target = following / path.relative_to(folder)
        target.parent.mkdir(parents=True, exist_ok=True)
        try:
            target.hardlink_to(path)
        except OSError:
            temporary = target.with_name(f".{target.name}.{os.getpid()}{TEMPORARY}")
            shutil.copyfile(path, temporary)
            temporary.replace(target)


def put_in_place(folder: Path) -> None:
    """Give the next version its folder's name; the former folder goes."""
    following, before, folder = beside(folder), away(folder), _real(folder)
    if not folder.exists():
        following.rename(folder)
    elif not exchanged(following, folder):
        folder.rename(before)
        following.rename(folder)
    sync_folder(folder.parent)
    for other in (following, before):
        shutil.rmtree(other, ignore_errors=True)


def tidy(folder: Path) -> None:
    """Remove other versions of a folder that is complete."""
    for other in (beside(folder), away(folder)):
        shutil.rmtree(other, ignore_errors=True)


def recover(folder: Path) -> None:
    """Bring back the folder that was moved away for a moment, where that moment was the last of a build."""
    if not folder.exists():
        with suppress(FileNotFoundError):
            away(folder).rename(folder)


def present(folder: Path) -> Path:
    """Return where a folder is to be read.

    By its own name, or, for the moment of its replacement, where it was moved.
    """
    return folder if folder.exists() or not away(folder).exists() else away(folder)


def exchanged(one: Path, other: Path) -> bool:
    """Exchange the names of two folders in one step; False where the system cannot do so."""
    rename = _renameat2()
    return rename is not None and rename(_HERE, os.fsencode(one), _HERE, os.fsencode(other), _EXCHANGE) == 0


@cache
def _renameat2() -> Callable[..., Any] | None:
    if sys.platform != "linux":
        return None
    function: Any = getattr(ctypes.CDLL(None), "renameat2", None)
    if function is not None:
        function.argtypes = (ctypes.c_int, ctypes.c_char_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_uint)
    return function  # type: ignore[no-any-return]
