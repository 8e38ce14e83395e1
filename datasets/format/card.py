"""The dataset card: `README.md` beside the tables, with the header that `datasets.load_dataset` reads."""

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import orjson

from hearth.datasets.format.croissant import SUMMARY
from hearth.schemas.tables import TABLES
from hearth.storage.files import write_bytes
from hearth.version import ACTION_SET, VERSION

NAME = "README.md"


def write_card(folder: Path) -> None:
    """Write the card of a dataset's folder: counts, tables and columns, ledger, splits and leakage, licences."""
    write_bytes(folder / NAME, "\n".join(card(folder)).encode() + b"\n")


def card(folder: Path) -> Iterator[str]:
    """The lines of the card."""
    counts = {table: sum(_rows(path) for path in sorted((folder / table).glob("*.parquet"))) for table in TABLES}
    yield from _header(counts)
    yield from ("# Hearth", "", SUMMARY, "", f"Dataset version {VERSION}, action set {ACTION_SET}.", "")
    yield from ("## Use", "", "```python", "import hearth", 'ds = hearth.load(".")', *_USES, "```", "")
    yield from _tables(counts)
    yield from ("## Where records went", "", *_ledger(folder), "")
    yield from _splits(folder)
    yield from ("## Where it comes from", "", *_sources(folder), "", *_LICENCE)


_USES = (
    'ds["PROGRAM_ID"].runs[0].final          # one program, its runs and their graphs',
    'ds.sql("SELECT action, count(*) FROM steps GROUP BY 1").df()',
    "",
    "from datasets import load_dataset",
    'load_dataset(".", "programs")            # any table, without Hearth',
)

_LICENCE = (
    "MIT, as is every source that Hearth reads by default; records keep the licence of the source they name.",
    "Ids of workers are salted hashes; the salt is not published.",
)


def _rows(path: Path) -> int:
    import pyarrow.parquet as pq

    return int(pq.read_metadata(path).num_rows)


def _header(counts: dict[str, int]) -> Iterator[str]:
    yield from ("---", "license: mit", "pretty_name: Hearth", "language: [en]", "tags: [planning, household, embodied]")
    yield "configs:"
    for table in TABLES:
        yield f"- config_name: {table}"
        yield f'  data_files: "{table}/*.parquet"'
        if table == "programs":
            yield "  default: true"
    yield from ("---", "")


def _tables(counts: dict[str, int]) -> Iterator[str]:
    yield from ("## Tables", "")
    for table, schema in TABLES.items():
        yield from (f"### {table} ({counts[table]:,} rows)", "", "| column | type | meaning |", "|---|---|---|")
        for column in schema:
            comment = (column.metadata or {}).get(b"comment", b"").decode()
            kind = str(column.type).split("<")[0].replace("string", "text")
            yield f"| `{column.name}` | {kind} | {_cell(comment)} |"
        yield ""


def _ledger(folder: Path) -> Iterator[str]:
    import pyarrow.parquet as pq

    yield from ("| stage | in | went on | refused | why |", "|---|--:|--:|--:|---|")
    for row in pq.ParquetFile(folder / "ledger/part-00000.parquet").read().to_pylist():
        why = ", ".join(f"{each['code']} {each['count']:,}" for each in row["codes"])
        numbers = (row["records_in"], row["records_through"], row["records_rejected"])
        yield f"| {row['stage']} | {' | '.join(f'{number:,}' for number in numbers)} | {_cell(why)} |"


def _splits(folder: Path) -> Iterator[str]:
    splits: dict[str, Any] = orjson.loads((folder / "splits.json").read_bytes())["splits"]
    yield from ("## Splits", "", "Table `splits` has the part of every execution in every split.", "")
    for name, split in splits.items():
        parts = ", ".join(f"{part} {number:,}" for part, number in split["runs"].items())
        yield f"- `{name}`: {split['rule']}. Executions: {parts}. {_leaks(split)}"
    yield ""


def _leaks(split: dict[str, Any]) -> str:
    mine, random = split["leakage"], split["at_random"]
    kinds = {"siblings": "siblings", "steps": "near-duplicate steps", "texts": "near-duplicate texts"}
    leaks = (f"{kinds[kind]} {mine[kind]:,} (random split: {random[kind]:,})" for kind in kinds)
    return f"Of {mine['programs']:,} test programs, those with a relative in train: {', '.join(leaks)}."


def _sources(folder: Path) -> Iterable[str]:
    import pyarrow.parquet as pq

    counts: dict[tuple[str, str], int] = {}
    for path in sorted((folder / "programs").glob("part-*.parquet")):
        table = pq.ParquetFile(path).read(columns=["origin", "source"])
        for pair in zip(table["origin"].to_pylist(), table["source"].to_pylist(), strict=True):
            counts[pair] = counts.get(pair, 0) + 1
    yield from ("| origin | source | programs |", "|---|---|--:|")
    for (origin, source), number in sorted(counts.items(), key=lambda item: (item[0][0] or "", item[0][1] or "")):
        yield f"| {_cell(origin)} | {_cell(source)} | {number:,} |"


def _cell(text: str | None) -> str:
    return (text or "").replace("|", "\\|").replace("\n", " ")
