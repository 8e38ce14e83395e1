"""An array of a film's file, which may be a stranger's: its header is read first, and nothing larger is allocated."""

from collections.abc import Mapping
from math import prod
from typing import IO, Any, NamedTuple
from zipfile import ZIP_DEFLATED, ZIP_STORED, ZipFile

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.archives import opened_zip

MASKS, COLOURS, CHANGES = "class_ids", "rgb", "rgb_changes"
"""Names of a film's arrays: class masks, which every film has, and colours; those of demonstrations are changes from
picture to picture."""

FORMS: Mapping[str, tuple[int, type[np.generic]]] = {
    MASKS: (3, np.uint16),
    COLOURS: (4, np.uint8),
    CHANGES: (4, np.uint8),
}
"""Dimensions and kind of numbers of a film's arrays."""

LARGEST = 32 << 20
"""Bytes of a film's file; the largest of `make clips`, with colours and depth, has eight million."""

MOST_BYTES = 1 << 29
"""Bytes of an array of a film in memory."""

MOST_PIXELS = 1 << 20
"""Largest number of pixels of a picture."""

MOST_PICTURES = 6_000
"""Largest number of pictures of a film: twenty minutes have 5,400."""

HEADER = 512
"""Characters of an array's header; the longest of `FORMS` has 128."""


class _Header(NamedTuple):
    """The contents of an array's header, and the bytes that follow it."""

    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    left: int


def film_array(data: IO[bytes], file: str, array: str = MASKS, most: int = MOST_PICTURES) -> NDArray[Any]:
    """Return an array of a film, as `rendering.film.clips` stores them, in the form of `FORMS`.

    Args:
        data: the file's.
        file: its name in errors.
        array: of `FORMS`.
        most: pictures, at most.

    Raises:
        HearthError: DAMAGED_FILE, if it is something else; FILE_TOO_LARGE, if it has too many or too large pictures.
    """
    dimensions, kind = FORMS[array]
    try:
        with opened_zip(data, file) as archive:
            header = _header(archive, f"{array}.npy")
            if len(header.shape) != dimensions or header.dtype != kind or not prod(header.shape):
                raise ValueError(f"its {array} have the form {header.shape} of {header.dtype}")
            _check_size(header, file, array, most)
            with archive.open(f"{array}.npy") as member:
                found: NDArray[Any] = npy.read_array(member, allow_pickle=False, max_header_size=HEADER)
    except HearthError:
        raise
    except Exception as error:  # zipfile, zlib and NumPy raise a dozen kinds for files that are not theirs
        raise damaged(file, str(error)[:100]) from error
    return found


def _header(archive: ZipFile, name: str) -> _Header:
    """Return the contents of an array's header.

    Raises:
        ValueError: it is packed or written in a way in which NumPy does not store arrays.
    """
    info = archive.getinfo(name)
    if info.flag_bits & 1 or info.compress_type not in (ZIP_STORED, ZIP_DEFLATED):
        raise ValueError(f"{name} is packed in an unknown way")
    with archive.open(info) as member:
        if npy.read_magic(member) != (1, 0):
            raise ValueError(f"{name} is of an unknown version")
        shape, _, dtype = npy.read_array_header_1_0(member, max_header_size=HEADER)
        return _Header(shape, dtype, info.file_size - member.tell())


def _check_size(header: _Header, file: str, array: str, most: int) -> None:
    size, pixels = prod(header.shape) * header.dtype.itemsize, header.shape[1] * header.shape[2]
    if header.shape[0] > most or pixels > MOST_PIXELS or size > MOST_BYTES:
        message = f"its {array} have the form {header.shape}"
        remedy = f"at most {most:,} pictures of {MOST_PIXELS:,} pixels, and {MOST_BYTES:,} bytes in all"
        raise HearthError.of(Code.FILE_TOO_LARGE, message, file=file, suggestion=remedy)
    if size != header.left:
        raise ValueError(f"its {array} have the form {header.shape}, but {header.left:,} bytes")


def damaged(file: str, message: str) -> HearthError:
    """Return the error for a damaged film file."""
    return HearthError.of(Code.DAMAGED_FILE, message, file=file, suggestion="fetch the dataset again")
