"""The loop that all stages share."""

from __future__ import annotations

import os
import pickle
import time
from dataclasses import replace
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from hearth.pipelines import publish
from hearth.pipelines.engine import runner
from hearth.pipelines.engine.runner import run_stage
from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.engine.stage import Job, Partition, Stage
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.lock import locked
from hearth.storage.partitions import Counts
from hearth.storage.rejects import INTERNAL_ERROR, Reject

SCHEMA = pa.schema([("program_id", pa.string()), ("number", pa.int32()), ("half", pa.int32())])


def process(record, context):
    number = record["number"]
    if number % 10 == 3:
        return Reject.of(Code.EMPTY, "ends in three", file="numbers", line=number)
    if number % 10 == 5:
        raise KeyError(number)
    if number % 10 == 7:
        return [{"number": "not a number", "program_id": record["program_id"]}]
    rows = [{"program_id": record["program_id"], "number": number, "half": half} for half in range(1 + number % 2)]
    return [*rows, Reject.of(Code.SYNTAX, "a part of it")] if number % 10 == 9 else rows


def partitions(job):
    for share in range(4):
        yield Partition(share, f"share {share}", list(range(share * 25, share * 25 + 25)), 25)


def records(job, partition):
    return ({"program_id": f"n{number}", "number": number} for number in partition.payload)


STAGE = Stage("count", {"": SCHEMA}, process, partitions=partitions, records=records, settings=("seed",))


@pytest.fixture
def settings(tmp_path):
    source = tmp_path / "numbers.txt"
    source.write_text("0 to 99")
    return Settings((str(source),), str(tmp_path / "out"))


def rejects(result):
    return pq.read_table(result.manifest.folder / "rejects.parquet").to_pylist()


def contents(folder):
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir()) if path.name != "timing.json"}


def test_every_record_ends_in_rows_or_in_rejects(settings):
    result = run_stage(STAGE, settings)
    counts = result.manifest.counts
    assert (counts.records_in, counts.through, counts.rejected) == (100, 70, 30)
    assert counts.codes == {"EMPTY": 10, INTERNAL_ERROR: 20}
    assert counts.partial == 10
    rows = [row for path in sorted(result.manifest.folder.glob("part-*")) for row in pq.read_table(path).to_pylist()]
    assert counts.rows.total() == len(rows) == 70 + sum(n % 2 for n in range(100) if n % 10 in (1, 9))
    ids = {row["program_id"] for row in rows} | {row["record_id"] for row in rejects(result) if not row["partial"]}
    assert ids == {f"n{number}" for number in range(100)}


def test_an_exception_costs_its_own_record_and_says_where_it_arose(settings):
    (row,) = [row for row in rejects(run_stage(STAGE, settings)) if row["record_id"] == "n15"]
    assert row["code"] == INTERNAL_ERROR
    assert "KeyError at test_stage_loop.py:" in row["message"]


def test_a_row_that_does_not_fit_its_table_costs_its_own_record(settings):
    found = {row["record_id"]: row["code"] for row in rejects(run_stage(STAGE, settings))}
    assert found["n17"] == INTERNAL_ERROR
    assert "n16" not in found
    assert "n18" not in found


def test_a_column_that_the_table_lacks_is_not_dropped_in_silence(settings):
    stage = replace(STAGE, process=lambda record, context: [{"nmuber": record["number"]}])
    result = run_stage(stage, settings)
    assert result.manifest.counts.codes == {INTERNAL_ERROR: 100}
    assert "nmuber" in rejects(result)[0]["message"]


def test_a_record_of_which_nothing_comes_is_rejected(settings):
    result = run_stage(replace(STAGE, process=lambda record, context: []), settings)
    assert result.manifest.counts.rejected == 100


def test_counts_that_do_not_add_up_are_an_error():
    with pytest.raises(AssertionError, match="3 records in, 1 through, 1 rejected"):
        Counts(records_in=3, through=1, rejected=1).check("somewhere")


def test_the_manifest_is_written_last(settings, monkeypatch):
    written = []
    replaced = Path.replace

    def replace_and_note(path, target):
        written.append(Path(target).name)
        return replaced(path, target)

    monkeypatch.setattr(Path, "replace", replace_and_note)
    run_stage(STAGE, settings)
    assert written.count("manifest.json") == 1
    assert "timing.json" in written
    assert written[-1] == "manifest.json"


def test_what_is_up_to_date_is_not_done_again(settings):
    assert run_stage(STAGE, settings).fresh
    assert not run_stage(STAGE, settings).fresh
    assert run_stage(STAGE, replace(settings, seed=1)).fresh


def test_a_damaged_part_is_made_again(settings):
    folder = run_stage(STAGE, settings).manifest.folder
    before = contents(folder)
    (folder / "part-00002.parquet").write_bytes(b"PAR1")
    assert run_stage(STAGE, settings).fresh
    assert contents(folder) == before


def test_a_stopped_stage_goes_on_where_it_was(settings, monkeypatch):
    folder = run_stage(STAGE, settings).manifest.folder
    undisturbed = contents(folder)
    for path in folder.iterdir():
        path.unlink()
    done = []
    run_partition = runner.Workers.run

    def stop_after_two(self, job, partitions, seen):
        for number, one in enumerate(run_partition(self, job, partitions, seen)):
            done.append(one[0].number)
            yield one
            if number == 1:
                raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(runner.Workers, "run", stop_after_two)
        with pytest.raises(KeyboardInterrupt):
            run_stage(STAGE, settings)
    assert not (folder / "manifest.json").exists()
    again = []
    monkeypatch.setattr(
        runner.Workers, "run", lambda *given: (again.append(x[0].number) or x for x in run_partition(*given))
    )
    run_stage(STAGE, settings)
    assert (done, again) == ([0, 1], [2, 3])
    assert contents(folder) == undisturbed


def test_a_share_that_changed_is_made_again_alone(settings, monkeypatch):
    folder = run_stage(STAGE, settings).manifest.folder
    untouched = (folder / "part-00000.parquet").stat().st_mtime_ns

    def changed(job):
        for share in partitions(job):
            yield replace(share, digest="new", payload=[*share.payload, 1000]) if share.number == 3 else share

    stage = replace(STAGE, partitions=changed)
    result = run_stage(stage, replace(settings, sources=(*settings.sources, settings.sources[0])))
    assert result.manifest.counts.records_in == 101
    assert (folder / "part-00000.parquet").stat().st_mtime_ns == untouched
    assert len([row for row in rejects(result) if not row["partial"]]) == 30


def test_parts_that_no_longer_exist_are_removed(settings):
    folder = run_stage(STAGE, settings).manifest.folder
    fewer = replace(STAGE, partitions=lambda job: (p for p in partitions(job) if p.number < 2))
    run_stage(fewer, replace(settings, sources=(*settings.sources, settings.sources[0])))
    assert sorted(path.name for path in folder.glob("part-*")) == ["part-00000.parquet", "part-00001.parquet"]


def test_nothing_half_written_is_left(settings):
    stage = replace(STAGE, records=lambda job, partition: iter([1 / 0]))
    with pytest.raises(ZeroDivisionError):
        run_stage(stage, settings)
    folder = settings.folder("count")
    assert [path.name for path in folder.iterdir()] == []
    (folder / ".part-00000.parquet.99.tmp").write_text("half of a part")
    (folder / ".catalog.duckdb.99.tmp.wal").write_text("what a library keeps beside half a file")
    run_stage(STAGE, settings)
    assert [path.name for path in folder.iterdir() if ".tmp" in path.name] == []


def test_what_a_build_stopped_after_its_manifest_left_goes(settings):
    folder = run_stage(STAGE, settings).manifest.folder
    before = contents(folder)
    (folder / ".rejects-00001.parquet").write_bytes(b"gathered already")
    assert not run_stage(STAGE, settings).fresh
    assert contents(folder) == before


def test_two_builds_at_once_are_refused(settings, tmp_path):
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        with locked(tmp_path / "out"):
            os.write(writer, b"held")
            os.read(reader, 1)
            import signal

            signal.pause()
        os._exit(0)
    try:
        import time

        for _ in range(200):
            if (tmp_path / "out/.lock").exists() and (tmp_path / "out/.lock").read_text():
                break
            time.sleep(0.02)
        with pytest.raises(HearthError, match=f"process {child} is building here"):
            run_stage(STAGE, settings)
    finally:
        os.kill(child, 9)
        os.waitpid(child, 0)
    assert run_stage(STAGE, settings).fresh


def test_a_stage_says_which_one_it_lacks(settings):
    stage = replace(STAGE, reads=("validate",))
    with pytest.raises(HearthError, match="run `validate` first"):
        run_stage(stage, settings)


def test_a_record_that_hangs_costs_only_itself_and_is_tried_again(settings):
    patience = {"n5": 60.0}

    def slow(record, context):
        end = time.monotonic() + patience.get(record["program_id"], 0.0)
        while time.monotonic() < end:
            pass
        return [{"program_id": record["program_id"], "number": record["number"], "half": 0}]

    stage = replace(STAGE, process=slow)
    result = run_stage(stage, replace(settings, time_limit=0.2))
    assert [(row["record_id"], row["code"]) for row in rejects(result)] == [("n5", "TIMED_OUT")]
    assert result.manifest.counts.through == 99
    patience.clear()
    again = run_stage(stage, replace(settings, time_limit=0.2))
    assert again.fresh and again.manifest.counts.through == 100
    assert not run_stage(stage, settings).fresh


def test_parts_are_shared_and_gathered_without_loss(settings):
    run_stage(STAGE, settings)
    source = replace(STAGE, process=lambda record, context: [{**record}] if record["number"] != 40 else [])
    whole = replace(source, name="whole", reads=("count",), partitions=None, records=None)
    stages = (whole, replace(whole, name="shared", share=7), replace(whole, name="gathered", gather=60))
    found = [run_stage(stage, settings).manifest for stage in stages]
    one, shared, gathered = found
    assert one.counts.to_json() == shared.counts.to_json() == gathered.counts.to_json()
    assert (len(one.parts), len(gathered.parts)) == (4, 2) and len(shared.parts) > 12
    rows = [
        [row for part in each.parts for row in pq.read_table(each.folder / part["files"][0]).to_pylist()]
        for each in found
    ]
    assert rows[0] == rows[1] == rows[2]


def test_a_job_goes_to_a_worker_without_what_was_opened_here(settings):
    job = Job(publish.STAGE, settings)
    assert job.context.homes.names()
    sent = pickle.loads(pickle.dumps(job))
    assert sent == job and "context" not in vars(sent)
