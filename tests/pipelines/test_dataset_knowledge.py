"""A dataset carries the knowledge it was made with: built with an overlay, moved, and the overlay gone."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import orjson
import pytest

import hearth
from hearth.analysis.planner_agreement import helpful
from hearth.datasets.dataset import Dataset
from hearth.datasets.diff import compare
from hearth.datasets.export.formats import FORMATS, export
from hearth.datasets.export.pddl_problems import tasks
from hearth.datasets.export.program_batches import Wanted
from hearth.datasets.format.case_rows import rerun
from hearth.datasets.format.stored_cases import stored_cases
from hearth.datasets.report.report_writer import write_report
from hearth.datasets.verify import StoredHomes, verify
from hearth.kb.loading.load import default, digest
from hearth.pipelines.build import build
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.syntax import print_lines
from hearth.scoring.baselines import Example, random_sampling
from hearth.scoring.dataset_scores import score_dataset
from hearth.scoring.evaluate import summarise

OVERLAY = {
    "objects_kitchenware.csv": """id,name,category,hypernym,properties,states,rooms,size,gloss,same_as,source
9001,samovar,Props,drinkware,GRABBABLE MOVABLE,cleanliness,kitchen,0.2 0.4 0.2,boils water for tea,,ours
""",
    "placements.csv": """object,relation,destination,room,weight,evidence
samovar,ON,table,kitchen,5,ours
""",
    "actions.yaml": """Read:
  id: 40
  roles: [text]
  needs: [{any: [GRABBABLE]}]
  before:
  - NOT_AFFORDED: affords(o)
  - NOT_HOLDING: holds(a, o)
  effects: []
  say: Read {0}
  words: [peruse]
""",
}
"""A class that ours has not, and an action that takes more than ours does."""

PROGRAM = """Tea
I read what the samovar says.


[Walk] <samovar> (1)
[Grab] <samovar> (1)
[Read] <samovar> (1)
"""


def laid(folder: Path) -> Path:
    folder.mkdir()
    for name, text in OVERLAY.items():
        (folder / name).write_text(text)
    return folder


@pytest.fixture(scope="module")
def moved(build_folder, tmp_path_factory):
    """A dataset made with an overlay, by itself in another folder; the overlay and the build are gone."""
    here = tmp_path_factory.mktemp("laid")
    (here / "tea.txt").write_text(PROGRAM)
    build_folder(here / "out", [here / "tea.txt"], kb_folder=str(laid(here / "mine"))).run_all()
    there = tmp_path_factory.mktemp("elsewhere") / "dataset"
    shutil.move(here / "out/publish", there)
    shutil.rmtree(here)
    return there


@pytest.fixture
def copy(moved, tmp_path):
    return shutil.copytree(moved, tmp_path / "copy")


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def test_it_says_which_and_has_the_files(moved):
    manifest = hearth.load(moved).manifest
    assert manifest["knowledge"] == {
        "base": digest(),
        "overlay": {"sha256": digest(moved / "knowledge"), "path": "knowledge"},
    }
    copied = {name for name in manifest["files"] if name.startswith("knowledge")}
    assert copied == {f"knowledge/{name}" for name in OVERLAY}
    assert {path.name: path.read_text() for path in (moved / "knowledge").iterdir()} == OVERLAY


def test_it_runs_again_as_it_did(moved):
    found = verify(moved, workers=2)
    assert (found.faults, found.note) == ((), "")
    assert found.executions


def test_its_programs_are_perfect(moved, tmp_path):
    ds = hearth.load(moved)
    names = [name for (name,) in ds.rows("SELECT execution_id FROM executions WHERE executable")[1]]
    of = dict(ds.rows("SELECT execution_id, program_id FROM executions")[1])
    rows = [{"id": name, "predicted": list(print_lines(ds[of[name]].program))} for name in names]
    (tmp_path / "mine.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows))
    found = summarise(score_dataset(ds, tmp_path / "mine.jsonl"))
    assert found.count == len(names) > 1
    assert {name: value.mean for name, value in found.means.items()} == dict.fromkeys(found.means, 1.0)


@pytest.mark.parametrize("form", sorted({*FORMATS} - {"coco"}))  # COCO asks for pictures with masks
def test_every_form_can_be_exported(moved, tmp_path, form):
    assert export(hearth.load(moved), form, tmp_path / form)


def test_exports_say_what_the_overlay_says(moved, tmp_path):
    ds = hearth.load(moved)
    for form in ("nl", "rdf", "pddl"):
        export(ds, form, tmp_path / form)
    assert "Read samovar" in (tmp_path / "nl/steps.jsonl").read_text()
    assert "class/samovar" in (tmp_path / "rdf/knowledge.ttl").read_text()
    domain = (tmp_path / "pddl/domain.pddl").read_text()
    (read,) = [part for part in domain.split("(:action ") if part.lower().startswith("read\n")]
    assert "grabbable" in read.lower() and "readable" not in read.lower()


def test_report_query_and_difference(moved, copy, tmp_path):
    ds = hearth.load(moved)
    assert write_report(ds, tmp_path / "report")
    assert ds.rows("SELECT count(*) FROM vocabulary WHERE kind = 'class' AND name = 'samovar'")[1] == [(1,)]
    assert compare(moved, copy) == []


def test_problems_are_planned_with_it(moved):
    (task, *_) = tasks(hearth.load(moved), Wanted())
    assert "Read" not in helpful(task) and task.world.home.knowledge.object_class("samovar")


def test_programs_are_drawn_from_it(moved):
    ds = hearth.load(moved)
    steps = ds[next(iter(ds))].program.steps
    examples = [Example(str(number), "tea", steps) for number in range(1_000)]
    drawn = random_sampling(examples[:1], examples, 0, ds.knowledge)
    assert "samovar" in {ref.name for program in drawn for step in program for ref in step.objects}


def test_what_it_is_without_the_overlay(moved):
    """The overlay matters: with ours alone the programs neither run nor parse."""
    manifest = orjson.loads((moved / "manifest.json").read_bytes())
    ds = Dataset(moved, {**manifest, "knowledge": {**manifest["knowledge"], "overlay": None}})
    assert ds.knowledge is default()
    case = next(iter(stored_cases(ds, [ds[next(iter(ds))].runs[0].row["execution_id"]], ("ticks", "failure"))))
    assert "NOT_AFFORDED" in str(rerun(case, StoredHomes(ds)).failure)


def test_one_made_before_was_made_with_ours(copy):
    store_knowledge(copy, None)
    assert hearth.load(copy).knowledge is default()


def store_knowledge(folder, knowledge):
    """Make the manifest say something else of the knowledge."""
    manifest = orjson.loads((folder / "manifest.json").read_bytes())
    del manifest["knowledge"]
    stored = {} if knowledge is None else {"knowledge": knowledge}
    (folder / "manifest.json").write_bytes(orjson.dumps({**manifest, **stored}))


def test_another_base_is_noted(copy):
    manifest = hearth.load(copy).manifest
    store_knowledge(copy, {**manifest["knowledge"], "base": "0" * 64})
    found = verify(copy)
    assert found.faults == () and "(00000000), which differs from ours" in found.note


@pytest.mark.parametrize(
    "knowledge",
    [
        [],
        "ours",
        {"base": ""},
        {"base": "", "overlay": "knowledge"},
        {"base": "", "overlay": {"path": "knowledge"}},
        {"base": "", "overlay": {"path": 3, "sha256": 4}},
    ],
)
def test_a_manifest_that_does_not_say_which(copy, knowledge):
    store_knowledge(copy, knowledge)
    assert [fault.code for fault in verify(copy).faults] == [Code.BAD_JSON]


def test_what_it_carries_is_looked_after(copy):
    def codes():
        with pytest.raises(HearthError) as caught:
            _ = hearth.load(copy).knowledge
        assert verify(copy).faults
        return [str(fault.code) for fault in caught.value.diagnostics]

    (copy / "knowledge/limits.yaml").write_text("sit: {default: 9}\n")
    assert codes() == ["DAMAGED_FILE"]
    (copy / "knowledge/limits.yaml").unlink()
    assert verify(copy).faults == ()
    store_knowledge(copy, {"base": "", "overlay": {"path": "../elsewhere", "sha256": ""}})
    assert codes() == ["DAMAGED_FILE"]
    store_knowledge(copy, {"base": "", "overlay": {"path": "nowhere", "sha256": ""}})
    assert codes() == ["MISSING_FILE"]
    (copy / "knowledge/aliases.csv").write_text("not a table\n")
    store_knowledge(copy, {"base": "", "overlay": {"path": "knowledge", "sha256": digest(copy / "knowledge")}})
    assert codes() == ["BAD_TABLE"]


def test_a_stage_run_alone_goes_on_with_it(build_folder, tmp_path):
    (tmp_path / "tea.txt").write_text(PROGRAM)
    overlay = laid(tmp_path / "mine")
    first = build_folder(tmp_path / "out", [tmp_path / "tea.txt"], kb_folder=str(overlay))
    first.run("ingest", "validate")
    shutil.rmtree(overlay)
    for name in ("sample", "augment", "render", "publish"):
        build(out=str(first.out), only=name, homes_folder=first.settings.homes_folder, homes=("cabin",), pictures=0)
    assert verify(first.out).faults == ()
    assert hearth.load(first.out).knowledge.object_class("samovar")
    for name in ("validate", "sample", "augment", "render"):
        manifest = orjson.loads((first.out / name / "manifest.json").read_bytes())
        assert manifest["knowledge"]["overlay"]["sha256"] == digest(first.out / "publish/knowledge")


def test_a_build_without_it_leaves_none(build_folder, tmp_path):
    (tmp_path / "tea.txt").write_text(PROGRAM.replace("samovar", "novel"))
    for kb in (str(laid(tmp_path / "mine")), None):
        made = build_folder(tmp_path / "out", [tmp_path / "tea.txt"], kb_folder=kb).run_all()
    assert not list(made.out.glob("*/knowledge"))
    assert hearth.load(made.out).manifest["knowledge"] == {"base": digest(), "overlay": None}
