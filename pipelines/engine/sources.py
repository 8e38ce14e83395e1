"""Sources: the files and folders a build is given, under labels that do not tell where on a machine they were."""

from __future__ import annotations

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
    """The sources by name, with a label each: their name, numbered where several share one.

    In the order of their names, so that the order they are given in decides nothing.

    Raises:
        HearthError: MISSING_FILE, naming every path that is not there; EMPTY, when none were given.
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
    """What is hashed with worker ids: as given, or else derived from the sources' bytes, which are not published."""
    return settings.salt or value_digest(["workers", sorted(source_digests(settings.sources).values())])
