"""The programs of a published dataset, as `mine` reads them."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


def programs(dataset: Path) -> Iterator[list[tuple[str, tuple[str, ...]]]]:
    """The steps of every program of a dataset folder (or of its programs table), one batch in memory at a time.

    Augmented programs are left out: they repeat what their parents say.

    Raises:
        HearthError: there is no programs table, or it has no steps.
    """
    import pyarrow
    import pyarrow.dataset

    files = _files(dataset)
    try:
        table = pyarrow.dataset.dataset(files, format="parquet")
    except (pyarrow.ArrowException, OSError, ValueError) as error:
        raise HearthError.of(Code.BAD_TABLE, f"not Parquet: {error}", file=str(dataset)) from error
    if "steps" not in table.schema.names:
        raise HearthError.of(Code.BAD_TABLE, "the programs have no `steps`", file=str(dataset))
    try:
        origin = pyarrow.dataset.field("origin") != "augmented" if "origin" in table.schema.names else None
        for batch in table.to_batches(columns=["steps"], filter=origin):
            for steps in batch.column("steps").to_pylist():
                yield [_step(step) for step in steps or ()]
    except (pyarrow.ArrowException, OSError, TypeError, ValueError, LookupError, OverflowError) as error:
        message = f"not a table of programs: {type(error).__name__} {error}"
        raise HearthError.of(Code.BAD_TABLE, message, file=str(dataset)) from error


def _step(step: Any) -> tuple[str, tuple[str, ...]]:
    """The names of a step's action and objects.

    Raises:
        TypeError, LookupError: it is none.
    """
    names = (step["action"], *(thing["name"] for thing in step["objects"] or ()))
    if not all(isinstance(name, str) for name in names):
        raise TypeError("a step whose names are no texts")
    return names[0], names[1:]


def _files(dataset: Path) -> list[str]:
    if dataset.is_file():
        return [str(dataset)]
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
    return [str(path) for path in found]
