"""The published dataset: tables, SQL, macros, the loader, and moving the folder."""

from __future__ import annotations

import shutil
from collections import Counter

import duckdb
import pytest

import hearth
from hearth.datasets.dataset import Dataset
from hearth.datasets.format.case_rows import rerun
from hearth.datasets.format.catalog import VIEWS
from hearth.pipelines.engine.build_homes import Homes
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.graph import from_release
from hearth.schemas.syntax import print_lines
from hearth.schemas.tables import TABLES
from hearth.storage.files import file_digest, read_json

MILK = "release:batch-1/file1_1"
TELEVISION = "crowd:P1"


@pytest.fixture
def ds(made):
    return hearth.load(made.out)


def cases(made):
    return {row["execution_id"]: row for name in ("sample", "augment") for row in made.rows(name)}


def test_every_table_has_its_columns(ds):
    for name, schema in TABLES.items():
        assert getattr(ds, name).columns == schema.names, name


def test_every_view_and_column_has_a_comment(ds):
    for table, schema in TABLES.items():
        query = f"SELECT column_name, comment FROM duckdb_columns() WHERE table_name = '{table}'"
        comments = dict(ds.rows(query)[1])
        assert comments.keys() >= set(schema.names) and all(comments.values()), table
        assert ds.rows(f"SELECT comment FROM duckdb_views() WHERE view_name = '{table}'")[1][0][0], table


def test_executions_that_fail_are_left_out_unless_asked_for(made):
    usual, every = Dataset.open(made.out), Dataset.open(made.out, failures=True)
    counts = [one.rows(f"SELECT count(*) FROM executions WHERE {one.included}")[1][0][0] for one in (usual, every)]
    assert counts[0] == every.rows("SELECT count(*) FROM executions WHERE executable")[1][0][0] < counts[1]


def test_arrays_are_of_the_start_unless_asked_for(ds):
    start, later = ds.to_tensors([MILK]), ds.to_tensors([MILK], 1)
    assert (start.node_states == ds.to_tensors([MILK], 0).node_states).all()
    assert start.edge_index.shape != later.edge_index.shape or (start.edge_index != later.edge_index).any()


def test_the_program_as_text(ds):
    (text,) = ds.rows("SELECT program_text($id)", id=MILK)[1][0]
    assert text == "\n".join(print_lines(ds[MILK].program))
    ids = [row[0] for row in ds.rows("SELECT program_id FROM programs WHERE program_text(program_id) LIKE '%milk%'")[1]]
    assert MILK in ids
    assert TELEVISION not in ids


def test_graphs_are_the_engines_at_every_tick(made):
    homes, ds = Homes(made.settings), hearth.load(made.out, failures=True)
    for execution_id, case in cases(made).items():
        execution = rerun(case, homes)
        run = next(run for run in ds[case["program_id"]].runs if run.row["execution_id"] == execution_id)
        assert run.executable == case["executable"]
        for tick, world in enumerate(execution.worlds):
            expected = world.graph()
            graph = run.graph(tick)
            assert graph.edges == expected.edges
            assert states(graph) == states(expected)


def states(graph):
    return {node.id: sorted(node.states) for node in graph.nodes}


def test_macros_rebuild_the_same_graphs(ds):
    for program_id in list(ds)[:6]:
        for run in ds[program_id].runs:
            for tick in range(len(run.row["ticks"]) + 1):
                parameters = {"id": run.row["execution_id"], "tick": tick}
                graph = run.graph(tick)
                _, edges = ds.rows("SELECT * FROM graph_edges($id, $tick) ORDER BY ALL", **parameters)
                assert edges == [tuple(edge) for edge in graph.edges]
                _, nodes = ds.rows(
                    "SELECT id, class_name, states FROM graph_nodes($id, $tick) ORDER BY id", **parameters
                )
                assert nodes == [(node.id, node.class_name, sorted(node.states)) for node in graph.nodes]


def test_final_states(ds):
    run = ds[MILK].runs[0]
    _, found = ds.rows(
        "SELECT state FROM final_state($id) WHERE class_name = 'fridge' ORDER BY 1", id=run.row["execution_id"]
    )
    assert [state for (state,) in found] == ["CLEAN", "CLOSED", "OFF", "PLUGGED_IN"]


def test_a_program_with_all_that_belongs_to_it(ds):
    entry = ds[MILK]
    (run,) = entry.runs
    assert (entry.title, run.home, run.executable) == ("Fetch milk", "cottage", True)
    assert entry.description.startswith("Take the milk")
    assert run.bindings()["milk", 1] == 24
    assert {row["name"] for row in run.conditions} == {"closed", "inside"}
    assert run.networkx().has_edge(24, 23, "INSIDE")
    assert run.networkx(len(run.row["ticks"])).has_edge(24, 20, "ON")
    assert from_release(run.release_json(0)) == run.start
    assert entry.repairs == ()
    assert MILK in ds
    assert len(ds) == len(list(ds))
    with pytest.raises(KeyError):
        ds["nobody"]
    with pytest.raises(IndexError):
        run.graph(99)


def test_repairs_belong_to_their_programs(ds):
    _, found = ds.rows("SELECT DISTINCT program_id, parent_id FROM repairs WHERE program_id IS NOT NULL")
    assert found
    for program_id, parent_id in found:
        entry = ds[program_id]
        assert entry.row["parent_id"] == parent_id
        assert [row["attempt"] for row in entry.repairs] == list(range(len(entry.repairs)))
        assert entry.row["split"] == ds[parent_id].row["split"]


def test_what_the_release_stored_is_reproduced_or_not(ds):
    _, found = ds.rows("SELECT program_id, executable, reproduces, failure.code FROM executions WHERE rules = 'replay'")
    assert sorted(found)[:2] == [(MILK, True, True, None), ("release:batch-1/file1_2", False, False, "NOT_CLOSE")]


def test_program_to_repairs_to_final_states(ds):
    query = """
        SELECT p.title, r.handler, s.class_name, s.state
        FROM programs p JOIN repairs r USING (program_id) JOIN executions e USING (execution_id),
        LATERAL (SELECT class_name, state FROM final_state('crowd:P1+cabin.0@cabin/0')) s
        WHERE e.execution_id = 'crowd:P1+cabin.0@cabin/0' AND s.class_name = 'television' ORDER BY ALL
    """
    _, found = ds.rows(query)
    assert {row[3] for row in found} >= {"ON"}


def test_the_folder_may_be_moved(made, tmp_path):
    folder = tmp_path / "it's, moved"
    shutil.copytree(made.out / "publish", folder)
    assert len(Dataset.open(folder)) == len(hearth.load(made.out))


def test_plain_duckdb_reads_the_catalog_after_a_move(made, tmp_path):
    folder = tmp_path / "moved"
    shutil.copytree(made.out / "publish", folder)
    with duckdb.connect(str(folder / "catalog.duckdb"), read_only=True) as connection:
        connection.execute(f"SET file_search_path = '{folder}'")
        (text,) = connection.execute(f"SELECT program_text('{MILK}')").fetchone()
        assert text.startswith("[Walk] <kitchen> (1)")
        (steps,) = connection.execute("SELECT count(*) FROM steps").fetchone()
        (nested,) = connection.execute("SELECT sum(len(steps)) FROM programs").fetchone()
        assert steps == nested


@pytest.mark.parametrize(
    "query",
    [
        "CREATE TABLE mine (i INT)",
        "DROP VIEW programs",
        "COPY programs TO '/tmp/elsewhere.csv'",
        "SELECT 1; SELECT 2",
        "ATTACH '/tmp/other.duckdb' AS other",
        "SET threads = 1",
        "INSTALL httpfs",
        "LOAD httpfs",
        "PRAGMA version",
        "EXPORT DATABASE '/tmp/other'",
        "CALL enable_logging()",
        "SELECT 1 FROM (COPY programs TO '/tmp/elsewhere.csv')",
        "EXPLAIN",
        "",
    ],
)
def test_a_dataset_can_only_be_read(ds, query):
    with pytest.raises(HearthError):
        ds.rows(query)


@pytest.mark.parametrize(
    "query",
    [
        "COPY (SELECT 1 AS x) TO '{}'",
        "EXPLAIN ANALYZE COPY (SELECT 1 AS x) TO '{}'",
        "explain/**/analyze/* \u00e9 */copy (SELECT '\u00e9' AS x) TO '{}'",
        "EXPLAIN (ANALYZE, FORMAT json) COPY (SELECT 1 AS x) TO '{}'",
        "WITH made AS (COPY (SELECT 1 AS x) TO '{}') FROM made",
        "EXPLAIN ANALYZE WITH made AS (COPY (SELECT 1 AS x) TO '{}') FROM made",
        "SELECT 1; COPY (SELECT 1 AS x) TO '{}'",
        "FROM query($$COPY (SELECT 1 AS x) TO '{}'$$)",
    ],
)
def test_no_query_replaces_a_table(made, tmp_path, query):
    folder = shutil.copytree(made.out / "publish", tmp_path / "copy")
    part = next((folder / "programs").glob("*.parquet"))
    before = part.read_bytes()
    with pytest.raises(HearthError):
        Dataset.open(folder).rows(query.format(part))
    assert part.read_bytes() == before


@pytest.mark.parametrize("query", ["read_text('{}')", "read_csv('{}')", "'{}'", "glob('{}')"])
def test_other_files_are_out_of_reach(ds, tmp_path, query):
    other = tmp_path / "other.csv"
    other.write_text("a,b\n1,2\n")
    asked = f"SELECT count(*) FROM {query.format(other)}"
    assert duckdb.sql(asked).fetchall()
    with pytest.raises(HearthError, match="disabled by configuration"):
        ds.rows(asked)


def test_nothing_opens_what_is_closed(ds):
    with pytest.raises(duckdb.Error, match="locked"):
        ds.connection.execute("SET threads = 1")
    assert ds.connection.execute("SELECT current_setting('python_enable_replacements')").fetchall() == [(False,)]
    settings = "SELECT current_setting('autoinstall_known_extensions'), current_setting('autoload_known_extensions')"
    assert ds.rows(settings)[1] == [(False, False)]


@pytest.mark.parametrize(
    "query",
    [
        "DESCRIBE programs",
        "SHOW TABLES",
        "EXPLAIN SELECT 1",
        "EXPLAIN ANALYZE SELECT 1",
        "EXPLAIN (FORMAT json) (SELECT 1)",
        "FROM steps LIMIT 1",
        "WITH found AS (FROM steps) SELECT count(*) FROM found -- and no more",
        "SUMMARIZE ledger;",
        "VALUES (1)",
    ],
)
def test_ways_to_ask(ds, query):
    assert ds.rows(query, limit=5)[1]


def test_a_wrong_query_says_why(ds):
    with pytest.raises(HearthError, match="titel"):
        ds.rows("SELECT titel FROM programs")
    with pytest.raises(HearthError, match="Conversion Error"):
        ds.rows("SELECT title::INT FROM programs")


@pytest.mark.parametrize(
    ("manifest", "message"),
    [("[1]", "no dataset here"), ('{"stage": "publish"}', "does not name"), (None, "install a newer")],
)
def test_what_replaces_an_open_dataset_is_looked_at_as_well(made, tmp_path, manifest, message):
    folder = shutil.copytree(made.out / "publish", tmp_path / "copy")
    dataset = Dataset.open(folder)
    assert dataset.rows("SELECT 1")[1] == [(1,)]
    newer = (folder / "manifest.json").read_text().replace('"format": 3', '"format": 99')
    (folder / "other.json").write_text(manifest or newer)
    (folder / "other.json").replace(folder / "manifest.json")
    with pytest.raises(HearthError, match=message):
        dataset.rows("SELECT 1")


def test_no_dataset_and_a_newer_one(made, tmp_path):
    with pytest.raises(HearthError, match="no dataset here"):
        hearth.load(tmp_path)
    folder = shutil.copytree(made.out / "publish", tmp_path / "newer")
    text = (folder / "manifest.json").read_text().replace('"format": 3', '"format": 99')
    (folder / "manifest.json").write_text(text)
    with pytest.raises(HearthError, match="format 99"):
        hearth.load(folder)


def test_the_manifest_has_the_digest_of_every_file(made):
    folder = made.out / "publish"
    files = read_json(folder / "manifest.json")["files"]
    there = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert set(files) == there - {"manifest.json", "timing.json", "catalog.duckdb"}
    for name, entry in files.items():
        assert file_digest(folder / name) == entry["sha256"]


def test_a_place_is_a_file_and_the_line_where_the_record_begins(ds, inputs):
    for name, place, title in ds.rows("SELECT program_id, place, title FROM programs WHERE origin <> 'augmented'")[1]:
        file, _, line = place.rpartition(":")
        (path,) = (path for path in inputs.rglob("*.*") if path.as_posix().endswith(file))
        text = path.read_text().splitlines()[int(line) - 1]
        assert title in text and (name.partition(":")[2] in text) == name.startswith("crowd:"), place


def test_nothing_refers_to_what_is_not_there(ds):
    for table, column, other in (
        ("executions", "program_id", "programs"),
        ("executions", "environment_id", "environments"),
        ("environments", "home", "homes"),
        ("programs", "activity_id", "activities"),
        ("programs", "description_id", "descriptions"),
        ("repairs", "program_id", "programs"),
        ("repairs", "execution_id", "executions"),
    ):
        query = f"SELECT count(*) FROM {table} ANTI JOIN {other} USING ({column}) WHERE {column} IS NOT NULL"
        assert ds.rows(query)[1] == [(0,)], (table, column)


def test_relations_counted_from_differences(made):
    ds = hearth.load(made.out, failures=True)
    found = dict(ds.rows("SELECT relation, edges FROM start_relations WHERE edges > 0")[1])
    runs = [run for program_id in ds for run in ds[program_id].runs]
    assert found == Counter(edge.relation for run in runs for edge in run.start.edges)


def test_an_unknown_id_names_those_that_are_like_it(ds):
    with pytest.raises(KeyError, match=r"no program `crowd:P01` among .*; the nearest ids are `crowd:P1"):
        _ = ds["crowd:P01"]
    with pytest.raises(KeyError, match=r"x{77}\.\.\.`"):
        _ = ds["x" * 10_000]


def test_the_id_of_an_execution_is_answered_with_its_program(ds):
    for execution, program in ds.rows("SELECT execution_id, program_id FROM executions ORDER BY 1")[1][:5]:
        with pytest.raises(KeyError) as caught:
            _ = ds[execution]
        assert f"an execution of a program: dataset[{program!r}].runs" in str(caught.value.args[0])


@pytest.mark.parametrize("key", [0, -1, None, slice(0, 2), ("a", "b")])
def test_a_key_that_is_not_an_id_is_answered_with_the_keys_that_there_are(made, key):
    ds = hearth.load(made.out / "publish")
    first = next(iter(ds))
    with pytest.raises(TypeError, match=r"found by its id, a text, not by") as caught:
        ds[key]
    assert f"dataset[{first!r}]" in str(caught.value) and "list(dataset)" in str(caught.value)


def test_completion_has_tables_and_views(ds):
    assert {*TABLES, *VIEWS, "sql", "rows", "folder"} <= {*dir(ds)}
