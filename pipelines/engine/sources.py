"""Sources: the files and folders of a build, with labels that do not reveal their path on this machine."""

from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.readers.item import Source
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.files import tree_digest, value_digest
from hearth.storage.rejects import as_text


def labelled(paths: Iterable[str]) -> list[Source]:
    """The sources with their labels: the file name, numbered if several sources share it.

    They are ordered by name, so that the output does not depend on the order given.

    Raises:
        HearthError: MISSING_FILE, with every missing path; EMPTY, if there are no paths.
    """
    sources: list[Source] = []
    used: Counter[str] = Counter()
    named = sorted((Path(text).name or Path(text).resolve().name, text) for text in paths)
    for name, text in named:
        path = Path(text)
        used[name] += 1
        sources.append(Source(as_text(name if used[name] == 1 else f"{name}~{used[name]}"), path))
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
    """The salt of worker ids: the given one, or else one derived from the sources' bytes, which are not published."""
    return settings.salt or value_digest(["workers", sorted(source_digests(settings.sources).values())])
