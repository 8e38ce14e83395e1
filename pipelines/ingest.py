"""Stage 1: reads descriptions and programs of any known form, one row each, their text unchanged."""

import shutil
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple, TypedDict

import pyarrow.parquet as pq

from hearth.datasets.format.home_inference import write_home
from hearth.datasets.format.row_conversion import graph_of
from hearth.kb.language.recognition_knowledge import recognition, recognizing
from hearth.pipelines.crowd.copied_answers import Copies, pasted
from hearth.pipelines.crowd.description_lookup import Described
from hearth.pipelines.crowd.duplicate_records import Repeated
from hearth.pipelines.engine.build_context import knowledge
from hearth.pipelines.engine.salt_record import salt_changed
from hearth.pipelines.engine.settings import DERIVED, Settings
from hearth.pipelines.engine.source_labels import labelled, salt
from hearth.pipelines.engine.stage import Job, Partition, Stage
from hearth.pipelines.readers import (
    alfred,
    crowd,
    enclosed_json,
    json_records,
    natural_language_plans,
    program_tables,
    program_text,
    published_dataset,
    release,
    scene_graphs,
    sketches,
    text_chats,
    yaml_documents,
)
from hearth.pipelines.readers.field_columns import Asked, FieldColumns, read_columns, shown
from hearth.pipelines.readers.reader_items import Item, Source, read_refused, refused
from hearth.pipelines.readers.recognition_by_content import DOCUMENT, LISTED, TEXTS, Recognised, recognise
from hearth.pipelines.readers.scanning_time import SECONDS, ScanningTime
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.stage_rows import IngestedRow
from hearth.schemas.tables import INGESTED
from hearth.storage.archives import DamagedError
from hearth.storage.batch_sizes import RECORDS_CONVERTED
from hearth.storage.files import value_digest
from hearth.storage.names import inside, numbered
from hearth.storage.partitions import Counts
from hearth.storage.rejects import Reject, as_text

SCANNERS: dict[str, Callable[..., Iterator[Item]]] = {
    release.NAME: release.scan,
    alfred.NAME: alfred.scan,
    crowd.NAME: crowd.scan,
    program_text.NAME: program_text.scan,
    natural_language_plans.NAME: natural_language_plans.scan,
    TEXTS: natural_language_plans.scan_list,
    json_records.NAME: json_records.scan,
    LISTED: json_records.scan_list,
    DOCUMENT: json_records.scan_document,
    program_tables.NAME: program_tables.scan,
    yaml_documents.NAME: yaml_documents.scan,
    enclosed_json.NAME: enclosed_json.scan,
    text_chats.NAME: text_chats.scan,
    published_dataset.NAME: published_dataset.scan,
    sketches.NAME: sketches.scan,
    scene_graphs.NAME: scene_graphs.scan,
}
"""The function that finds the records of a file or folder, by reader."""

_NAMED = frozenset({json_records.NAME, LISTED, DOCUMENT, program_tables.NAME, yaml_documents.NAME, enclosed_json.NAME})
"""Readers of records whose fields may have other names."""

READERS: dict[str, Callable[[Item, str], Iterable[IngestedRow | Reject]]] = {
    release.NAME: lambda item, salt: release.read(item),
    alfred.NAME: lambda item, salt: alfred.read(item, salt, recognition()),
    crowd.NAME: lambda item, salt: [crowd.read(item, salt)],
    program_text.NAME: lambda item, salt: [program_text.read(item)],
    natural_language_plans.NAME: lambda item, salt: [natural_language_plans.read(item)],
    json_records.NAME: json_records.read,
    published_dataset.NAME: lambda item, salt: published_dataset.read(item),
    sketches.NAME: lambda item, salt: [sketches.read(item)],
    scene_graphs.NAME: lambda item, salt: [scene_graphs.read(item)],
    "refused": lambda item, salt: [read_refused(item)],
}
"""The function that reads one record, by reader. To add one: a file in `readers/`, a row here and in `SCANNERS`."""

WEIGHTS = {
    program_text.NAME: 1,
    natural_language_plans.NAME: 4,
    json_records.NAME: 4,
    release.NAME: 256,
    scene_graphs.NAME: 1024,
}
"""The weight of a record in filling a partition, by reader; others weigh `OTHER_WEIGHT`."""

OTHER_WEIGHT = 64
"""The weight of a record of any other reader, such as a row of a CSV."""

FULL_PARTITION = 8_192
"""The weight at which a partition is full: 128 rows of a CSV, 8,192 programs as text, 2,048 plans or records of JSON,
32 programs of a release, or 8 scene graphs."""


def items(
    sources: Iterable[Source],
    columns: FieldColumns | None = None,
    found_columns: dict[str, FieldColumns] | None = None,
    time_limit: float = SECONDS,
) -> Iterator[tuple[str, Item]]:
    """Yield every record of the sources with its source's label; a copy of an earlier record is refused.

    Args:
        sources: files and folders.
        columns: columns of tables and keys of JSON that hold fields; others are guessed.
        found_columns: receives those of each table as it is read.
        time_limit: seconds of a record, from which that of scanning a packed file follows; 0 for none.
    """
    given, times = columns or {}, ScanningTime(time_limit)
    scanned = partial(_scanned_in_time, times)
    repeated = Repeated()
    found = [(source.label, entry) for source in sources for entry in _recognised(source)]
    described = Described()
    batches = (item for _, entry in found if entry.reader == crowd.NAME for item in scanned(entry, Asked(given)))
    copies = Copies(pasted(described.noted(batches)))
    for label, entry in found:
        if entry.refusal:
            yield label, refused(entry.inside, entry.refusal)
            continue
        asked = Asked(given)
        if entry.reader == program_tables.NAME and found_columns is not None:
            found_columns[entry.inside] = program_tables.columns_of(entry.path, given)
        elif entry.reader in _NAMED and found_columns is not None:
            found_columns[entry.inside] = asked.found  # filled as its records are read
        checked = repeated.first(scanned(entry, asked), entry.reader, entry.inside)
        if entry.reader == crowd.NAME:
            checked = map(described.checked, map(copies.checked, checked))
        yield from ((label, item) for item in checked)
    times.close()


def _recognised(source: Source) -> Iterator[Recognised]:
    """Yield the entries of a source; an error in Hearth is refused as one record.

    Raises:
        HearthError: the source is missing, or nothing in it can be read.
    """
    try:
        yield from recognise(source.path, source.label)
    except (HearthError, OSError):
        raise
    except Exception as error:
        yield Recognised(source.path, source.label, "", Reject.caused(error, source.label))


def _scanned_in_time(times: ScanningTime, entry: Recognised, columns: Asked) -> Iterator[Item]:
    """Yield the records that a reader finds before the time of a packed file is over."""
    return times.within(entry.path, entry.inside, _scanned(entry, columns))


def _scanned(entry: Recognised, columns: Asked) -> Iterator[Item]:
    """Yield the records that a reader finds; if it breaks off, those before the break, then the break as a reject."""
    found = False
    try:
        more = (columns,) if entry.reader in _NAMED else ()
        for item in SCANNERS[entry.reader](entry.path, entry.inside, *more):
            found = True
            yield item
    except DamagedError as error:
        found = True
        yield refused(entry.inside, Reject.because([f.at(entry.inside) for f in error.diagnostics]), f"{entry.inside}~")
    except (HearthError, OSError):
        raise
    except Exception as error:
        found = True
        yield refused(entry.inside, Reject.caused(error, entry.inside), f"{entry.inside}~")
    if not found:
        yield refused(entry.inside, Reject.of(Code.EMPTY, "no records in it", file=entry.inside))


def partitions(job: Job) -> Iterator[Partition]:
    """Shares of the sources, each of one source."""
    with recognizing(knowledge(job.settings)):
        yield from _partitions(job)


def _partitions(job: Job) -> Iterator[Partition]:
    share: list[tuple[str, Item]] = []
    weight = 0
    number = 0
    columns = read_columns(job.settings.columns)
    found_items = items(labelled(job.settings.sources), columns, job.context.columns, job.settings.time_limit)
    for found in _limited(found_items, job.settings.limit):
        if share and (weight >= FULL_PARTITION or share[0][0] != found[0]):
            yield _partition(number, share)
            number += 1
            share, weight = [], 0
        share.append(found)
        weight += WEIGHTS.get(found[1].reader, OTHER_WEIGHT)
    if share:
        yield _partition(number, share)


def _limited(found: Iterator[tuple[str, Item]], limit: int | None) -> Iterator[tuple[str, Item]]:
    """Yield the first `limit` programs and at most as many other records; refused items do not count."""
    counts = {True: 0, False: 0}
    for source, item in found:
        is_program = not (item.reader == crowd.NAME and item.value["stage"] == 1) and item.reader != sketches.NAME
        if limit is not None and item.reader != "refused":
            if counts[is_program] >= limit:
                if is_program:
                    return
                continue
            counts[is_program] += 1
        yield source, item


def _partition(number: int, share: list[tuple[str, Item]]) -> Partition:
    try:
        digest = _digest(share)
    except (HearthError, TypeError):
        share = [(source, _storable(source, item)) for source, item in share]
        digest = _digest(share)
    return Partition(number, digest, share, len(share))


def _digest(share: list[tuple[str, Item]]) -> str:
    return value_digest(
        [
            [source, item.record_id, item.reader, item.place, item.line, item.value, item.version]
            for source, item in share
        ]
    )


def _storable(source: str, item: Item) -> Item:
    """Return the item, or its refusal if it is not JSON in UTF-8 of at most some 250 levels."""
    try:
        _digest([(source, item)])
    except (HearthError, TypeError) as error:
        deep = isinstance(error, HearthError)
        message = "nested deeper than 250 levels" if deep else f"it cannot be stored: {error}"
        fault = Reject.of(
            Code.BAD_JSON, message, file=item.place, line=item.line, suggestion="save it as JSON in UTF-8"
        )
        return refused(as_text(item.place), fault, as_text(item.record_id), item.line)
    return item


class Found(TypedDict):
    """A record before it is read."""

    program_id: str
    source: str
    item: Item


def records(job: Job, partition: Partition) -> Iterator[Found]:
    """Yield the items of a share, as records."""
    for source, item in partition.payload:
        yield {"program_id": item.record_id, "source": source, "item": item}


class Context(NamedTuple):
    """The salt of workers' ids, the columns of each table that was read, and the settings."""

    salt: str
    columns: dict[str, FieldColumns]
    settings: Settings


def process(record: Found, context: Context) -> list[IngestedRow | Reject]:
    """Read one record; a scene that is not a home in which something can run is refused."""
    with recognizing(knowledge(context.settings)):
        found = read(record["item"], record["source"], context.salt)
    for row in found:
        if not isinstance(row, Reject) and row["kind"] == "scene":
            scene_graphs.check(row, knowledge(context.settings))
    return found


def read(item: Item, source: str = "", salt: str = "") -> list[IngestedRow | Reject]:
    """Return the rows of an item, and a reject for each part of it that can't be read.

    Args:
        item: as found by `items`.
        source: the label of its source.
        salt: for the hashes of workers' ids.
    """
    found = READERS[item.reader](item, salt)
    return [row if isinstance(row, Reject) else {**row, "source": source} for row in found]


def prepare(settings: Settings) -> dict[str, Any]:
    """Begin anew where the last build had another salt; the plan has nothing by which a salt could be guessed."""
    if salt_changed(Path(settings.out), settings.salt):
        shutil.rmtree(settings.folder("ingest"), ignore_errors=True)
    return {}


def guesses(columns: Mapping[str, FieldColumns]) -> list[str]:
    """Return a sentence for each file whose columns or keys are not those of our own records."""
    return [shown(place, found) for place, found in columns.items() if found and not getattr(found, "is_ours", False)]


def write_scenes(job: Job, counts: Counts) -> None:
    """Write the scene graphs as homes; a name that two of them share is numbered."""
    folder = job.folder / DERIVED
    shutil.rmtree(folder, ignore_errors=True)
    taken: set[str] = set()
    for path in sorted(job.folder.glob("part-*.parquet")) if counts.tally["scene"] else ():
        for row in pq.read_table(path, columns=["title", "groundings"], filters=[("kind", "=", "scene")]).to_pylist():
            folder.mkdir(exist_ok=True)
            name = numbered(row["title"], taken)
            taken.add(name)
            write_home(inside(folder, f"{name}.json"), graph_of(row["groundings"][0]["start"]))


STAGE = Stage(
    name="ingest",
    tables={"": INGESTED},
    process=process,
    settings=("limit", "columns"),
    open=lambda job: Context(salt(job.settings), {}, job.settings),
    prepare=prepare,
    partitions=partitions,
    records=records,
    finish=write_scenes,
    facts=lambda job: {"columns": job.context.columns, "guesses": guesses(job.context.columns)},
    batch=lambda partition: max(RECORDS_CONVERTED, (partition.size or 0) // 16),
    labels=lambda row: (row["kind"],),
)
