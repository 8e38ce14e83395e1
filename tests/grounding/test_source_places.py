"""Things are where the author takes them from, `the milk out of the fridge`, in a home that is made for a program."""

from __future__ import annotations

import pytest
from typer.testing import CliRunner

from hearth import cli
from hearth.commands.inputs import choose_given
from hearth.grounding.grounded_run import as_given_or_sampled
from hearth.grounding.preconditions.source_places import source_conditions
from hearth.homes.library import load_graph
from hearth.schemas.syntax import parse_program
from hearth.simulation.rules import DEFAULT
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home


def plan(tmp_path, *lines):
    file = tmp_path / "plan.txt"
    file.write_text("\n".join(f"{number}. {line}" for number, line in enumerate(lines, 1)))
    return file


@pytest.mark.parametrize("name", ["cedar", "willow"])
def test_the_milk_is_in_the_fridge_from_which_it_is_taken(tmp_path, knowledge, name):
    file = plan(tmp_path, "Walk to the kitchen", "Take the milk out of the fridge", "Drink the milk")
    given, home = choose_given(file, knowledge), Home.from_graph(load_graph(name, knowledge), name, knowledge)
    assert given.sources == ((1, "fridge"),)
    for seed in range(3):
        found = as_given_or_sampled(given.program, home, seed, True, DEFAULT, given.sources)[1]
        world, milk = found.environment.world, found.environment.program.steps[1].objects[0].node
        inside = edge_rows.inside(world, world.home.index[milk])
        assert "fridge" in {world.home.classes[i] for i in indices(inside)}
        assert found.execution.failure is None and len(found.execution.worlds) == 4


@pytest.mark.parametrize(
    ("text", "sources", "conditions"),
    [
        ("[Grab] <milk> (1)", [(0, "fridge")], {"inside(milk (1), fridge (1))", "open(fridge (1))"}),
        ("[Open] <fridge> (2)\n[Grab] <milk> (1)", [(1, "fridge")], {"inside(milk (1), fridge (2))"}),
        ("[Grab] <cup> (1)", [(0, "table")], {"in(cup (1), table (1))"}),
        ("[Grab] <cup> (1)", [(0, "kitchen")], set()),
        ("[Grab] <cup> (1)\n[PutBack] <cup> (1) <table> (1)\n[Grab] <cup> (1)", [(2, "table")], set()),
        ("[Grab] <cup> (1)", [], set()),
    ],
)
def test_conditions_say_where_things_are(knowledge, text, sources, conditions):
    program, faults = parse_program(text)
    assert not faults
    assert {str(each) for each in source_conditions(program, sources, knowledge)} == conditions


def test_a_line_with_two_places_says_of_neither(tmp_path, knowledge):
    file = plan(tmp_path, "Take the milk from the fridge and the cup from the table")
    assert choose_given(file, knowledge).sources == ()


def test_a_place_in_which_a_thing_cannot_be_is_said(tmp_path):
    file = plan(tmp_path, "Walk to the kitchen", "Take the milk out of the fridge", "Open the fridge", "Drink the milk")
    done = CliRunner().invoke(cli.app, ["run", str(file), "--sample", "--home", "cedar"])
    assert done.exit_code == 0 and "Done: 4 steps." in done.output
    assert "Step 2 takes its thing from elsewhere: no start was found with it at <fridge>." in done.output
