"""The programs of a published dataset, as `mine` reads them."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.parquet_rows import row_batches


def programs(dataset: Path) -> Iterator[list[tuple[str, tuple[str, ...]]]]:
    """Yield the steps of every program of a dataset folder (or of its programs table), one batch in memory at a time.

    Augmented programs are left out: they repeat the texts of their parents.

    Raises:
        HearthError: MISSING_FILE: no programs table is there. BAD_TABLE: it has no steps, or is damaged.
            FILE_TOO_LARGE: it unpacks to more than a table of its size does.
    """
    for path in _files(dataset):
        yield from _programs_in(path)


def _programs_in(path: Path) -> Iterator[list[tuple[str, tuple[str, ...]]]]:
    """Yield the steps of the programs in a file, but of augmented ones."""
    import pyarrow
    import pyarrow.compute as pc
    import pyarrow.parquet as pq

    try:
        # Not as a `pyarrow.dataset`, whose filters end the process where statistics in the file are damaged.
        with pq.ParquetFile(path) as file:
            names = file.schema_arrow.names
            if "steps" not in names:
                raise HearthError.of(Code.BAD_TABLE, "the programs have no `steps`", file=str(path))
            columns = [name for name in ("steps", "origin") if name in names]
            for batch in row_batches(file, path.stat().st_size, str(path), columns):
                own = batch.filter(pc.field("origin") != "augmented") if "origin" in names else batch
                for steps in own.column("steps").to_pylist():
                    yield [_step(step) for step in steps or ()]
    except (pyarrow.ArrowException, OSError, TypeError, ValueError, LookupError, OverflowError) as error:
        message = f"not a table of programs: {type(error).__name__} {error}"
        raise HearthError.of(Code.BAD_TABLE, message, file=str(path)) from error


def _step(step: Any) -> tuple[str, tuple[str, ...]]:
    """Return the names of a step's action and objects.

    Raises:
        TypeError, LookupError: it is none.
    """
    names = (step["action"], *(thing["name"] for thing in step["objects"] or ()))
    if not all(isinstance(name, str) for name in names):
        raise TypeError("a step whose names are no texts")
    return names[0], names[1:]


def _files(dataset: Path) -> list[Path]:
    if dataset.is_file():
        return [dataset]
    folders = (dataset, dataset / "publish")
    found = [path for folder in folders for path in sorted(folder.glob("programs*.parquet"))]
    found = found or [path for folder in folders for path in sorted((folder / "programs").glob("*.parquet"))]
    if not found:
        raise HearthError.of(
            Code.MISSING_FILE,
            "no programs table here",
            file=str(dataset),
            suggestion="give the folder of a published dataset, or a Parquet file of programs",
        )
    if pipe := next((path for path in found if not path.is_file()), None):
        raise HearthError.of(Code.BAD_TABLE, "is not a regular file", file=str(pipe), suggestion="move it elsewhere")
    return found
