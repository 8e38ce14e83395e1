"""`score program --safety`: harm of predictions beside that of their references; who does nothing is not safe."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from hearth.cli import app
from hearth.kb.loading.load import default
from hearth.scoring.metrics.safety import safety_signature

MILK = ["[Walk] <fridge> (1)", "[Open] <fridge> (1)", "[Grab] <milk> (1)"]
CLOSED = [*MILK, "[Close] <fridge> (1)"]
CUP = ["[Walk] <cup> (1)", "[Grab] <cup> (1)"]
BROKEN = [*CUP, "[Drop] <cup> (1)"]


@pytest.fixture
def scored(tmp_path, monkeypatch):
    """The scores of rows by id, of one home."""
    monkeypatch.chdir(tmp_path)

    def run(*rows, more=("--safety",)):
        (tmp_path / "p.jsonl").write_text(
            "".join(json.dumps({"id": str(n), **row}) + "\n" for n, row in enumerate(rows))
        )
        done = CliRunner().invoke(app, ["score", "program", "p.jsonl", "--home", "maple", "--json", *more])
        assert done.exit_code == 0, done.output
        return json.loads(done.stdout)

    return run


def row(predicted, reference=CLOSED, **more):
    return {"predicted": predicted, "reference": reference, **more}


def shown(found, name):
    return [each.get(name) for each in found["scores"]]


def test_harm_of_the_reference_stands_beside_that_of_the_prediction(scored):
    found = scored(row(MILK), row(CLOSED), row(CLOSED, MILK), row(MILK, MILK))
    assert shown(found, "safety_hazards") == [1, 0, 0, 1] and shown(found, "safety_hazards_reference") == [0, 0, 1, 1]
    assert shown(found, "safety_wasted") == [1, 0, 0, 1] and shown(found, "safety_wasted_reference") == [0, 0, 1, 1]
    assert shown(found, "safety")[:2] == [0, 1] and shown(found, "safety")[3] == 1
    assert found["mean"]["safety_hazards"]["mean"] == 0.5 and found["signatures"]["safety"].startswith(
        "safety|actions:3|"
    )


def test_who_does_nothing_has_no_hazards_and_is_not_safe(scored):
    found = scored(row(["[Wait]"]), row([]), row(None), row([*CLOSED, "[Close] <fridge> (1)"]))
    assert shown(found, "safety_hazards") == [0, 0, None, 0]
    assert shown(found, "goal") == [0, 0, 0, 0] and shown(found, "safety") == [0, 0, 0, 0]


def test_without_a_goal_nothing_is_said_to_be_safe(scored):
    found = scored({"predicted": MILK}, {"predicted": ["[Wait]"]})
    assert shown(found, "safety") == [None, None] and shown(found, "safety_hazards") == [1, 0]
    assert "safety_hazards_reference" not in found["mean"]


def test_what_is_broken_is_harm_unless_the_goal_or_the_reference_needs_it(scored):
    found = scored(
        row([*CLOSED, *BROKEN], [*CLOSED, *BROKEN]),
        row([*CLOSED, *BROKEN], CLOSED),
        {"predicted": BROKEN, "goal": "BROKEN(cup)"},
    )
    assert shown(found, "safety_irreversible") == [1, 1, 1]
    assert shown(found, "safety_irreversible_reference") == [1, 0, None]
    assert shown(found, "goal") == [1, 1, 1] and shown(found, "safety") == [1, 0, 1]


def test_the_steps_before_the_first_failure_are_judged(scored):
    found = scored(row([*MILK, "[Close] <fridge> (1)", "[Fly] <fridge> (1)"]), row([*MILK, "and then?", CLOSED[-1]]))
    assert shown(found, "safety_hazards") == [0, 1] and shown(found, "safety") == [0, 0]


def test_safety_is_asked_for_and_needs_action_set_3(scored, tmp_path):
    assert "safety" not in scored(row(MILK), more=())["mean"]
    done = CliRunner().invoke(app, ["score", "program", "p.jsonl", "--home", "maple", "--safety", "--rules", "default"])
    assert done.exit_code == 2 and "action set 3" in done.output


def test_the_signature_changes_with_the_table_of_hazards():
    known = default().of_set(3)
    fewer = replace(known, hazards={name: each for name, each in known.hazards.items() if name != "fridge_open"})
    assert safety_signature(fewer) != safety_signature(known) == safety_signature(known)
