"""Ids of workers are published as hashes, by a salt that nothing of a build gives away."""

import json
import re
from types import SimpleNamespace

import pytest

from hearth.pipelines import ingest
from hearth.pipelines.engine.runner import run_stage
from hearth.pipelines.engine.salt_record import salt_changed
from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.engine.source_labels import labelled, salt, source_digests
from hearth.pipelines.ingest import items, read
from hearth.pipelines.readers.reader_items import worker_hash
from hearth.storage.files import value_digest

RAW = "A3RAWWORKERID"
RECORD = {"title": "Watch TV", "worker": RAW, "steps": ["[Walk] <television> (1)"]}


def workers(path):
    return [row["worker"] for _, item in items(labelled([str(path)])) for row in read(item, salt="salt")]


def test_ids_in_records_are_hashed_and_hashes_stay(tmp_path):
    path = tmp_path / "a.jsonl"
    path.write_text("".join(json.dumps({**RECORD, "worker": name}) + "\n" for name in (RAW, "0123456789abcdef")))
    first, second = workers(path)
    assert re.fullmatch("[0-9a-f]{16}", first) and first == worker_hash(RAW, "salt") != worker_hash(RAW, "other")
    assert second == "0123456789abcdef"


def test_the_salt_cannot_be_computed_from_what_a_manifest_has(tmp_path):
    path = tmp_path / "a.jsonl"
    path.write_text(json.dumps(RECORD))
    settings = SimpleNamespace(salt=None, sources=[str(path)])
    made = salt(settings)
    assert made != value_digest(["workers", sorted(source_digests(settings.sources).values())])
    assert made == salt(settings)
    path.write_text(json.dumps({**RECORD, "title": "Watch"}))
    assert made != salt(settings)
    assert salt(SimpleNamespace(salt="mine", sources=[str(path)])) == "mine"


def test_labels_differ_whatever_files_are_called(tmp_path):
    paths = [tmp_path / "x/a", tmp_path / "y/a", tmp_path / "a~2"]
    for path in paths:
        path.parent.mkdir(exist_ok=True)
        path.write_text(path.as_posix())
    names = list(map(str, paths))
    assert sorted(source.label for source in labelled(names)) == ["a", "a~2", "a~3"]
    assert len(source_digests(names)) == 3


def test_lines_of_graphs_are_lines(tmp_path):
    """The first line is longer than what is looked at to recognise other forms."""
    path = tmp_path / "a.jsonl"
    path.write_text("".join(json.dumps({**RECORD, "note": "x" * 150_000}) + "\n" for _ in range(3)))
    assert len(workers(path)) == 3


@pytest.mark.parametrize("before", [False, True])
def test_a_wide_first_cell_of_a_table_is_read_whatever_was_read_before(tmp_path, before):
    if before:
        (tmp_path / "a.csv").write_text("title,description\nx,y\n")
    wide = tmp_path / "b.csv"
    wide.write_text(f"title,{'d' * 140_000}\nWatch TV,On the sofa\n")
    for path in sorted(tmp_path.iterdir()):
        list(items(labelled([str(path)])))


@pytest.fixture
def salted(tmp_path):
    """Build `ingest` with a salt, or none; the ids of workers and the manifest as text."""
    folder = tmp_path / "batch"
    folder.mkdir()
    header = "HITId,WorkerId,Platform,AssignmentStatus,Input.scene,Answer.title,Answer.description\n"
    (folder / "descriptions.csv").write_text(f"{header}D1,W1,AMT,Approved,bedroom,Read,I sit down and read a book.\n")

    def built(given):
        settings = Settings(sources=(str(folder),), out=str(tmp_path / "out"), salt=given)
        run_stage(ingest.STAGE, settings)
        return (settings.folder("ingest") / "manifest.json").read_text()

    return built


def test_a_manifest_has_no_digest_of_a_salt(salted):
    """A salt that somebody guesses could be tried on any digest of it, the stage's key included."""
    made = json.loads(salted("guessable"))
    assert "salt" not in json.dumps(made["plan"]) and "salt" not in made["settings"]
    assert json.loads(salted("another"))["key"] == made["key"]


def test_another_salt_begins_anew(tmp_path):
    assert not salt_changed(tmp_path, None)
    assert salt_changed(tmp_path, "one") and not salt_changed(tmp_path, "one")
    assert salt_changed(tmp_path, "two") and salt_changed(tmp_path, None) and not salt_changed(tmp_path, None)
    salt_changed(tmp_path, "three")
    (file,) = tmp_path.iterdir()
    assert file.stat().st_mode & 0o077 == 0 and b"three" not in file.read_bytes()
