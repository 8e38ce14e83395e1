"""A video file, written by a thread of its own: the codec takes as long as a picture of a camera that stays."""

from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

from hearth.rendering.arrays import Image
from hearth.rendering.film.stderr_suppression import quiet
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import library

CODECS = {".webm": "VP80", ".mp4": "mp4v"}
"""OpenCV's codec by file suffix; browsers play VP80."""

WAITING = 4
"""The most pictures that wait for the codec."""


class Writer:
    """Writes a video file, which gets its name only when it is complete.

    Raises:
        HearthError: an odd width or height, of which codecs would cut a pixel; or the file can't be written.
    """

    def __init__(self, path: Path, width: int, height: int, fps: float) -> None:
        cv2 = library("cv2")

        if width % 2 or height % 2:
            even = f"{width // 2 * 2} by {height // 2 * 2}"
            raise HearthError.of(Code.NOT_RENDERED, f"a video can't have {width} by {height} pixels", suggestion=even)
        codec = CODECS.get(path.suffix)
        self.path, self.part = path, path.with_name(f".part{path.suffix}")
        self.thread, self.waiting = ThreadPoolExecutor(1, "film"), deque[Future[None]]()
        self.file: Any = None
        if codec:
            with quiet():
                self.file = cv2.VideoWriter(str(self.part), cv2.VideoWriter.fourcc(*codec), fps, (width, height))
        if self.file is None or not self.file.isOpened():
            known = ", ".join(f"*{suffix}" for suffix in CODECS)
            raise HearthError.of(Code.NOT_RENDERED, f"OpenCV can't write {path}", suggestion=f"a file {known}")

    def add(self, picture: Image) -> None:
        """Add a picture, (H, W, 3) in the order red, green, blue; it may be changed afterwards."""
        cv2 = library("cv2")
        self._wait(WAITING - 1)
        self.waiting.append(self.thread.submit(self.file.write, cv2.cvtColor(picture, cv2.COLOR_RGB2BGR)))

    def close(self) -> None:
        """Finish the file.

        Raises:
            HearthError: nothing was written, for example because the disk is full.
        """
        self._wait(0)
        self.thread.shutdown()
        self.file.release()
        if not self.part.exists() or not self.part.stat().st_size:
            raise HearthError.of(Code.NOT_RENDERED, f"nothing could be written to {self.path}", file=str(self.path))
        if self.path.suffix == ".webm":
            _renumber(self.part)
        self.part.replace(self.path)

    def _wait(self, most: int) -> None:
        """Until no more than `most` pictures wait."""
        while len(self.waiting) > most:
            self.waiting.popleft().result()


TRACK_IDS = (b"\x73\xc5\x88", b"\x63\xc5\x88")
"""First bytes of Matroska's eight-byte TrackUID and TagTrackUID."""

HEAD = 4096
"""Bytes at the start of a file that contain them."""


def _renumber(path: Path) -> None:
    """Replace the random track number of a webm by 1, so that equal films are equal bytes."""
    with path.open("r+b") as file:
        head = file.read(HEAD)
        for mark in TRACK_IDS:
            at = head.find(mark)
            if at >= 0:
                file.seek(at + len(mark))
                file.write((1).to_bytes(8, "big"))
