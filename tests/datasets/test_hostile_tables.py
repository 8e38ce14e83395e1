"""Tables of strangers whose manifests fit them: what no build writes is refused, and names of columns are no SQL."""

from __future__ import annotations

import json
import os
import shutil
from hashlib import sha256

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from hearth.analysis.augmentation_results import figures
from hearth.challenges.challenge_dataset import ChallengeData
from hearth.datasets.dataset import Dataset
from hearth.datasets.diff import compare
from hearth.datasets.export.formats import export
from hearth.datasets.published_programs import programs
from hearth.datasets.report.report_writer import write_report
from hearth.datasets.verify import verify
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.tables import TABLES
from hearth.web.annotate.annotation_marks import films_of


@pytest.fixture
def copy(made, tmp_path):
    return shutil.copytree(made.out / "publish", tmp_path / "copy")


def rewritten(folder, table, change):
    """The folder with other files of a table, under a manifest that fits them."""
    document = json.loads((folder / "manifest.json").read_bytes())
    for path in sorted((folder / table).glob("*.parquet")):
        changed = change(pq.read_table(path))
        if isinstance(changed, bytes):
            path.write_bytes(changed)
        else:
            pq.write_table(changed, path)
        data = path.read_bytes()
        name = path.relative_to(folder).as_posix()
        document["files"][name] = {"bytes": len(data), "sha256": sha256(data).hexdigest()}
    (folder / "manifest.json").write_text(json.dumps(document))
    return folder


def test_names_of_columns_are_no_sql(made, copy, tmp_path):
    written = tmp_path / "written.csv"
    name = (
        "x'], lambda name: name IS NOT NULL) AS differing FROM a JOIN b ON true) a; "
        f"COPY (SELECT 42 AS z) TO '{written}'; --"
    )
    for odd in (name, 'x", (SELECT 1) AS "y'):
        folder = shutil.copytree(copy, tmp_path / str(len(odd)))
        rewritten(folder, "programs", lambda table, odd=odd: table.append_column(odd, pa.array([1] * len(table))))
        found = next(each for each in compare(made.out, folder) if each.table == "programs")
        assert {column for row in found.changed for column in row.columns} == {odd}
        assert not written.exists()


OTHERS = {
    "garbage": lambda table: b"PAR1" + b"x" * 100 + b"PAR1",
    "a column twice": lambda table: table.append_column("program_id", table["program_id"]),
    "bytes": lambda table: table.set_column(
        table.column_names.index("title"), "title", table["title"].cast(pa.binary())
    ),
    "a column less": lambda table: table.drop_columns(["program_id"]),
}


@pytest.mark.parametrize("form", OTHERS)
def test_tables_of_other_forms(made, copy, tmp_path, form):
    rewritten(copy, "programs", OTHERS[form])
    assert {fault.code for fault in verify(copy).faults} <= {Code.BAD_TABLE, Code.DAMAGED_FILE}
    assert verify(copy).faults
    dataset = Dataset.open(copy)
    for ask in (
        lambda: compare(made.out, copy),
        lambda: export(dataset, "jsonl", tmp_path / "lines"),
        lambda: export(dataset, "code", tmp_path / "code"),
        lambda: write_report(dataset, tmp_path / "report"),
        lambda: figures(copy),
        lambda: list(programs(copy)),
    ):
        try:
            ask()
        except HearthError as error:
            assert error.diagnostics[0].code in (Code.DAMAGED_FILE, Code.BAD_TABLE, Code.SYNTAX), error


def test_an_execution_by_rules_that_nobody_knows(copy, tmp_path):
    def changed(table):
        rows = [{**row, "rules": "x"} for row in table.to_pylist()]
        return pa.Table.from_pylist(rows, table.schema)

    rewritten(copy, "executions", changed)
    with pytest.raises(HearthError) as caught:
        export(Dataset.open(copy), "pddl", tmp_path / "pddl")
    assert caught.value.diagnostics[0].code == Code.DAMAGED_FILE


def test_steps_of_other_kinds_are_not_mined(tmp_path):
    for steps in ([["x"]], [[{"action": 1, "objects": []}]], [[{"action": "Sleep", "objects": [{"name": None}]}]]):
        pq.write_table(pa.table({"steps": pa.array(steps)}), tmp_path / "programs.parquet")
        with pytest.raises(HearthError) as caught:
            list(programs(tmp_path))
        assert caught.value.diagnostics[0].code == Code.BAD_TABLE


def test_a_challenge_whose_table_is_a_pipe_is_not_waited_for(tmp_path):
    (tmp_path / "manifest.json").write_text('{"stage": "challenge", "format": 2, "files": {}}')
    os.mkfifo(tmp_path / "tasks.parquet")
    data = ChallengeData.found(tmp_path)
    assert data is not None
    with pytest.raises(HearthError) as caught:
        data.rows("SELECT 1")
    assert caught.value.diagnostics[0].code == Code.DAMAGED_FILE


def test_films_of_programs_that_there_are_not_are_not_shown(copy):
    films_of.cache_clear()
    (name,) = Dataset.open(copy).rows("SELECT min(execution_id) FROM executions")[1][0]
    (copy / "films").mkdir(exist_ok=True)
    (copy / "films/a.webm").write_bytes(b"x")
    row = {**dict.fromkeys(TABLES["videos"].names), "execution_id": name, "file": "films/a.webm"}
    rewritten(copy, "videos", lambda _: pa.Table.from_pylist([row], TABLES["videos"]))
    assert list(films_of(copy)) == [name]
    films_of.cache_clear()
    rewritten(copy, "executions", lambda table: table.set_column(
        table.column_names.index("program_id"), "program_id", pa.array(["x"] * len(table))))  # fmt: skip
    with pytest.raises(HearthError) as caught:
        films_of(copy)
    assert caught.value.diagnostics[0].code == Code.DAMAGED_FILE


def test_code_that_is_written_has_numbers_of_agents_alone(copy, tmp_path):
    def changed(table):
        rows = table.to_pylist()
        for row in rows:
            for step in row["steps"]:
                step["agent"] = "1); import os; os.abort("
        kind = table.schema.field("steps").type.value_type
        step = pa.struct([field if field.name != "agent" else pa.field("agent", pa.string()) for field in kind])
        columns = {name: [row[name] for row in rows] for name in table.column_names}
        types = {field.name: field.type if field.name != "steps" else pa.list_(step) for field in table.schema}
        return pa.table({name: pa.array(values, types[name]) for name, values in columns.items()})

    rewritten(copy, "programs", changed)
    with pytest.raises(HearthError) as caught:
        export(Dataset.open(copy), "code", tmp_path / "code")
    assert caught.value.diagnostics[0].code == Code.DAMAGED_FILE
    assert not (tmp_path / "code/programs.py").exists()
