"""Predictions in words: read as `check` reads them, with a count of the steps that were corrected."""

import json

from typer.testing import CliRunner

from hearth.cli import app

PLAN = "1. Walk to the fridge\n2. Open the frigde and grab the milk\n3. Close it\n"
PROGRAM = ["[Walk] <fridge> (1)", "[Open] <fridge> (1)", "[Grab] <milk> (1)", "[Close] <fridge> (1)"]


def scores(tmp_path, *options):
    file = tmp_path / "mine.jsonl"
    file.write_text(json.dumps({"id": "a", "home": "maple", "predicted": PLAN, "reference": PROGRAM}) + "\n")
    done = CliRunner().invoke(app, ["score", "program", str(file), "--json", *options])
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)


def test_corrected_steps_are_counted(tmp_path):
    found = scores(tmp_path)
    assert (found["fuzzy"], found["scores"][0]["fuzzy"]) == (1, 1)
    assert found["scores"][0]["lcs_step"] == 1 and found["scores"][0]["executable"] == 1


def test_without_corrections_the_step_is_refused(tmp_path):
    found = scores(tmp_path, "--fuzzy", "off")
    assert found["fuzzy"] == 0
    assert found["scores"][0]["lcs_step"] < 1 and found["scores"][0]["parsable"] == 0
