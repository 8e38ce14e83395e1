"""The nodes that a step may have touched include all that it did touch, found edge by edge."""

from __future__ import annotations

import random

from small_worlds import random_graph, random_step

from hearth.kb.loading.load import default
from hearth.schemas.program import Step
from hearth.schemas.vocabulary import STATES
from hearth.simulation.engine import act
from hearth.simulation.motion.positions import placed
from hearth.simulation.world.bits import indices
from hearth.simulation.world.changed_nodes import BY_PLACE, changed, unchanged
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

RELATIONS = ("ON", "INSIDE", "CLOSE", "FACING", "HOLDS_RH", "HOLDS_LH")


def _by_edges(before: World, after: World, name: str) -> set[int]:
    """The ends of the edges of a relation that came or went, or the nodes whose state differs."""
    if name in STATES:
        old, new = ({n.id for n in world.graph().nodes if name in n.states} for world in (before, after))
        return old ^ new
    old, new = ({(e.source, e.target) for e in world.edges() if e.relation == name} for world in (before, after))
    return {node for edge in old ^ new for node in edge}


def _remains(before: World, after: World) -> bool:
    """Return whether all is equal but what characters are close to and face."""
    people = {before.home.ids[agent.index] for agent in before.agents}
    one, other = (
        {tuple(e) for e in world.edges() if e.relation not in BY_PLACE or not {e.source, e.target} & people}
        for world in (before, after)
    )
    states = [sorted((n.id, n.states) for n in world.graph().nodes) for world in (before, after)]
    return one == other and states[0] == states[1]


def test_everything_that_a_step_touches_is_in_it():
    equal, different = 0, 0
    for seed in range(120):
        chooser = random.Random(seed)
        graph = random_graph(chooser, characters=1 + seed % 2)
        world = World.start(Home.from_graph(graph, "", default()))
        for _ in range(25):
            after = act(world, random_step(chooser, graph))
            if not isinstance(after, World):
                continue
            for name in (*RELATIONS, *STATES):
                maybe = {world.home.ids[i] for i in indices(changed(name, world, after))}
                assert _by_edges(world, after, name) <= maybe, name
            if unchanged(world, after):
                assert _remains(world, after)
            equal, different = equal + _remains(world, after), different + (not _remains(world, after))
            world = after
    assert equal > 20 < different


def test_a_stride_changes_nothing_else(maple):
    world, strides = placed(World.start(maple)), 0
    for _ in range(12):
        turned = act(world, Step("Turnleft"))
        assert isinstance(turned, World) and turned is not world and unchanged(world, turned)
        after = act(turned, Step("Walkforward"))
        if isinstance(after, World) and after.agents[0].inside == turned.agents[0].inside:
            assert unchanged(turned, after)
            strides += 1
        world = turned
    assert strides
