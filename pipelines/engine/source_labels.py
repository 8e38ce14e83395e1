"""Sources: the files and folders of a build, with labels that do not reveal their path on this machine."""

import hashlib
from collections.abc import Iterable
from functools import lru_cache, partial
from hashlib import blake2b
from pathlib import Path

from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.readers.reader_items import Source
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.files import tree_digest, value_digest, walk
from hearth.storage.names import numbered
from hearth.storage.rejects import as_text


def labelled(paths: Iterable[str]) -> list[Source]:
    """Return the sources with their labels: the file name, numbered if several sources share it.

    They are ordered by name, so that the output does not depend on the order given.

    Raises:
        HearthError: MISSING_FILE, with every missing path; EMPTY, if there are no paths.
    """
    sources: list[Source] = []
    named = sorted((Path(text).name or Path(text).resolve().name, text) for text in paths)
    taken, seen = {name for name, _ in named}, set()
    for name, text in named:
        label = numbered(name, taken) if name in seen else name
        seen.add(name)
        taken.add(label)
        sources.append(Source(as_text(label), Path(text)))
    missing = [source.path for source in sources if not source.path.exists()]
    if missing:
        errors = [HearthError.of(Code.MISSING_FILE, "no such file or folder", file=str(path)) for path in missing]
        raise HearthError(fault for error in errors for fault in error.diagnostics)
    if not sources:
        raise HearthError.of(Code.EMPTY, "no sources to read", suggestion="name a file or folder to read")
    return sources


def source_digests(paths: Iterable[str]) -> dict[str, str]:
    """SHA-256 of every source by its label."""
    return {source.label: tree_digest(source.path) for source in labelled(paths)}


def salt(settings: Settings) -> str:
    """Return the salt of worker ids: the given one, or else one derived from the sources' bytes, which are not
    published.

    Its digest of the bytes is another than that of manifests, from which the salt cannot be computed.
    """
    return settings.salt or value_digest(["workers", sorted(map(_secret, labelled(settings.sources)))])


def _secret(source: Source) -> str:
    files = [source.path] if source.path.is_file() else walk(source.path)
    return value_digest([_keyed(file, file.stat().st_size, file.stat().st_mtime_ns) for file in files])


@lru_cache(maxsize=10_000)
def _keyed(path: Path, size: int, changed: int) -> str:
    """Return a digest of a file's bytes that is published nowhere.

    The file is read once a process while it stays as it is.
    """
    with path.open("rb") as file:
        return hashlib.file_digest(file, partial(blake2b, person=b"workers")).hexdigest()
