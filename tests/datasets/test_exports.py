"""Every form of export, read by a tool that is not the one that wrote it."""

from __future__ import annotations

import ast
import contextlib
import csv
import json
import shutil
import subprocess
import sys
from pathlib import Path

import networkx
import pandas as pd
import pyarrow.parquet as pq
import pytest
from hostile_datasets import rename

import hearth
from hearth.analysis.release_replay import replay
from hearth.datasets.export.formats import FORMATS, export
from hearth.datasets.export.program_batches import Wanted
from hearth.datasets.export.rdf import iri, text
from hearth.datasets.export.release_layout import ROOT
from hearth.kb.language.step_phrases import parses
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.tables import TABLES
from hearth.storage.names import file_name

MILK = "release:batch-1/file1_1"


@pytest.fixture(scope="module")
def ds(made):
    return hearth.load(made.out)


def test_the_release_comes_back_through_ingest(ds, tmp_path, built, made):
    export(ds, "release", tmp_path / "out")
    again = built(tmp_path / "out")
    again.run("ingest", "validate", "sample")
    assert not again.rejects("ingest")
    first = {row["execution_id"]: row for row in made.rows("sample") if row["program_id"].startswith("release:")}
    second = {row["execution_id"]: row for row in again.rows("sample")}
    assert first
    for name, row in first.items():
        same = ("title", "description", "bindings", "ticks", "executable", "failure", "home")
        assert {key: second[name][key] for key in same} == {key: row[key] for key in same}
        stripped = [[{**step, "line": 0} for step in case["steps"]] for case in (row, second[name])]
        assert stripped[0] == stripped[1]


def test_what_was_exported_as_a_release_replays(ds, tmp_path):
    export(ds, "release", tmp_path / "out")
    found = list(replay(tmp_path / "out" / ROOT, default()))
    assert len(found) == ds.rows("SELECT count(DISTINCT (program_id, home)) FROM executions")[1][0][0]
    assert all(not one.faults for one in found)
    mine = [one for one in found if one.program_id == "batch-1/file1_1"]
    assert [one.exact for one in mine] == [True]


def test_words_name_the_same_actions_and_objects(ds, tmp_path):
    export(ds, "nl", tmp_path / "out")
    rows = [json.loads(line) for line in (tmp_path / "out/steps.jsonl").read_text().splitlines()]
    assert [row["program_id"] for row in rows] == list(ds)
    for row in rows:
        for said, step in zip(row["steps"], ds[row["program_id"]].program.steps, strict=True):
            meant = {(action.name, names) for action, names in parses(default(), said)}
            assert (step.action, tuple(ref.name for ref in step.objects)) in meant


def test_pairs_for_tuning_and_examples(ds, tmp_path):
    export(ds, "nl", tmp_path / "out", Wanted((MILK,)))
    chat = pd.read_json(tmp_path / "out/chat.jsonl", lines=True)
    (messages,) = chat["messages"]
    assert [message["role"] for message in messages] == ["user", "assistant"]
    assert "Fetch milk" in messages[0]["content"]
    assert messages[1]["content"].startswith("1. Walk to kitchen\n2. ")
    (example,) = json.loads((tmp_path / "out/examples.json").read_text())
    assert example.startswith("Task: Fetch milk\nStep 1: Walk to kitchen\nStep 2: ")


def test_json_lines_hold_every_row(ds, tmp_path):
    export(ds, "jsonl", tmp_path / "out")
    for table in TABLES:
        lines = (tmp_path / f"out/{table}.jsonl").read_text().splitlines()
        assert len(lines) == ds.sql(f"SELECT count(*) FROM {table}").fetchall()[0][0], table
        if table not in ("programs", "executions", "home_edges", "ledger", "vocabulary"):
            continue
        rows = ds.sql(f"SELECT * FROM {table} ORDER BY ALL").to_arrow_table().to_pylist()
        assert list(map(json.loads, lines)) == rows


def test_json_lines_of_some_programs_have_their_rows_alone(ds, tmp_path):
    name = next(iter(ds))
    export(ds, "jsonl", tmp_path / "out", Wanted((name,)))
    runs = {row["execution_id"] for row in ds.read("SELECT * FROM executions WHERE program_id = $id", {"id": name})}
    for table in ("programs", "executions", "splits", "frames", "videos"):
        rows = [json.loads(line) for line in (tmp_path / f"out/{table}.jsonl").read_text().splitlines()]
        assert {row.get("program_id", name) for row in rows} <= {name}
        assert {row["execution_id"] for row in rows if "execution_id" in row} <= runs
    assert runs


def test_the_lines_are_in_one_order_whatever_the_order_of_rows(ds, made, tmp_path):
    """Rows that share their first columns included: nothing is left to the threads that sort them."""
    shutil.copytree(made.out / "publish", tmp_path / "shuffled")
    (part,) = (tmp_path / "shuffled/home_edges").glob("*.parquet")
    rows = pq.read_table(part)
    pq.write_table(rows.take(list(range(len(rows)))[::-1]), part)
    export(ds, "jsonl", tmp_path / "out")
    export(hearth.load(tmp_path / "shuffled"), "jsonl", tmp_path / "again")
    assert (tmp_path / "out/home_edges.jsonl").read_bytes() == (tmp_path / "again/home_edges.jsonl").read_bytes()


def test_code_is_python_that_makes_the_same_calls(ds, tmp_path):
    export(ds, "code", tmp_path / "out")
    tree = ast.parse((tmp_path / "out/programs.py").read_text())
    functions = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
    assert len(functions) == len({function.name for function in functions}) == len(ds)
    imported = {alias.name for node in tree.body if isinstance(node, ast.ImportFrom) for alias in node.names}
    for function, program_id in zip(functions, ds, strict=True):
        calls = [node.value for node in function.body if isinstance(node, ast.Expr)]
        steps = ds[program_id].program.steps
        assert [[argument.value for argument in call.args] for call in calls] == [
            [f"{ref.name}_{ref.instance}" for ref in step.objects] for step in steps
        ]
        assert [call.func.id.replace("_", "") for call in calls] == [step.action.lower() for step in steps]
        assert {call.func.id for call in calls} <= imported


def test_code_runs_alone_in_its_folder(ds, made, tmp_path):
    folder = shutil.copytree(made.out / "publish", tmp_path / "dataset")
    rename(folder, "Watch TV", "Walk")
    rename(folder, "Grab", "print")
    export(hearth.load(folder), "code", tmp_path / "out")
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"programs.py", "actions.py"}
    plain = [sys.executable, "-I", "-c"]
    for body, said in (("runpy.run_path('programs.py')", ""), ("import programs; programs.walk_2()", "walk('")):
        code = f"import runpy, sys; sys.path.insert(0, '.'); {body}"
        done = subprocess.run([*plain, code], cwd=tmp_path / "out", capture_output=True, text=True, check=False)
        assert (done.returncode, done.stderr) == (0, "")
        assert done.stdout.startswith(said) and bool(said) == bool(done.stdout)


def test_tables_as_csv_have_the_rows_of_the_lines(ds, tmp_path):
    for wanted, to in ((Wanted(), "all"), (Wanted((MILK,)), "one")):
        assert export(ds, "csv", tmp_path / to / "csv", wanted) == export(ds, "jsonl", tmp_path / to / "json", wanted)
        for path in (tmp_path / to / "json").iterdir():
            with (tmp_path / to / "csv" / f"{path.stem}.csv").open(newline="") as file:
                found = list(csv.DictReader(file))
            rows = [json.loads(line) for line in path.read_text().splitlines()]
            assert len(found) == len(rows)
            for cells, row in zip(found, rows, strict=True):
                assert [*cells] == [*row]
                nested = {key: json.loads(cells[key]) for key, value in row.items() if isinstance(value, list | dict)}
                assert nested == {key: row[key] for key in nested}


@pytest.mark.parametrize("form", ["networkx", "graphml"])
def test_graphs_read_by_networkx(ds, tmp_path, form):
    export(ds, form, tmp_path / "out", Wanted((MILK,)))
    (run,) = ds[MILK].runs
    assert export(ds, form, tmp_path / "two", Wanted(limit=2)) == 2 == len(list((tmp_path / "two").iterdir())) // 2
    for moment, graph in (("start", run.start), ("final", run.final)):
        base = tmp_path / f"out/{file_name(run.row['execution_id'])}.{moment}"
        if form == "graphml":
            found = networkx.read_graphml(f"{base}.graphml", node_type=int, force_multigraph=True)
            states = {node: attributes["states"].split() for node, attributes in found.nodes(data=True)}
            edges = {(source, attributes["relation"], target) for source, target, attributes in found.edges(data=True)}
        else:
            found = networkx.node_link_graph(json.loads(base.with_name(f"{base.name}.json").read_text()), edges="edges")
            states = {node: attributes["states"] for node, attributes in found.nodes(data=True)}
            edges = {(source, relation, target) for source, target, relation in found.edges(keys=True)}
        assert states == {node.id: list(node.states) for node in graph.nodes}
        assert edges == {tuple(edge) for edge in graph.edges}


def test_triples_read_by_rdflib(ds, tmp_path):
    rdflib = pytest.importorskip("rdflib", reason="rdflib is not installed: pip install rdflib")
    export(ds, "rdf", tmp_path / "out")
    found = rdflib.Graph().parse(tmp_path / "out/programs.ttl")
    query = "SELECT (COUNT(?s) AS ?n) WHERE { ?p a <https://hearth.invalid/terms#Program> . ?p <%sstep> ?s }"
    ((number,),) = found.query(query % "https://hearth.invalid/terms#")
    assert int(number) == ds.rows("SELECT count(*) FROM steps")[1][0][0]
    known = rdflib.Graph().parse(tmp_path / "out/knowledge.ttl")
    assert len(known) > len(default().objects)


def test_literals_and_identifiers_are_escaped():
    assert text('say "hi"\\\n\0') == '"say \\"hi\\"\\\\\\n"'
    assert iri("program", "a b>") == "<https://hearth.invalid/terms/program/a%20b%3E>"


def test_only_what_was_asked_for(ds, tmp_path):
    assert export(ds, "nl", tmp_path / "one", Wanted(limit=1)) == 1
    assert export(ds, "code", tmp_path / "none", Wanted(limit=0)) == 0
    assert set(FORMATS) >= {"release", "nl", "jsonl", "code", "networkx", "graphml", "rdf"}


def test_what_cannot_be_exported_is_named(ds, tmp_path):
    with pytest.raises(HearthError, match="unknown form"):
        export(ds, "word", tmp_path / "out")
    with pytest.raises(HearthError, match="no program `nobody`"):
        export(ds, "nl", tmp_path / "out", Wanted(("nobody",)))
    (tmp_path / "mine.txt").write_text("precious")
    with pytest.raises(HearthError, match="something already"):
        export(ds, "nl", tmp_path)


HOSTILE = [("../../stolen", "..", "x\0y"), ("/stolen-by-export", "a/../../../stolen", "..\\stolen")]


@pytest.mark.parametrize(("home", "program", "origin"), HOSTILE)
def test_no_name_of_a_home_or_program_leads_out_of_an_export(made, tmp_path, home, program, origin):
    folder = shutil.copytree(made.out / "publish", tmp_path / "dataset")
    for old, new in (("cabin", home), (MILK, f"release:{program}"), ("crowd:P1", f"{origin}:{program}")):
        rename(folder, old, new)
    known = set(tmp_path.rglob("*"))
    for form in FORMATS:
        to = tmp_path / "a/b/c" / form
        with contextlib.suppress(HearthError):
            export(hearth.load(folder), form, to)
        known |= {to, *to.parents, *to.rglob("*")}
    assert set(tmp_path.rglob("*")) <= known and len(list(tmp_path.glob("a/b/c/*/*"))) > 6
    assert not Path("/stolen-by-export").exists()


def test_names_of_data_in_code_are_names_strings_and_comments(made, tmp_path):
    folder = shutil.copytree(made.out / "publish", tmp_path / "dataset")
    hostile = "x')\nimport os; os.system('id')  # \u2028\u202e\r\0\f"
    rename(folder, MILK, f"release:{hostile}")
    for name in ("Walk", "kitchen", "milk", "Drink milk"):
        rename(folder, name, hostile)
    export(hearth.load(folder), "code", tmp_path / "out")
    text = (tmp_path / "out/programs.py").read_text()
    tree = ast.parse(text)
    kinds = {type(node) for node in tree.body}
    assert kinds == {ast.Expr, ast.ImportFrom, ast.FunctionDef}
    names = {node.func.id for node in ast.walk(tree) if isinstance(node, ast.Call)}
    assert "import" not in names and not {ast.Import, ast.Attribute} & {type(node) for node in ast.walk(tree)}
    assert not {"\u2028", "\u202e", "\0"} & set(text)
