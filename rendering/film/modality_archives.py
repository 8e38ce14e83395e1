"""The modalities of a film besides its colours: archives of lossless PNG pictures, or lines of JSON; with an index.

`VIEW.depth.zip` has `000000.png`, `000001.png`, ...: one picture a frame, encoded as `png.encode` says. Values that are
no pictures are lines of `VIEW.boxes.jsonl`. `VIEW.index.json` names the files, and has the times of the steps and the
time, tick and camera of each frame.
"""

import zipfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import orjson
from numpy.typing import NDArray

from hearth.rendering.film.png import decode, encode
from hearth.rendering.modalities import PICTURES
from hearth.rendering.rays.threads import each
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.names import inside

EPOCH = (1980, 1, 1, 0, 0, 0)
"""The date of all entries: equal films are equal bytes."""


class FrameTime(NamedTuple):
    """The time and the content of a frame."""

    time: float
    tick: int
    camera: Mapping[str, Any]


class FrameFiles:
    """Writes the modalities of a film, frame by frame.

    Args:
        out: an existing folder.
        view: name of the camera, with which the files' names begin.
        modalities: all of the film's; `rgb` is the video itself.
    """

    def __init__(self, out: Path, view: str, modalities: Sequence[str]) -> None:
        self.names = tuple(name for name in dict.fromkeys(modalities) if name != "rgb")
        self.paths = {name: inside(out, f"{view}.{name}.{_suffix(name)}") for name in self.names}
        self.index = inside(out, f"{view}.index.json")
        self.frames: list[FrameTime] = []
        self._files: dict[str, Any] = {name: _opened(path) for name, path in self.paths.items()}

    def add(self, at: FrameTime, pictures: Mapping[str, Any]) -> None:
        """Add a frame's pictures, which are encoded in parallel."""
        drawn = [name for name in self.names if name in PICTURES]
        for name, data in zip(drawn, each(lambda name: encode(pictures[name]), drawn), strict=True):
            self._files[name].writestr(zipfile.ZipInfo(f"{len(self.frames):06d}.png", EPOCH), data)
        for name in self.names:
            if name not in PICTURES:
                self._files[name].write(orjson.dumps(pictures[name], option=orjson.OPT_APPEND_NEWLINE))
        self.frames.append(at)

    def close(self, fps: float, steps: Sequence[Mapping[str, Any]]) -> tuple[Path, ...]:
        """Finish the files and write the index; returns all of them."""
        for file in self._files.values():
            file.close()
        if not self.names:
            return ()
        found = {
            "fps": fps,
            "files": {name: path.name for name, path in self.paths.items()},
            "steps": steps,
            "frames": [at._asdict() for at in self.frames],
        }
        option = orjson.OPT_INDENT_2 | orjson.OPT_APPEND_NEWLINE | orjson.OPT_SERIALIZE_NUMPY
        self.index.write_bytes(orjson.dumps(found, option=option))
        return (*self.paths.values(), self.index)


def _suffix(modality: str) -> str:
    return "zip" if modality in PICTURES else "jsonl"


def _opened(path: Path) -> Any:
    return zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) if path.suffix == ".zip" else path.open("wb")


def pictures_in(path: Path) -> Iterator[NDArray[Any]]:
    """Yield the pictures of a modality's archive, frame by frame, as `png.decode` gives them.

    Raises:
        HearthError: the file does not hold pictures.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            for name in sorted(archive.namelist()):
                yield decode(archive.read(name))
    except zipfile.BadZipFile as error:
        raise HearthError.of(Code.NOT_RENDERED, f"{path} does not hold pictures", file=str(path)) from error
