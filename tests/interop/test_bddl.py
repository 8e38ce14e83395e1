"""Problems of BEHAVIOR: read as environments and goals, and homes and goals written as problems."""

import json
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

import hearth
from hearth.challenges.household import household_tasks, solve
from hearth.cli import app
from hearth.homes.lint import lint
from hearth.interop.bddl.environment import environment_of
from hearth.interop.bddl.expressions import DEEPEST, LONGEST, read_expression
from hearth.interop.bddl.goal_reading import goal_of, way_of
from hearth.interop.bddl.goal_writing import problem_text
from hearth.interop.bddl.problem import read_problem
from hearth.interop.bddl.words import words
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.simulation.world.edit import edit
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

KNOWN = default().of_set(3)
SAID = ("ON", "INSIDE", "OPEN", "CLOSED", "OFF")
"""States and relations of goals that BDDL can say."""
TEXT = (Path(__file__).parent / "bddl_problems" / "tidying_a_shelf.bddl").read_text()


def activity(text=TEXT):
    return environment_of(read_problem(text, "mine.bddl"), KNOWN)


def world(found):
    return World.start(Home.from_graph(found.graph, "", KNOWN))


def test_a_problem_is_an_environment():
    found = activity()
    assert lint(found.graph, KNOWN) == () and found.left_out == ()
    classes = {node.id: node.class_name for node in found.graph.nodes}
    edges = {(classes[one], relation, classes[other]) for one, relation, other in found.graph.edges}
    assert {("mug", "ON", "table"), ("mug", "INSIDE", "kitchen"), ("plate", "INSIDE", "cabinet")} <= edges
    states = {node.class_name: node.states for node in found.graph.nodes}
    assert "DIRTY" in states["table"] and "CLEAN" not in states["table"] and "OPEN" in states["cabinet"]


def test_its_goal_is_a_goal_of_ours():
    found = activity()
    ids = found.nodes
    table, book, cabinet = ids["table.n.02_1"], ids["book.n.02_1"], ids["cabinet.n.01_1"]
    assert str(goal_of(found, KNOWN)) == (
        f"not DIRTY({table}) and (forpairs x1: mug, x2: plate. (ON(x1, x2))) and (forn 1 x1: plate. (ON(x1, {table})))"
        f" and (exists x1: cabinet. (INSIDE({book}, x1)))"
        f" and ((not INSIDE({book}, {cabinet})) or (not OPEN({cabinet})))"
    )


def test_a_goal_holds_only_where_all_of_it_does():
    found = activity()
    goal, start, ids = goal_of(found, KNOWN), world(found), found.nodes
    table, book, cabinet = ids["table.n.02_1"], ids["book.n.02_1"], ids["cabinet.n.01_1"]
    places = {ids["plate.n.04_1"]: ("ON", table), ids["mug.n.04_1"]: ("ON", ids["plate.n.04_1"]),
              ids["mug.n.04_2"]: ("ON", ids["plate.n.04_2"]), book: ("INSIDE", cabinet)}  # fmt: skip
    done = edit(start, place=places, set=[(table, "CLEAN"), (cabinet, "CLOSED")], check=False)
    assert not hearth.Progress.start(goal, start).satisfied
    assert hearth.Progress.start(goal, done).satisfied
    both = edit(done, place={ids["plate.n.04_2"]: ("ON", table)}, check=False)
    assert not hearth.Progress.start(goal, both).satisfied  # two plates, where exactly one is wanted


def test_a_way_to_the_goal_is_about_nodes_alone():
    found = activity()
    literals = [literal for literal, _ in way_of(found, KNOWN)]
    assert all(isinstance(term, int) for literal in literals for term in literal.terms)
    assert {literal.name for literal in literals} == {"ON", "INSIDE", "CLEAN", "CLOSED"}


def test_a_problem_that_was_read_is_written_and_read_back():
    found = activity()
    goal = goal_of(found, KNOWN)
    again = activity(problem_text(found.graph, goal, KNOWN))
    assert by_classes(goal_of(again, KNOWN), again) == by_classes(goal, found)
    assert sorted(edges(again)) == sorted(edges(found))


def edges(found):
    classes = {node.id: node.class_name for node in found.graph.nodes}
    shown = [edge for edge in found.graph.edges if edge.relation in ("ON", "INSIDE")]
    return [(classes[one], relation, classes[other]) for one, relation, other in shown]


def by_classes(goal, found):
    classes = {str(node.id): node.class_name for node in found.graph.nodes}
    return re.sub(r"(?<=[(, ])[0-9]+(?=[,)])", lambda match: classes[match[0]], str(goal))


def test_goals_of_household_tasks_are_written_and_mean_the_same():
    tasks = [task for task in household_tasks("valid_seen", 10)
             if not task.goal.parts and all(literal.name in SAID for literal, _ in task.goal)][:2]  # fmt: skip
    assert tasks
    assert len(tasks) == 2
    for task in tasks:
        start = task.start()
        again = activity(problem_text(start.graph(), task.goal, KNOWN))
        goal = goal_of(again, KNOWN)
        assert not hearth.Progress.start(goal, world(again)).satisfied
        end = solve(start, task.goal, task.seed, default(), sees_all=True).env.world
        reached = activity(problem_text(end.graph(), task.goal, KNOWN))
        assert hearth.Progress.start(task.goal, end).satisfied
        assert hearth.Progress.start(goal_of(reached, KNOWN), world(reached)).satisfied, str(task.goal)


@pytest.mark.parametrize("text", ["OPEN(fridge) then CLOSED(fridge)", "always CLOSED(fridge)", "GRAB(milk)"])
def test_goals_that_bddl_cannot_say_are_refused(text):
    home = hearth.home("maple")
    with pytest.raises(HearthError) as raised:
        problem_text(hearth.load_graph("maple", default()), hearth.read_goal(text, home), default())
    assert raised.value.diagnostics[0].code is Code.NOT_UNDERSTOOD


@pytest.mark.parametrize("old, new, code", [
    ("(:goal", "(:gaol", Code.SYNTAX),
    ("(open cabinet.n.01_1)", "(open cabinet.n.01_1", Code.SYNTAX),
    ("(open cabinet.n.01_1)", "(open cupboard.n.01_1)", Code.UNDECLARED),
    ("mug.n.04_2 - mug", "mug.n.04_1 - mug", Code.DUPLICATE),
    ("(inside ?book.n.02_1 ?cabinet.n.01))", "(under ?book.n.02_1 ?cabinet.n.01))", Code.NOT_UNDERSTOOD),
    ("kitchen", "spaceship", Code.NO_ROOM),
])  # fmt: skip
def test_faults_are_named(old, new, code):
    with pytest.raises(HearthError) as raised:
        goal_of(activity(TEXT.replace(old, new)), KNOWN)
    [fault] = raised.value.diagnostics
    assert fault.code is code and fault.suggestion and (fault.line or code is Code.NO_ROOM)


@pytest.mark.parametrize("text", ["(" * (DEEPEST + 2), "x" * (LONGEST + 1), "", ")", "(a) (b)", "(" * 100_000])
def test_odd_texts_are_refused(text):
    with pytest.raises(HearthError):
        read_expression(text)


def test_a_thing_without_a_class_is_named():
    text = TEXT.replace("book.n.02", "gizmo.n.01")
    found = activity(text)
    assert [fault.code for fault in found.left_out] == [Code.UNKNOWN_OBJECT]
    with pytest.raises(HearthError, match="gizmo"):
        goal_of(found, KNOWN)


def test_every_class_of_the_table_is_one_of_ours():
    for word, name in words().classes.items():
        assert KNOWN.object_class(name) is not None, word
        assert KNOWN.object_class(word) is None, f"{word} needs no row"


def test_an_activity_is_converted_by_a_command(tmp_path):
    paths = [str(tmp_path / "shelf.bddl"), str(tmp_path / "home.json")]
    (tmp_path / "shelf.bddl").write_text(TEXT)
    done = CliRunner().invoke(app, ["home", "convert", *paths, "--json"])
    assert done.exit_code == 0, done.output
    document = json.loads(done.stdout)
    home = hearth.home(str(tmp_path / "home.json"))
    assert str(hearth.read_goal(document["goal"], home)) == document["goal"]
    (tmp_path / "shelf.bddl").write_text(TEXT.replace("(imply", "(unless"))
    done = CliRunner().invoke(app, ["home", "convert", *paths])
    assert done.exit_code == 1 and "NOT_UNDERSTOOD" in done.output
