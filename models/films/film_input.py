"""A film as a user has it: masks of a dataset of clips, or a video, at the rate and size of clips."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.models.films.clip_data import LARGEST, film_array
from hearth.rendering.film.clips import FILE, RATE, SIZE
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.libraries import library
from hearth.storage.input_files import read_input

VIDEOS = (".webm", ".mp4")
"""Suffixes of videos."""

ARRAYS = ".npz"
"""The suffix of a film of a dataset of clips."""

LONGEST = 20 * 60
"""Seconds of a video at most."""


def is_film(text: str) -> bool:
    """Whether an argument names a film: by its suffix, or a folder with one; a text may be the name of any folder."""
    try:
        folder = bool(text) and Path(text).is_dir()
    except (OSError, ValueError):  # a long text, or one with a null, names nothing
        folder = False
    return Path(text).suffix in (ARRAYS, *VIDEOS) or (folder and bool(_films(Path(text))))


def _films(path: Path) -> list[Path]:
    """The films of a folder: its arrays, then its videos; a file itself."""
    videos = sorted(each for suffix in VIDEOS for each in path.glob(f"*{suffix}")) if path.is_dir() else [path]
    return [each for each in (path / FILE, *videos) if each.is_file()]


def film_file(path: Path) -> Path:
    """The film of a folder: its arrays, else its first video; of a file itself.

    Raises:
        HearthError: MISSING_FILE, if there is none.
    """
    found = _films(path)
    if not found:
        message = f"no film at `{path}`"
        wanted = f"a file *{', *'.join((ARRAYS, *VIDEOS))}, or a folder with one"
        raise HearthError.of(Code.MISSING_FILE, message, file=str(path), suggestion=wanted)
    return found[0]


def read_masks(path: Path) -> NDArray[np.uint16]:
    """(T, H, W) class numbers of a film of a dataset of clips (`clips.npz`).

    Raises:
        HearthError: MISSING_FILE; DAMAGED_FILE, if the file holds something else.
    """
    return film_array(BytesIO(read_input(path, LARGEST)), str(path))


def read_pictures(path: Path) -> NDArray[np.uint8]:
    """(T, H, W, 3) colours of a video, scaled to the size of clips, `RATE` a second.

    Raises:
        HearthError: MISSING_FILE, without OpenCV; DAMAGED_FILE, if it is another file; BAD_ARGUMENT, if it is
            too long.
    """
    cv2 = library("cv2")
    video = cv2.VideoCapture(str(path))
    rate = video.get(cv2.CAP_PROP_FPS)
    found: list[Any] = []
    number = 0
    while rate > 0 and video.grab():
        if number >= rate * len(found) / RATE:
            picture = video.retrieve()[1]
            found.append(cv2.resize(picture, SIZE, interpolation=cv2.INTER_AREA)[..., ::-1])
        number += 1
        if number > rate * LONGEST:
            message = f"a film of more than {LONGEST // 60} minutes"
            raise HearthError.of(Code.BAD_ARGUMENT, message, file=str(path), suggestion="cut it into parts")
    video.release()
    if not found:
        message = "no pictures can be read from it"
        raise HearthError.of(Code.DAMAGED_FILE, message, file=str(path), suggestion="a *.webm or *.mp4 that plays")
    return np.stack(found)
