"""All stages, one after the other, over any mix of sources."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from importlib.resources import as_file, files
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq

from hearth.pipelines.engine.build_estimates import forecast
from hearth.pipelines.engine.build_homes import Homes, known_homes
from hearth.pipelines.engine.engines import engine as make_engine
from hearth.pipelines.engine.option_presets import tiered
from hearth.pipelines.engine.progress import Progress
from hearth.pipelines.engine.runner import REJECTS, run_stage
from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.engine.stages import STAGES, record_of, stage
from hearth.pipelines.engine.user_overlays import kept_overlays, of_new_dataset, overlays
from hearth.pipelines.render import no_pictures
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import lacking, remedy
from hearth.schemas.short_repr import brief
from hearth.schemas.stage_rows import RejectedRow
from hearth.storage.lock import locked
from hearth.storage.manifest import Manifest, read_manifest
from hearth.storage.partitions import Counts
from hearth.storage.remote_build_folders import working
from hearth.storage.url_fetching import fetched

FIRST = ("crowd/descriptions.csv", "crowd/programs.csv")
"""The first part of the embedded corpus, in `data_raw`: with faults put into it."""

CORPUS = (*FIRST, "written/descriptions.csv", "written/programs.csv", "written/sketches.json")
"""The embedded corpus."""

_SHOWN = 20


@dataclass(frozen=True, slots=True)
class Funnel:
    """The counts of records through the stages of a build.

    Attributes:
        stages: counts by stage, in order, of the stages that have run.
        records: the meaning of a record of each of them, and a note of the records that were left out.
        fresh: stages that were not up to date.
        dataset: the folder of the published dataset; None before it is published.
        columns: the columns of each table that was read, by field.
        unread: files that were not read, with the reason.
        guesses: a sentence on each file with the columns that were taken for its fields.
    """

    stages: dict[str, Counts]
    records: dict[str, str]
    fresh: tuple[str, ...]
    dataset: Path | None
    columns: dict[str, dict[str, str]]
    unread: tuple[str, ...]
    guesses: tuple[str, ...] = ()

    @property
    def fuzzy(self) -> int:
        """Steps that were corrected or shortened."""
        return self.stages["validate"].tally["fuzzy"] if "validate" in self.stages else 0

    __repr__ = brief

    def to_json(self) -> dict[str, Any]:
        """Plain values."""
        return {
            "stages": {name: counts.to_json() for name, counts in self.stages.items()},
            "records": self.records,
            "fresh": list(self.fresh),
            "dataset": str(self.dataset) if self.dataset else None,
            "columns": self.columns,
            "unread": self.unread,
        }

    @property
    def rejected(self) -> int:
        """Records refused whole by any stage but `augment`, whose refusals concern perturbed environments."""
        return sum(counts.rejected for name, counts in self.stages.items() if name != "augment")


def corpus(names: Sequence[str] = CORPUS) -> tuple[str, ...]:
    """Paths of the embedded corpus, or of its first part (`FIRST`)."""
    with as_file(files("hearth.data_raw")) as folder:
        return tuple(str(folder / name) for name in names)


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
    options = tiered("", options, options)
    paths = tuple(str(fetched(source)) for source in sources) or corpus()
    fresh: list[str] = []
    with working(out) as (folder, url, revision):
        settings = Settings(paths, folder, store=url, revision=revision, **options)
        settings = kept_overlays(settings, only) if only else of_new_dataset(settings)
        overlays(settings)  # their faults are reported before the sources are read
        known_homes(settings)
        with locked(Path(folder)), make_engine(engine, workers, scheduler) as pool:
            for name in [only] if only else list(STAGES):
                if name == "render" and progress and (settings.pictures or settings.videos):
                    _note_lacking(progress)
                result = run_stage(stage(name), settings, pool, progress)
                if name == "validate" and not only:
                    expected = forecast(result.manifest.counts.through, settings, pool.count, force=force)
                    if expected and progress:
                        progress.note(expected)
                if result.fresh:
                    fresh.append(name)
                if name == "ingest":
                    Homes(settings).names()
                if name == "ingest" or not only:
                    _check_left(name, settings)
        return funnel(settings, tuple(fresh))


def _note_lacking(progress: Progress) -> None:
    """Report that pictures are left out, if they are."""
    if libraries := lacking("pictures"):
        progress.note(f"{no_pictures(libraries)}. To have them, {remedy('pictures')}, and build again.")


def funnel(settings: Settings, fresh: tuple[str, ...] = ()) -> Funnel:
    """Return the counts in the manifests of a build."""
    manifests = {name: read_manifest(settings.folder(name)) for name in STAGES}
    counts = {name: manifest.counts for name, manifest in manifests.items() if manifest}
    records = {name: record_of(name, manifest.content["plan"]) for name, manifest in manifests.items() if manifest}
    published = manifests["publish"]
    ingested = manifests["ingest"]
    columns, guesses = (ingested.content.get(key, {}) if ingested else {} for key in ("columns", "guesses"))
    folder = published.folder if published else None
    return Funnel(counts, records, fresh, folder, columns, tuple(_unread(ingested)), tuple(guesses))


def _unread(ingested: Manifest | None) -> Iterator[str]:
    """Yield the files that `ingest` refused whole, with the reason; at most `_SHOWN`, then their number."""
    if ingested is None:
        return
    rows = pq.read_table(ingested.folder / REJECTS, columns=["record_id", "file", "message", "fault"]).to_pylist()
    whole = [row for row in rows if row["record_id"] == row["file"] and not row["fault"]]
    yield from (f"{row['file']}: {row['message']}" for row in whole[:_SHOWN])
    if len(whole) > _SHOWN:
        yield f"{len(whole) - _SHOWN:,} further files, listed in `rejects`"


def _check_left(name: str, settings: Settings) -> None:
    """Raise the first rejects if a stage leaves neither a program nor a description to publish."""
    ingested, done = (read_manifest(settings.folder(stage)) for stage in ("ingest", name))
    if name not in ("ingest", "validate", "sample") or not ingested or not done or done.counts.through:
        return
    if name != "ingest" and ingested.counts.tally["description"]:
        return
    faults = list(_faults(pq.read_table(done.folder / REJECTS).slice(0, _SHOWN).to_pylist()))
    message, refused = f"nothing is left after `{name}`", done.counts.rejected
    what = f"{message}: {refused:,} refused" if refused else f"{message}: there is not one program in the sources"
    left = [] if name == "ingest" and faults else [Diagnostic(Code.EMPTY, what)]
    raise HearthError([*faults, *left])


def _faults(rows: Iterable[RejectedRow]) -> Iterator[Diagnostic]:
    for row in rows:
        code = Code.__members__.get(row["code"], Code.INTERNAL_ERROR)
        at = row["file"], row["line"], row["column"], 0
        yield Diagnostic(code, row["message"], *at, row["found"], row["suggestion"])
