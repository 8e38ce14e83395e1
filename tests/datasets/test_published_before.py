"""Datasets of format 1, as versions 0.1 and 0.2 published them: whatever reads datasets goes on reading them.

They have the crowd's answers and `evening.txt` of `tests/golden/pipelines/input` in the cabin, and no pictures; that of
0.1 one perturbation each, that of 0.2 three, of which some led to no program. `0.1.json` is what 0.1 read in its own:
the lines of its programs, and a digest of each graph they go through. None is made anew: a change of format needs a
reader of these, and gets an archive of its own.
"""

from __future__ import annotations

import hashlib
import json
import re
import shutil
import tarfile
from pathlib import Path

import duckdb
import pyarrow.parquet as pq
import pytest
from hostile_datasets import rewrite
from typer.testing import CliRunner

import hearth
from hearth import cli
from hearth.datasets.diff import compare
from hearth.datasets.export.formats import FORMATS, export
from hearth.datasets.export.program_batches import Wanted
from hearth.datasets.format.catalog import earlier
from hearth.datasets.report.report_writer import write_report
from hearth.datasets.verify import verify
from hearth.kb.loading.load import default
from hearth.pipelines.build import build
from hearth.schemas.syntax import print_lines
from hearth.schemas.tables import TABLES
from hearth.scoring.dataset_scores import score_dataset
from hearth.scoring.evaluate import summarise
from hearth.storage.files import file_digest

GOLDEN = Path(__file__).resolve().parents[1] / "golden"


RUNS_AND_ROWS = {"0.1": (5, 834), "0.2": (9, 871)}


@pytest.fixture(scope="module", params=RUNS_AND_ROWS)
def version(request):
    return request.param


@pytest.fixture(scope="module")
def folder(tmp_path_factory, version):
    to = tmp_path_factory.mktemp("before")
    with tarfile.open(GOLDEN / f"datasets/{version}.tar.xz") as archive:
        archive.extractall(to, filter="data")
    return to / f"dataset-{version}"


@pytest.fixture(scope="module")
def ds(folder):
    return hearth.load(folder)


def digest(graph):
    return hashlib.sha256(json.dumps(graph, sort_keys=True).encode()).hexdigest()[:16]


def test_every_execution_runs_as_it_did(folder, version):
    found = verify(folder)
    assert found.faults == ()
    assert (found.executions, found.rows) == RUNS_AND_ROWS[version]


def test_it_was_made_with_our_knowledge(ds, version):
    assert ("knowledge" in ds.manifest) == (version != "0.1")
    assert ds.knowledge is default()


def test_a_run_without_part_has_none_as_now(ds, folder):
    stored = duckdb.sql(
        f"SELECT count(*) FROM read_parquet('{folder}/splits/*.parquet') WHERE part = 'none'"
    ).fetchall()
    found = ds.rows("SELECT count(*) FILTER (part IS NULL), count(*) FILTER (part = 'none') FROM splits")[1]
    assert found == [(*stored[0], 0)] != [(0, 0)]


def test_a_column_that_it_lacks_is_named(folder, tmp_path, version):
    copy = shutil.copytree(folder, tmp_path / "copy")
    for path in (copy / "splits").glob("*.parquet"):
        pq.write_table(pq.read_table(path).drop_columns(["part"]), path)
        content = json.loads((copy / "manifest.json").read_text())
        content["files"][f"splits/{path.name}"] = {"bytes": path.stat().st_size, "sha256": file_digest(path)}
        (copy / "manifest.json").write_text(json.dumps(content))
    assert [fault.message for fault in verify(copy).faults] == ["other columns than the table's: part"]


def test_programs_and_graphs_are_what_they_were(ds, version):
    found = {}
    for name in ds:
        runs = {
            run.row["execution_id"]: [digest(run.release_json(tick)) for tick in range(len(run.row["ticks"]) + 1)]
            for run in ds[name].runs
        }
        found[name] = {"lines": list(print_lines(ds[name].program)), "runs": runs}
    assert found == json.loads((GOLDEN / f"datasets/{version}.json").read_text())


def test_its_own_catalog_answers_plain_duckdb_as_ours_does(folder, ds):
    with duckdb.connect(folder / "catalog.duckdb", read_only=True) as plain:
        plain.execute("SET file_search_path = ?", [str(folder)])
        for table in TABLES.keys() - {name for name, then in earlier(1).items() if then.get("absent")}:
            query = f"SELECT count(*) FROM {table}"
            assert plain.execute(query).fetchall() == ds.rows(query)[1]
        for query in (
            "SELECT program_id, program_text(program_id) FROM programs ORDER BY ALL",
            "SELECT * FROM graph_edges('crowd:P4@cabin/0', 4) ORDER BY ALL",
            "SELECT execution_id, number, agent, action FROM steps JOIN executions USING (program_id) ORDER BY ALL",
            "SELECT * FROM final_state('text:evening.txt@cabin/0') ORDER BY ALL",
        ):
            rows = plain.execute(query).fetchall()
            assert rows and rows == ds.rows(query)[1]


def test_its_programs_are_perfect_references(ds, tmp_path):
    rows = [
        {"id": run.row["execution_id"], "predicted": list(print_lines(ds[name].program))}
        for name in ds
        for run in ds[name].runs
    ]
    (tmp_path / "mine.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows))
    found = summarise(score_dataset(ds, tmp_path / "mine.jsonl"))
    assert found.count == len(rows) == len(ds.read("SELECT execution_id FROM executions"))
    assert {name: value.mean for name, value in found.means.items()} == dict.fromkeys(found.means, 1.0)


@pytest.mark.parametrize("form", sorted({*FORMATS} - {"coco"}))
def test_every_form_can_be_exported(ds, tmp_path, form):
    assert export(ds, form, tmp_path / form)


def test_it_has_no_pictures_to_be_exported(ds, tmp_path):
    with pytest.raises(hearth.HearthError, match="NOT_RENDERED: no picture with a mask"):
        export(ds, "coco", tmp_path / "coco")


def test_it_is_reported(ds, tmp_path):
    assert write_report(ds, tmp_path / "report")


@pytest.fixture(scope="module")
def ours(folder, tmp_path_factory):
    """The same, with ids as the embedded corpus had them."""
    copy = shutil.copytree(folder, tmp_path_factory.mktemp("ours") / "dataset")
    renamed(copy, r"\bcrowd:([PD])(?=\d)", lambda found: f"crowd:3{found[1]}0001A2SM")
    return copy


def renamed(folder, pattern, by):
    """Replace a pattern in every text of a dataset's tables."""
    for table in TABLES:
        rewrite(folder, table, lambda row: json.loads(re.sub(pattern, by, json.dumps(row))))


@pytest.mark.parametrize("version", ["0.1"], indirect=True)
@pytest.mark.parametrize("end", ["", "+cabin.0"])
def test_ids_of_the_embedded_corpus_are_found_under_both_names(ours, end, tmp_path):
    ds, name = hearth.load(ours), f"written:3P0001A2SM1{end}"
    assert name in ds and "written:3P0001A2SM9" not in ds
    assert ds[name].row == ds[f"crowd:3P0001A2SM1{end}"].row
    assert [run.row["execution_id"] for run in ds[name].runs] == [f"crowd:3P0001A2SM1{end}@cabin/0"]
    assert export(ds, "nl", tmp_path / "out", Wanted((name,))) == 1
    row = {"id": f"{name}@cabin/0", "predicted": list(print_lines(ds[name].program))}
    (tmp_path / "mine.jsonl").write_text(json.dumps(row) + "\n")
    scored = [each.pair.id for each in score_dataset(ds, tmp_path / "mine.jsonl") if not each.missing]
    assert scored == [f"crowd:3P0001A2SM1{end}@cabin/0"]


@pytest.mark.parametrize("version", ["0.1"], indirect=True)
def test_the_embedded_corpus_becomes_written_when_it_is_built_again(ours, built):
    made = built(ours, variants=0)
    made.run("ingest")
    found = {row["program_id"]: row for row in made.rows("ingest") if row["origin"] != "text"}
    assert set(found) == {f"written:3{name}" for name in ("P0001A2SM1", "P0001A2SM4", "D0001A2SM1")}
    assert {(row["origin"], row["worker"], row["platform"]) for row in found.values()} == {("written", None, None)}
    assert made.rejects("ingest") == []


@pytest.mark.parametrize("version", ["0.1"], indirect=True)
def test_a_difference_knows_the_embedded_corpus_by_both_names(ours, tmp_path):
    again = shutil.copytree(ours, tmp_path / "again")
    renamed(again, "crowd:3", "written:3")
    assert compare(ours, again) == []


@pytest.mark.parametrize("version", ["0.1"], indirect=True)
def test_it_is_compared_with_one_of_now(folder, tmp_path):
    """Knowledge and repairs may grow; the records and the homes in which they run keep their ids."""
    inputs = GOLDEN / "pipelines/input"
    build(
        sources=(str(inputs / "programs/evening.txt"), str(inputs / "crowd")),
        out=str(tmp_path / "now"),
        homes_folder=str(inputs / "homes"),
        homes=("cabin",),
        pictures=0,
        videos=0,
        variants=1,
    )
    result = CliRunner().invoke(cli.app, ["diff", str(folder), str(tmp_path / "now"), "--json"])
    assert result.exit_code == 0
    found = {each["table"]: each["counts"] for each in json.loads(result.stdout)}
    for table in ("activities", "descriptions", "programs", "homes", "home_nodes", "home_edges", "executions"):
        counts = found.get(table, {})
        new = counts.get("only_second", 0) if table != "executions" else 0  # originals that fail came with format 2
        assert not counts.get("only_first") and not new, table
