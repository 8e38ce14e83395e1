"""The catalog describes itself: comments on all its tables and columns, and the way in which it finds the tables."""

from __future__ import annotations

import shutil
import subprocess
import sys

import duckdb
import pytest

import hearth
from hearth.datasets.format.catalog import CATALOG, SQL, VIEWS, published
from hearth.datasets.verify import verify
from hearth.schemas.tables import TABLES, comment_of, nested

COMMENTS = (
    "SELECT view_name, NULL, comment FROM duckdb_views() WHERE NOT internal",
    "SELECT table_name, column_name, comment FROM duckdb_columns() WHERE NOT internal",
    "SELECT function_name, NULL, comment FROM duckdb_functions() WHERE NOT internal",
)


@pytest.fixture(scope="module")
def folder(made):
    return made.out / "publish"


@pytest.fixture(scope="module")
def said(folder):
    """(name, column or None) -> its comment, in the catalog."""
    with duckdb.connect(str(folder / CATALOG), read_only=True) as plain:
        return {(name, column): text for query in COMMENTS for name, column, text in plain.execute(query).fetchall()}


@pytest.mark.parametrize("table", TABLES)
def test_every_column_and_nested_field_has_a_comment(table):
    fields = [each for column in TABLES[table] for each in nested(column)]
    assert comment_of(TABLES[table])
    assert [name for name, field in fields if not comment_of(field)] == []


def test_paths_of_nested_fields():
    found = dict(nested(TABLES["executions"].field("ticks")))
    assert {"ticks", "ticks[].instructions", "ticks[].instructions[].agent", "ticks[].added[].relation"} <= found.keys()
    assert dict(nested(TABLES["videos"].field("variation"))).keys() >= {"variation.seed", "variation.hour"}
    assert [path for path, _ in nested(TABLES["programs"].field("title"))] == ["title"]


def test_views_columns_and_macros_of_the_catalog_have_comments(said):
    names = {name for name, _ in said}
    assert names >= {*TABLES, *VIEWS, "program_text", "graph_edges", "final_state"}
    assert [key for key, text in said.items() if not text] == []
    for table, schema in TABLES.items():
        for column in schema:
            text = said[table, column.name]
            assert text.startswith(comment_of(column))
            assert all(f"\n{path}: {comment_of(field)}" in text for path, field in list(nested(column))[1:])


def test_a_query_finds_the_comments_too(folder, said):
    dataset = hearth.load(folder)
    for query in COMMENTS:
        for name, column, text in dataset.rows(query)[1]:
            assert said[name, column] == text


@pytest.mark.parametrize("name", ["moved", "it's [here], now"])
def test_the_catalog_works_from_any_folder(folder, tmp_path, monkeypatch, name):
    moved = shutil.copytree(folder, tmp_path / name)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    count = "SELECT count(*) FROM programs"
    for path in (moved / CATALOG, f"../{name}/{CATALOG}"):
        with duckdb.connect(str(path), read_only=True) as plain:
            assert plain.execute(count).fetchall() == hearth.load(folder).rows(count)[1]
            text = plain.execute("SELECT min(program_text(program_id)) FROM programs").fetchall()
            assert text == hearth.load(folder).rows("SELECT min(program_text(program_id)) FROM programs")[1]


def test_its_first_line_says_what_to_do_where_it_is_attached(folder):
    assert "first SET file_search_path" in (folder / SQL).read_text().splitlines()[0]
    with duckdb.connect() as plain:
        plain.execute(f"ATTACH '{folder / CATALOG}' AS mine (READ_ONLY)")
        with pytest.raises(duckdb.IOException):
            plain.execute("SELECT count(*) FROM mine.programs")
        plain.execute(f"SET file_search_path = '{folder}'")
        assert plain.execute("SELECT count(*) FROM mine.programs").fetchone()[0] > 0


@pytest.mark.parametrize("name", ["h", 'my "data"; --'])
def test_a_dataset_is_attached_to_a_connection_of_anybodys(folder, tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    with duckdb.connect(tmp_path / "own.duckdb") as own:
        own.execute("CREATE TABLE mine AS SELECT 'crowd:P1' AS program_id, 3 AS grade")
        hearth.attach(own, str(folder), name)
        hearth.attach(own, str(folder), "again")
        named = '"' + name.replace('"', '""') + '"'
        query = f"SELECT count(*), sum(executable::int) FROM {named}.originals"
        assert own.execute(query).fetchall() == hearth.load(folder).rows(query.replace(f"{named}.", ""))[1]
        found = own.execute(f"SELECT title, grade, again.program_text(program_id) FROM mine JOIN {named}.programs USING"
                            " (program_id)").fetchall()  # fmt: skip
        assert [row[:2] for row in found] == [("Watch TV", 3)] and found[0][2].startswith("[")
        assert own.execute("SELECT current_database()").fetchone() == ("own",)
        with pytest.raises(hearth.HearthError, match="has a database `again` already"):
            hearth.attach(own, str(folder), "again")
    with duckdb.connect(tmp_path / "own.duckdb") as own:
        assert own.execute("SHOW TABLES").fetchall() == [("mine",)]


def test_verify_sees_another_comment(folder, tmp_path):
    copy = shutil.copytree(folder, tmp_path / "copy")
    assert (copy / SQL).read_text() == published()
    for statement in ("COMMENT ON COLUMN programs.title IS 'x'", "COMMENT ON MACRO step_text IS 'x'"):
        shutil.copy(folder / CATALOG, copy / CATALOG)
        assert verify(copy).faults == ()
        with duckdb.connect(str(copy / CATALOG)) as plain:
            plain.execute(statement)
        assert [fault.code for fault in verify(copy).faults] == ["DAMAGED_FILE"]


def test_a_catalog_that_cannot_be_written_whole_is_an_error(made, tmp_path):
    """DuckDB writes it when it closes, and then says nothing of a full disk."""
    copy = shutil.copytree(made.out / "publish", tmp_path / "copy")
    script = f"""if True:
        import resource
        from pathlib import Path
        from hearth.datasets.format.catalog import write_catalog
        resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, 200_000))
        try:
            write_catalog(Path({str(copy)!r}))
        except OSError as error:
            print("refused")
    """
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert done.stdout == "refused\n", done.stderr
