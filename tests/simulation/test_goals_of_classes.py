"""Goals about things of a class: some, all, exactly so many, or pairs one to one."""

import pytest

import hearth
from hearth.challenges.instruction_reader import read_instruction
from hearth.challenges.instruction_writer import instruction
from hearth.kb.loading.load import default
from hearth.simulation.world.world import World

PAIRS = "forpairs x: plate, y: table. (ON(x, y))"


@pytest.mark.parametrize("text, on, reached", [
    ("forall x: plate. (ON(x, table))", {2: 10, 3: 10}, True),
    ("forall x: plate. (ON(x, table))", {2: 10}, False),
    ("exists x: plate. (not ON(x, table))", {2: 10}, True),
    ("forn 1 x: plate. (ON(x, table))", {2: 10}, True),
    ("forn 1 x: plate. (ON(x, table))", {2: 10, 3: 10}, False),
    ("forn 2 x: plate. (ON(x, table))", {2: 10, 3: 11}, True),
    (PAIRS, {2: 10, 3: 11}, True),
    (PAIRS, {2: 10, 3: 10}, False),
    ("forpairs y: table, x: plate. (ON(x, y))", {2: 11, 3: 10}, True),
])  # fmt: skip
def test_goals_about_things_of_a_class(text, on, reached):
    classes = {1: "kitchen", 2: "plate", 3: "plate", 4: "apple", 10: "table", 11: "table", 20: "character"}
    nodes = [{"id": n, "class_name": name, "category": "Rooms" if n == 1 else "Characters" if n == 20 else "Props"}
             for n, name in classes.items()]  # fmt: skip
    edges = [{"from_id": n, "relation_type": "INSIDE", "to_id": 1} for n in classes if n != 1]
    edges += [{"from_id": one, "relation_type": "ON", "to_id": other} for one, other in on.items()]
    home = hearth.Home.from_release({"nodes": nodes, "edges": edges}, "pairs", default())
    goal = hearth.read_goal(text, home)
    assert hearth.Progress.start(goal, World.start(home)).satisfied is reached
    assert hearth.read_goal(str(goal), home) == goal
    assert read_instruction(instruction(goal, default(), 0), default()) == goal


BROKEN = (
    "forn x: plate. (ON(x, table))",
    "forn 2 x. (ON(x, table))",
    "forall x: plte. (ON(x, 1))",
    "forpairs x: plate. (ON(x, table))",
)


@pytest.mark.parametrize("text", BROKEN)
def test_faults_of_goals_about_things_of_a_class_have_a_column(text):
    home = hearth.home("maple", default())
    with pytest.raises(hearth.HearthError) as raised:
        hearth.read_goal(text, home)
    assert raised.value.diagnostics[0].column > 0
