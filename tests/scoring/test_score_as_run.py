"""Without a reference, a program is executable in scores if and only if `run` does all of its steps."""

import csv
from pathlib import Path

import pytest

from hearth.grounding.grounded_run import as_given
from hearth.homes import library
from hearth.kb import action_grammar
from hearth.schemas.syntax import parse_program
from hearth.scoring.line_sequences import read
from hearth.scoring.metrics.executability import executability
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

CROWD = Path(__file__).resolve().parents[2] / "data_raw/crowd/programs.csv"
PLATES = [["[Walk] <plate> (1)", "[Grab] <plate> (1)"], ["[Walk] <towel> (1)", "[Grab] <towel> (1)"]]


@pytest.fixture(scope="module")
def maple(knowledge):
    return Home.from_graph(library.load_graph("maple", knowledge), "maple", knowledge)


@pytest.mark.parametrize("lines", PLATES)
def test_a_thing_that_run_reaches_is_not_another_one_in_a_closed_cupboard(maple, lines):
    assert executability(read(lines), World.start(maple)).executable


def test_scores_and_run_agree(maple, knowledge):
    rows = csv.DictReader(CROWD.read_text("utf-8").splitlines(keepends=True))
    texts = [row["Answer.program"] for row in rows][::15]
    verdicts = []
    for text in texts:
        program, faults = action_grammar.check(parse_program("T\n\n\n" + text)[0], knowledge)
        if not faults and program.steps:
            scored = executability(program.steps, World.start(maple)).executable
            verdicts.append((scored, as_given(program, maple).execution.executable))
    assert [a for a, _ in verdicts] == [b for _, b in verdicts]
    assert {True, False} <= {a for a, _ in verdicts}
