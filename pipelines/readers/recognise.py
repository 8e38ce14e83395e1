"""What a path is, told by its content and not by its name."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from hearth.pipelines.files import walk
from hearth.pipelines.readers import crowd, release
from hearth.pipelines.readers.item import lines
from hearth.pipelines.rejects import Reject
from hearth.schemas.errors import HearthError
from hearth.schemas.failures import Code

_MAGIC: dict[bytes, str] = {
    b"\x89PNG": "a PNG picture",
    b"\xff\xd8\xff": "a JPEG picture",
    b"GIF8": "a GIF picture",
    b"BM": "a bitmap picture",
    b"RIFF": "a picture, sound or video",
    b"%PDF": "a PDF document",
    b"PAR1": "a Parquet file",
    b"\x1f\x8b": "a gzip file",
    b"\x28\xb5\x2f\xfd": "a zstd file",
    b"SQLite": "an SQLite database",
    b"\x7fELF": "a program of this machine",
    b"\xd0\xcf\x11\xe0": "an old Office document",
}

_ASIDE = frozenset({".md", ".yaml", ".yml", ".rst"})
"""Notes and settings that stand beside data; what a folder holds of them is not read as data."""

FORMS = "a release (zip or folder), crowd-sourcing CSV, or program text"


class Recognised(NamedTuple):
    """A file or folder and the reader it is for; `refusal` where there is none."""

    path: Path
    inside: str
    reader: str
    refusal: Reject | None = None


def recognise(path: Path, label: str) -> Iterator[Recognised]:
    """What a source holds: one entry for each file or folder that one reader reads whole.

    Raises:
        HearthError: the path is missing, or nothing in it is of any known form.
    """
    if not path.exists():
        raise HearthError.of(Code.MISSING_FILE, "no such file or folder", file=str(path))
    if path.is_file():
        yield _named_file(path, label)
        return
    files = [file.relative_to(path).as_posix() for file in walk(path)]
    if any(map(release.names_it, files)):
        yield Recognised(path, label, release.NAME)
        files = [name for name in files if not release.names_it(name)]
        yield from _folder(path, label, files)
        return
    found = list(_folder(path, label, files))
    if all(entry.refusal for entry in found):
        what = [fault.message for entry in found if entry.refusal for fault in entry.refusal.diagnostics]
        kinds = f"; the first is {what[0]}" if what else ""
        message = f"nothing to read among {len(files)} files{kinds}" if files else "an empty folder"
        raise HearthError.of(Code.UNSUPPORTED_FILE, message, file=str(path), suggestion=f"give {FORMS}")
    yield from found


def _folder(path: Path, label: str, names: list[str]) -> Iterator[Recognised]:
    for name in names:
        if Path(name).suffix.lower() not in _ASIDE:
            yield _file(path / name, f"{label}/{name}")


def _named_file(path: Path, label: str) -> Recognised:
    """A file that was asked for by name: what can't be read in it is an error, not a reject."""
    found = _file(path, label)
    if found.refusal and path.stat().st_size:
        raise HearthError(tuple(fault.at(str(path)) for fault in found.refusal.diagnostics))
    return found


def _file(path: Path, place: str) -> Recognised:
    with path.open("rb") as file:
        start = file.read(8)
    if start.startswith(b"PK"):
        return _archive(path, place)
    kind = next((kind for magic, kind in _MAGIC.items() if start.startswith(magic)), None)
    if kind:
        return _refused(path, place, kind)
    line = next((line for line, _ in lines(path)), "")
    if crowd.header_of(line[:10_000]):
        return Recognised(path, place, crowd.NAME)
    if line.lstrip()[:1] in ("{", "[") and path.suffix.lower() in (".json", ".jsonl"):
        return _refused(path, place, "a JSON file that is no release")
    if path.suffix.lower() in (".csv", ".tsv"):
        return _refused(path, place, "a table whose first line names none of a batch's columns", Code.BAD_TABLE)
    return Recognised(path, place, "text")


def _archive(path: Path, place: str) -> Recognised:
    try:
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
    except (zipfile.BadZipFile, EOFError, NotImplementedError) as error:
        message = f"a damaged or truncated archive: {error}"
        reject = Reject.of(Code.BAD_ARCHIVE, message, file=place, suggestion="download it again")
        return Recognised(path, place, "", reject)
    if any(map(release.names_it, names)):
        return Recognised(path, place, release.NAME)
    example = f", for example `{names[0]}`" if names else ""
    message = f"an archive of {len(names)} files without any of the release's folders{example}"
    suggestion = f"it needs one of the folders {', '.join(sorted(release.FOLDERS))}"
    return Recognised(path, place, "", Reject.of(Code.BAD_ARCHIVE, message, file=place, suggestion=suggestion))


def _refused(path: Path, place: str, kind: str, code: Code = Code.UNSUPPORTED_FILE) -> Recognised:
    return Recognised(path, place, "", Reject.of(code, kind, file=place, suggestion=f"give {FORMS}"))
