"""Achievements of programs, worked out by hand."""

from __future__ import annotations

from repair_worlds import ROOMS, small_world, steps_of

from hearth.grounding.preconditions.postconditions import achieved, missing, nodes_of, reached
from hearth.schemas.literals import HOLDS, Literal
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.simulation.engine import run

ME = ("character", 1)


def goal_of(world: str, program: str) -> set[str]:
    execution = run(small_world(ROOMS + world), steps_of(program))
    assert execution.failure is None
    return set(map(str, achieved(execution)))


def test_states_that_came_are_achieved_and_those_that_were_are_not():
    world = "20 television OFF PLUGGED_IN inside 1\n21 fridge CLOSED inside 1"
    program = (
        "[Walk] <television> (1.20)\n[SwitchOn] <television> (1.20)\n[Walk] <fridge> (1.21)\n"
        "[Open] <fridge> (1.21)\n[Close] <fridge> (1.21)"
    )
    assert goal_of(world, program) == {"ON(television (1))"}


def test_hands_seats_and_clothes():
    world = "20 couch inside 1\n21 book inside 1\n22 clothes_hat inside 1"
    program = (
        "[Walk] <clothes_hat> (1.22)\n[Grab] <clothes_hat> (1.22)\n[PutOn] <clothes_hat> (1.22)\n[Walk] <book> (1.21)\n"
        "[Grab] <book> (1.21)\n[Walk] <couch> (1.20)\n[Sit] <couch> (1.20)"
    )
    assert goal_of(world, program) == {
        "ON(clothes_hat (1), character (1))",
        "HOLDS(character (1), book (1))",
        "ON(character (1), couch (1))",
        "SITTING(character (1))",
    }


def test_a_thing_put_somewhere_is_there_and_its_room_is_of_no_matter():
    world = "20 table inside 2\n21 cup inside 1"
    program = (
        "[Walk] <cup> (1.21)\n[Grab] <cup> (1.21)\n[Walk] <bedroom> (1.2)\n[Walk] <table> (1.20)\n"
        "[PutBack] <cup> (1.21) <table> (1.20)"
    )
    assert goal_of(world, program) == {"ON(cup (1), table (1))"}


def test_a_room_counts_for_who_went_there_last_and_for_what_was_dropped_there():
    world = "21 cup inside 1"
    program = "[Walk] <cup> (1.21)\n[Grab] <cup> (1.21)\n[Walk] <bedroom> (1.2)"
    assert goal_of(world, program) == {"HOLDS(character (1), cup (1))", "INSIDE(character (1), bedroom (1))"}
    dropped = goal_of(world, program + "\n[Drop] <cup> (1.21)")
    assert dropped == {"INSIDE(cup (1), bedroom (1))", "INSIDE(character (1), bedroom (1))"}


def test_what_is_poured_stays_but_a_bottle_is_where_it_was_put():
    world = "20 table inside 1\n21 juice on 20 inside 1\n22 drinking_glass inside 1\n23 water inside 1"
    take = "[Walk] <{0}>\n[Grab] <{0}>\n[Walk] <drinking_glass> (1.22)\n[Pour] <{0}> <drinking_glass> (1.22)"
    juice = take.replace("<{0}>", "<juice> (1.21)")
    assert "INSIDE(juice (1), drinking_glass (1))" not in goal_of(world, juice)
    water = take.replace("<{0}>", "<water> (1.23)")
    assert "INSIDE(water (1), drinking_glass (1))" in goal_of(world, water)


def test_goals_are_said_of_instances_and_asked_of_any_binding():
    goal = (Literal.of("ON", ("cup", 1), ("table", 1)), Literal.of("SITTING", ME))
    world = small_world(ROOMS + "30 table inside 1\n31 cup on 30 inside 1\n32 cup inside 1")
    assert missing(goal, {("cup", 1): 31, ("table", 1): 30, ME: 10}, world) == goal[1:]
    assert missing(goal, {("cup", 1): 32, ("table", 1): 30, ME: 10}, world) == goal
    assert missing(goal, {ME: 10}, world) == goal
    assert reached((), {}, world)


def test_every_character_has_a_node():
    world = small_world("1 kitchen\n10 character inside 1\n11 character inside 1")
    assert nodes_of(steps_of("[StandUp]"), world) == {("character", 1): 10, ("character", 2): 11}


def test_of_what_nodes_alone_name_each_is_a_thing_of_its_own():
    """As steps of `legal` name them: without instances."""
    world = small_world(ROOMS + "20 table inside 1\n21 cup on 20 inside 1\n22 cup on 20 inside 1")
    table, one, other = ObjectRef("table", 0, 20), ObjectRef("cup", 0, 21), ObjectRef("cup", 0, 22)
    steps = [Step("Walk", (table,)), Step("Grab", (one,)), Step("Grab", (other,)), Step("PutBack", (other, table))]
    program = Program("Cups", "", tuple(steps))
    nodes = nodes_of(program, world)
    assert sorted(nodes.values()) == [10, 20, 21, 22]
    execution = run(world, program)
    assert set(achieved(execution)) == {Literal(HOLDS, (ME, one.key))}
    assert missing(achieved(execution), nodes, world) == achieved(execution)
    again = Program("Cups", "", tuple(steps[:1] + steps[2:]))
    assert nodes_of(again, world)[other.key] == 22
    unbound = [(ref.name, ref.instance, ref.node) for ref in program.unbound().objects()]
    assert unbound == [("table", 1, None), ("cup", 1, None), ("cup", 2, None)]
