"""The dataset card: `README.md` next to the tables, with the header that `datasets.load_dataset` reads."""

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import orjson
import pyarrow as pa

from hearth.datasets.format.croissant import SUMMARY
from hearth.datasets.format.datasheet import datasheet
from hearth.datasets.format.image_tables import FOLDER as IMAGES
from hearth.datasets.format.split_columns import PARTS
from hearth.datasets.format.splits import DESCENDED, LEFT_OUT
from hearth.repair.perturbation_strengths import MILD
from hearth.schemas.tables import TABLES, comment_of, nested
from hearth.storage.files import write_bytes
from hearth.version import ACTION_SET, VERSION

NAME = "README.md"


def write_card(folder: Path, strength: str = MILD) -> None:
    """Write the card of a dataset's folder: counts, tables and columns, ledger, splits and leakage, licences."""
    write_bytes(folder / NAME, "\n".join(card(folder, strength)).encode() + b"\n")


def card(folder: Path, strength: str) -> Iterator[str]:
    """Yield the lines of the card."""
    counts = {table: sum(_rows(path) for path in sorted((folder / table).glob("*.parquet"))) for table in TABLES}
    yield from _header(folder)
    yield from ("# Hearth", "", SUMMARY, "", f"Dataset version {VERSION}, action set {ACTION_SET}.", "")
    yield from ("## Use", "", "```python", "import hearth", 'ds = hearth.load(".")', *_USES, "```", "", _CROISSANT, "")
    yield from _datasheet(folder, strength)
    yield from _tables(counts)
    yield from ("## Where records went", "", *_ledger(folder), "")
    yield from _splits(folder)
    yield from ("## Where it comes from", "", *_sources(folder), "", *_LICENCE)


_USES = (
    'ds["PROGRAM_ID"].runs[0].final             # one program, its runs and their graphs',
    'ds.sql("SELECT action, count(*) FROM steps GROUP BY 1").df()',
    "",
    "from datasets import load_dataset",
    'folder = "PATH/OF/THIS/FOLDER"             # `datasets` 5 refuses "."',
    'load_dataset(folder)["train"]              # programs by split, without Hearth',
    'load_dataset(folder, "executions")["test"] # executions of these; likewise all that descends from programs',
    'load_dataset(folder, "frames")["train"]    # with the picture in the column `image`',
    'load_dataset(folder, "executions")["rows"] # all rows of a table, whatever their part',
)

_CROISSANT = (
    "`croissant.json` describes all tables with all nested fields; `mlcroissant` 1.1 reads programs with all steps and"
    " their objects, but of other lists within lists only the first entry, `load_dataset` and DuckDB all."
)

_LICENCE = ("MIT, as is every source that Hearth reads by default; records keep the licence of the source they name.",)


def _datasheet(folder: Path, strength: str) -> Iterator[str]:
    sheet = datasheet(folder, strength)
    yield from ("## Authors, method and purpose", "")
    for name in ("motivation", "composition", "process", "authors", "uses", "limits"):
        yield from (f"**{name.capitalize()}.** {sheet[name]}", "")
    yield from (sheet["thesis"], "", "```bibtex", sheet["bibtex"], "```", "")


def _rows(path: Path) -> int:
    import pyarrow.parquet as pq

    return int(pq.read_metadata(path).num_rows)


def _header(folder: Path) -> Iterator[str]:
    yield from ("---", "license: mit", "pretty_name: Hearth", "language: [en]", "tags: [planning, household, embodied]")
    yield "configs:"
    yield from _config(folder, "programs", _parts("programs"))
    yield "  default: true"
    yield from _config(folder, "programs_left_out", {f"programs/*.{LEFT_OUT}.parquet": ROWS})
    for table in (name for name in TABLES if name != "programs"):
        place = IMAGES if table == "frames" else table
        yield from _config(folder, table, {**(_parts(place) if table in DESCENDED else {}), f"{place}/*.parquet": ROWS})
    yield from ("---", "")


ROWS = "rows"
"""The split of all rows of a table, for `load_dataset`: the only one of tables that do not descend from programs."""


def _parts(place: str) -> dict[str, str]:
    """Return the part that the files of a pattern have, by pattern."""
    return {f"{place}/*.{part}.parquet": part for part in PARTS}


def _config(folder: Path, name: str, files: dict[str, str]) -> Iterator[str]:
    """Yield a table for `load_dataset`, with its splits by patterns of files; it fails at splits without a row."""
    found = {pattern: split for pattern, split in files.items() if any(map(_rows, folder.glob(pattern)))}
    if found:
        yield from (f"- config_name: {name}", "  data_files:")
        for pattern, split in found.items():
            yield from (f"  - split: {split}", f'    path: "{pattern}"')


def _tables(counts: dict[str, int]) -> Iterator[str]:
    yield from ("## Tables", "")
    for table, schema in TABLES.items():
        yield from (f"### {table} ({counts[table]:,} rows)", "", comment_of(schema), "", *columns(schema), "")


def columns(schema: pa.Schema) -> Iterator[str]:
    """Yield a table of the columns and nested fields, with their types and meanings."""
    yield from ("| column | type | meaning |", "|---|---|---|")
    for path, field in (each for column in schema for each in nested(column)):
        kind = re.sub(r"<.*", "", str(field.type)).replace("string", "text")
        yield f"| `{path}` | {kind} | {_cell(comment_of(field))} |"


def _ledger(folder: Path) -> Iterator[str]:
    import pyarrow.parquet as pq

    yield from (
        "| stage | in | went on | refused | parts refused | rows | records are | why |",
        f"|---|{'--:|' * 5}---|---|",
    )
    for row in pq.ParquetFile(folder / "ledger/part-00000.parquet").read().to_pylist():
        why = ", ".join(f"{each['code']} {each['count']:,}" for each in row["codes"])
        counts = ("records_in", "records_through", "records_rejected", "partial_rejects", "rows")
        numbers = " | ".join(f"{row[name]:,}" for name in counts)
        yield f"| {row['stage']} | {numbers} | {row['record']} | {_cell(why)} |"


def _splits(folder: Path) -> Iterator[str]:
    splits: dict[str, Any] = orjson.loads((folder / "splits.json").read_bytes())["splits"]
    yield from ("## Splits", "", _SPLITS, "")
    for name, split in splits.items():
        parts = ", ".join(f"{part} {number:,}" for part, number in split["runs"].items())
        without = f"{split['runs_without_part']:,} without a part"
        yield f"- `{name}`: {split['rule']}. Executions: {parts}; {without}. {_leaks(split)}"
    yield from ("", "## Executions that fail", "", *_FAILURES, "")


_SPLITS = (
    "Table `splits` has the part of every execution that ran to its end in every split, null where the split has no"
    " place for it. `programs.split` is the part in `activities`, by which `load_dataset` gives programs and all that"
    " descends from them: an execution, a repair or a picture is in its program's part, a clip in the `part` that it"
    " names. The split `rows` of a table has all of its rows, those of programs without a part as well."
)

_FAILURES = (
    "An original that fails in a perturbed environment is an execution of its own, with `executable` false and a typed",
    "failure; `perturbations` has each perturbation of the environment and its effect, `repairs` the repairs that",
    "followed. Such executions are in no split. `hearth.load(..., failures=True)`, `export --failures` and",
    "`score dataset --failures` have them; otherwise runs, tensors and scores are of executions that ran to their end.",
)


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
