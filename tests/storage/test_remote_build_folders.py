"""Folders that live elsewhere, in the store in memory that comes with fsspec."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import pytest

fsspec = pytest.importorskip("fsspec")

from hearth.datasets.dataset import Dataset  # noqa: E402
from hearth.datasets.verify import verify  # noqa: E402
from hearth.pipelines.build import build  # noqa: E402
from hearth.schemas.diagnostics import HearthError  # noqa: E402
from hearth.schemas.failures import Code  # noqa: E402
from hearth.storage.files import file_digest  # noqa: E402
from hearth.storage.remote import url_of  # noqa: E402
from hearth.storage.remote_build_folders import Store, store, working  # noqa: E402
from hearth.storage.url_fetching import _temporary_folder, fetched  # noqa: E402

URL = "memory://bucket/evening"


@pytest.fixture(autouse=True)
def memory(tmp_path, monkeypatch):
    """An empty store, and work folders of the test's own."""
    (tmp_path / "work").mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "work"))
    store.cache_clear()
    _temporary_folder.cache_clear()
    filesystem = fsspec.filesystem("memory")
    filesystem.store.clear()
    yield filesystem
    filesystem.store.clear()


def names(memory):
    return {path.removeprefix("/bucket/evening/") for path in memory.find("/bucket/evening")}


@pytest.mark.parametrize(
    ("path", "url"),
    [
        ("s3://bucket/a", "s3://bucket/a"),
        (Path("s3://bucket/a"), "s3://bucket/a"),
        ("memory://x/", "memory://x"),
        ("data_out", None),
        (Path("/tmp/x"), None),
        ("C:/data", None),
    ],
)
def test_what_is_a_url(path, url):
    assert url_of(path) == url


def build_into(url, made):
    settings = made.settings
    return build(settings.sources, url, homes=settings.homes, homes_folder=settings.homes_folder, pictures=0,
                 action_set=2)  # fmt: skip


def forget_the_copy():
    shutil.rmtree(Store(URL).work)


def test_a_build_into_a_store_is_the_local_one(made, memory):
    build_into(URL, made)
    local = {
        path.relative_to(made.out).as_posix(): path.read_bytes()
        for path in made.out.rglob("*")
        if path.is_file() and path.name not in ("timing.json", "catalog.duckdb", ".lock")
    }
    assert {name: memory.cat(f"/bucket/evening/{name}") for name in local} == local
    assert names(memory) - local.keys() == {
        ".revision", "publish/catalog.duckdb",
        *(f"{stage}/timing.json" for stage in ("ingest", "validate", "sample", "augment", "render", "publish")),
    }  # fmt: skip
    assert not build_into(URL, made).fresh
    forget_the_copy()
    assert not build_into(URL, made).fresh


def test_the_dataset_is_read_where_it_is(made, memory):
    memory.put(f"{made.out}/publish/", "/bucket/evening/publish/", recursive=True)
    assert len(Dataset.open(URL)) == len(made.rows("publish/programs"))
    assert verify(URL).faults == ()
    before = {path: path.stat().st_mtime_ns for path in fetched(URL).rglob("*.parquet")}
    assert before and {path: path.stat().st_mtime_ns for path in fetched(URL).rglob("*.parquet")} == before


def test_a_source_is_fetched_and_again_when_it_changes(memory):
    memory.pipe_file("/bucket/evening/a.txt", b"one")
    assert fetched(f"{URL}/a.txt").read_bytes() == b"one"
    memory.pipe_file("/bucket/evening/a.txt", b"two")
    assert fetched(f"{URL}/a.txt").read_bytes() == b"two"
    with pytest.raises(HearthError) as error:
        fetched(f"{URL}/b.txt")
    assert error.value.diagnostics[0].code is Code.MISSING_FILE


def test_only_one_builds_there(memory):
    with working(URL), pytest.raises(HearthError) as error, working(URL):
        pass
    (fault,) = error.value.diagnostics
    assert fault.code is Code.LOCKED and "process" in fault.message and fault.file == URL
    with working(URL):
        pass


def test_the_lock_of_a_killed_build_is_taken_over_on_its_machine_only(memory):
    with working(URL):
        held = json.loads(memory.cat("/bucket/evening/.lock"))
    dead = {**held, "pid": 2**22 + 1}
    memory.pipe_file("/bucket/evening/.lock", json.dumps(dead).encode())
    with working(URL):
        pass
    memory.pipe_file("/bucket/evening/.lock", json.dumps({**dead, "host": "another"}).encode())
    with pytest.raises(HearthError), working(URL):
        pass


def test_another_machine_goes_on_from_what_is_there(made, memory):
    build_into(URL, made)
    work = Store(URL).work
    memory.rm_file("/bucket/evening/publish/manifest.json")
    memory.rm("/bucket/evening/publish/programs", recursive=True)
    forget_the_copy()
    assert build_into(URL, made).fresh == ("publish",)
    assert (work / "publish/manifest.json").read_bytes() == memory.cat("/bucket/evening/publish/manifest.json")


def test_a_copy_that_is_behind_the_store_is_fetched_anew(made, memory):
    build_into(URL, made)
    memory.pipe_file("/bucket/evening/.revision", b"another machine was here")
    memory.rm("/bucket/evening/publish", recursive=True)
    with working(URL) as (folder, _, _):
        assert not (Path(folder) / "publish").exists()


def test_a_push_that_was_cut_off_is_made_up_for(made, memory):
    build_into(URL, made)
    memory.rm_file("/bucket/evening/sample/manifest.json")
    memory.rm_file("/bucket/evening/sample/part-00000.parquet")
    with working(URL):
        pass
    assert {"sample/manifest.json", "sample/part-00000.parquet"} <= names(memory)


def test_a_worker_elsewhere_fetches_what_it_needs(made, memory):
    from hearth.pipelines.engine.runner import input_partitions
    from hearth.pipelines.engine.settings import Settings
    from hearth.pipelines.engine.stage import Job
    from hearth.pipelines.engine.stages import stage
    from hearth.pipelines.engine.workers import run_here

    build_into(URL, made)
    with working(URL) as (folder, url, revision):
        settings = replace(made.settings, out=folder, store=url, revision=revision)
        assert isinstance(settings, Settings)
        job = Job(stage("validate"), settings, stage("validate").prepare(settings))
        partition = next(input_partitions(job))
        memory.rm_file("/bucket/evening/validate/part-00000.parquet")
        shutil.rmtree(folder)
        counts = run_here(job, partition)
        assert counts.records_in and "validate/part-00000.parquet" in names(memory)
        assert not (Path(folder) / "ingest/part-00001.parquet").exists()


CHANGING = ("put_file", "pipe_file", "cp_file", "rm_file")
"""Calls by which a build changes a store."""


@pytest.fixture
def changes(memory, monkeypatch):
    """Calls a function before and after each change to the store, once it is given one."""
    watching = []

    def watched(change, own):
        def call(*words, **options):
            watch = watching.pop() if watching else lambda *_: None
            try:
                watch(change, words)
                own(*words, **options)
                watch("", ())
            finally:
                watching.append(watch)

        return call

    for change in CHANGING:
        monkeypatch.setattr(memory, change, watched(change, getattr(memory, change)))
    return watching


def publish_anew(made, seed):
    settings = made.settings
    return build(out=URL, only="publish", seed=seed, homes=settings.homes, pictures=0)


def read_whole():
    """The key of the dataset as somebody finds it who has not read it before; each of its files is as it should be."""
    _temporary_folder.cache_clear()
    folder = fetched(URL)
    manifest = json.loads((folder / "manifest.json").read_bytes())
    files = {path.relative_to(folder).as_posix(): file_digest(path) for path in folder.rglob("*") if path.is_file()}
    said = {name: entry["sha256"] for name, entry in manifest["files"].items()}
    others = {"manifest.json", "timing.json", "catalog.duckdb", ".fetched.json"}
    assert {name: value for name, value in files.items() if name not in others} == said
    shutil.rmtree(folder.parent)
    return manifest["key"]


def test_whoever_reads_between_two_changes_finds_the_old_or_the_new(made, changes):
    build_into(URL, made)
    before, seen, moments = read_whole(), [], []

    def read(change, words):
        moments.append(change)
        seen.append(read_whole())

    changes.append(read)
    assert publish_anew(made, 1).fresh
    after = read_whole()
    assert list(dict.fromkeys(seen)) == [before, after] and before != after
    assert moments.count("put_file") > 20 and moments.count("cp_file") > 20 and moments.count("rm_file") > 20


def test_whoever_reads_during_the_first_build_finds_none_or_all(made, changes):
    seen = []

    def read(change, words):
        try:
            seen.append(read_whole())
        except FileNotFoundError:
            seen.append("none")

    settings = made.settings
    for name in ("ingest", "validate", "sample", "augment", "render"):
        build(settings.sources, URL, only=name, homes=settings.homes, homes_folder=settings.homes_folder, pictures=0,
                 action_set=2)  # fmt: skip
    changes.append(read)
    publish_anew(made, 0)
    assert list(dict.fromkeys(seen)) == ["none", read_whole()]


def test_each_file_is_sent_once(made, changes):
    sent = []
    changes.append(lambda change, words: sent.append(words[0]) if change == "put_file" else None)
    build_into(URL, made)
    tables = [path.replace("/.publish/", "/publish/") for path in map(str, sent) if "publish/" in path]
    assert len(tables) == len(set(tables)) == len(made.result.manifest.content["files"]) + 3
    sent.clear()
    assert publish_anew(made, 0).fresh == () and sent == []


class Stopped(Exception):
    """A build is killed."""


def test_a_build_stopped_between_any_two_changes_is_made_up_for(made, memory, changes):
    build_into(URL, made)
    before = read_whole()
    shutil.copytree(Store(URL).work, kept := Path(tempfile.gettempdir()) / "kept")
    there, number, found = dict(memory.store), 0, set()

    def stop(change, words, left):
        left.append(change)
        if len(left) == 2 * number + 1:
            raise Stopped

    while True:
        left = []
        changes[:] = [lambda change, words, left=left: stop(change, words, left)]
        try:
            publish_anew(made, 1)
            break
        except (Stopped, HearthError):
            changes.clear()
            found.add(read_whole())
        publish_anew(made, 1)
        assert not [name for name in names(memory) if name.startswith(".publish")]
        found.add(read_whole())
        memory.store.clear()
        memory.store.update(there)
        shutil.rmtree(Store(URL).work)
        shutil.copytree(kept, Store(URL).work)
        number += 7  # each seventh moment, of some two hundred
    changes.clear()
    assert number > 70 and found == {before, read_whole()}


def test_an_unknown_kind_of_store_is_named():
    with pytest.raises(HearthError) as error:
        fetched("nosuch://bucket/a")
    assert "nosuch" in error.value.diagnostics[0].message


@pytest.mark.parametrize("name", ["../../stolen", "tables/../../../stolen", "/stolen", "..\\stolen", "c:/stolen"])
def test_a_name_that_leaves_the_copy_is_refused(memory, tmp_path, monkeypatch, name):
    memory.pipe_file("/bucket/evening/manifest.json", b"{}")
    found = memory.find("/bucket/evening", detail=True)
    key = f"/bucket/evening/{name}"
    hostile = {**found, key: {"name": "/bucket/evening/manifest.json", "size": 2}}
    monkeypatch.setattr(memory, "find", lambda *_, **__: hostile)
    before = sorted(path for path in tmp_path.rglob("*") if path.is_file())
    for read in (lambda: fetched(URL), lambda: store(URL).settle()):
        with pytest.raises(HearthError) as error:
            read()
        assert error.value.diagnostics[0].code is Code.DAMAGED_FILE
    outside = [path for path in tmp_path.rglob("*") if path.is_file() and "stolen" in path.name]
    assert not outside and not before and not Path("/stolen").exists()


def test_a_folder_that_goes_while_it_is_listed_holds_nothing(memory, monkeypatch):
    """s3fs lists such a folder as itself."""
    memory.pipe_file("/bucket/evening/a.txt", b"one")
    found = {"/bucket/evening": {"name": "/bucket/evening", "size": 0, "type": "directory"}}
    monkeypatch.setattr(memory, "find", lambda *_, **__: found)
    with pytest.raises(HearthError) as error:
        fetched(URL)
    assert error.value.diagnostics[0].code is Code.MISSING_FILE


def test_members_of_a_zip_do_not_leave_the_copy(tmp_path):
    import zipfile

    path = tmp_path / "dataset.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("ds/manifest.json", "{}")
        archive.writestr("ds/../../../stolen", "x")
    with pytest.raises(HearthError):
        fetched(f"zip://ds::{path}")
    assert not list(tmp_path.parent.rglob("stolen"))


def test_a_link_in_a_folder_given_as_a_url_does_not_lead_out(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "given"
    folder.mkdir()
    (tmp_path / "secret").write_text("secret")
    (folder / "a.txt").write_text("a")
    assert (fetched("file://given") / "a.txt").read_text() == "a"
    (folder / "b.txt").symlink_to(tmp_path / "secret")
    with pytest.raises(HearthError, match="leaves the folder"):
        fetched("file://given")


def test_copies_are_closed_to_others_and_removed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.txt").write_text("a")
    asked = """if True:
        from hearth.storage.url_fetching import fetched
        from hearth.storage.remote_build_folders import Store
        print(fetched("file://a.txt"))
        print(Store("memory://x").work)"""
    environment = {**os.environ, "TMPDIR": str(tmp_path / "work")}
    seen = []
    for _ in range(2):
        command = [sys.executable, "-c", asked]
        done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=True)
        copy, work = map(Path, done.stdout.split())
        seen.append(copy.parent.parent)
        assert not copy.parent.parent.exists() and work.parent.stat().st_mode & 0o777 == 0o700
    assert seen[0] != seen[1]
    assert fetched("file://a.txt").parent.parent.stat().st_mode & 0o777 == 0o700


def test_a_folder_that_another_user_prepared_is_not_used(tmp_path):
    (tmp_path / "elsewhere").mkdir()
    place = tmp_path / f"work/hearth-{os.getuid()}"
    place.symlink_to(tmp_path / "elsewhere")
    with pytest.raises(HearthError, match="closed to others"):
        Store(URL)
    place.unlink()
    place.mkdir(mode=0o777)
    place.chmod(0o777)
    with pytest.raises(HearthError, match="closed to others"):
        Store(URL)
