"""Actions that only the rules `consequences` simulate: `run` says so, whatever else a sampled start lacks."""

import json

import pytest
from typer.testing import CliRunner

from hearth.cli import app

ADVICE = "Under these rules [Wait] is not simulated; `--rules consequences` simulates it."


def run(path, text, *options):
    file = path / "a.txt"
    file.write_text(f"T\n\n{text}\n")
    return CliRunner().invoke(app, ["run", str(file), "--home", "maple", *options])


TEXTS = {
    "first": "[Wait]\n[Walk] <sofa> (1)",
    "after a walk": "[Walk] <sofa> (1)\n[Wait]\n[Sit] <sofa> (1)",
    "after a start that has to be made": "[Grab] <cup> (1)\n[Wait]",
    "after a fault of the home": "[Walk] <fridge> (1)\n[Grab] <kettle> (1)\n[Wait]",
}


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
def test_sampling_names_the_action_and_the_rules_that_simulate_it(tmp_path, text):
    found = run(tmp_path, text, "--sample")
    assert found.exit_code == 1 and ADVICE in found.output.splitlines()
    sampling = next(line for line in found.output.splitlines() if line.startswith("Sampling does not help"))
    assert "[Wait]" in sampling and "NOT_SIMULATED" in sampling
    shown = json.loads(run(tmp_path, text, "--sample", "--json").stdout)
    assert "[Wait]" in shown["not_sampled"]


@pytest.mark.parametrize("text", [TEXTS["first"], TEXTS["after a walk"]], ids=["first", "after a walk"])
def test_a_run_names_the_rules_that_simulate_an_action(tmp_path, text):
    assert ADVICE in run(tmp_path, text).output.splitlines()
    assert json.loads(run(tmp_path, text, "--json").stdout)["failure"]["remedy"] == ADVICE
    assert run(tmp_path, text, "--rules", "consequences").exit_code == 0


def test_several_actions_are_named_together(tmp_path):
    found = run(tmp_path, "[Walk] <cup> (1)\n[Wait]\n[Grab] <cup> (1)\n[Break] <cup> (1)")
    assert "Under these rules [Wait], [Break] are not simulated" in found.output


def test_where_nothing_has_to_be_added_one_line_says_so(tmp_path):
    line = "  Nothing was added: the program runs in the home as it is."
    text = "[Walk] <sofa> (1)\n[Sit] <sofa> (1)"
    assert run(tmp_path, text, "--sample").output.splitlines().count(line) == 1
    assert line not in run(tmp_path, text).output.splitlines()
    assert line not in run(tmp_path, "[Walk] <sofa> (1)\n[Wash] <plate> (1)", "--sample").output.splitlines()


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("[Walk] <violin> (1)", "looked for instrument_violin, instrumentviolin, violin: maple has none"),
        ("[Walk] <sofa> (1)\n[Grab] <violin> (1)", "looked for instrument_violin, instrumentviolin, violin"),
        ("[Walk] <fridge> (1)\n[Walk] <fridge> (2)", "found fridge (137), freezer (182); none fits"),
    ],
)
def test_the_explanation_of_a_step_without_its_object_says_what_was_looked_for(tmp_path, text, line):
    assert line in run(tmp_path, text, "--explain").output
    assert "looked for" not in run(tmp_path, text).output
