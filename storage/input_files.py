"""Bytes of a file that a user names: a regular file, no larger than its kind is."""

import os
import stat
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count
from pathlib import Path
from typing import Any, BinaryIO

from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.text_decoding import decode

LARGEST = 64 << 20
"""Bytes of a program, plan, graph or list of ratings; a home of a thousand things has two million."""

LARGEST_TABLE = 1 << 30
"""Bytes of a file with a row for each of many programs."""


_INHERITED = ("/dev/stdin", "/dev/fd/")
"""Places of the files that a shell opens for a command, as in `check <(make_programs)`."""


def read_input(path: Path, largest: int = LARGEST) -> bytes:
    """Return the bytes of a file; `-` is standard input.

    Devices, sockets and named pipes are refused: they may never end, or never begin.

    Raises:
        HearthError: MISSING_FILE, UNSUPPORTED_FILE or FILE_TOO_LARGE.
    """
    if str(path) == "-":
        return _limited(sys.stdin.buffer.read(largest + 1), "standard input", largest)
    with _opened(path) as file:
        return _limited(file.read(largest + 1), str(path), largest)


def read_start(path: Path, count: int) -> bytes:
    """Return the first bytes of a file, or all that it has.

    Raises:
        HearthError: MISSING_FILE or UNSUPPORTED_FILE, as of `read_input`.
    """
    with _opened(path) as file:
        return file.read(count)


def read_lines(path: Path, longest: int = LARGEST) -> Iterator[bytes]:
    """Yield the lines of a file with their ends, with one line in memory at a time.

    Args:
        path: as of `read_input`.
        longest: bytes of a line, at most.

    Raises:
        HearthError: as of `read_input`; FILE_TOO_LARGE with the line that is too long.
    """
    if str(path) == "-":
        yield from _lines(sys.stdin.buffer, "standard input", longest)
        return
    with _opened(path) as file:
        yield from _lines(file, str(path), longest)


def _lines(file: BinaryIO, name: str, longest: int) -> Iterator[bytes]:
    for number in count(1):
        line = file.readline(longest + 1)
        if len(line) > longest:
            raise HearthError(Diagnostic(Code.FILE_TOO_LARGE, f"a line of more than {longest:,} bytes", name, number))
        if not line:
            return
        yield line


@contextmanager
def _opened(path: Path) -> Iterator[BinaryIO]:
    inherited = str(path).startswith(_INHERITED)
    try:
        # The call does not wait for the writer of a pipe; of regular files the flag changes nothing.
        descriptor = os.open(path, os.O_RDONLY | (0 if inherited else os.O_NONBLOCK))
    except (OSError, ValueError) as error:
        missing = isinstance(error, FileNotFoundError | NotADirectoryError | PermissionError)
        reason = (getattr(error, "strerror", None) or "can't be read").lower()
        raise HearthError.of(Code.MISSING_FILE if missing else Code.UNSUPPORTED_FILE, reason, file=str(path)) from None
    try:
        mode = os.fstat(descriptor).st_mode
        if not stat.S_ISREG(mode) and not (inherited and stat.S_ISFIFO(mode)):
            what = "is a directory" if stat.S_ISDIR(mode) else "is not a regular file"
            raise HearthError.of(Code.UNSUPPORTED_FILE, what, file=str(path), suggestion="name a file")
        with os.fdopen(descriptor, "rb", closefd=False) as file:
            yield file
    except OSError as error:  # of the disk, or of a file that the system makes up, such as a process's memory
        reason = f"it can't be read: {(error.strerror or str(error)).lower()}"
        raise HearthError.of(Code.UNSUPPORTED_FILE, reason, file=str(path)) from error
    finally:
        os.close(descriptor)


@contextmanager
def placed(path: Path) -> Iterator[Path]:
    """Yield the path of a file or folder itself; else a temporary copy of standard input or of a shell's pipe.

    Raises:
        HearthError: as of `read_input`.
    """
    if path.is_file() or path.is_dir():
        yield path
        return
    data = read_input(path)
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "input"
        copy.write_bytes(data)
        yield copy


def _limited(data: bytes, name: str, largest: int) -> bytes:
    if len(data) > largest:
        raise HearthError.of(Code.FILE_TOO_LARGE, f"more than {largest:,} bytes", file=name)
    return data


def load_yaml(path: Path) -> Any:
    """Return the plain value of a YAML file.

    Raises:
        HearthError: the file cannot be read, is not text or YAML, or holds too much.
    """
    import yaml

    from hearth.schemas.yaml_limits import LARGEST as LARGEST_YAML
    from hearth.schemas.yaml_limits import LIMITS, LOADER, too_much

    text = decode(read_input(path, LARGEST_YAML), str(path))
    if isinstance(text, Diagnostic):
        raise HearthError(text)
    why = too_much(text)
    if why:
        raise HearthError.of(Code.FILE_TOO_LARGE, why, file=str(path), suggestion=LIMITS)
    try:
        return yaml.load(text, LOADER)
    except (yaml.YAMLError, ValueError) as error:  # ValueError: a date of month 13
        raise HearthError.of(Code.BAD_TABLE, f"not YAML: {error}", file=str(path)) from error
