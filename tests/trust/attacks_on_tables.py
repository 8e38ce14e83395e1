"""Attacks by tables: of datasets whose manifests fit them, and of published challenges; and files of predictions."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
from attack import Attack, Ground

from hearth.datasets.dataset import Dataset
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.tables import TABLES
from hearth.storage.manifest import NAME

PROGRAM = (
    "Read a book\nOn the sofa.\n\n\n[Walk] <novel> (1)\n[Grab] <novel> (1)\n[Walk] <sofa> (1)\n[Sit] <sofa> (1)\n"
    "[Read] <novel> (1)\n"
)
Place = tuple[Any, ...]
"""The place of a value in a row: names of columns and fields, and numbers within lists."""


@cache
def _made() -> tuple[TemporaryDirectory[str], Path]:
    """A small dataset with augmented programs."""
    from hearth.pipelines.build import build

    made = TemporaryDirectory()
    source = Path(made.name) / "read.txt"
    source.write_text(PROGRAM)
    build([str(source)], str(Path(made.name) / "out"), homes=("maple",), pictures=0, variants=2)
    return made, Path(made.name) / "out/publish"


def small(folder: Path) -> Path:
    """A copy of a small dataset."""
    return Path(shutil.copytree(_made()[1], folder))


def signed(folder: Path) -> Path:
    """The folder, whose manifest now has the digests of its files, as somebody who can run Hearth makes it."""
    document = json.loads((folder / NAME).read_bytes())
    for name in document["files"]:
        data = (folder / name).read_bytes()
        document["files"][name] = {"bytes": len(data), "sha256": sha256(data).hexdigest()}
    (folder / NAME).write_text(json.dumps(document))
    return folder


def put(folder: Path, table: str, place: Place, bad: Any) -> Path:
    """Replace a value in the first row of a table that has that place."""
    (path,) = sorted((folder / table).glob("*.parquet"))[:1]
    schema = TABLES[table]
    rows = pq.read_table(path).to_pylist()
    for row in rows:
        inner: Any = row
        for step in place[:-1]:
            fits = isinstance(inner, dict) or (isinstance(inner, list) and step < len(inner))
            inner = inner[step] if fits else None
        if isinstance(inner, dict) or (isinstance(inner, list) and inner):
            inner[place[-1]] = bad
            break
    pq.write_table(pa.Table.from_pylist(rows, schema), path)
    return signed(folder)


def places(kind: Any, before: Place) -> Iterator[tuple[Place, Any]]:
    """The places within a column, with their types."""
    yield before, kind
    if pa.types.is_list(kind):
        yield from places(kind.value_type, (*before, 0))
    elif pa.types.is_struct(kind):
        for field in kind:
            yield from places(field.type, (*before, field.name))


def bad_of(kind: Any) -> tuple[Any, ...]:
    """Values that no build writes, of a type."""
    if pa.types.is_string(kind):
        return "x", None, "", "../../guard/x", "9" * 5_000, "ON", "\x1b[2J"
    if pa.types.is_integer(kind):
        return 2**31 - 1, None, -1, 0
    if pa.types.is_floating(kind):
        return float("nan"), None, float("inf"), -1e308
    return ([], None, [None]) if pa.types.is_list(kind) else (None,)


@cache
def changes() -> tuple[tuple[str, Place, Any], ...]:
    """Every change of one value: table, place, value."""
    return tuple(
        (table, place, bad)
        for table, schema in TABLES.items()
        if any((_made()[1] / table).glob("*.parquet"))
        for field in schema
        for place, kind in places(field.type, (field.name,))
        for bad in bad_of(kind)
    )


def _asked(folder: Path, aside: Path) -> Iterator[tuple[str, Callable[[], Any]]]:
    """All that reads a dataset's tables, by name."""
    from hearth.analysis.augmentation_results import figures
    from hearth.datasets.diff import compare
    from hearth.datasets.export.formats import FORMATS, export
    from hearth.datasets.published_programs import programs
    from hearth.datasets.report.report_writer import write_report
    from hearth.datasets.verify import verify
    from hearth.scoring.dataset_scores import score_dataset

    dataset = Dataset.open(folder, failures=True)
    yield "verify", lambda: verify(folder)
    yield "entries", lambda: [_entry(dataset, name) for name in list(dataset)[:2]]
    yield "tensors", lambda: dataset.to_tensors(list(dataset)[:2])
    for form in FORMATS.keys() - {"graphml"}:  # it reads what `networkx` does, and takes seconds to write
        yield form, lambda form=form: export(dataset, form, aside / form)  # type: ignore[misc]
    yield "report", lambda: write_report(dataset, aside / "report", replays=1)
    yield "diff", lambda: compare(_made()[1], folder)
    yield "figures", lambda: figures(folder)
    yield "mine", lambda: list(programs(folder))
    predicted = aside / "predicted.jsonl"
    predicted.write_text(json.dumps({"program_id": "text:read.txt", "predicted": PROGRAM}))
    yield "score", lambda: score_dataset(dataset, predicted)


def _entry(dataset: Dataset, name: str) -> Any:
    found = dataset[name]
    graphs = [(run.start, run.final, run.conditions, run.release_json()) for run in found.runs]
    return found.program, found.sketches, len(graphs)


def read_all(folder: Path, aside: Path, names: Sequence[str] = ()) -> list[Any]:
    """Everything that is asked of a dataset, or some of it; each may be refused.

    Raises:
        AssertionError: one ended otherwise, by its name.
    """
    found: list[Any] = []
    aside.mkdir(exist_ok=True)
    for name, ask in _asked(folder, aside):
        if names and name not in names:
            continue
        try:
            found.append(ask())
        except HearthError as error:
            found.append(error.diagnostics)
        except Exception as error:
            raise AssertionError(f"{name}: {type(error).__name__}: {str(error)[:60]}") from error
    return found


def other_forms(folder: Path, table: str, form: str) -> Path:
    """Give a table another form than any build writes, under a manifest that fits it."""
    (path,) = sorted((folder / table).glob("*.parquet"))[:1]
    found = pq.read_table(path)
    text = next((field.name for field in found.schema if pa.types.is_string(field.type)), found.column_names[0])
    written = {"garbage": b"PAR1" + b"x" * 100 + b"PAR1", "sizes": path.read_bytes().replace(*_SIZES)}
    if form in written:
        path.write_bytes(written[form])
        return signed(folder)
    forms: dict[str, Callable[[], pa.Table]] = {
        "no rows": lambda: found.slice(0, 0),
        "twice": lambda: pa.concat_tables([found, found]),
        "a column less": lambda: found.drop_columns([text]),
        "a column twice": lambda: found.append_column(text, found[text]),
        "numbers": lambda: found.set_column(0, found.column_names[0], pa.array(range(len(found)))),
        "dictionary": lambda: found.set_column(
            found.column_names.index(text), text, found[text].combine_chunks().dictionary_encode()
        ),
        "bytes": lambda: found.set_column(found.column_names.index(text), text, found[text].cast(pa.binary())),
        "dates": lambda: found.append_column("when", pa.array([2**40] * len(found), pa.timestamp("s"))),
        "backwards": lambda: found.select(found.column_names[::-1]),
    }
    pq.write_table(forms[form](), path)
    return signed(folder)


FORMS = (
    "garbage", "no rows", "twice", "a column less", "a column twice", "numbers", "dictionary", "bytes", "dates",
    "backwards", "sizes",
)  # fmt: skip

_SIZES = b"\x15\x0c\x19", b"\x15\x00\x19"
"""A column of texts in a footer, and one of truth values: its statistics of sizes no longer fit it."""

EVERY = 17
"""Of the changes of one value, attacks are every seventeenth; fuzzing draws from all."""


def tables() -> Iterator[Attack]:
    """Datasets, challenges and predictions whose tables are as no command writes them."""
    yield Attack("tables", "as it is", _whole)
    for table, place, bad in changes()[::EVERY]:
        title = f"{table}.{'.'.join(map(str, place))[:40]} = {bad!r:.16}"
        yield Attack("tables", title, lambda ground, t=table, p=place, b=bad: _read(
            ground, lambda folder: put(folder, t, p, b)))  # fmt: skip
    for number, table in enumerate(table for table in TABLES if any((_made()[1] / table).glob("*.parquet"))):
        for form in FORMS if table in ("programs", "executions", "environments") else FORMS[number % 3 :: 3]:
            yield Attack("tables", f"{table}: {form}", lambda ground, t=table, f=form: _read(
                ground, lambda folder: other_forms(folder, t, f)))  # fmt: skip
    for name in COLUMNS:
        yield Attack("tables", f"a column {name[:40]!a}", lambda ground, n=name: _read(
            ground, lambda folder: _column(folder, n.replace("{guard}", str(ground.guard)))))  # fmt: skip
    for target in ("pipe", "/dev/zero", "loop", ".", "text"):
        yield Attack("tables", f"a challenge's table -> {target}", lambda ground, t=target: _challenge(ground, t))
    for file in FILMS:
        yield Attack("tables", f"a film called {file!a:.30}", lambda ground, f=file: served_films(ground, f))
    yield Attack("tables", "a film of no program", lambda ground: served_films(ground, FILMS[0], "x"))
    yield from _predictions()


def _whole(ground: Ground) -> None:
    """Check that the dataset verifies as long as nothing is changed."""
    from hearth.datasets.verify import verify

    assert not verify(signed(small(ground.folder / "dataset"))).faults, "it is not as it was"


def _read(ground: Ground, change: Callable[[Path], Path]) -> Any:
    return read_all(change(small(ground.folder / "dataset")), ground.folder / "aside")


COLUMNS = (
    "x'], lambda name: name IS NOT NULL) AS differing FROM a JOIN b ON true) a; COPY (SELECT 1) TO '{guard}/x'; --",
    'x", (SELECT content FROM read_text(\'{guard}/secret.csv\')) AS "y', "x\"; COPY (SELECT 1) TO '{guard}/x'; --",
    "", "'", '"', "a\x1b[2J", "x" * 9_000,
)  # fmt: skip
"""Names of columns that are SQL, or nothing."""


def _column(folder: Path, name: str) -> Path:
    """A further column in every file of programs."""
    for path in sorted((folder / "programs").glob("*.parquet")):
        found = pq.read_table(path)
        pq.write_table(found.append_column(name, pa.array(["x"] * len(found))), path)
    return signed(folder)


FILMS: tuple[Any, ...] = (
    "films/true.webm", "../guard/secret.webm", "{guard}/secret.webm", "/dev/zero", "films/pipe.webm", "films/loop.webm",
    "films/out.webm", "films", "", "x\0.webm", "n" * 400 + ".webm", "programs/x.parquet", "manifest.json", None,
)  # fmt: skip
"""Values of rows that name films."""


def served_films(ground: Ground, file: Any, program: str = "") -> Any:
    """The films of a dataset that the server would show: each is a file of its folder."""
    from hearth.web.annotate.annotation_marks import films_of

    folder = small(ground.folder / "dataset")
    (ground.guard / "secret.webm").write_bytes(b"x")
    try:
        name, films = (
            next(iter(Dataset.open(folder).rows("SELECT execution_id FROM executions")[1]))[0],
            folder / "films",
        )
        films.mkdir(exist_ok=True)
        (films / "true.webm").write_bytes(b"x")
        os.mkfifo(films / "pipe.webm")
        (films / "loop.webm").symlink_to("loop.webm")
        (films / "out.webm").symlink_to(ground.guard / "secret.webm")
        given = file.replace("{guard}", str(ground.guard)) if isinstance(file, str) else file
        row = {**{field.name: None for field in TABLES["videos"]}, "execution_id": name, "file": given}
        (path,) = (folder / "videos").glob("*.parquet")
        pq.write_table(pa.Table.from_pylist([row], TABLES["videos"]), path)
        if program:
            put(folder, "executions", ("program_id",), program)
        found = films_of(folder)
        assert all(each.path.resolve().is_relative_to(folder.resolve()) for each in found.values())
        return list(found)
    finally:
        (ground.guard / "secret.webm").unlink()


def _challenge(ground: Ground, target: str) -> Any:
    """A published challenge, one of whose tables is something else."""
    from hearth.challenges.challenge_dataset import TABLES as OF_CHALLENGES
    from hearth.challenges.challenge_dataset import ChallengeData

    folder = ground.folder / "challenge"
    folder.mkdir()
    (folder / NAME).write_text('{"stage": "challenge", "format": 2, "files": {}}')
    for table, schema in OF_CHALLENGES.items():
        pq.write_table(schema.empty_table(), folder / f"{table}.parquet")
    file = folder / "tasks.parquet"
    file.unlink()
    if target == "pipe":
        os.mkfifo(file)
    elif target == "text":
        file.write_text("PAR1")
    elif target == ".":
        file.mkdir()
    else:
        file.symlink_to(file if target == "loop" else target)
    found = ChallengeData.found(folder)
    return found and found.rows("SELECT * FROM tasks")


def predictions() -> bytes:
    """A true file of predictions, as Parquet."""
    from io import BytesIO

    held = BytesIO()
    step = {"action": "Sleep", "objects": [{"name": "bed", "instance": 1, "node": 5}], "agent": 0, "joins": False}
    rows = [{"id": "a", "predicted": [step], "reference": "[Sleep]", "home": "maple", "tl_goal": "ON(television)"}]
    pq.write_table(pa.Table.from_pylist(rows), held)
    return held.getvalue()


def scored(path: Path) -> Any:
    """The scores of a file of predictions."""
    from hearth.kb.loading.load import default
    from hearth.scoring.environments import by_row
    from hearth.scoring.evaluate import evaluate
    from hearth.scoring.predictions import read_pairs

    pairs = read_pairs(path)
    return evaluate(pairs, default(), by_row(path, default()))


def _values() -> dict[str, Any]:
    """Columns that no predictions have."""
    return {
        "a date far away": pa.array([2**40], pa.timestamp("s")), "a day far away": pa.array([2**30], pa.date32()),
        "a time in no zone": pa.array([0], pa.timestamp("us", tz="Nowhere/X")), "bytes": pa.array([b"\xff\xfe"]),
        "a map": pa.array([[("a", 1)]], pa.map_(pa.string(), pa.int64())), "half": pa.array([1.0], pa.float16()),
        "a dictionary": pa.array(["a"]).dictionary_encode(), "lists": pa.array([[[["a"]]]]),
        "a decimal": pa.array([None], pa.decimal256(70, 2)), "huge": pa.array([2**63 - 1]),
        "broken text": pa.Array.from_buffers(pa.string(), 1, pa.array([b"\xff\xfe"]).buffers()),
        "steps": pa.array([[{"action": "Sleep", "objects": [{"name": "bed", "instance": 2**60, "node": -5}]}]]),
    }  # fmt: skip


def _predictions() -> Iterator[Attack]:
    def score(ground: Ground, columns: dict[str, Any]) -> Any:
        path = ground.folder / "predictions.parquet"
        pq.write_table(pa.table(columns), path)
        return scored(path)

    plain = {"id": pa.array(["x"]), "predicted": pa.array(["[Sleep]"]), "reference": pa.array(["[Sleep]"])}
    for name, values in _values().items():
        for column in (*plain, "graph", "home", "tl_goal", "x"):
            yield Attack("tables", f"predictions: {column} is {name}", lambda ground, c=column, v=values: score(
                ground, {**plain, c: v}))  # fmt: skip
    for rows in (2_000_000, 20_000_000):
        yield Attack("tables", f"predictions: {rows:,} rows of nothing", lambda ground, r=rows: score(
            ground, dict.fromkeys(plain, pa.nulls(r, pa.string()))))  # fmt: skip
    text = pa.DictionaryArray.from_arrays(pa.array([0] * 40_000, pa.int32()), pa.array(["x" * (1 << 20)]))
    yield Attack("tables", "predictions: 40 gigabytes of one text", lambda ground: score(
        ground, {**dict.fromkeys(plain, text)}))  # fmt: skip
