"""Packed sources read in place: members of a zip, gzip and zstd files; refused where they unpack to too many bytes."""

import gzip
import io
import stat
import zipfile
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path, PurePosixPath
from typing import IO, Any, BinaryIO, cast

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.names import leaves
from hearth.storage.rejects import Reject

GZIP = b"\x1f\x8b"
ZSTD = b"\x28\xb5\x2f\xfd"

LARGEST_MEMBER = 4_000_000_000
"""Bytes that a packed file may unpack to while it is read as a stream."""

MOST_PACKED = 50
"""Largest ratio of a packed file's contents to its size, once the contents exceed `_HARMLESS` bytes."""

MOST_MEMBERS = 20_000
"""Files of an archive that are looked at one by one; a release may have more, for its names say what each of them is.

Looking at one takes half a millisecond: an archive is read, or refused, within ten seconds.
"""

LARGEST_DIRECTORY = 24_000_000
"""Bytes of an archive's own list of its files, which is read before any of them: 150,000 files with usual names."""

_HARMLESS = 8_000_000

_READ = 1 << 15
"""Bytes unpacked at a time: where a file breaks off, no more than these are lost."""


@dataclass(frozen=True, slots=True)
class Member:
    """A file inside a zip, read where it is."""

    archive: Path
    name: str

    @property
    def suffix(self) -> str:
        """Return the suffix of its name, as that of a path."""
        return PurePosixPath(self.name).suffix

    def info(self) -> zipfile.ZipInfo:
        """Return its entry in the archive's directory."""
        return archive(self.archive).getinfo(self.name)


Place = Path | Member
"""The place of a file."""


class DamagedError(HearthError):
    """A packed file that can't be read to its end."""


@lru_cache(maxsize=4)
def _archive(path: str, changed: int) -> zipfile.ZipFile:
    file = Path(path).open("rb")  # noqa: SIM115 - open as long as the process
    try:
        return opened_zip(file, path)
    except HearthError:
        file.close()
        raise
    except (zipfile.BadZipFile, EOFError, NotImplementedError, OSError, ValueError) as error:
        file.close()
        message = f"a damaged or truncated archive: {error}"
        raise HearthError.of(Code.BAD_ARCHIVE, message, file=path, suggestion="download it again") from error


def opened_zip(file: IO[bytes], name: str) -> zipfile.ZipFile:
    """Return the zip in an open file, which stays open: every zip of others is opened here.

    Raises:
        HearthError: FILE_TOO_LARGE: the list of its files is beyond `LARGEST_DIRECTORY`; BAD_ARCHIVE: several files
            have one name.
        zipfile.BadZipFile: it is not a zip, or damaged; other errors of `zipfile`.
    """
    try:
        found = zipfile.ZipFile(cast("IO[bytes]", _Listing(file)))
    except _TooLongError as error:
        message = f"an archive of too many files: the list of them has {error.args[0]:,} bytes"
        place, remedy = name, f"{UNPACK}; at most {LARGEST_DIRECTORY:,} bytes of a list are read"
        raise HearthError.of(Code.FILE_TOO_LARGE, message, file=place, suggestion=remedy) from error
    found.fp = file
    _need_names_of_their_own(found, name)
    return found


def _need_names_of_their_own(found: zipfile.ZipFile, place: str) -> None:
    """Refuse an archive in which a file could be read instead of another."""
    if len(found.NameToInfo) == len(found.filelist):
        return
    twice, times = Counter(info.filename for info in members(found)).most_common(1)[0] if members(found) else ("", 1)
    if times > 1:
        message = f"{times} files in it have the name `{twice[:100]}`: by it only one of them can be read"
        raise HearthError.of(Code.BAD_ARCHIVE, message, file=place, suggestion="pack it anew")


UNPACK = "unpack it, and name the folder as a source"


class _TooLongError(Exception):
    """The list of an archive's files is too long to be read; its size is the argument."""


class _Listing:
    """A file of which `zipfile` reads the list of the archive's files, which it asks for in one piece."""

    def __init__(self, file: IO[bytes]) -> None:
        self._file = file

    def read(self, size: int = -1) -> bytes:
        """Return bytes of the file.

        Raises:
            _TooLongError: they are more than a list may have.
        """
        if size > LARGEST_DIRECTORY:
            raise _TooLongError(size)
        return self._file.read(size)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._file, name)


def archive(path: Path) -> zipfile.ZipFile:
    """Return the archive at a path, open once a process.

    Raises:
        HearthError: BAD_ARCHIVE; FILE_TOO_LARGE, as of `opened_zip`.
    """
    return _archive(str(path), path.stat().st_mtime_ns)


def members(found: zipfile.ZipFile) -> list[zipfile.ZipInfo]:
    """Return the files of an archive, without folders; `is_dir` itself breaks at a name that is empty."""
    return [info for info in found.infolist() if not info.filename.endswith("/")]


def refusal_of(info: zipfile.ZipInfo, place: str) -> Reject | None:
    """Return why a member is not read, by its entry in the directory."""
    if leaves(info.filename):
        message = f"`{info.filename[:100]}` leaves the archive"
        return Reject.of(Code.BAD_ARCHIVE, message, file=place, found=info.filename[:200], suggestion="pack it anew")
    if not info.filename:
        return Reject.of(Code.BAD_ARCHIVE, "a file without a name", file=place, suggestion="pack it anew")
    if stat.S_ISLNK(info.external_attr >> 16):
        message = "a link, which could point anywhere: never followed"
        return Reject.of(Code.BAD_ARCHIVE, message, file=place, found=info.filename[:200], suggestion="pack the file")
    if info.flag_bits & 1:
        return Reject.of(Code.BAD_ARCHIVE, "it is encrypted", file=place, suggestion="pack it without a password")
    if bomb(info.file_size, info.compress_size):
        return Reject.of(Code.FILE_TOO_LARGE, _reported(info.file_size, info.compress_size), file=place)
    return None


def bomb(size: int, packed: int) -> bool:
    """Return whether the ratio of unpacked to packed bytes is beyond that of any text."""
    return size > LARGEST_MEMBER or (size > _HARMLESS and size > packed * MOST_PACKED)


def _reported(size: int, packed: int) -> str:
    return f"a zip bomb: {packed:,} bytes that unpack to {size:,}"


def size_of(place: Place) -> int:
    """Bytes as they are read, of packed members unpacked; of gzip and zstd files, packed."""
    return place.info().file_size if isinstance(place, Member) else place.stat().st_size


def raw(place: Place) -> BinaryIO:
    """Return a file's bytes, unpacked."""
    if isinstance(place, Member):
        member = _opened(place)
        guarded: io.RawIOBase = _Guarded(member, place.name, place.info().compress_size)
        return io.BufferedReader(guarded)
    file = place.open("rb")
    start = file.read(4)
    file.seek(0)
    if start.startswith(GZIP):
        return _buffered(_Guarded(cast("IO[bytes]", gzip.open(file)), str(place), place.stat().st_size, file))
    if start.startswith(ZSTD):
        file.close()
        import pyarrow as pa

        stream = pa.CompressedInputStream(pa.OSFile(str(place)), "zstd")
        return _buffered(_Guarded(stream, str(place), place.stat().st_size))
    return file


def unpacked(data: bytes, name: str) -> BinaryIO:
    """Return the stream of a gzip file's bytes.

    Args:
        data: the packed bytes.
        name: of the file, for messages.
    """
    return _buffered(_Guarded(cast("IO[bytes]", gzip.open(io.BytesIO(data))), name, len(data)))


def _opened(member: Member) -> IO[bytes]:
    try:
        return archive(member.archive).open(member.name)
    except Exception as error:  # a directory that lies: BadZipFile, KeyError, NotImplementedError, RuntimeError, ...
        raise _damaged(member.name, f"can't be unpacked: {error}") from error


def _damaged(name: str, message: str) -> DamagedError:
    return DamagedError(Reject.of(Code.BAD_ARCHIVE, message, file=name, suggestion="download it again").diagnostics)


def _buffered(stream: io.RawIOBase) -> BinaryIO:
    return io.BufferedReader(stream)


class _Guarded(io.RawIOBase):
    """A stream that is unpacked, which ends in `DamagedError` where it is damaged or too large."""

    def __init__(self, stream: IO[bytes], name: str, packed: int, behind: IO[bytes] | None = None) -> None:
        self._stream, self._name, self._packed, self._behind = stream, name, packed, behind
        self._size = 0

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: bytearray) -> int:  # type: ignore[override]
        try:
            data = self._stream.read(min(len(buffer), _READ))
        except Exception as error:  # archives raise the errors of their compression: zlib, lzma, EOFError, ArrowIOError
            raise _damaged(self._name, f"can't be unpacked: {error}") from error
        self._size += len(data)
        if bomb(self._size, self._packed):
            fault = Reject.of(Code.FILE_TOO_LARGE, _reported(self._size, self._packed), file=self._name)
            raise DamagedError(fault.diagnostics)
        buffer[: len(data)] = data
        return len(data)

    def close(self) -> None:
        if not self.closed:
            with suppress(Exception):
                self._stream.close()
            if self._behind:
                self._behind.close()
        super().close()
