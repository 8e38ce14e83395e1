"""The manifest of a stage: its inputs, its counts, and the hash of every file it wrote."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hearth.storage.files import file_digest, is_temporary, read_json, value_digest, walk, write_json
from hearth.storage.partitions import Counts
from hearth.version import ACTION_SET, VERSION

NAME = "manifest.json"
TIMING = "timing.json"
FORMAT = 3
"""Version of the format of datasets; it changes with their tables.

`datasets/format/earlier.yaml` gives the readings of earlier formats.
"""

UNHASHED = frozenset({NAME, TIMING, "catalog.duckdb"})
"""The manifest itself, files that differ from run to run, and the catalog, whose bytes DuckDB does not fix."""


@dataclass(frozen=True, slots=True)
class Manifest:
    """A complete stage folder."""

    folder: Path
    content: dict[str, Any]

    @property
    def key(self) -> str:
        """Digest of all that the stage was made from."""
        return str(self.content["key"])

    @property
    def counts(self) -> Counts:
        """Return the counts of its records."""
        return Counts.from_json(self.content["counts"])

    @property
    def parts(self) -> list[dict[str, Any]]:
        """Return its partitions: `rows`, and `files` with their digests by table."""
        return list(self.content["parts"])

    @property
    def digest(self) -> str:
        """Digest of all that the stage wrote."""
        return value_digest(self.content["files"])

    def write(self) -> None:
        """Write the manifest, which marks the stage as complete; it is the last file written."""
        write_json(self.folder / NAME, self.content)

    def intact(self) -> bool:
        """Return whether every file is there with the length it had."""
        return all(_length(self.folder / name) == entry["bytes"] for name, entry in self.content["files"].items())


def read_manifest(folder: Path) -> Manifest | None:
    """Return the manifest of a complete stage; None where there is none, or one of another format."""
    content = read_json(folder / NAME)
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        return None
    return Manifest(folder, content)


def describe(folder: Path, asked: dict[str, Any], inputs: dict[str, str], key: str, **facts: Any) -> Manifest:
    """Return the manifest of a stage whose other files are all in place; `write` marks the stage as complete."""
    content = {
        "format": FORMAT,
        "version": VERSION,
        "action_set": ACTION_SET,
        **asked,
        "key": key,
        "inputs": inputs,
        **facts,
        "files": dict(_files(folder)),
    }
    return Manifest(folder, content)


def _files(folder: Path) -> Iterator[tuple[str, dict[str, Any]]]:
    for path in walk(folder):
        name = path.relative_to(folder).as_posix()
        if name not in UNHASHED and not is_temporary(name):
            yield name, {"bytes": path.stat().st_size, "sha256": file_digest(path)}


def _length(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:
        return -1
