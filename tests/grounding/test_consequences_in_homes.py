"""The seven types of tasks of ALFRED by action set 3: each a goal, and a program that reaches it in all our homes."""

import pytest

from hearth.grounding.grounded_run import LEAST, attempt
from hearth.homes import library
from hearth.kb.action_grammar import check
from hearth.kb.loading.load import default
from hearth.schemas.failures import Failure
from hearth.schemas.program import Program
from hearth.schemas.syntax import parse_steps
from hearth.simulation.goal_text import read_goal
from hearth.simulation.goals import Progress
from hearth.simulation.rules import CONSEQUENCES, DEFAULT
from hearth.simulation.world.home import Home

PUT_BREAD = (
    "Walk {0}; Open {0}; Walk food_bread; Grab food_bread; Walk {0}; PutIn food_bread {0}; Close {0}; SwitchOn {0}"
)

TASKS = {
    "look at in light": (
        "Walk book; Grab book; Walk table_lamp; SwitchOn table_lamp; Read book",
        "HOLDS(agent, book) and ON(table_lamp)",
    ),
    "pick and place": ("Walk cup; Grab cup; Walk table; PutBack cup table", "ON(cup, table)"),
    "place in something that is moved": (
        "Walk spoon; Grab spoon; Walk cup; PutIn spoon cup; Grab cup; Walk table; PutBack cup table",
        "ON(cup, table) and INSIDE(spoon, cup)",
    ),
    "pick two and place": (
        "Walk cup; Grab cup; Walk cup:2; Grab cup:2; Walk table; PutBack cup table; PutBack cup:2 table",
        "ON(cup, table): 2",
    ),
    "clean and place": ("Walk cup; Grab cup; Walk sink; Wash cup; PutBack cup sink", "CLEAN(cup) and ON(cup, sink)"),
    "heat and place": (PUT_BREAD.format("microwave") + "; Wait" * 3, "HOT(food_bread)"),
    "cool and place": (PUT_BREAD.format("fridge") + "; Wait" * 10, "COLD(food_bread)"),
}


def program_of(text: str) -> Program:
    lines = []
    for step in text.split("; "):
        action, *names = step.split()
        parts = (name.partition(":") for name in names)
        lines.append(f"[{action}]" + "".join(f" <{name}> ({number or 1})" for name, _, number in parts))
    steps = tuple(step for line in lines for step in parse_steps(line))
    program, faults = check(Program(steps=steps), default())
    assert not faults
    return program


@pytest.mark.parametrize("home", library.names())
@pytest.mark.parametrize("task", TASKS)
def test_a_program_reaches_the_goal_of_each_type_of_task(task, home):
    place = Home.from_graph(library.load_graph(home, default()), home, default())
    text, goal = TASKS[task]
    trial = attempt(program_of(text), place, 0, CONSEQUENCES, size=LEAST)
    assert not isinstance(trial, Failure), trial
    execution = trial.execution
    assert execution.executable
    assert Progress.of(read_goal(goal, execution.worlds[0].home), execution).satisfied
    assert execution.rules.consequences and not DEFAULT.consequences
