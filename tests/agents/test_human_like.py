"""The human-like agent: it reaches goals, sees only what it sees, closes what it opened, and has its own generator."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import pytest
from small_tasks import play, scrambled, standing, start, target, wanted

from hearth.agents.human_like import Habits, HumanLike
from hearth.agents.mcts import Search
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episode_loop import Player
from hearth.challenges.episode_loop import play as played_by
from hearth.schemas.goals import Goal
from hearth.schemas.literals import Literal
from hearth.simulation.env import Env
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices
from hearth.simulation.world.edit import edit
from hearth.simulation.world.states import OPEN
from hearth.simulation.world.world import World

PUTS = ("PutBack", "PutIn")

FAST = Habits(search=Search(simulations=20))


@pytest.fixture(scope="session")
def kitchen(maple):
    return start(maple, {"plate": 3, "fork": 2, "apple": 2, "cupcake": 2, "book": 2}, seed=5)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(
    ("relation", "furniture", "counts"),
    [
        ("ON", "dining_table", {"plate": 2, "fork": 1}),
        ("INSIDE", "fridge", {"apple": 2, "cupcake": 1}),
        ("INSIDE", "dishwasher", {"plate": 2, "fork": 2}),
    ],
)
def test_it_puts_things_where_they_are_wanted(kitchen, relation, furniture, counts, seed):
    goal = wanted(kitchen, relation, furniture, **counts)
    played = play(kitchen, goal, [HumanLike(), None], seed)
    assert played.progress.satisfied
    assert not [tick.failures for tick in played.ticks if tick.failures]


def test_it_takes_a_book_and_sits_down_last(kitchen):
    sofa = target(kitchen, "sofa")
    goal = Goal.of(
        Literal.of("ON", "agent:0", sofa), Literal.of("HOLDS", "agent:0", "book"),
        Literal.of("ON", "apple", target(kitchen, "coffee_table")),
    )  # fmt: skip
    played = play(kitchen, goal, [HumanLike(), None])
    assert played.progress.satisfied
    assert played.ticks[-1].instructions[0].action == "Sit"


def test_it_switches_on_what_is_to_be_on(kitchen):
    goal = Goal.of(Literal.of("ON", target(kitchen, "television")))
    assert play(kitchen, goal, [HumanLike(), None]).progress.satisfied


def test_what_it_does_not_see_changes_nothing(kitchen):
    goal = wanted(kitchen, "ON", "dining_table", plate=2, fork=1)
    plain = play(kitchen, goal, [HumanLike(), None], 3)
    assert play(kitchen, goal, [HumanLike(), None], 3, scramble=scrambled).choices == plain.choices


def test_seeds_differ_and_repeat(kitchen):
    goal = wanted(kitchen, "ON", "dining_table", plate=2, fork=2)
    runs = [play(kitchen, goal, [HumanLike(FAST), None], seed).choices for seed in (1, 2, 3, 1)]
    assert runs[0] == runs[3]
    assert len(set(map(str, runs))) == 3


def test_two_agents_of_one_seed_have_their_own_generators(kitchen):
    """The order of two agents does not change the other agent's random choices."""
    goal = wanted(kitchen, "ON", "dining_table", plate=2)
    env = Env()
    env.restore(kitchen)
    drawn = []
    for others in (0, 3):
        for number in range(others):
            HumanLike().reset(env.observe(1), goal, number)
        agent = HumanLike()
        agent.reset(env.observe(0), goal, 7)
        drawn.append([agent.chooser.random() for _ in range(5)])
    assert drawn[0] == drawn[1]


@pytest.mark.parametrize("seed", range(4))
def test_it_closes_what_it_opened_and_opens_nothing_for_ever(kitchen, seed):
    """A container that stays open had a wanted thing in it, or is the one from which the last thing was taken."""
    played = play(kitchen, wanted(kitchen, "ON", "dining_table", plate=2, fork=2), [HumanLike(), None], seed)
    opened = [tick.instructions[0].objects[0].node for tick in played.ticks if done(tick, "OPEN")]
    assert len(opened) > 3
    assert max(Counter(opened).values()) <= 2
    assert all(one != other for one, other in pairwise(opened))
    end = played.ticks[-1].world
    left = list(indices(end.states[OPEN] & ~kitchen.states[OPEN]))
    things = end.home.instances("plate") | end.home.instances("fork")
    assert sum(not edge_rows.contents(end, i) & things for i in left) <= 1


def test_it_leaves_a_container_open_while_more_is_to_go_in(kitchen):
    goal = wanted(kitchen, "INSIDE", "dishwasher", plate=2, fork=2)
    ticks = play(kitchen, goal, [HumanLike(), None]).ticks
    dishwasher = target(kitchen, "dishwasher")
    closed = [t for t in ticks if done(t, "CLOSED") and t.instructions[0].objects[0].node == dishwasher]
    assert not closed


def done(tick, state: str) -> bool:
    instruction = tick.instructions.get(0)
    return instruction is not None and tick.world.home.knowledge.state_of(instruction.action) == state


@pytest.mark.parametrize("things", [{"apple": 2}, {}])
def test_hands_full_of_what_is_not_needed_are_emptied(kitchen, things):
    """It begins with two books in its hands, and is to carry apples, or nothing."""
    right, left = list(indices(kitchen.home.instances("book")))[:2]
    full = kitchen.with_agent(0, kitchen.agents[0]._replace(right=1 << right, left=1 << left))
    goal = wanted(kitchen, "INSIDE", "fridge", apple=2)
    told = wanted(kitchen, "INSIDE", "fridge", **things)
    played = play(full, goal, [HumanLike(), None], goals=[told, None], limit=150)
    assert played.progress.satisfied == bool(things)
    both = [tick for tick in played.ticks if tick.world.agents[0].held == 1 << right | 1 << left]
    assert len(both) <= 8  # the walk to a surface


def test_it_goes_on_where_another_takes_what_it_wanted(kitchen):
    goal = wanted(kitchen, "ON", "dining_table", plate=2, fork=1)
    played = play(kitchen, goal, [HumanLike(), HumanLike()], 2)
    assert played.progress.satisfied


def test_a_closed_door_is_opened_and_left_open(kitchen):
    """The doors of a room are closed while the agent is in it."""
    home = kitchen.home
    closed = edit(
        kitchen,
        set=[(home.ids[i], "CLOSED") for i in indices(home.doors & home.properties["CAN_OPEN"])],
        check=False,
    )
    assert isinstance(closed, World)
    inside = standing(closed, 0, "bedroom")
    played = play(inside, wanted(kitchen, "ON", "dining_table", plate=2, fork=1), [HumanLike(), None])
    assert played.progress.satisfied
    doors = [tick for tick in played.ticks if done(tick, "OPEN") and home.doors >> opened_by(tick) & 1]
    assert doors
    assert not [tick for tick in played.ticks if done(tick, "CLOSED") and home.doors >> opened_by(tick) & 1]


def opened_by(tick) -> int:
    return tick.world.home.index[tick.instructions[0].objects[0].node]


def test_it_does_other_things_while_a_container_does_not_open(kitchen):
    """The fridge, in which an apple is, is on, so that it can't be opened; nothing allowed switches it off."""
    home = kitchen.home
    fridge = target(kitchen, "fridge")
    apples = [home.ids[i] for i in indices(home.instances("apple"))]
    locked = edit(kitchen, place={apples[0]: ("INSIDE", fridge)}, set=[(fridge, "CLOSED"), (fridge, "ON")], check=False)
    assert isinstance(locked, World)
    goal = wanted(kitchen, "ON", "dining_table", apple=2, plate=2)
    played = play(locked, goal, [HumanLike(), None], limit=200)
    assert played.progress.counts == (1, 2)


def test_with_full_hands_it_keeps_what_it_is_to_hold(kitchen):
    home = kitchen.home
    book, apple = (next(indices(home.instances(name))) for name in ("book", "apple"))
    full = kitchen.with_agent(0, kitchen.agents[0]._replace(right=1 << book, left=1 << apple))
    goal = Goal.of(Literal.of("HOLDS", "agent:0", "book"), Literal.of("ON", "agent:0", target(kitchen, "sofa")))
    assert play(full, goal, [HumanLike(), None], limit=60).progress.satisfied


@pytest.mark.parametrize("seed", range(3))
def test_what_one_part_of_a_goal_needs_is_not_taken_for_another(kitchen, seed):
    goal = wanted(kitchen, "ON", "dining_table", plate=1, fork=1) & wanted(kitchen, "INSIDE", "fridge", plate=2, fork=1)
    played = play(kitchen, goal, [HumanLike(), None], seed)
    assert played.progress.satisfied
    put = [t.instructions[0].objects[0].node for t in played.ticks if t.instructions[0].action in PUTS]
    assert len(put) == len(set(put))


def test_what_is_switched_on_is_switched_off_before_it_is_opened(maple):
    """Another may have switched the freezer on; while it is on it can't be opened."""
    world = start(maple, {"apple": 1}, seed=3)
    apple, freezer = target(world, "apple"), target(world, "freezer")
    world = edit(world, place={apple: ("INSIDE", freezer)}, set=[(freezer, "ON")], check=False)
    goal = wanted(world, "ON", "kitchen_counter", apple=1)
    done = played_by(world, goal, [Player(HumanLike(), goal)], 0, actions=challenge("wah").allowed(maple.knowledge))
    assert done.success
    assert [t.instructions[0].action for t in done.env.ticks].count("SwitchOff") == 1
