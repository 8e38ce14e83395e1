"""Attacks by films: videos, arrays of clips and of demonstrations, and the rows of a dataset that name them."""

from __future__ import annotations

import os
import pickle
import shutil
import struct
import zipfile
from collections.abc import Callable, Iterator
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from attack import Attack, Ground
from attacks_on_videos import changed, video, videos
from small_checkpoints import colours, film, folder_of

from hearth.datasets.dataset import Dataset
from hearth.models.demonstrations.demonstration_data import Demonstrations, read_pictures
from hearth.models.films import film_input
from hearth.models.films.clip_data import Clips
from hearth.models.model_registry import restore
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.tables import TABLES


def films() -> Iterator[Attack]:
    """Films that are none, that are too large, or that name others; and tables that name films."""
    yield from videos()
    yield from _arrays()
    yield from _tables()
    for reader in (film_input.read_pictures, film_input.read_masks, read_pictures):
        for name in ("/dev/zero", "pipe", "zero", ".", "loop", "x\0y", "none.webm"):
            title = f"{reader.__name__} of {reader.__module__.rpartition('.')[2]}: {name!a}"
            yield Attack("films", title, lambda ground, r=reader, n=name: r(_prepared(ground) / n))


def _prepared(ground: Ground) -> Path:
    os.mkfifo(ground.folder / "pipe")
    (ground.folder / "zero").symlink_to("/dev/zero")
    (ground.folder / "loop").symlink_to("loop")
    return ground.folder


def _member(header: str | bytes, data: bytes = b"", version: bytes = b"\x01\x00") -> bytes:
    """An array's file with any header."""
    text = header.encode() if isinstance(header, str) else header
    size = struct.pack("<H", len(text)) if version == b"\x01\x00" else struct.pack("<I", len(text))
    return b"\x93NUMPY" + version + size + text + data


def _header(shape: str, kind: str = "'<u2'", order: str = "False") -> str:
    return f"{{'descr': {kind}, 'fortran_order': {order}, 'shape': {shape}, }}\n"


class _Calls:
    def __reduce__(self) -> Any:
        return os.system, ("touch pickled",)


MEMBERS = {
    **{f"shape {shape}": _member(_header(shape), bytes(24)) for shape in (
        "(1000000000000, 1, 1)", "(4294967296, 4294967296, 1)", "(2000000, 16, 16)", "(-3, 2, 2)", "(1.0, 2, 2)",
        "(True, 3, 4)", "(0, 3, 4)", "(3, 4)", "()", "(12,)", "(2, 2, 2, 2)", "[3, 2, 2]", "None", "(3, 2, 1e9)",
    )},
    **{f"kind {kind[:20]}": _member(_header("(3, 2, 2)", kind), bytes(4_000)) for kind in (
        "'|O'", "'<f8'", "'<u8'", "'<U9'", "'|V100000000'", "[('a', '<u2')]", "('<u2', (1000000000,))", "'<M8[s]'",
        "'x'", "None", "'>u2'", "[('a', '|O')]", "{}", "'<u2,<u2'",
    )},
    "pickle": _member(_header("(1, 1, 1)", "'|O'"), pickle.dumps([_Calls()])),
    "only a pickle": pickle.dumps(_Calls()),
    "nothing": b"",
    "version 2": _member(_header("(1000000000, 9, 9)"), bytes(24), b"\x02\x00"),
    "version 3": _member(_header("(3, 2, 2)"), bytes(24), b"\x03\x00"),
    "version 9": _member(_header("(3, 2, 2)"), bytes(24), b"\x09\x09"),
    "long header": _member(_header("(3, 2, 2)") + " " * 60_000, bytes(24)),
    "longer header": _member(_header("(3, 2, 2)") + " " * 5_000_000, bytes(24), b"\x02\x00"),
    "deep header": _member("(" * 9_000), "minus": _member("-" * 9_000 + "1"), "open": _member("{'descr': '"),
    "not text": _member(b"\xff\xfe" * 50), "indented": _member("  {\n 'a'\n:  L5 "),
    "calls": _member("__import__('os')"),
    "rows of columns": _member(_header("(3, 2, 2)", "'<u2'", "True"), bytes(24)),
    "more bytes": _member(_header("(3, 2, 2)"), bytes(9_000)),
    "less bytes": _member(_header("(30, 20, 20)"), bytes(24)),
}  # fmt: skip
"""Files of an array that no film has."""


def _packed(members: dict[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    held = BytesIO()
    with zipfile.ZipFile(held, "w", method, compresslevel=1) as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    return held.getvalue()


def _array(values: np.ndarray) -> bytes:
    held = BytesIO()
    np.save(held, values)
    return held.getvalue()


@cache
def above() -> bytes:
    """A true demonstration: four pictures."""
    changes = colours()[:4].copy()
    changes[1:] -= colours()[:3]
    return _packed({"class_ids.npy": _array(film()[:4]), "rgb_changes.npy": _array(changes)})


def _with_flag(data: bytes, at: int, value: bytes) -> bytes:
    """An archive with other bytes in the entries of its directory."""
    found, start = bytearray(data), 0
    while (start := found.find(b"PK\x01\x02", start)) >= 0:
        found[start + at : start + at + len(value)] = value
        start += 4
    return bytes(found)


ARCHIVES: dict[str, Callable[[], bytes]] = {
    "encrypted": lambda: _with_flag(above(), 8, b"\x01\x00"),
    "unknown method": lambda: _with_flag(above(), 10, b"\x63\x00"),
    "bzip2": lambda: _packed({"class_ids.npy": _array(film())}, zipfile.ZIP_BZIP2),
    "lzma": lambda: _packed({"class_ids.npy": _array(film())}, zipfile.ZIP_LZMA),
    "huge by its directory": lambda: _with_flag(above(), 24, b"\xf0\xff\xff\xff"),
    "small by its directory": lambda: _with_flag(above(), 24, b"\x90\x00\x00\x00"),
    "far": lambda: _with_flag(above(), 42, b"\xff\xff\xff\x7f"),
    "other check": lambda: _with_flag(above(), 16, b"\x00\x00\x00\x00"),
    "other version": lambda: _with_flag(above(), 6, b"\xff\x00"),
    "bomb": lambda: _packed({"class_ids.npy": _member(_header("(150000000, 1, 1)"), bytes(300_000_000))}),
    "large pictures": lambda: _packed({"class_ids.npy": _array(np.zeros((9, 5_000, 5_000), np.uint16))}),
    "many pictures": lambda: _packed({
        "class_ids.npy": _array(np.zeros((400_000, 2, 2), np.uint16)),
        "rgb_changes.npy": _array(np.zeros((400_000, 2, 2, 3), np.uint8))}),
    "one pixel": lambda: _packed({
        "class_ids.npy": _array(np.zeros((1, 1, 1), np.uint16)),
        "rgb_changes.npy": _array(np.zeros((1, 1, 1, 3), np.uint8))}),
    "every class": lambda: _packed({
        "class_ids.npy": _array(np.arange(9 * 96 * 128, dtype=np.uint16).reshape(9, 96, 128)),
        "rgb_changes.npy": _array(np.zeros((9, 96, 128, 3), np.uint8))}),
    "other colours": lambda: _packed({
        "class_ids.npy": _array(film()[:4]), "rgb_changes.npy": _array(np.zeros((4, 9, 9, 3), np.uint8))}),
    "two colours": lambda: _packed({
        "class_ids.npy": _array(film()[:4]), "rgb_changes.npy": _array(np.zeros((4, 48, 64, 2), np.uint8))}),
    "many members": lambda: _packed({f"{n}.npy": b"" for n in range(100_000)}, zipfile.ZIP_STORED),
    "hostile names": lambda: _packed({"../../guard/x": b"x", "/etc/x": b"x", "class_ids.npy": _array(film())}),
    "an array alone": lambda: _array(film()),
    "text": lambda: b"text",
    "empty": lambda: b"",
    "cut": lambda: above()[:-40],
    "a film": video,
}  # fmt: skip
"""Files of arrays that no film has."""


def _arrays() -> Iterator[Attack]:
    for name, data in MEMBERS.items():
        yield Attack("films", f"array: {name}", lambda ground, d=data: _taken(ground, _packed({"class_ids.npy": d})))
        both = {"class_ids.npy": _array(film()[:4]), "rgb_changes.npy": data}
        yield Attack("films", f"colours: {name}", lambda ground, b=both: _shown(ground, _packed(b)))
    for name, make in ARCHIVES.items():
        yield Attack("films", f"arrays of a film: {name}", lambda ground, m=make: _taken(ground, m()))
        yield Attack("films", f"demonstration: {name}", lambda ground, m=make: _shown(ground, m()))
    for seed in range(60):
        yield Attack(
            "films", f"demonstration changed {seed}", lambda ground, s=seed: _shown(ground, changed(above(), s))
        )


def _taken(ground: Ground, data: bytes) -> Any:
    return named(ground.folder / "given.npz", data)


def named(path: Path, data: bytes) -> Any:
    """Read a film as `model show` does, and name its clips."""
    from hearth.models.films.film_prediction import cut

    path.write_bytes(data)
    return _trained("clips-seen").named(cut(film_input.read_masks(path)))


@cache
def _trained(kind: str) -> Any:
    return restore(folder_of(kind))[1]


def _shown(ground: Ground, data: bytes) -> Any:
    return sketched(ground.folder / "above.npz", data)


def sketched(path: Path, data: bytes) -> Any:
    """Read a demonstration as `model show` does, and write its sketch."""
    path.write_bytes(data)
    trained = _trained("demo2sketch")
    return trained.sketches([trained.see(read_pictures(path))])


NAMES: tuple[Any, ...] = (
    None, "", ".", "..", "../guard/secret.csv", "../../guard/secret.csv", "{guard}/secret.csv", "/dev/zero", "pipe",
    "a/../../guard/x", "x\0y", "n" * 5_000, "https://127.0.0.1:9/x.npz", "loop", "films",
)  # fmt: skip
NUMBERS: tuple[Any, ...] = (None, -1, 0, 8, 2**31 - 1, -(2**31))
TEXTS: tuple[Any, ...] = (None, "", "x" * 100_000, "\x1b[2J", "<script>")
LISTED: tuple[Any, ...] = (None, [], [None], ["x"] * 9, ["\x1b[2J"])

COLUMNS: dict[str, dict[str, tuple[Any, ...]]] = {
    "clips": {"file": NAMES, "first": NUMBERS, "frames": NUMBERS, "tick": NUMBERS, "action": TEXTS, "objects": LISTED,
              "kind": TEXTS, "execution_id": TEXTS, "number": NUMBERS},
    "demonstration_frames": {"file": NAMES, "execution_id": TEXTS, "tick": NUMBERS, "index": NUMBERS},
}  # fmt: skip
"""Values of rows that name films, by table and column."""


def _tables() -> Iterator[Attack]:
    for table, columns in COLUMNS.items():
        for column, values in columns.items():
            for bad in values:
                title = f"table {table}: {column} = {bad!r:.30}"
                yield Attack("films", title, lambda ground, t=table, c=column, b=bad: _listed(ground, t, c, b))


def _listed(ground: Ground, table: str, column: str, bad: Any) -> Any:
    """A dataset with films, and one row of them that says something else."""
    folder = Path(shutil.copytree(ground.dataset, ground.folder / "dataset"))
    (folder / "films").mkdir(exist_ok=True)
    (folder / "films/true.npz").write_bytes(_packed({"class_ids.npy": _array(film())}) if table == "clips" else above())
    os.mkfifo(folder / "pipe")
    (folder / "loop").symlink_to("loop")
    names = {field.name: None for field in TABLES[table]}
    common = {"execution_id": "crowd:1", "file": "films/true.npz", "tick": 1, "index": 0, "part": "train"}
    of_clips = {"number": 0, "first": 0, "frames": 9, "action": "Walk", "objects": ["sofa"], "kind": "seen",
                "modalities": ["class_ids"]}  # fmt: skip
    row = {name: {**common, **of_clips}.get(name, value) for name, value in names.items()}
    value = bad.replace("{guard}", str(ground.guard)) if isinstance(bad, str) else bad
    (path,) = (folder / table).glob("*.parquet")
    schema = TABLES[table]
    open_to_nothing = pa.schema([field.with_nullable(True) for field in schema], metadata=schema.metadata)
    pq.write_table(pa.Table.from_pylist([row, {**row, column: value}], open_to_nothing), path)
    return _from_table(Dataset.open(folder), table)


def _from_table(dataset: Dataset, table: str) -> Any:
    """Read every film that a table names; each may be refused."""
    found: list[Any] = []
    if table == "clips":
        clips = Clips.of(dataset, "train")
        trained = _trained("clips-seen")
        readers: list[Callable[[], Any]] = [lambda: [trained.named(each) for each in clips.by_film()], clips.__len__]
    else:
        there = Demonstrations.of(dataset)
        readers = [lambda name=name: there.pictures(name).masks.shape for name in there.files]
    for reader in readers:
        try:
            found.append(reader())
        except HearthError as error:
            found.append(error.diagnostics)
    return found
