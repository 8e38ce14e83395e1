"""The rules of a replay allow and remember other things: doors, things that are off, the place where a thing was."""

from __future__ import annotations

from action_home import IDS, after, step

from hearth.simulation.engine import act
from hearth.simulation.rules import DEFAULT, REPLAY
from hearth.simulation.world.world import World


def test_what_has_a_switch_is_watched_only_when_on_unless_replaying():
    world = after("Walk chair; TurnTo television")
    assert isinstance(act(world, step("Watch television"), REPLAY), World)


def test_doors_do_not_stop_a_replay():
    world = after("Walk door; Close door; Walk kitchen")
    assert isinstance(act(world, step("Walk bed"), REPLAY), World)


def test_the_remembered_place_is_never_the_character_except_in_replay():
    for rules, places in ((DEFAULT, []), (REPLAY, [IDS["character"]])):
        world = act(after("Walk sponge"), step("Grab sponge"), rules)
        assert [world.home.ids[p] for _, p, _ in world.agents[0].origins] == places
