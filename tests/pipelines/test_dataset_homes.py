"""A dataset carries the user's homes that it was made with, and stages run alone go on with them."""

from __future__ import annotations

import json
import shutil

import orjson
import pytest
from builds import GOLDEN_SOURCES, INPUT

import hearth
from hearth.datasets.dataset_homes import digest, own_homes
from hearth.datasets.export.formats import FORMATS, export
from hearth.datasets.export.pddl_problems import tasks
from hearth.datasets.export.program_batches import Wanted
from hearth.datasets.report.report_writer import write_report
from hearth.datasets.verify import verify
from hearth.homes.library import load_graph
from hearth.pipelines.build import build
from hearth.pipelines.engine.stages import STAGES
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.syntax import print_lines
from hearth.scoring.dataset_scores import score_dataset
from hearth.scoring.evaluate import summarise


@pytest.fixture
def mine(tmp_path):
    """A folder of homes, with a file that is none."""
    folder = shutil.copytree(INPUT / "homes", tmp_path / "mine")
    (folder / "notes.txt").write_text("not a home")
    return folder


@pytest.fixture
def moved(made, tmp_path, monkeypatch):
    """A dataset made with homes of the user's, alone in another folder."""
    monkeypatch.chdir(tmp_path)
    return shutil.copytree(made.out / "publish", tmp_path / "elsewhere")


def manifest_of(folder):
    return orjson.loads((folder / "manifest.json").read_bytes())


def test_it_says_which_and_has_the_files(moved, knowledge):
    manifest = manifest_of(moved)
    assert manifest["homes"] == {"overlay": {"sha256": digest(INPUT / "homes"), "path": "own_homes"}}
    assert manifest["homes"]["overlay"]["sha256"] == manifest["plan"]["homes_overlay"]
    assert {name for name in manifest["files"] if name.startswith("own_homes/")} == {"own_homes/cabin.json"}
    folder = own_homes(moved, manifest)
    assert load_graph("cabin", knowledge, folder) == load_graph("cabin", knowledge, INPUT / "homes")


def test_all_that_reads_it_needs_no_other_folder(moved, tmp_path):
    ds = hearth.load(moved)
    assert (verify(moved).faults, verify(moved).unknown) == ((), ())
    assert write_report(ds, tmp_path / "report") and tasks(ds, Wanted())
    for form in sorted({*FORMATS} - {"coco"}):  # COCO asks for pictures with masks
        assert export(ds, form, tmp_path / form)
    of = dict(ds.rows("SELECT execution_id, program_id FROM executions WHERE executable")[1])
    rows = [{"id": name, "predicted": list(print_lines(ds[program].program))} for name, program in of.items()]
    (tmp_path / "mine.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows))
    found = summarise(score_dataset(ds, tmp_path / "mine.jsonl"))
    assert found.count == len(rows) and {value.mean for value in found.means.values()} == {1.0}


def test_a_stage_run_alone_goes_on_with_them(made, mine, tmp_path):
    out = str(tmp_path / "out")
    build(list(map(str, GOLDEN_SOURCES)), out, only="ingest")
    build(out=out, only="validate", action_set=2)
    build(out=out, only="sample", homes_folder=str(mine), homes=("cabin",), action_set=2)
    shutil.rmtree(mine)
    for name in ("augment", "render", "publish"):
        build(out=out, only=name, homes=("cabin",), pictures=0)
    for name in STAGES:
        assert manifest_of(tmp_path / "out" / name) == manifest_of(made.out / name)


def test_a_build_without_them_leaves_none(made, tmp_path):
    out = shutil.copytree(made.out, tmp_path / "out")
    build(list(map(str, GOLDEN_SOURCES)), str(out), homes=("maple",), variants=0, pictures=0)
    assert not list(out.glob("*/own_homes"))
    assert manifest_of(out / "publish")["homes"] == {"overlay": None}


def test_what_it_carries_is_looked_after(moved):
    (moved / "own_homes/cabin.json").write_text("{}")
    assert "own_homes/cabin.json" in str(verify(moved).faults)
    with pytest.raises(HearthError, match="other files of homes"):
        own_homes(moved, manifest_of(moved))
    shutil.rmtree(moved / "own_homes")
    with pytest.raises(HearthError, match="the homes it was made with"):
        own_homes(moved, manifest_of(moved))


def test_a_manifest_that_contradicts_its_homes(moved):
    manifest = manifest_of(moved)
    for overlay in ({"sha256": "0" * 64, "path": "own_homes"}, {"sha256": "", "path": "../x"}, {"path": 3}, "homes"):
        (moved / "manifest.json").write_bytes(orjson.dumps({**manifest, "homes": {"overlay": overlay}}))
        assert len(verify(moved).faults) == 1
    (moved / "manifest.json").write_bytes(orjson.dumps({key: manifest[key] for key in manifest.keys() - {"homes"}}))
    assert verify(moved).faults == ()


def test_a_folder_that_is_missing_is_reported_before_the_sources_are_read(tmp_path):
    with pytest.raises(HearthError, match="not a directory"):
        build(list(map(str, GOLDEN_SOURCES)), str(tmp_path / "out"), homes_folder=str(tmp_path / "nowhere"))
    assert not (tmp_path / "out/ingest").exists()


@pytest.mark.parametrize(("among", "read"), [("programs.txt", False), (".", True)], ids=["a file", "a folder"])
def test_a_home_that_is_not_there_is_refused_as_soon_as_it_can_be(among, read, tmp_path):
    """A folder may hold a scene graph of that name, which its reading shows."""
    source = tmp_path / "sources"
    source.mkdir()
    (source / "programs.txt").write_text("Sleep\n\n\n[Walk] <bedroom> (1)\n")
    with pytest.raises(HearthError, match="there is no home `nowhere`"):
        build([str(source / among)], str(tmp_path / "out"), homes=("nowhere",))
    assert (tmp_path / "out/ingest").exists() == read
    assert not (tmp_path / "out/validate").exists()
