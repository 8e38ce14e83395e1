"""Files that a user names for a command's output: whole or absent, through a link, into a pipe or a device."""

import os
import re
import shutil
import stat
import sys
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.terminal import shown_line
from hearth.storage.files import replacing

_STREAMS = {"/dev/stdout": 1, "/dev/stderr": 2}
_OPENED = re.compile(r"/(?:dev|proc/self)/fd/(\d{1,9})")
_REMEDY = "name a file, a pipe that is read or a device such as /dev/stdout"


@contextmanager
def writing(path: Path) -> Iterator[Path]:
    """Yield a temporary name; on success what was written there is the content of the file that the user named.

    A link stays a link: the file that it leads to is written. A file of before keeps who may read it. Into a pipe and a
    device such as `/dev/stdout` the whole content is written at the end, and they stay what they are.

    Raises:
        HearthError: UNWRITABLE: a disk, a socket, a pipe that nobody reads, or a link without an end.
    """
    if _is_stream(path):
        with tempfile.TemporaryDirectory() as folder:
            temporary = Path(folder) / "output"
            yield temporary
            _pour(temporary, path)
        return
    place = followed(path) if path.is_symlink() else path
    with replacing(place) as temporary:
        yield temporary
        if place.is_file():
            temporary.chmod(place.stat().st_mode & 0o7777)


def write(path: Path, data: bytes) -> None:
    """Write a whole file of the user's, or none; errors as of `writing`."""
    with writing(path) as temporary:
        temporary.write_bytes(data)


def write_rows(path: Path, rows: Iterable[Mapping[str, Any]]) -> None:
    """Write rows as JSON lines, in a folder that need not exist; errors as of `writing`."""
    import orjson

    path.parent.mkdir(parents=True, exist_ok=True)
    write(path, b"".join(shown_line(orjson.dumps(row, option=orjson.OPT_APPEND_NEWLINE)) for row in rows))


def _is_stream(path: Path) -> bool:
    """Return whether this is the name of a pipe, a device or a socket."""
    if _descriptor(path) is not None:
        return True
    try:
        mode = path.stat().st_mode
    except (OSError, ValueError):
        return False
    return not stat.S_ISREG(mode) and not stat.S_ISDIR(mode)


def _descriptor(path: Path) -> int | None:
    """Return the number of a descriptor that this process has, where the path is its name."""
    found = _OPENED.fullmatch(str(path))
    return _STREAMS.get(str(path), None if found is None else int(found[1]))


def followed(path: Path) -> Path:
    """Return the place that a name leads to, over all links.

    Raises:
        HearthError: UNWRITABLE: a link leads to itself.
    """
    try:
        place = path.resolve()
    except (OSError, RuntimeError):
        place = path
    if place.is_symlink():
        raise _refused(path, "it is a link that leads to itself")
    return place


def _pour(temporary: Path, path: Path) -> None:
    """Write the bytes of a file into a pipe or a device."""
    try:
        with temporary.open("rb") as whole, os.fdopen(_opened(path), "wb") as to:
            shutil.copyfileobj(whole, to)
    except BrokenPipeError:
        raise _refused(path, "nobody reads it to its end") from None
    except OSError as error:
        raise _refused(path, (error.strerror or str(error)).lower()) from None


def _opened(path: Path) -> int:
    number = _descriptor(path)
    if number is not None:
        sys.stdout.flush()
        sys.stderr.flush()
        return os.dup(number)
    mode = path.stat().st_mode
    if not stat.S_ISFIFO(mode) and not stat.S_ISCHR(mode):
        raise _refused(path, f"it is {'a disk' if stat.S_ISBLK(mode) else 'a socket'}")
    try:
        # The call does not wait for the reader of a pipe.
        descriptor = os.open(path, os.O_WRONLY | os.O_NONBLOCK | os.O_NOCTTY)
    except OSError as error:
        why = "nobody reads this pipe" if stat.S_ISFIFO(mode) else (error.strerror or str(error)).lower()
        raise _refused(path, why) from None
    os.set_blocking(descriptor, True)
    return descriptor


def _refused(path: Path, why: str) -> HearthError:
    return HearthError.of(Code.UNWRITABLE, f"nothing can be written there: {why}", file=str(path), suggestion=_REMEDY)
