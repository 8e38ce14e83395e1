"""Attacks by what datasets of strangers keep beside their tables: manifests, splits, the catalog's SQL, other files."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from attack import DEEP, Attack, Ground
from attacks_on_studies import _at, _with

from hearth.schemas.diagnostics import HearthError
from hearth.storage.manifest import NAME

BAD: tuple[Any, ...] = (None, [], -1, True, "9" * 5_000, {"x": {"x": []}}, DEEP)
"""Values that somebody could write in the place of any other."""

FIELDS = (
    "format", "version", "action_set", "stage", "settings", "plan", "key", "inputs", "knowledge", "homes", "strength",
    "counts", "parts", "files",
)  # fmt: skip
WITHIN: tuple[tuple[Any, ...], ...] = (
    ("knowledge", "overlay"), ("knowledge", "base"), ("homes", "overlay"), ("homes", "overlay", "path"),
    ("homes", "overlay", "sha256"), ("counts", "rows"), ("counts", "rows", "programs"), ("counts", "codes"),
    ("counts", "records_in"), ("parts", 0), ("parts", 0, "files"), ("parts", 0, "rows"),
    ("files", "programs/part-00000.train.parquet"), ("files", "programs/part-00000.train.parquet", "bytes"),
    ("files", "programs/part-00000.train.parquet", "sha256"),
)  # fmt: skip
FILES = (
    "{guard}/secret.csv",
    "../../../guard/secret.csv",
    "..",
    "",
    "x\0",
    "pipe",
    "loop",
    "out/secret.csv",
    "x" * 9_000,
)
"""Names of files in a manifest."""

TABLES = (
    "range(999999999999)", "programs; COPY (SELECT 1) TO '{guard}/x'", "read_text('{guard}/secret.csv')", "", "x",
    "programs p, programs q, steps, steps s, ticks",
)  # fmt: skip
"""Names of tables in a manifest."""


def opened(folder: Path) -> Any:
    """All that is asked of a folder that may be a dataset: its rows, whether it is whole, its programs as a source."""
    from hearth.datasets.dataset import Dataset
    from hearth.datasets.dataset_homes import own_homes
    from hearth.datasets.verify import verify
    from hearth.models.text_examples import facts_of
    from hearth.pipelines.engine.source_labels import labelled
    from hearth.pipelines.ingest import items, read

    found: list[Any] = []

    def ask(question: Callable[[], Any]) -> None:
        try:
            found.append(question())
        except HearthError as error:
            found.append(error.diagnostics)

    ask(lambda: [row for _, item in items(labelled([str(folder)])) for row in read(item)][:3])
    dataset = Dataset.open(folder)
    ask(lambda: dataset.rows("SELECT count(*) FROM programs"))
    ask(lambda: (dataset.knowledge.actions.keys(), own_homes(folder, dataset.manifest), facts_of(dataset)))
    ask(lambda: verify(folder))
    return found


def manifested(folder: Path) -> Any:
    """Return the faults of a manifest, without the queries and replays by which `verify` checks the tables."""
    from hearth.datasets.dataset import Dataset
    from hearth.datasets.verify import _counts, _files, _overlays
    from hearth.datasets.verify_folder import manifest_faults, unknown

    dataset = Dataset.open(folder)
    found = [*unknown(dataset), *_files(dataset), *_overlays(dataset)]
    return found or [*_counts(dataset), *manifest_faults(dataset)]


def _copy(ground: Ground) -> Path:
    """A copy of the dataset, whose files are links to the same ones: they are replaced, not written to."""
    return Path(shutil.copytree(ground.dataset, ground.folder / "dataset", copy_function=os.link))


def _put(folder: Path, name: str, data: bytes) -> None:
    (folder / name).unlink(missing_ok=True)
    (folder / name).write_bytes(data)


def _said(change: Callable[[dict[str, Any]], Any], ground: Ground) -> Any:
    folder = _copy(ground)
    document = json.loads((folder / NAME).read_bytes())
    _put(folder, NAME, json.dumps(_at(change(document), ground)).encode())
    os.mkfifo(folder / "pipe")
    (folder / "loop").symlink_to("loop")
    (folder / "out").symlink_to(ground.guard)
    return opened(folder)


def datasets() -> Iterator[Attack]:
    """Yield attacks by the files next to the tables, each with another fault in them."""
    for place in (*((name,) for name in FIELDS), *WITHIN):
        for bad in BAD:
            name = f"manifest: {'.'.join(map(str, place))[-30:]} = {bad!r:.16}"
            yield Attack("datasets", name, lambda ground, p=place, b=bad: _said(lambda it: _with(it, p, b), ground))
    for number in (0, -7, 10**6, 10**30):
        yield Attack("datasets", f"manifest: format {number}", lambda ground, n=number: _said(
            lambda document: {**document, "format": n}, ground))  # fmt: skip
    for name in FILES:
        entry = {"bytes": 31, "sha256": "0" * 64}
        yield Attack("datasets", f"manifest: names {name[:30]!a}", lambda ground, n=name, e=entry: _said(
            lambda document: {**document, "files": {**document["files"], n: e}}, ground))  # fmt: skip
        for field in ("knowledge", "homes"):
            over = {"base": "", "overlay": {"path": name, "sha256": ""}}
            yield Attack("datasets", f"manifest: {field} in {name[:30]!a}", lambda ground, f=field, o=over: _said(
                lambda document: {**document, f: o}, ground))  # fmt: skip
    for name in TABLES:
        yield Attack("datasets", f"manifest: counts {name[:30]!a}", lambda ground, n=name: _said(
            lambda document: _with(document, ("counts", "rows"), {n: 1}), ground))  # fmt: skip
    yield from _other_files()


WHOLE = {
    "deep": b"[" * 100_000, "nothing": b"", "null": b"null", "a list": b"[]", "bytes": b"\xff\xfe{",
    "digits": b"9" * 100_000, "other splits": b'{"splits": {"x": 1}}', "splits": b'{"splits": [[]]}',
}  # fmt: skip


def _other_files() -> Iterator[Attack]:
    for name in (NAME, "splits.json", "timing.json", "catalog.sql", "catalog.duckdb"):
        for what, data in WHOLE.items():
            yield Attack("datasets", f"{name}: {what}", lambda ground, n=name, d=data: _replaced(ground, n, d))
    tables = ("programs/part-00000.train.parquet", "splits/x.parquet")
    for name in (NAME, "splits.json", "timing.json", "catalog.sql", "catalog.duckdb", *tables):
        for target in ("pipe", "/dev/zero", "loop", "."):
            yield Attack("datasets", f"{name} -> {target}", lambda ground, n=name, t=target: _linked(ground, n, t))


def _replaced(ground: Ground, name: str, data: bytes) -> Any:
    folder = _copy(ground)
    _put(folder, name, data)
    return opened(folder)


def _linked(ground: Ground, name: str, target: str) -> Any:
    folder = _copy(ground)
    (folder / name).unlink(missing_ok=True)
    if target == "pipe":
        os.mkfifo(folder / name)
    else:
        (folder / name).symlink_to(folder / name if target == "loop" else target)
    return opened(folder)
