"""Starts of tasks: nothing is reached, everything can be, and the same seed gives the same world."""

from __future__ import annotations

import pytest

from hearth.challenges.challenge_definition import challenge
from hearth.challenges.goal_grammar import wanted_things
from hearth.challenges.start_worlds import site_of
from hearth.challenges.tasks import task
from hearth.homes.library import names
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.simulation.goals import Progress
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.motion.positions import ends
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices
from hearth.simulation.world.digest import digest

WAH = challenge("wah")
SPLITS = tuple(WAH.splits)


@pytest.fixture(scope="module")
def tasks(knowledge):
    """Some tasks with their starts."""
    drawn = [task("wah", SPLITS[number % 3], number) for number in range(45)]
    return [(one, one.start(knowledge)) for one in drawn]


def test_nothing_is_fulfilled_and_there_are_enough_things(tasks):
    for one, world in tasks:
        assert not any(Progress.start(one.goal_in(world.home), world).counts)
        wanted = wanted_things(one.goal)
        for name, most in WAH.grammar.most_of.items():
            here = (world.home.instances(name) & world.home.everything).bit_count()
            assert wanted.get(name, 0) <= here <= max(most, wanted.get(name, 0)) + 1


def test_some_starts_have_more_than_is_wanted_and_things_that_nobody_wants(tasks):
    more = unwanted = 0
    for one, world in tasks:
        wanted = wanted_things(one.goal)
        for name in WAH.grammar.most_of:
            here = (world.home.instances(name) & world.home.everything).bit_count()
            more += here > wanted.get(name, 0) > 0
            unwanted += name not in wanted and here > 0
    assert more > 45
    assert unwanted > 45


def test_all_things_are_at_furniture_that_can_be_walked_to(tasks):
    for _, world in tasks:
        home, here = world.home, ground_of(world.home)
        for name in WAH.grammar.most_of:
            for i in indices(home.instances(name) & home.everything):
                places = (edge_rows.on(world, i) | edge_rows.inside(world, i)) & ~home.rooms
                assert places.bit_count() == 1
                (place,) = indices(places)
                assert home.classes[place] not in WAH.never_at
                assert ends(world, here, place)


def test_agents_stand_at_places_in_different_rooms(tasks):
    for _, world in tasks:
        assert [agent.stride for agent in world.agents] == list(WAH.strides)
        assert all(agent.pose is not None and not agent.held for agent in world.agents)
        assert len({edge_rows.agent_room(world, agent) for agent in world.agents}) == len(world.agents)


def test_equal_seeds_give_equal_worlds_and_others_differ(knowledge):
    digests = [digest(task("wah", "train", number).start(knowledge)) for number in (0, 0, 1)]
    assert digests[0] == digests[1] != digests[2]


def test_a_demonstration_is_in_another_home(tasks):
    assert all(one.home != one.demonstration_home for one, _ in tasks)
    assert {one.demonstration_home for one, _ in tasks} <= set(WAH.train)


@pytest.mark.parametrize("home", names())
def test_every_home_has_all_the_furniture(home, knowledge):
    assert home in {*WAH.train, *WAH.test}
    found = site_of("wah", home, knowledge).home
    assert all(found.instances(each) for each in WAH.grammar.furniture)
    assert not any(found.instances(each) & found.everything for each in WAH.grammar.most_of)


def test_a_goal_of_other_furniture_is_refused():
    with pytest.raises(HearthError) as raised:
        task("wah", "train", goal="ON(plate, bed)")
    assert raised.value.diagnostics[0].code is Code.UNKNOWN_OBJECT


def test_actions_of_the_challenge_are_executed(knowledge, tasks):
    from hearth.simulation.actions.legal import legal
    from hearth.simulation.actions.registry import EVERY

    actions = WAH.allowed(knowledge)
    assert actions <= set(EVERY)
    _, world = tasks[0]
    some, every = legal(world, 0, actions=actions), legal(world, 0)
    assert some.masks == {name: masks for name, masks in every.masks.items() if name in actions}
    assert len(some.masks) < len(every.masks)
