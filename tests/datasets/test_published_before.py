"""A dataset that version 0.1 published, kept as it was: whatever reads datasets goes on reading it.

It has the crowd's answers and `evening.txt` of `tests/golden/pipelines/input` in the cabin, one perturbation each and
no pictures. `0.1.json` is what 0.1 read in it: the lines of its programs, and a digest of each graph they go through.
Neither is made anew: a change of format needs a reader of this one, and gets an archive of its own.
"""

from __future__ import annotations

import hashlib
import json
import tarfile
from pathlib import Path

import duckdb
import pytest
from typer.testing import CliRunner

import hearth
from hearth import cli
from hearth.datasets.export.formats import FORMATS, export
from hearth.datasets.report.write import write_report
from hearth.datasets.verify import verify
from hearth.kb.loading.load import default
from hearth.pipelines.build import build
from hearth.schemas.syntax import print_lines
from hearth.schemas.tables import TABLES
from hearth.scoring.dataset_scores import score_dataset
from hearth.scoring.evaluate import summarise

GOLDEN = Path(__file__).resolve().parents[1] / "golden"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    to = tmp_path_factory.mktemp("before")
    with tarfile.open(GOLDEN / "datasets/0.1.tar.xz") as archive:
        archive.extractall(to, filter="data")
    return to / "dataset-0.1"


@pytest.fixture(scope="module")
def ds(folder):
    return hearth.load(folder)


def digest(graph):
    return hashlib.sha256(json.dumps(graph, sort_keys=True).encode()).hexdigest()[:16]


def test_every_execution_runs_as_it_did(folder):
    found = verify(folder)
    assert found.faults == ()
    assert (found.executions, found.rows) == (5, 834)


def test_it_was_made_with_our_knowledge(ds):
    assert "knowledge" not in ds.manifest
    assert ds.knowledge is default()


def test_programs_and_graphs_are_what_they_were(ds):
    found = {}
    for name in ds:
        runs = {
            run.row["execution_id"]: [digest(run.release_json(tick)) for tick in range(len(run.row["ticks"]) + 1)]
            for run in ds[name].runs
        }
        found[name] = {"lines": list(print_lines(ds[name].program)), "runs": runs}
    assert found == json.loads((GOLDEN / "datasets/0.1.json").read_text())


def test_its_own_catalog_answers_plain_duckdb_as_ours_does(folder, ds):
    with duckdb.connect(folder / "catalog.duckdb", read_only=True) as plain:
        plain.execute("SET file_search_path = ?", [str(folder)])
        for table in TABLES:
            query = f"SELECT count(*) FROM {table}"
            assert plain.execute(query).fetchall() == ds.rows(query)[1]
        for query in (
            "SELECT program_id, program_text(program_id) FROM programs ORDER BY ALL",
            "SELECT * FROM graph_edges('crowd:P4@cabin/0', 4) ORDER BY ALL",
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
    assert found.count == len(rows) == 5
    assert {name: value.mean for name, value in found.means.items()} == dict.fromkeys(found.means, 1.0)


@pytest.mark.parametrize("form", FORMATS)
def test_every_form_can_be_exported(ds, tmp_path, form):
    assert export(ds, form, tmp_path / form)


def test_it_is_reported(ds, tmp_path):
    assert write_report(ds, tmp_path / "report")


def test_it_is_compared_with_one_of_now(folder, tmp_path):
    """What is known or repaired may grow; what was read, and where it runs, is identified as it was."""
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
        assert not counts.get("only_first") and not counts.get("only_second"), table
