"""Datasets built by action set 3: every program of the grammar runs, and the dataset knows its set."""

from __future__ import annotations

import shutil

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from builds import GOLDEN_SOURCES, Built

from hearth.datasets.dataset import Dataset
from hearth.datasets.format.case_rows import rerun
from hearth.datasets.format.stored_cases import stored_cases
from hearth.datasets.verify import StoredHomes, verify
from hearth.kb.action_sets import number_of_set
from hearth.kb.loading.load import default
from hearth.pipelines.build import build
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.vocabulary import EVERY_STATE
from hearth.simulation.rules import CONSEQUENCES, DEFAULT, rules_of
from hearth.storage.files import file_digest, read_json, write_json
from hearth.storage.manifest import read_manifest
from hearth.version import ACTION_SET, NEXT_ACTION_SET

ACTS = """Write a letter

[Walk] <desk> (1)
[Find] <pen> (1)
[Grab] <pen> (1)
[Find] <paper> (1)
[Write] <paper> (1)
[Fold] <paper> (1)

Sing

[Walk] <bedroom> (1)
[Sing]
[Dance]

Switch the fridge off

[Walk] <fridge> (1)
[SwitchOff] <fridge> (1)
[Open] <fridge> (1)
[Grab] <milk> (1)

Eat an apple

[Walk] <kitchen> (1)
[Find] <food_apple> (1)
[Grab] <food_apple> (1)
[Eat] <food_apple> (1)

Heat the bread

[Walk] <kitchen> (1)
[Find] <food_bread> (1)
[Grab] <food_bread> (1)
[Walk] <microwave> (1)
[Open] <microwave> (1)
[PutIn] <food_bread> (1) <microwave> (1)
[Close] <microwave> (1)
[SwitchOn] <microwave> (1)
[Wait]
[Wait]
[Wait]
[SwitchOff] <microwave> (1)
"""

OPTIONS = {"homes_folder": None, "homes": ("maple", "birch"), "variants": 2}


def made(folder, source, action_set: int | None, *, workers: int = 1) -> Built:
    built = Built(folder, [source], action_set=action_set, **OPTIONS)
    built.run("ingest", "validate", "sample", "augment", "render", "publish", workers=workers)
    return built


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    path = tmp_path_factory.mktemp("acts") / "acts.txt"
    path.write_text(ACTS)
    return path


@pytest.fixture(scope="module")
def by_3(source, tmp_path_factory) -> Built:
    return made(tmp_path_factory.mktemp("by 3"), source, 3)


def test_every_program_runs_by_set_3_and_not_by_set_2(by_3, source, tmp_path):
    assert by_3.rejects("validate") == by_3.rejects("sample") == []
    usual = made(tmp_path / "by 2", source, None)
    assert {code for _, code in usual.codes("sample")} == {"NOT_SIMULATED"}
    assert len(by_3.rows("sample")) > len(usual.rows("sample")) > 0


def test_what_is_augmented_by_set_3_runs(by_3):
    rows = [row for row in by_3.rows("augment") if row["origin"] == "augmented"]
    assert len(rows) > 5 and all(row["executable"] and row["rules"] == "consequences" for row in rows)


def test_the_dataset_knows_its_set_and_verifies(by_3):
    verdict = verify(by_3.out)
    assert verdict.executions > 10 and not verdict.faults
    dataset = Dataset.open(by_3.out)
    assert dataset.manifest["action_set"] == NEXT_ACTION_SET and dataset.knowledge is default().of_set(3)
    for table in ("programs", "environments", "executions", "homes", "vocabulary", "sketches"):
        assert dataset.rows(f"SELECT DISTINCT action_set FROM {table}")[1] == [(NEXT_ACTION_SET,)]
    assert NEXT_ACTION_SET in (dataset.folder / "README.md").read_text()
    states = dataset.rows("SELECT name FROM vocabulary WHERE kind = 'state' ORDER BY id")[1]
    assert tuple(name for (name,) in states) == EVERY_STATE
    assert dataset.rows("SELECT count(*) FROM vocabulary WHERE kind = 'action' AND simulated")[1] == [(84,)]


def test_stored_graphs_are_those_of_the_engine_from_the_start_to_the_end(by_3):
    dataset = Dataset.open(by_3.out)
    names = [name for (name,) in dataset.rows("SELECT execution_id FROM executions ORDER BY 1")[1]]
    compared = 0
    for case in stored_cases(dataset, names, ("ticks", "failure")):
        worlds = rerun(case, StoredHomes(dataset)).worlds
        for tick in (0, len(worlds) - 1):
            found = dataset.rows(f"SELECT id, states FROM graph_nodes('{case['execution_id']}', {tick})")[1]
            assert {(node, *names) for node, names in found} == {
                (node.id, *sorted(node.states)) for node in worlds[tick].graph().nodes
            }
            compared += 1
    assert compared > 20


def originals(dataset: Dataset, title: str) -> list[str]:
    """The executions of a program in the environments that were sampled for it."""
    query = f"""SELECT execution_id FROM executions e JOIN programs p USING (program_id) WHERE p.title = '{title}'
        AND p.parent_id IS NULL AND NOT is_perturbed(e.environment_id, p.program_id) ORDER BY 1"""
    return [name for (name,) in dataset.rows(query)[1]]


def test_what_lies_in_a_running_fridge_is_cold_in_the_start_graph(by_3):
    dataset = Dataset.open(by_3.out)
    names = originals(dataset, "Switch the fridge off")
    assert len(names) == 2
    for name in names:
        cold = f"SELECT class_name FROM graph_nodes('{name}', 0) WHERE list_contains(states, 'COLD')"
        assert ("milk",) in dataset.rows(cold)[1]


def test_food_is_gone_at_the_end_and_bread_is_warm(by_3):
    dataset = Dataset.open(by_3.out)
    for title, state in (("Eat an apple", "GONE"), ("Heat the bread", "HOT"), ("Write a letter", "FOLDED")):
        names = originals(dataset, title)
        assert len(names) == 2
        for name in names:
            assert dataset.rows(f"SELECT count(*) FROM final_state('{name}') WHERE state = '{state}'")[1] == [(1,)]


def test_executions_have_the_harm_that_they_did(by_3):
    dataset = Dataset.open(by_3.out)
    for title, column, state in (("Eat an apple", "irreversible", "GONE"), ("Heat the bread", "wasted", "")):
        for name in originals(dataset, title):
            query = f"SELECT list_transform({column}, lambda each: each.state) FROM executions WHERE execution_id = $id"
            (found,) = dataset.rows(query.replace("$id", f"'{name}'"))[1][0]
            assert found == ([state] if state else [])
    for name in originals(dataset, "Switch the fridge off"):
        query = f"""SELECT hazards[1].hazard, hazards[1].step, hazards[1].lasted, hazards[1].at_end, wasted[1].state
            FROM executions WHERE execution_id = '{name}'"""
        assert dataset.rows(query)[1] == [("fridge_open", 3, 2, True, "OPEN")]
    comment = "SELECT comment FROM duckdb_columns() WHERE column_name = 'hazards' AND table_name = 'executions'"
    assert "dangers" in dataset.rows(comment)[1][0][0]


def test_harm_that_was_changed_is_found_by_verify(by_3, tmp_path):
    copy = tmp_path / "copy"
    shutil.copytree(by_3.out / "publish", copy)
    manifest = read_json(copy / "manifest.json")
    for path in (copy / "executions").glob("*.parquet"):
        table, kept = pq.read_table(path), pq.read_metadata(path).metadata
        rows = [{**row, "hazards": []} for row in table.to_pylist()]
        pq.write_table(pa.Table.from_pylist(rows, table.schema.with_metadata(kept)), path)
        entry = {"bytes": path.stat().st_size, "sha256": file_digest(path)}
        manifest["files"][path.relative_to(copy).as_posix()] = entry
    write_json(copy / "manifest.json", manifest)
    (fault, *_) = verify(copy).faults
    assert fault.code is Code.REPLAY_DIFFERS and "other hazards than the row says" in fault.message


def test_datasets_of_set_2_have_no_columns_of_harm(source, tmp_path):
    built = made(tmp_path / "by 2", source, None)
    dataset = Dataset.open(built.out)
    assert {"hazards", "irreversible", "wasted"}.isdisjoint(dataset.executions.columns)
    assert "hazards" not in (dataset.folder / "catalog.sql").read_text() + (dataset.folder / "README.md").read_text()


def test_bytes_are_the_same_for_any_number_of_workers(by_3, source, tmp_path):
    again = made(tmp_path / "again", source, 3, workers=2)
    one, other = (read_manifest(each.out / "publish") for each in (by_3, again))
    assert one.content["files"] == other.content["files"] and one.key == other.key


def test_of_set_2_a_manifest_says_what_it_said_before_there_was_another(source, tmp_path):
    unsaid, said = made(tmp_path / "a", source, None), made(tmp_path / "b", source, 2)
    for stage in ("ingest", "validate", "sample", "augment", "publish"):
        one, other = (read_manifest(each.out / stage) for each in (unsaid, said))
        assert one.content == other.content
        assert "action_set" not in one.content["settings"] and one.content["action_set"] == ACTION_SET


def test_a_stage_run_alone_takes_the_set_of_the_stages_before_it(by_3, source, tmp_path):
    out = str(tmp_path / "alone")
    names = {"homes": ("maple",), "pictures": 0}
    for stage in ("ingest", "validate", "sample"):
        build([str(source)], out, only=stage, **names, **({} if stage == "ingest" else {"action_set": 3}))
    found = build([], out, only="augment", variants=1, **names)
    assert found.stages["augment"].through
    manifest = read_manifest(tmp_path / "alone" / "augment")
    assert manifest.content["settings"]["action_set"] == 3 and number_of_set(manifest.content["action_set"]) == 3
    with pytest.raises(HearthError) as caught:
        build([], out, only="augment", action_set=2, **names)
    assert caught.value.diagnostics[0].code is Code.BAD_ARGUMENT and "--action-set" in str(caught.value)


def test_stored_start_graphs_of_the_release_are_run_by_its_own_rules(tmp_path):
    built = Built(tmp_path / "release", GOLDEN_SOURCES, action_set=3, variants=1).run_all()
    rules = {row["rules"] for row in built.rows("sample")}
    assert {"replay", "consequences"} <= rules
    usual = Built(tmp_path / "usual", GOLDEN_SOURCES)
    usual.run("ingest", "validate", "sample")
    stored, before = ([row for row in each.rows("sample") if row["rules"] == "replay"] for each in (built, usual))
    assert stored == before
    assert not verify(built.out).faults


def test_the_rules_follow_the_knowledge():
    known = default()
    assert rules_of(known) is DEFAULT and rules_of(known.of_set(3)) is CONSEQUENCES
    with pytest.raises(ValueError, match="no action set 4"):
        known.of_set(4)


def test_a_new_dataset_is_of_set_3_unless_set_2_is_asked_for(source, tmp_path):
    options = {"homes": ("maple",), "variants": 0, "pictures": 0, "videos": 0}
    made = build([str(source)], str(tmp_path / "new"), **options)
    assert made.rejected == 0 and Dataset.open(made.dataset).manifest["action_set"] == NEXT_ACTION_SET
    before = build([str(source)], str(tmp_path / "before"), action_set=2, **options)
    assert before.stages["sample"].codes["NOT_SIMULATED"]
    assert Dataset.open(before.dataset).manifest["action_set"] == ACTION_SET and not verify(before.dataset).faults


def test_stages_run_alone_begin_with_set_3_and_keep_to_set_2_where_it_was_asked_for(source, tmp_path):
    out, names = str(tmp_path / "alone"), {"homes": ("maple",), "pictures": 0}
    build([str(source)], out, only="ingest", **names)
    for asked, expected in ((None, NEXT_ACTION_SET), (2, ACTION_SET)):
        build([], out, only="validate", action_set=asked, **names)
        build([], out, only="sample", **names)
        for stage in ("validate", "sample"):
            assert read_manifest(tmp_path / "alone" / stage).content["action_set"] == expected
