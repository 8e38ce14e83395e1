"""Questions of strangers reach the dataset and nothing else, and end within their limits of time and memory."""

from __future__ import annotations

import json
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from hearth.datasets.dataset import Dataset
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.duckdb_connections import open_database

SECRET = "kept from strangers"


@pytest.fixture
def ground(made, tmp_path, monkeypatch):
    """A dataset in a folder of links that lead to a secret, as current folder and home."""
    shutil.copytree(made.out / "publish", tmp_path / "asked")
    (tmp_path / "guard").mkdir()
    (tmp_path / "guard/secret.csv").write_text(f"{SECRET}\n")
    (tmp_path / "here").mkdir()
    for name in (".tmp", "tmp", "catalog.duckdb.tmp", "temp"):
        (tmp_path / "here" / name).symlink_to(tmp_path / "guard")
    for name in ("catalog.duckdb.tmp", ".tmp"):
        (tmp_path / "asked" / name).symlink_to(tmp_path / "guard")
    (tmp_path / "asked/link.csv").symlink_to(tmp_path / "guard/secret.csv")
    (tmp_path / "asked/programs/part-9.parquet").symlink_to(tmp_path / "guard/secret.csv")
    (tmp_path / "home/.duckdb").mkdir(parents=True)
    (tmp_path / "home/.duckdb/secret.csv").symlink_to(tmp_path / "guard/secret.csv")
    monkeypatch.chdir(tmp_path / "here")
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setenv("HEARTH_SECRET", SECRET)
    return tmp_path


PLACES = (
    ".tmp/secret.csv", "tmp/secret.csv", "temp/secret.csv", "catalog.duckdb.tmp/secret.csv",
    "./.tmp/../.tmp/secret.csv",
    "../guard/secret.csv", "{root}/here/.tmp/secret.csv", "{root}/asked/.tmp/secret.csv", "{root}/asked/link.csv",
    "{root}/asked/catalog.duckdb.tmp/secret.csv", "{root}/asked/../guard/secret.csv", "{root}/guard/secret.csv",
    "{root}/asked//..//guard//secret.csv", "{root}/asked/programs/part-9.parquet", "~/.duckdb/secret.csv",
    "{root}/home/.duckdb/secret.csv", "file://{root}/guard/secret.csv", "file:{root}/guard/secret.csv",
    "file://localhost{root}/guard/secret.csv", "{root}/*/secret.csv", "{root}/asked/.tmp/*", ".tmp/*", "**/secret.csv",
    "//localhost{root}/guard/secret.csv", "\\\\?\\{root}/guard/secret.csv", "C:/guard/secret.csv", "/proc/self/environ",
    "/proc/self/cwd/.tmp/secret.csv", "/proc/self/root{root}/guard/secret.csv", "/dev/fd/0",
)  # fmt: skip


@pytest.mark.parametrize("reader", ["read_text", "read_blob", "read_csv", "read_json", "glob", "sniff_csv"])
def test_no_path_leads_out(ground, reader):
    dataset = Dataset.open(ground / "asked")
    for place in PLACES:
        path = place.format(root=ground)
        try:
            found = dataset.rows(f"SELECT * FROM {reader}('{path}')")[1]
        except HearthError:
            continue
        assert SECRET not in str(found) and (reader != "glob" or not any("secret" in str(row) for row in found)), path


STATEMENTS = (
    "COPY (SELECT 1) TO '{root}/guard/x.csv'", "ATTACH '{root}/guard/x.duckdb' AS x", "INSTALL httpfs", "LOAD httpfs",
    "FORCE INSTALL httpfs FROM community", "PRAGMA temp_directory='{root}'", "SET temp_directory = '{root}/guard'",
    "SET GLOBAL allowed_directories = ['/']", "RESET lock_configuration", "SET secret_directory = '{root}/guard'",
    "SET VARIABLE x = 1", "PREPARE x AS SELECT 1", "EXECUTE x", "CREATE MACRO m() AS TABLE FROM read_text('.tmp/*')",
    "CREATE SECRET s (TYPE s3)", "EXPORT DATABASE '{root}/guard'", "IMPORT DATABASE '{root}/guard'",
    "FROM query('COPY (SELECT 1) TO ''{root}/guard/x.csv''')", "FROM query_table('.tmp/secret.csv')",
    "FROM '.tmp/secret.csv'", "FROM SECRET", "FROM STATEMENTS", "SELECT getenv('HEARTH_SECRET')",
    "PRAGMA database_list", "CALL pragma_version()", "USE system", "CHECKPOINT",
    "FROM read_duckdb('{root}/guard/secret.csv')", "FROM parquet_metadata('.tmp/secret.csv')",
    "FROM parquet_file_metadata('{root}/guard/secret.csv')", "FROM duckdb_extensions()", "FROM sqlite_scan('a', 'b')",
)  # fmt: skip


@pytest.mark.parametrize("text", STATEMENTS)
def test_no_statement_changes_or_opens_anything(ground, text):
    before = sorted(ground.rglob("*"))
    with pytest.raises(HearthError):
        Dataset.open(ground / "asked").rows(text.format(root=ground))
    assert sorted(ground.rglob("*")) == before


def test_a_link_called_tmp_leads_out_of_a_plain_connection(ground):
    """The reason for `open_database`: DuckDB's own default lets any query through the link."""
    import duckdb

    with duckdb.connect() as connection:
        connection.execute("SET enable_external_access = false")
        found = connection.execute("SELECT content FROM read_text('.tmp/secret.csv')").fetchall()
        assert found == [(f"{SECRET}\n",)]


def test_no_setting_names_a_folder_of_the_person_who_asks(ground):
    settings = Dataset.open(ground / "asked").rows("SELECT name, value FROM duckdb_settings()")[1]
    named = {name: value for name, value in settings if str(ground / "home") in str(value)}
    assert not named


def test_spilled_rows_lie_in_a_folder_of_ours_that_goes(tmp_path):
    with open_database(settings={"memory_limit": "100MB", "threads": 1}) as connection:
        (aside,) = connection.execute("SELECT current_setting('temp_directory')").fetchone()
        assert Path(aside).parent.stat().st_mode & 0o77 == 0
        query = "SELECT count(*) FROM (SELECT range, random() AS r FROM range(8000000) ORDER BY r)"
        assert connection.execute(query).fetchone() == (8_000_000,)
    assert not Path(aside).exists()


LONG = (
    "SELECT count(*) FROM range(1000000000000)",
    "WITH RECURSIVE t(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM t) SELECT max(n) FROM t",
    "SELECT count(*) FROM range(1000000) a, range(1000000) b WHERE a.range + b.range = 7",
    "SELECT * FROM range(1000000000000)",
)


@pytest.mark.parametrize("text", LONG)
def test_what_takes_too_long_is_ended(ground, text):
    dataset = Dataset.open(ground / "asked")
    dataset.within = 0.5
    began = time.monotonic()
    with pytest.raises(HearthError) as caught:
        for _ in dataset.batches(text, 2_048)[1]:
            pass
    assert caught.value.diagnostics[0].code == Code.TIMED_OUT
    assert time.monotonic() - began < 10
    assert dataset.rows("SELECT 1")[1] == [(1,)]  # the connection goes on


def asked(ground, text, *words, **options):
    words = [sys.executable, "-m", "hearth.cli", "query", str(ground / "asked"), text, *words]
    return subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (LONG[0], "TIMED_OUT"),
        (LONG[3], "TIMED_OUT"),
        ("SELECT len(range(2000000000))", "FILE_TOO_LARGE"),
        ("SELECT list(repeat('a', 1000)) FROM range(100000000)", "FILE_TOO_LARGE"),
    ],
)
@pytest.mark.skipif(sys.platform != "linux", reason="the memory of a process is bounded on Linux only")
def test_the_command_ends_in_time_and_memory(ground, text, code):
    process = asked(ground, text, "--csv", "--within", "8")
    process.stdout.close()  # not a terminal, nor read
    said = process.stderr.read().decode()
    process.wait(60)
    assert code in said or "Broken" in said or process.returncode, said
    assert process.returncode


def test_json_that_has_begun_stays_apart_from_its_fault(ground):
    text = "SELECT (CASE WHEN range = 4999999 THEN 'x' ELSE '1' END)::INT AS n FROM range(5000000)"
    out, said = asked(ground, text, "--json").communicate(timeout=60)
    assert out.startswith(b'[\n  {\n    "n": 1') and b"errors" not in out
    assert b"Conversion Error" in said
    out, _ = asked(ground, "SELECT 'x'::INT", "--json").communicate(timeout=60)
    assert json.loads(out)["errors"][0]["code"] == "SYNTAX"


@pytest.mark.parametrize("form", ["--json", "--csv"])
@pytest.mark.skipif(sys.platform != "linux", reason="`ru_maxrss` is in other units elsewhere")
def test_rows_are_printed_as_they_come(ground, form):
    """Three million rows take no more memory than one: 30 million were measured, too."""
    peaks = []
    for rows in (1, 3_000_000):
        code = (
            "import resource, sys; from hearth.cli import main\n"
            "try: main()\n"
            "except SystemExit: print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, file=sys.stderr)"
        )
        words = ["query", str(ground / "asked"), f"SELECT * FROM range({rows})", form, "--within", "0"]
        done = subprocess.run([sys.executable, "-c", code, *words], capture_output=True, check=False)
        found = [line for line in done.stderr.decode().splitlines() if line.strip().isdigit()]
        peaks.append(int(found[0]))
    assert peaks[1] < peaks[0] + 40_000


def test_an_interrupt_is_heeded(ground):
    process = asked(ground, LONG[0], preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
    time.sleep(4)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=20)
    assert process.returncode == 130, said
    assert b"Stopped." in said


def test_a_small_file_of_many_rows_is_answered(ground):
    """A column of one value takes next to nothing in Parquet."""
    path = next((ground / "asked/vocabulary").glob("*.parquet"))
    table = pq.read_table(path)
    row = table.slice(0, 1)
    many = pa.Table.from_arrays(
        [pa.array([row[name][0].as_py()] * 5_000_000, type=row.schema.field(name).type) for name in row.column_names],
        schema=row.schema,
    )
    pq.write_table(many, path, compression="zstd")
    assert path.stat().st_size < 1_000_000
    (ground / "asked/programs/part-9.parquet").unlink()
    dataset = Dataset.open(ground / "asked")
    assert dataset.rows("SELECT count(*), count(DISTINCT name) FROM vocabulary")[1] == [(5_000_000, 1)]
    assert len(dataset.rows("FROM vocabulary ORDER BY name", 100)[1]) == 100


def test_the_words_of_an_interruption_in_data_are_a_fault_of_the_question(ground):
    process = asked(ground, "SELECT error('Query interrupted')")
    _, said = process.communicate(timeout=60)
    assert process.returncode == 1 and b"Query interrupted" in said and b"Stopped" not in said
