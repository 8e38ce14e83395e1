"""The files that count as films: arrays of a dataset of clips, and videos."""

from pathlib import Path

from hearth.rendering.film.clip_file import FILE
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

VIDEOS = (".webm", ".mp4")
"""Suffixes of videos."""

ARRAYS = ".npz"
"""The suffix of a film of a dataset of clips."""


def is_film(text: str) -> bool:
    """Return whether an argument names a film.

    By its suffix, or a folder with one; a text may be the name of any folder.
    """
    try:
        folder = bool(text) and Path(text).is_dir()
    except (OSError, ValueError):  # a long text, or one with a null, names nothing
        folder = False
    return Path(text).suffix in (ARRAYS, *VIDEOS) or (folder and bool(_films(Path(text))))


def _films(path: Path) -> list[Path]:
    """Return the films of a folder: its arrays, then its videos; a file itself."""
    videos = sorted(each for suffix in VIDEOS for each in path.glob(f"*{suffix}")) if path.is_dir() else [path]
    return [each for each in (path / FILE, *videos) if each.is_file()]


def film_file(path: Path) -> Path:
    """Return the film of a folder: its arrays, else its first video; of a file itself.

    Raises:
        HearthError: MISSING_FILE, if there is none.
    """
    found = _films(path)
    if not found:
        message = f"no film at `{path}`"
        wanted = f"a file *{', *'.join((ARRAYS, *VIDEOS))}, or a folder with one"
        raise HearthError.of(Code.MISSING_FILE, message, file=str(path), suggestion=wanted)
    return found[0]
