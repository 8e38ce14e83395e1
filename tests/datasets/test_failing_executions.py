"""Executions in which a program fails, most of them of originals in perturbed environments: published, replayed, in no
split, and read only when asked for."""

from __future__ import annotations

import json
import shutil
from collections import Counter

import pyarrow.parquet as pq
import pytest
from typer.testing import CliRunner

import hearth
from hearth import cli
from hearth.datasets.verify import verify
from hearth.schemas.syntax import print_lines
from hearth.storage.files import file_digest


@pytest.fixture(scope="module")
def ds(made):
    return hearth.load(made.out)


@pytest.fixture(scope="module")
def failing(ds):
    """Execution id -> its program and failure."""
    query = "SELECT execution_id, program_id, failure.code FROM executions WHERE NOT executable ORDER BY 1"
    return {name: (program, code) for name, program, code in ds.rows(query)[1]}


def test_every_original_that_failed_is_published_with_its_failure(made, ds, failing):
    perturbed = {name for (name,) in ds.rows("SELECT environment_id FROM perturbations")[1]}
    failing = {name: found for name, found in failing.items() if name.rpartition("/")[0] in perturbed}
    tried = [row for row in made.rows("augment") if row["parent_id"] is None]
    expected = {row["execution_id"]: (row["program_id"], row["failure"]["code"]) for row in tried if row["failure"]}
    assert failing == expected and len(expected) > 3
    first = {row["environment_id"]: row["repairs"] for row in made.rows("augment") if row["repairs"]}
    codes = {row["execution_id"]: first[row["environment_id"]][0]["failure"]["code"] for row in tried}
    assert {name: code for name, (_, code) in failing.items()} == {name: codes[name] for name in failing}


def test_an_original_that_only_misses_its_goal_is_not_among_them(made, failing):
    assert {row["executable"] for row in made.rows("augment") if row["parent_id"] is None} <= {True, False}
    assert not [row for row in made.rows("augment") if row["executable"] and row["execution_id"] in failing]


def test_they_are_in_no_split(ds, failing):
    assert not {name for (name,) in ds.rows("SELECT execution_id FROM splits")[1]} & set(failing)
    (left,) = ds.rows("SELECT count(*) FROM splits JOIN executions USING (execution_id) WHERE NOT executable")[1]
    assert left == (0,)


def test_they_are_read_when_asked_for(made, ds, failing):
    asked = hearth.load(made.out, failures=True)
    for name in ds:
        more = {run.row["execution_id"] for run in asked[name].runs} - {
            run.row["execution_id"] for run in ds[name].runs
        }
        assert more == {execution for execution, (program, _) in failing.items() if program == name}
        assert all(run.executable for run in ds[name].runs)
    (program, count), *_ = Counter(program for program, _ in failing.values()).most_common()
    tensors = [len(each.to_tensors([program]).lengths) for each in (ds, asked)]
    assert tensors[1] - tensors[0] == count > 1


def run(*words):
    result = CliRunner().invoke(cli.app, list(map(str, words)))
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


def test_exports_and_scores_have_them_when_asked(made, ds, failing, tmp_path):
    counts = [
        run("export", made.out, "-f", "networkx", "-o", tmp_path / f"out{len(more)}", "--json", *more)["count"]
        for more in ((), ("--failures",))
    ]
    assert counts[1] - counts[0] == len(failing)
    rows = [{"id": name, "predicted": list(print_lines(ds[of].program))} for name, (of, _) in failing.items()]
    (tmp_path / "mine.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows))
    score = ("score", "dataset", made.out, tmp_path / "mine.jsonl", "-j", 1, "--json")
    assert run(*score, "--failures")["count"] - run(*score)["count"] == len(failing)


def test_verify_runs_them_again(made, failing, tmp_path):
    copy = shutil.copytree(made.out / "publish", tmp_path / "copy")
    assert verify(copy).faults == ()
    name = next(iter(failing))
    for path in (copy / "executions").glob("*.parquet"):
        table = pq.ParquetFile(path).read()
        rows = table.to_pylist()
        for row in rows:
            if row["execution_id"] == name:
                row["failure"]["actual"] = "something else"
        pq.write_table(table.from_pylist(rows, table.schema), path)
        content = json.loads((copy / "manifest.json").read_text())
        entry = {"bytes": path.stat().st_size, "sha256": file_digest(path)}
        content["files"][path.relative_to(copy).as_posix()] = entry
        (copy / "manifest.json").write_text(json.dumps(content))
    (fault,) = verify(copy).faults
    assert fault.code == "REPLAY_DIFFERS" and fault.message.startswith(f"{name}: ")


def test_a_perturbation_is_a_row_of_its_own_with_what_it_caused(made, ds):
    rows = ds.read("SELECT * FROM perturbations ORDER BY perturbation_id")
    assert len({row["perturbation_id"] for row in rows}) == len(rows) > 5
    assert len(rows) == sum(len(row["perturbations"]) for row in made.rows("augment") if row["parent_id"] is None)
    repairs = {(row["environment_id"], row["attempt"]): row for row in ds.read("SELECT * FROM repairs")}
    for row in rows:
        caused = [repairs[row["environment_id"], attempt] for attempt in row["attempts"]]
        assert {repair["perturbation_id"] for repair in caused} <= {row["perturbation_id"]}
        assert row["failure"] == (caused[0]["failure"] if caused else None)
    claimed = sum(len(row["attempts"]) for row in rows)
    assert claimed == sum(row["perturbation_id"] is not None for row in repairs.values()) > 0
