import pytest

from hearth.schemas.goals import Goal
from hearth.schemas.literals import Literal
from hearth.schemas.syntax import parse_program
from hearth.scoring.metrics.goals import goal_of
from hearth.simulation.engine import run
from hearth.simulation.goals import Progress

BOTH_CUPS = """[Walk] <cup> (1.20)
[Grab] <cup> (1.20)
[Grab] <cup> (2.21)
[Walk] <table> (1.10)
[PutBack] <cup> (1.20) <table> (1.10)"""


def ran(world, text):
    return run(world, parse_program(text)[0]).final


@pytest.mark.parametrize(
    ("predicate", "wanted", "found"),
    [
        (Literal.of("ON", "cup", "table"), 2, 1),
        (Literal.of("ON", 20, "table"), 1, 1),
        (Literal.of("ON", 20, 10), 1, 1),
        (Literal.of("ON", 21, 10), 1, 0),
        (Literal.of("ON", "cup", "piano"), 1, 0),
        (Literal.of("INSIDE", "agent", "kitchen"), 1, 1),
        (Literal.of("INSIDE", "agent:1", "kitchen"), 1, 0),
        (Literal.of("HOLDS", "agent", "cup"), 1, 1),
        (Literal.of("HOLDS_RH", "agent", "cup"), 1, 0),
        (Literal.of("CLEAN", "cup"), 2, 2),
        (Literal.of("CLOSE", "agent:0", "table"), 1, 1),
    ],
)
def test_counts_distinct_subjects(world, predicate, wanted, found):
    result = Progress.at(Goal.of((predicate, wanted)), ran(world, BOTH_CUPS))
    assert result.counts == (found,)
    assert result.satisfied == (found >= wanted)
    assert result.unmet().counts == (() if found >= wanted else ((predicate, wanted - found),))


def test_fraction_does_not_count_more_than_is_wanted(world):
    goal = Goal.of(Literal.of("CLEAN", "cup"), (Literal.of("ON", "cup", "table"), 3))
    assert Progress.at(goal, ran(world, BOTH_CUPS)).fraction == 2 / 4


def test_an_empty_goal_is_reached(world):
    result = Progress.at(Goal.of(), world)
    assert (result.satisfied, result.fraction) == (True, 1.0)


def test_what_an_execution_achieved(world):
    goal = goal_of(world, ran(world, BOTH_CUPS + "\n[Walk] <fridge> (1.11)\n[Open] <fridge> (1.11)"))
    assert [(str(predicate), count) for predicate, count in goal] == [
        ("HOLDS(agent, cup)", 1),
        ("ON(cup, table)", 1),
        ("OPEN(fridge)", 1),
    ]
    assert not Progress.at(goal, world).satisfied


def test_a_goal_is_reached_by_the_execution_it_was_made_of(world):
    final = ran(world, BOTH_CUPS)
    assert Progress.at(goal_of(world, final), final).satisfied


def test_holding_two_things_counts_both(world):
    final = ran(world, "\n".join(BOTH_CUPS.splitlines()[:3]))
    assert goal_of(world, final) == Goal.of((Literal.of("HOLDS", "agent", "cup"), 2))
    assert Progress.at(goal_of(world, final), final).satisfied
