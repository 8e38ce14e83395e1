"""A dataset checked from its folder: sound as published, and every way of damaging it named."""

from __future__ import annotations

import os
import shutil

import orjson
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq
import pytest

import hearth
from hearth.datasets.verify import verify
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.tables import TABLES
from hearth.storage.files import file_digest


@pytest.fixture
def copy(made, tmp_path):
    return shutil.copytree(made.out / "publish", tmp_path / "copy")


def part(folder, table, least=1):
    return next(path for path in sorted((folder / table).glob("*.parquet")) if pq.read_metadata(path).num_rows >= least)


def believed(folder, path):
    """Make the manifest say what the file now is, so that only its content is at fault."""
    manifest = orjson.loads((folder / "manifest.json").read_bytes())
    name = path.relative_to(folder).as_posix()
    manifest["files"][name] = {"bytes": path.stat().st_size, "sha256": file_digest(path)}
    (folder / "manifest.json").write_bytes(orjson.dumps(manifest))


def rewritten(folder, table, change):
    path = part(folder, table)
    pq.write_table(change(pq.ParquetFile(path).read()), path)
    believed(folder, path)


def codes(folder):
    return [str(fault.code) for fault in verify(folder).faults]


def said(folder, change):
    """A copy whose manifest says something else."""
    manifest = orjson.loads((folder / "manifest.json").read_bytes())
    change(manifest)
    (folder / "manifest.json").write_bytes(orjson.dumps(manifest))
    return folder


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda manifest: manifest["files"].update({"../secret.csv": {"bytes": 3, "sha256": "0"}}), "secret.csv"),
        (lambda manifest: manifest["files"].update({"/etc/hosts": {"bytes": 3, "sha256": "0"}}), "hosts"),
        (lambda manifest: manifest["files"].update({"x" * 999: {"bytes": 3, "sha256": "0"}}), "the folder has not"),
        (lambda manifest: manifest["files"].update({"splits.json": 7}), "splits.json"),
        (lambda manifest: manifest["files"].update({"splits.json": {"bytes": "x", "sha256": []}}), "splits.json"),
        (lambda manifest: manifest["counts"]["rows"].update({"range(999999999999)": 1}), "range"),
        (lambda manifest: manifest["counts"]["rows"].update({"programs": "x"}), "programs"),
        (lambda manifest: manifest.update(counts=[]), "field is missing or of another kind"),
        (lambda manifest: manifest["homes"]["overlay"].update(path="x\0y"), "lies outside"),
        (lambda manifest: manifest["homes"]["overlay"].update(path="loop"), "lies outside"),
    ],
)
def test_a_manifest_names_files_and_tables_of_the_folder(copy, change, message):
    (copy / "loop").symlink_to("loop")
    (copy.parent / "secret.csv").write_text("abc")
    faults = verify(said(copy, change)).faults
    assert faults and all(message in fault.message for fault in faults), faults


@pytest.mark.parametrize("change", [{"format": 0}, {"format": True}, {"version": None}, {"action_set": []}])
def test_a_manifest_without_its_form_is_refused(copy, change):
    with pytest.raises(HearthError, match="does not name a format, a version and its files"):
        verify(said(copy, lambda manifest: manifest.update(change)))


def test_what_never_ends_beside_the_tables_is_not_waited_for(copy):
    for name in ("timing.json", "catalog.sql"):
        (copy / name).unlink()
        os.mkfifo(copy / name)
    assert {"BAD_JSON", "DAMAGED_FILE", "MISSING_FILE"} & {*codes(copy)}
    os.mkfifo(copy / "programs/more.parquet")
    with pytest.raises(HearthError, match=r"more\.parquet: DAMAGED_FILE: is not a regular file"):
        hearth.load(copy).rows("SELECT 1 FROM programs")
    (copy / "manifest.json").unlink()
    (copy / "manifest.json").symlink_to("/dev/zero")
    with pytest.raises(HearthError, match="no dataset here"):
        hearth.load(copy)


def test_what_was_published_is_what_it_says(made):
    found = verify(made.out)
    assert found.faults == ()
    assert found.executions == len(made.rows("sample")) + len(made.rows("augment"))
    assert found.files > 10 < found.rows


def test_one_flipped_bit(copy):
    path = part(copy, "executions")
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(data)
    (fault,) = verify(copy).faults
    assert (str(fault.code), fault.file) == ("DAMAGED_FILE", str(path))


def test_a_file_cut_short_and_one_that_is_gone(copy):
    short, gone = part(copy, "programs"), part(copy, "home_edges")
    short.write_bytes(short.read_bytes()[:-1])
    gone.unlink()
    assert sorted(codes(copy)) == ["DAMAGED_FILE", "MISSING_FILE"]


def test_a_part_too_many(copy):
    path = part(copy, "programs")
    shutil.copy(path, path.with_name("part-00099.parquet"))
    assert codes(copy) == ["UNSUPPORTED_FILE"]


def test_a_table_without_files(copy):
    manifest = orjson.loads((copy / "manifest.json").read_bytes())
    manifest["files"] = {name: v for name, v in manifest["files"].items() if not name.startswith("vocabulary/")}
    (copy / "manifest.json").write_bytes(orjson.dumps(manifest))
    shutil.rmtree(copy / "vocabulary")
    assert codes(copy) == ["MISSING_FILE"]


def test_other_columns(copy):
    rewritten(copy, "programs", lambda table: table.drop_columns(["split"]))
    (fault,) = verify(copy).faults
    assert str(fault.code) == "BAD_TABLE"
    assert "split" in fault.message


def test_rows_that_are_gone(copy):
    rewritten(copy, "executions", lambda table: table.slice(1))
    assert "BAD_TABLE" in codes(copy)


def test_a_reference_to_nothing(copy):
    def elsewhere(table):
        names = pa.array(["nowhere"] * len(table), pa.string())
        return table.set_column(table.schema.get_field_index("activity_id"), table.schema.field("activity_id"), names)

    rewritten(copy, "programs", elsewhere)
    faults = verify(copy).faults
    assert any(str(fault.code) == "UNKNOWN_ID" and fault.found == "nowhere" for fault in faults)


def test_an_execution_that_says_another_change(copy):
    def fewer(table):
        rows = table.to_pylist()
        for row in rows:
            for tick in row["ticks"]:
                tick["added"] = tick["added"][1:]
        return pa.Table.from_pylist(rows, table.schema)

    rewritten(copy, "executions", fewer)
    found = verify(copy)
    assert {str(fault.code) for fault in found.faults} == {"REPLAY_DIFFERS"}
    assert "changes something else" in found.faults[0].message


def test_a_home_whose_things_are_in_other_states(copy):
    def closed(table):
        states = table["states"].combine_chunks()
        values = pc.replace_substring(states.values, "OPEN", "DIRTY")
        column = pa.ListArray.from_arrays(states.offsets, values)
        return table.set_column(table.schema.get_field_index("states"), table.schema.field("states"), column)

    rewritten(copy, "home_nodes", closed)
    assert set(codes(copy)) <= {"REPLAY_DIFFERS"}


def test_a_ledger_that_does_not_add_up(copy):
    def lost(table):
        place = table.schema.get_field_index("records_in")
        return table.set_column(place, table.schema.field(place), pc.add(table["records_in"], 1))

    rewritten(copy, "ledger", lost)
    assert set(codes(copy)) == {"BAD_TABLE"}


def test_a_sketch_without_a_flag_for_each_step(copy):
    def shorter(table):
        rows = table.to_pylist()
        rows[0]["keep"] = rows[0]["keep"][:-1]
        return pa.Table.from_pylist(rows, table.schema)

    rewritten(copy, "sketches", shorter)
    (fault,) = verify(copy).faults
    assert (str(fault.code), fault.file) == ("BAD_TABLE", str(copy / "sketches"))


def test_a_newer_dataset_is_not_guessed_at(copy):
    text = (copy / "manifest.json").read_text().replace('"format": 3', '"format": 99')
    (copy / "manifest.json").write_text(text)
    with pytest.raises(HearthError, match="format 99"):
        verify(copy)


def test_a_table_that_is_not_there_is_named(copy):
    shutil.rmtree(copy / "sketches")
    assert {*codes(copy)} == {"MISSING_FILE"}
    with pytest.raises(HearthError, match="no table `sketches`") as caught:
        len(hearth.load(copy))
    assert str(caught.value.diagnostics[0].code) == "MISSING_FILE"


def test_a_table_that_an_earlier_version_did_not_have_is_empty(copy):
    shutil.rmtree(copy / "videos")
    manifest = orjson.loads((copy / "manifest.json").read_bytes())
    manifest["files"] = {name: entry for name, entry in manifest["files"].items() if not name.startswith("videos/")}
    (copy / "manifest.json").write_bytes(orjson.dumps(manifest))
    ds = hearth.load(copy)
    assert len(ds) > 0
    assert ds.rows("SELECT count(*) FROM videos")[1] == [(0,)]
    assert ds.videos.columns == TABLES["videos"].names


def test_a_program_dealt_to_both_sides(copy):
    def moved(table):
        other = ["test" if split == "train" else "train" for split in table["split"].to_pylist()]
        return table.set_column(table.schema.get_field_index("split"), table.schema.field("split"), [other])

    rewritten(copy, "programs", moved)
    assert "BAD_TABLE" in codes(copy)


def test_any_number_of_workers_finds_the_same(copy, monkeypatch):
    def moved(table):
        rows = table.to_pylist()
        for row in rows:
            row["bindings"] = [{**each, "node": each["node"] + 1} for each in row["bindings"]]
        return pa.Table.from_pylist(rows, table.schema)

    rewritten(copy, "executions", moved)
    monkeypatch.setattr("hearth.datasets.verify.SHARE", 3)
    one, two = (verify(copy, number) for number in (1, 2))
    assert one == two and one.faults


def altered(folder, **changed):
    manifest = orjson.loads((folder / "manifest.json").read_bytes())
    (folder / "manifest.json").write_bytes(orjson.dumps({**manifest, **changed}))


CATALOGS = {
    "a view": "CREATE OR REPLACE VIEW programs AS SELECT 1 AS program_id",
    "a view more": "CREATE VIEW harm AS SELECT * FROM read_text('/etc/passwd')",
    "a macro": "CREATE OR REPLACE MACRO program_text(which) AS 'nothing'",
    "a table": "CREATE TABLE more(a INTEGER)",
    "a schema": "CREATE SCHEMA more",
    "a type": "CREATE TYPE more AS ENUM ('a')",
    "a sequence": "CREATE SEQUENCE more",
}


@pytest.mark.parametrize("name", CATALOGS)
def test_an_altered_catalog_is_found_and_never_used(copy, name):
    import duckdb

    rows = hearth.load(copy).rows("SELECT count(*) FROM programs JOIN executions USING (program_id)")
    with duckdb.connect(str(copy / "catalog.duckdb")) as connection:
        connection.execute(CATALOGS[name])
    (fault,) = verify(copy).faults
    assert (str(fault.code), fault.file) == ("DAMAGED_FILE", str(copy / "catalog.duckdb"))
    assert hearth.load(copy).rows("SELECT count(*) FROM programs JOIN executions USING (program_id)") == rows


def test_a_catalog_that_is_gone_or_is_none(copy):
    (copy / "catalog.duckdb").write_bytes(b"harm")
    assert codes(copy) == ["DAMAGED_FILE"]
    (copy / "catalog.duckdb").unlink()
    assert codes(copy) == ["MISSING_FILE"]
    assert len(hearth.load(copy))


@pytest.mark.parametrize("name", ["README.txt", "frames/harm.png", ".hidden", "programs/harm.exe", "knowledge/x.yaml"])
def test_files_that_the_manifest_does_not_name(copy, name):
    (copy / name).parent.mkdir(exist_ok=True)
    (copy / name).write_text("more")
    found = verify(copy)
    assert found.faults == () and [fault.file for fault in found.unknown] == [str(copy / name)]


def test_a_link_is_named_too(copy):
    (copy / "link").symlink_to("/etc")
    assert [fault.file for fault in verify(copy).unknown] == [str(copy / "link")]


def test_strict_fails_on_what_is_not_known(copy):
    from typer.testing import CliRunner

    from hearth.cli import app

    assert CliRunner().invoke(app, ["verify", str(copy), "--strict"]).exit_code == 0
    (copy / "more.txt").write_text("more")
    assert CliRunner().invoke(app, ["verify", str(copy)]).exit_code == 0
    strict = CliRunner().invoke(app, ["verify", str(copy), "--strict"])
    assert strict.exit_code == 1 and "more.txt" in strict.output


@pytest.mark.parametrize(
    "changed",
    [
        {"settings": {"seed": 7}}, {"plan": {"more": 1}}, {"code": "0"}, {"key": "0"}, {"inputs": {}},
        {"version": "9.9.9"}, {"action_set": "others/1"}, {"parts": [{"files": ["x"], "rows": 1}]},
        {"counts": {}}, {"counts": None}, {"parts": 7}, {"settings": None},
    ],
    ids=repr,
)  # fmt: skip
def test_altered_fields_of_the_manifest(copy, changed):
    altered(copy, **changed)
    assert "BAD_JSON" in codes(copy)


@pytest.mark.parametrize("more", [1, -1])
def test_a_ledger_that_counts_other_rows(copy, more):
    def counted(ledger):
        last = pc.equal(ledger["stage"], "publish")
        rows = pc.if_else(last, pc.add(ledger["rows"], more), ledger["rows"]).cast(ledger.schema.field("rows").type)
        return ledger.set_column(ledger.schema.get_field_index("rows"), ledger.schema.field("rows"), rows)

    rewritten(copy, "ledger", counted)
    (fault,) = verify(copy).faults
    assert str(fault.code) == "BAD_JSON" and "ledger" in fault.message


def test_what_fails_runs_nothing_again(copy):
    altered(copy, version="9.9.9")
    found = verify(copy)
    assert found.faults and found.executions == 0 < found.rows


@pytest.mark.parametrize("field", ["records_in", "through", "partial"])
def test_altered_counts_of_the_manifest(copy, field):
    manifest = orjson.loads((copy / "manifest.json").read_bytes())
    manifest["counts"][field] += 1
    altered(copy, counts=manifest["counts"])
    assert "BAD_JSON" in codes(copy)


@pytest.mark.parametrize("more", [1, -1])
def test_a_part_that_counts_other_rows_and_a_field_of_no_manifest(copy, more):
    manifest = orjson.loads((copy / "manifest.json").read_bytes())
    altered(copy, more=1)
    assert [fault.found for fault in verify(copy).unknown] == ["more"]
    manifest["parts"][0]["rows"] += more
    altered(copy, parts=manifest["parts"])
    assert codes(copy) == ["BAD_JSON"]


def test_timing_of_no_build(copy):
    (copy / "timing.json").write_text('{"seconds": 1, "workers": 2, "more": "harm"}')
    assert codes(copy) == ["BAD_JSON"]


def test_statistics_that_hide_rows(copy):
    """A file's footer decides which rows are read; a row that is not read is not verified."""
    path = part(copy, "executions")
    names = pq.read_table(path, columns=["execution_id"])["execution_id"].to_pylist()
    data = path.read_bytes()
    footer = len(data) - 8 - int.from_bytes(data[-8:-4], "little")
    end = data[footer:]
    for name in {min(names), max(names)}:
        end = end.replace(name.encode(), b"~" * len(name.encode()))
    path.write_bytes(data[:footer] + end)
    believed(copy, path)
    assert "REPLAY_DIFFERS" in codes(copy)
    assert "statistics" in verify(copy).faults[0].message
