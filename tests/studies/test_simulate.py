"""A whole study with agents in people's places: the same bytes, however often it is stopped; tables without names."""

import json
import re
import subprocess
import sys
from dataclasses import replace

import pyarrow.parquet as pq
import pytest
from studies.small import SMALL, simulated

from hearth.agents.agent_registry import HELPERS
from hearth.commands.study import report, simulate
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.studies.events import PLACES
from hearth.studies.study_file import named
from hearth.studies.study_findings import AGENT, PEOPLE, findings
from hearth.studies.study_folder import EVENTS, opened
from hearth.studies.study_preparation import prepared
from hearth.studies.study_report import page
from hearth.studies.study_simulation import Crowd, visits
from hearth.studies.study_tables import TABLES, Rows, archive, export, person_of

HOLDING = """
import sys
from pathlib import Path
from hearth.storage.lock import locked
with locked(Path(sys.argv[1])):
    print("held", flush=True)
    sys.stdin.read()
"""
"""A program that holds a folder until its input ends."""


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return simulated(tmp_path_factory.mktemp("studies"))


@pytest.fixture
def folder(made, tmp_path):
    """A copy of the simulated study's folder."""
    import shutil

    shutil.copytree(made.folder, tmp_path / "small")
    return tmp_path


def test_everybody_finishes_but_who_drops_out_and_is_replaced(made):
    standings = [made.conduct.standing(person) for person in made.ledger.streams()]
    assert [each.stage for each in standings].count("done") == 4
    (left,) = (each for each in standings if each.stage == "left")
    replacing = [each for each in standings if each.place == left.place and each.stage == "done"]
    assert len(replacing) == 1
    joined = [each.data["place"] for each in made.ledger.read(PLACES)]
    assert joined == [0, 1, 2, 3, left.place]


def test_visits_end_with_every_place_finished():
    found = visits([3, 4, 3], Crowd(5, 2))
    assert len(found) == 5
    assert {each.place for each in found if each.trials == [3, 4, 3][each.place]} == {0, 1, 2}
    assert visits([3, 4, 3], Crowd(5, 0)) == visits([3, 4, 3], Crowd(6, 0))


@pytest.mark.parametrize("share", [0.0, 0.31, 0.62, 0.97])
def test_a_simulation_that_was_killed_ends_with_the_same_bytes(made, folder, share):
    whole = (folder / "small" / EVENTS).read_bytes()
    first = whole.index(b"\n") + 1
    (folder / "small" / EVENTS).write_bytes(whole[: first + int((len(whole) - first) * share)])
    simulated(folder)
    assert (folder / "small" / EVENTS).read_bytes() == whole


def test_workers_change_nothing(made, tmp_path):
    simulated(tmp_path, workers=2)
    for file in (EVENTS, "references/alone.jsonl", "references/hp_rg.jsonl"):
        assert (tmp_path / "small" / file).read_bytes() == (made.folder / file).read_bytes()


def test_another_simulation_is_not_mixed_in(folder):
    with pytest.raises(Exception, match="another study or simulation"):
        simulated(folder, seed=1)


def test_two_simulations_at_once_are_refused(folder):
    held = subprocess.Popen(
        [sys.executable, "-c", HOLDING, str(folder / "small")], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    try:
        assert held.stdout.readline() == "held\n"
        with pytest.raises(HearthError, match=f"process {held.pid} is simulating here") as caught:
            simulated(folder)
        assert caught.value.diagnostics[0].code is Code.LOCKED
    finally:
        held.kill()
        held.communicate()
    simulated(folder)


def test_tables_hold_all_trials_and_no_id_of_a_person(made, tmp_path):
    counts = export(made, tmp_path)
    tables = {name: pq.read_table(tmp_path / f"{name}.parquet") for name in TABLES}
    assert {name: table.num_rows for name, table in tables.items()} == counts
    trials = tables["trials"].to_pylist()
    assert sum(row["counted"] for row in trials) == 8
    assert {(row["item"], row["condition"]) for row in trials if row["counted"]} == {
        (item, name) for item in range(4) for name in ("alone", "hp_rg")
    }
    assert all(row["simulated"] for table in tables.values() for row in table.to_pylist())
    ids = set(tables["participants"]["participant"].to_pylist())
    assert ids.isdisjoint(made.ledger.streams())
    written = b"".join(path.read_bytes() for path in tmp_path.glob("*.parquet"))
    assert not any(person.encode() in written for person in made.ledger.streams())
    assert {person_of(made, each) for each in ids} == set(made.ledger.streams())
    ticks = {(row["participant"], row["trial"]): row["ticks"] for row in trials}
    decisions = tables["decisions"].to_pylist()
    last = {}
    for row in decisions:
        last[row["participant"], row["trial"]] = max(last.get((row["participant"], row["trial"]), 0), row["tick"] + 1)
    assert last == ticks
    assert archive(made) == archive(made)


def test_findings_are_those_of_the_rows(made):
    found = findings(made)
    rows = [row for row in Rows(made).trials() if row["counted"]]
    for name in ("alone", "hp_rg"):
        mine = [row["reward"] for row in rows if row["condition"] == name]
        assert found.figure(PEOPLE, name, "reward").mean == pytest.approx(sum(mine) / len(mine))
    lengths = {row["item"]: row["length"] for row in rows if row["condition"] == "alone"}
    speedups = [lengths[row["item"]] / row["length"] - 1 for row in rows if row["condition"] == "hp_rg"]
    assert found.figure(PEOPLE, "hp_rg", "speedup").mean == pytest.approx(sum(speedups) / 4)
    assert found.figure(AGENT, "hp_rg", "success").count == 4
    assert (found.people, found.left, found.against) == (4, 1, "people alone (this study)")


def test_the_page_says_simulated_and_holds_nobodys_markup(made):
    found = findings(made)
    html = page(found, [])
    assert html.count("imulated") > 4
    assert "<strong>Simulated.</strong>" in html
    assert "t(3) = " in html
    real = page(replace(found, simulated=False), [])
    assert "<strong>Simulated.</strong>" not in real
    nasty = page(replace(found, study=replace(found.study, title="<script>alert(1)</script>")), [])
    assert "<script>" not in nasty


def test_simulated_people_are_not_filmed_as_people(made, tmp_path):
    with pytest.raises(HearthError, match="the people there are simulated"):
        prepared(named("likeness-of-films"), tmp_path, default, made)


def test_who_is_forgotten_is_in_no_table(made, folder):
    mine = opened(folder / "small", default)
    person = mine.ledger.streams()[1]
    mine.conduct.forget(person)
    again = opened(folder / "small", default)
    assert person not in again.ledger.streams()
    assert not re.search(person.encode(), (folder / "small" / EVENTS).read_bytes())
    assert len(list(Rows(again).participants())) == 4


def test_a_helper_that_fails_is_counted_as_the_helpers_failure(tmp_path, monkeypatch, capsys):
    """Its trials are in the tables with its code, in no figure of the people, and said in every report."""

    class Failing:
        def reset(self, observation, goal, seed):
            pass

        def act(self, observation, legal):
            raise RuntimeError("out of order")

    monkeypatch.setitem(HELPERS, "hp_random", replace(HELPERS["hp_random"], make=lambda partner: Failing()))
    made = simulated(tmp_path)
    rows = [row for row in Rows(made).trials() if row["counted"]]
    assert [(row["condition"] == "hp_rg", row["helper_fault"]) for row in rows] == [
        (row["condition"] == "hp_rg", "AGENT_FAILED" if row["condition"] == "hp_rg" else "") for row in rows
    ]
    found = findings(made)
    failed = sum(row["condition"] == "hp_rg" for row in rows)
    assert found.helper_faults == {"hp_rg": failed}
    assert found.figure(PEOPLE, "hp_rg", "success") is None and found.figure(PEOPLE, "alone", "success").mean > 0
    assert f"the helper failed in {failed} trials" in page(found, [])
    report(tmp_path / "small")
    assert f"the helper failed in {failed} trials" in capsys.readouterr().out
    (tmp_path / "small.yaml").write_text(SMALL)
    simulate(str(tmp_path / "small.yaml"), out=tmp_path, workers=1, as_json=True)
    assert json.loads(capsys.readouterr().out)["helper_faults"] >= failed


def test_nothing_is_said_of_helpers_that_did_not_fail(made):
    assert findings(made).helper_faults == {}
    assert "helper failed" not in page(findings(made), [])
