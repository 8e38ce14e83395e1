"""All stages, one after the other, over any mix of sources."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from importlib.resources import as_file, files
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq

from hearth.pipelines.engine.context import kept_knowledge
from hearth.pipelines.engine.engines import engine as make_engine
from hearth.pipelines.engine.estimates import forecast
from hearth.pipelines.engine.progress import Progress
from hearth.pipelines.engine.runner import REJECTS, run_stage
from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.engine.stages import STAGES, stage
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rows import RejectedRow
from hearth.storage.lock import locked
from hearth.storage.manifest import Manifest, read_manifest
from hearth.storage.partitions import Counts
from hearth.storage.stores import fetched, working

CORPUS = ("crowd/descriptions.csv", "crowd/programs.csv")
"""The embedded corpus, in `data_raw`."""

_SHOWN = 20


@dataclass(frozen=True, slots=True)
class Funnel:
    """What became of every record.

    Attributes:
        stages: counts by stage, in order, of the stages that have run.
        fresh: stages that were not up to date.
        dataset: the folder of the published dataset; None before it is published.
    """

    stages: dict[str, Counts]
    fresh: tuple[str, ...]
    dataset: Path | None

    def to_json(self) -> dict[str, Any]:
        """Plain values."""
        return {
            "stages": {name: counts.to_json() for name, counts in self.stages.items()},
            "fresh": list(self.fresh),
            "dataset": str(self.dataset) if self.dataset else None,
        }

    @property
    def rejected(self) -> int:
        """Records refused whole by any stage but `augment`, whose refusals concern perturbed environments."""
        return sum(counts.rejected for name, counts in self.stages.items() if name != "augment")


def corpus() -> tuple[str, ...]:
    """Paths of the embedded corpus."""
    with as_file(files("hearth.data_raw")) as folder:
        return tuple(str(folder / name) for name in CORPUS)


def build(
    sources: Sequence[str] = (),
    out: str = "data_out",
    *,
    workers: int = 1,
    engine: str = "local",
    scheduler: str = "",
    force: bool = False,
    only: str | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> Funnel:
    """Bring a dataset up to date with its sources; stages and partitions that did not change are kept.

    Args:
        sources: files and folders, in any mix of forms; the embedded corpus if empty.
        out: the folder for one folder a stage; the dataset is its `publish`. May be a URL that fsspec reads.
        workers: processes; any number gives the same bytes.
        engine: one of `engines.ENGINES`; any gives the same bytes.
        scheduler: address of a running cluster's scheduler, for the dask engine.
        force: build even if the disk seems too small.
        only: the one stage to run, on the output of the earlier ones.
        progress: receives the counts of each stage as it runs.
        options: the other fields of `Settings` (seed, limit, homes, ...).

    Raises:
        HearthError: a source can't be read, or no record of any source can be used.

    Examples:
        >>> made = hearth.build(["milk.txt"], "small", homes=("maple",), variants=0, pictures=0)
        >>> made.rejected, made.stages["sample"].through, made.dataset.name
        (0, 1, 'publish')
    """
    paths = tuple(str(fetched(source)) for source in sources) or corpus()
    fresh: list[str] = []
    with working(out) as (folder, url, revision):
        settings = Settings(paths, folder, store=url, revision=revision, **options)
        if only and only != "validate":
            settings = kept_knowledge(settings)
        with locked(Path(folder)), make_engine(engine, workers, scheduler) as pool:
            for name in [only] if only else list(STAGES):
                result = run_stage(stage(name), settings, pool, progress)
                if name == "validate" and not only:
                    expected = forecast(result.manifest.counts.through, settings, pool.count, force=force)
                    if expected and progress:
                        progress.note(expected)
                if result.fresh:
                    fresh.append(name)
                if name == "ingest":
                    _check_something(result.manifest)
        return funnel(settings, tuple(fresh))


def funnel(settings: Settings, fresh: tuple[str, ...] = ()) -> Funnel:
    """The counts in the manifests of a build."""
    manifests = {name: read_manifest(settings.folder(name)) for name in STAGES}
    counts = {name: manifest.counts for name, manifest in manifests.items() if manifest}
    published = manifests["publish"]
    return Funnel(counts, fresh, published.folder if published else None)


def _check_something(ingested: Manifest) -> None:
    """Raise the first rejects if no record could be read."""
    if ingested.counts.through:
        return
    faults = list(_faults(pq.read_table(ingested.folder / REJECTS).slice(0, _SHOWN).to_pylist()))
    raise HearthError(faults or [Diagnostic(Code.EMPTY, "the sources hold no records")])


def _faults(rows: Iterable[RejectedRow]) -> Iterator[Diagnostic]:
    for row in rows:
        code = Code.__members__.get(row["code"], Code.INTERNAL_ERROR)
        at = row["file"], row["line"], row["column"], 0
        yield Diagnostic(code, row["message"], *at, row["found"], row["suggestion"])
