"""A build that replaces a dataset: whoever reads it meanwhile finds the old one or the new one, never none."""

from __future__ import annotations

import shutil
import subprocess
import sys
import time
from dataclasses import replace

import pytest

import hearth
from hearth.pipelines.engine.runner import run_stage
from hearth.pipelines.engine.stages import stage
from hearth.storage import folder_exchange
from hearth.storage.folder_exchange import away, beside, present, put_in_place, recover, start_from

READER = """
import sys
from pathlib import Path
import hearth

folder, done = Path(sys.argv[1]), Path(sys.argv[2])
opened, failed, seen = 0, [], set()
Path(sys.argv[3]).touch()
while not done.exists() or not opened:
    try:
        ds = hearth.load(folder)
        (first, *_) = ds
        ds[first].runs[0].final
        ds.rows("SELECT count(*) FROM executions JOIN programs USING (program_id)")
        seen.add(ds.manifest["key"])
    except Exception as error:
        failed.append(repr(error))
    opened += 1
print(opened, len(failed), len(seen), failed[:3])
"""


@pytest.fixture
def again(made, tmp_path):
    """A way to publish a copy of a build again, with a seed that decides its splits."""
    shutil.copytree(made.out, tmp_path / "out")
    settings = replace(made.settings, out=str(tmp_path / "out"))

    def publish(seed):
        return run_stage(stage("publish"), replace(settings, seed=seed))

    return publish


def key(folder):
    return hearth.load(folder).manifest["key"]


def test_eight_readers_while_a_dataset_is_replaced(again, tmp_path):
    done, script = tmp_path / "done", tmp_path / "reader.py"
    script.write_text(READER)
    ready = [tmp_path / f"ready{number}" for number in range(8)]
    asked = [[sys.executable, str(script), str(tmp_path / "out"), str(done), str(path)] for path in ready]
    readers = [subprocess.Popen(one, stdout=subprocess.PIPE, text=True) for one in asked]
    while not all(path.exists() for path in ready):
        time.sleep(0.05)
    published = {again(seed).manifest.key for seed in (1, 2, 3, 4)}
    done.touch()
    found = [reader.communicate(timeout=300)[0].split(maxsplit=3) for reader in readers]
    assert len(published) == 4
    assert [(int(failed), why) for _, failed, _, why in found if int(failed)] == []
    assert sum(int(opened) for opened, *_ in found) >= 8


def test_a_dataset_that_is_open_goes_on_with_the_new_one(again, tmp_path):
    ds = hearth.load(tmp_path / "out")
    before, programs, part = ds.manifest["key"], list(ds), {row["part"] for row in ds.read("SELECT part FROM splits")}
    again(1)
    assert list(ds) == programs and ds[programs[0]].runs
    assert ds.manifest["key"] == key(tmp_path / "out") != before
    assert part


def test_nothing_is_missing_until_the_new_one_is_complete(again, tmp_path, monkeypatch):
    folder, seen = tmp_path / "out/publish", []
    before, exchanged = key(folder), folder_exchange.exchanged
    monkeypatch.setattr(
        folder_exchange, "exchanged", lambda one, other: seen.append(key(folder)) or exchanged(one, other)
    )
    assert again(1).fresh
    assert seen == [before] and key(folder) != before
    assert not beside(folder).exists()


def test_a_build_that_is_stopped_leaves_the_old_one_and_goes_on(again, tmp_path, monkeypatch):
    folder = tmp_path / "out/publish"
    before = key(folder)
    with monkeypatch.context() as patch:
        patch.setattr("hearth.pipelines.engine.runner.put_in_place", lambda folder: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            again(1)
    assert key(folder) == before and hearth.load(folder)
    assert beside(folder).exists()
    whole = again(1)
    assert whole.fresh and key(folder) == whole.manifest.key != before
    assert not beside(folder).exists() and not again(1).fresh


def test_what_a_build_killed_after_the_exchange_left_goes(again, tmp_path):
    folder = tmp_path / "out/publish"
    shutil.copytree(folder, beside(folder))
    assert not again(0).fresh
    assert not beside(folder).exists()


def test_parts_that_did_not_change_are_kept(again, tmp_path):
    folder = tmp_path / "out/publish"
    (folder / "manifest.json").unlink()
    part = next(folder.glob("executions/part-*.parquet"))
    before = part.stat().st_ino
    assert again(0).fresh
    assert part.stat().st_ino == before


@pytest.fixture
def folders(tmp_path):
    folder = tmp_path / "data"
    folder.mkdir()
    (folder / "part").write_text("old")
    start_from(folder, [folder / "part"])
    (beside(folder) / "new").write_text("new")
    return folder


@pytest.mark.parametrize("can", [True, False])
def test_a_folder_takes_the_place_of_another(folders, monkeypatch, can):
    if not can:
        monkeypatch.setattr(folder_exchange, "_renameat2", lambda: None)
    put_in_place(folders)
    assert sorted(path.name for path in folders.iterdir()) == ["new", "part"]
    assert [path.name for path in folders.parent.iterdir()] == ["data"]


def test_where_folders_cannot_be_exchanged_a_stopped_build_loses_nothing(folders, monkeypatch):
    monkeypatch.setattr(folder_exchange, "_renameat2", lambda: None)
    beside(folders).rename(folders.parent / "kept")
    with pytest.raises(FileNotFoundError):
        put_in_place(folders)  # stops between the two renames
    assert not folders.exists() and present(folders) == away(folders)
    assert (present(folders) / "part").read_text() == "old"
    recover(folders)
    assert present(folders) == folders and (folders / "part").read_text() == "old"


def test_files_are_copied_where_they_cannot_be_linked(tmp_path, monkeypatch):
    folder = tmp_path / "data"
    (folder / "deep").mkdir(parents=True)
    (folder / "deep/part").write_text("old")

    def refuse(self, target):
        raise OSError

    monkeypatch.setattr("pathlib.Path.hardlink_to", refuse)
    start_from(folder, [folder / "deep/part"])
    assert (beside(folder) / "deep/part").read_text() == "old"
    assert [path.name for path in (beside(folder) / "deep").iterdir()] == ["part"]


def test_a_link_to_a_dataset_elsewhere_stays_one(folders, tmp_path):
    link = tmp_path / "link"
    link.symlink_to(folders)
    assert beside(link).parent == folders.parent
    shutil.rmtree(beside(folders))
    start_from(link, [])
    (beside(link) / "new").write_text("new")
    put_in_place(link)
    assert link.is_symlink() and (link / "new").exists() and not (link / "part").exists()
