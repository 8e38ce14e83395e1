"""A film as a user has it: masks of a dataset of clips, or a video, at the rate and size of clips."""

from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.models.films.film_arrays import LARGEST, film_array
from hearth.rendering.film.clips import RATE, SIZE
from hearth.rendering.film.stderr_suppression import quiet
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import library
from hearth.storage.input_files import read_input, read_start

HEADS = {".webm": (0, b"\x1a\x45\xdf\xa3"), ".mp4": (4, b"ftyp")}
"""The first bytes of a video by file ending, with their position.

Other files are not given to FFmpeg. FFmpeg follows the contents of a file, and a list of other films would make it read
those films.
"""

LONGEST = 20 * 60
"""Seconds of a video at most."""

MOST_RATE = 240
"""Pictures a second of a video at most."""

MOST_PIXELS = 4096 * 2304
"""Largest number of pixels of a video's picture."""


def read_masks(path: Path) -> NDArray[np.uint16]:
    """Return (T, H, W) class numbers of a film of a dataset of clips (`clips.npz`).

    Raises:
        HearthError: MISSING_FILE; DAMAGED_FILE, if the file holds something else.
    """
    return film_array(BytesIO(read_input(path, LARGEST)), str(path))


def read_pictures(path: Path) -> NDArray[np.uint8]:
    """Return (T, H, W, 3) colours of a video, scaled to the size of clips, `RATE` a second.

    Raises:
        HearthError: MISSING_FILE, without OpenCV; DAMAGED_FILE, if it is another file; BAD_ARGUMENT, if it is
            too long; FILE_TOO_LARGE, if its pictures are.
    """
    cv2 = library("cv2")
    at, head = HEADS.get(path.suffix, (0, b"a video"))
    if read_start(path, at + len(head))[at:] != head:
        raise _unread(path)
    with quiet():
        video = cv2.VideoCapture(str(path), cv2.CAP_FFMPEG)
        try:
            found = [cv2.resize(each, SIZE, interpolation=cv2.INTER_AREA) for each in _retrieved(video, path)]
        except cv2.error as error:
            raise _unread(path) from error
        finally:
            video.release()
    if not found:
        raise _unread(path)
    return np.stack([each[..., ::-1] for each in found])


def _retrieved(video: Any, path: Path) -> Iterator[Any]:
    """`RATE` pictures a second."""
    import cv2

    rate, pixels = (
        video.get(cv2.CAP_PROP_FPS),
        video.get(cv2.CAP_PROP_FRAME_WIDTH) * video.get(cv2.CAP_PROP_FRAME_HEIGHT),
    )
    if pixels > MOST_PIXELS or rate > MOST_RATE:
        message = f"pictures of {pixels:,.0f} pixels, {rate:,.0f} a second"
        remedy = f"at most {MOST_PIXELS:,} pixels, {MOST_RATE} a second"
        raise HearthError.of(Code.FILE_TOO_LARGE, message, file=str(path), suggestion=remedy)
    number = taken = 0
    while rate > 0 and video.grab():
        done, picture = video.retrieve() if number >= rate * taken / RATE else (True, None)
        if not done:
            return
        while number >= rate * taken / RATE:  # of a slow film the same picture again
            yield picture
            taken += 1
        number += 1
        if number > rate * LONGEST:
            message = f"a film of more than {LONGEST // 60} minutes"
            raise HearthError.of(Code.BAD_ARGUMENT, message, file=str(path), suggestion="cut it into parts")


def _unread(path: Path) -> HearthError:
    message = "no pictures can be read from it"
    return HearthError.of(Code.DAMAGED_FILE, message, file=str(path), suggestion="a *.webm or *.mp4 that plays")
