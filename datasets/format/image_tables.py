"""The table `frames` with its pictures as values, for `load_dataset`: the library finds no file next to a Parquet file.

`datasets` 5 gives every configuration of a folder one reader, here that of Parquet, which takes a path for one from the
working directory. So the bytes of the pictures stand in files of their own, `frames/images/part-*.parquet`, that no
query of the table reads. Their schema names the feature `Image`, by which the library decodes the column.
"""

from collections.abc import Iterator, Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any, Final

import orjson
import pyarrow as pa
import pyarrow.parquet as pq

from hearth.schemas.tables import TABLES
from hearth.storage.batch_sizes import PICTURES_COPIED
from hearth.storage.partitions import write_batches

FOLDER: Final = "frames/images"
"""The folder of these files in a dataset."""

IMAGE: Final = "image"
"""The column that they have and `frames` has not: the bytes of the PNG, and its name relative to the dataset."""

_IMAGE_TYPE: Final = pa.struct({"bytes": pa.binary(), "path": pa.string()})

SCHEMA: Final = pa.schema(
    [*TABLES["frames"], pa.field(IMAGE, _IMAGE_TYPE, metadata={"comment": "the picture, as the file has it"})],
    metadata={
        **(TABLES["frames"].metadata or {}),
        "huggingface": orjson.dumps({"info": {"features": {IMAGE: {"_type": "Image"}}}}),
    },
)

_ENTRY: Final = ("file", IMAGE)


def write_images(folder: Path) -> None:
    """Write a file with pictures for each file of `frames` that has rows."""
    for path in sorted((folder / "frames").glob("part-*.parquet")):
        if pq.read_metadata(path).num_rows:
            write_batches(folder / FOLDER / path.name, SCHEMA, _with_images(folder, path))


def _with_images(folder: Path, path: Path) -> Iterator[pa.RecordBatch]:
    with pq.ParquetFile(path) as file:
        for batch in file.iter_batches(batch_size=PICTURES_COPIED):
            rows = batch.to_pylist()
            images = [{"bytes": (folder / row["file"]).read_bytes(), "path": row["file"]} for row in rows]
            with_images = [{**row, IMAGE: image} for row, image in zip(rows, images, strict=True)]
            yield pa.RecordBatch.from_pylist(with_images, SCHEMA)


def other_images(folder: Path, files: Mapping[str, Any]) -> Iterator[tuple[Path, str]]:
    """Yield the files with pictures that differ from the table and from the pictures in its folder, and why.

    Args:
        folder: of a dataset; those before version 0.3 have no such files.
        files: entries of the manifest, which agree with the folder.
    """
    for path in sorted((folder / FOLDER).glob("*.parquet")):
        if not pq.read_schema(path).equals(SCHEMA):
            yield path, f"other columns than those of `frames` and `{IMAGE}`"
            continue
        if not pq.read_table(path, columns=TABLES["frames"].names).equals(pq.read_table(folder / "frames" / path.name)):
            yield path, "other rows than `frames`"
        wrong = [row["file"] for row in _entries(path) if not _is_file_s(row, files)]
        if wrong:
            yield path, f"{len(wrong):,} pictures have other bytes than their files, first `{wrong[0]}`"


def _entries(path: Path) -> Iterator[dict[str, Any]]:
    with pq.ParquetFile(path) as file:
        for batch in file.iter_batches(batch_size=PICTURES_COPIED, columns=[*_ENTRY]):
            yield from batch.to_pylist()


def _is_file_s(row: Mapping[str, Any], files: Mapping[str, Any]) -> bool:
    """Return whether the picture of a row is the file that the row names."""
    image, known = row[IMAGE] or {}, files.get(row["file"], {})
    is_named = bool(image.get("path") == row["file"])
    return is_named and sha256(image.get("bytes") or b"").hexdigest() == str(known.get("sha256"))
