"""The programs of a published dataset, as `mine` reads them."""

from collections.abc import Iterator
from pathlib import Path

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
    except (pyarrow.ArrowInvalid, OSError) as error:
        raise HearthError.of(Code.BAD_TABLE, f"not Parquet: {error}", file=str(dataset)) from error
    if "steps" not in table.schema.names:
        raise HearthError.of(Code.BAD_TABLE, "the programs have no `steps`", file=str(dataset))
    origin = pyarrow.dataset.field("origin") != "augmented" if "origin" in table.schema.names else None
    for batch in table.to_batches(columns=["steps"], filter=origin):
        for steps in batch.column("steps").to_pylist():
            yield [(step["action"], tuple(thing["name"] for thing in step["objects"] or ())) for step in steps or ()]


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
    return [str(path) for path in found]
