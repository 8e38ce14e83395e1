from __future__ import annotations

import gc
import weakref
from dataclasses import replace

import pytest
from small_worlds import bound_step, node

from hearth.grounding.environments.default_state import prepared
from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge, EnvironmentGraph
from hearth.schemas.program import Program
from hearth.simulation.engine import act, run, tick
from hearth.simulation.env import Env, with_agents
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

KITCHEN, BEDROOM, A, FRIDGE, CUP, TABLE, BED, JUICE, SHELF, DOOR = range(1, 11)
NODES = {
    n.id: n
    for n in (
        node(KITCHEN, "kitchen"),
        node(BEDROOM, "bedroom"),
        node(A, "character"),
        node(FRIDGE, "fridge", states=["CLOSED", "OFF"]),
        node(CUP, "cup", states=["CLEAN"]),
        node(TABLE, "table"),
        node(BED, "bed"),
        node(JUICE, "apple"),
        node(SHELF, "plate"),
        node(DOOR, "door", properties=["CAN_OPEN"], states=["OPEN"]),
    )
}
EDGES = (
    Edge(A, "INSIDE", KITCHEN), Edge(FRIDGE, "INSIDE", KITCHEN), Edge(CUP, "INSIDE", KITCHEN), Edge(CUP, "ON", TABLE),
    Edge(TABLE, "INSIDE", KITCHEN), Edge(BED, "INSIDE", BEDROOM), Edge(SHELF, "INSIDE", FRIDGE),
    Edge(JUICE, "ON", SHELF), Edge(JUICE, "INSIDE", KITCHEN), Edge(DOOR, "BETWEEN", KITCHEN),
    Edge(DOOR, "BETWEEN", BEDROOM), Edge(SHELF, "INSIDE", KITCHEN),
)  # fmt: skip
GRAPH = EnvironmentGraph(tuple(NODES.values()), EDGES)
B = 11
"""The second character, which `with_agents` adds."""


def do(action: str, *ids: int, agent: int = 0):
    return bound_step(action, [NODES.get(i) or node(i, "character") for i in ids], agent)


def both_in_the_kitchen(*before) -> World:
    """Two characters there, after some steps."""
    world = with_agents(World.start(Home.from_graph(GRAPH, "", default())), 2)
    for step in (do("Walk", KITCHEN, agent=1), *before):
        world = act(world, step)
        assert isinstance(world, World), (step, world)
    return world


def codes(failures) -> dict[int, Code]:
    return {number: failure.code for number, failure in failures.items()}


def test_of_two_who_grab_one_cup_the_lower_number_gets_it():
    world = both_in_the_kitchen(do("Walk", CUP), do("Walk", CUP, agent=1))
    after, failures = tick(world, {0: do("Grab", CUP), 1: do("Grab", CUP, agent=1)})
    assert after.holding() == {0: (CUP,), 1: ()}
    assert codes(failures) == {1: Code.CONFLICT}
    # An agent that has lost the cup's CLOSE edge with the grab gets that failure; either way the other caused it.
    assert failures[1].actual.endswith("after what the other did in this tick")
    program = Program(steps=(do("Grab", CUP), do("Grab", CUP, agent=1)))
    program = program.with_steps(
        [program.steps[0], program.steps[1].__class__("Grab", program.steps[1].objects, 1, True)]
    )
    execution = run(world, program)
    assert execution.failure is not None
    assert (execution.failure.code, execution.failure.agent, execution.failure.tick) == (Code.CONFLICT, 1, 0)
    assert execution.final is world


def test_instructions_of_one_tick_are_judged_by_its_beginning():
    world = both_in_the_kitchen(do("Walk", FRIDGE), do("Walk", FRIDGE, agent=1))
    after, failures = tick(world, {0: do("Open", FRIDGE), 1: do("Close", FRIDGE, agent=1)})
    assert after.has_state(FRIDGE, "OPEN")
    assert codes(failures) == {1: Code.IS_CLOSED}
    after, failures = tick(after, {0: do("Open", FRIDGE), 1: do("Close", FRIDGE, agent=1)})
    assert after.has_state(FRIDGE, "CLOSED")
    assert codes(failures) == {0: Code.IS_OPEN}
    after, failures = tick(after, {0: do("Open", FRIDGE), 1: do("Open", FRIDGE, agent=1)})
    assert after.has_state(FRIDGE, "OPEN")
    assert codes(failures) == {1: Code.CONFLICT}


def test_doing_nothing_is_an_instruction():
    world = both_in_the_kitchen()
    assert tick(world, {0: None, 1: None}) == (world, {})
    assert tick(world, {}) == (world, {})


def test_what_one_does_elsewhere_does_not_disturb_the_other():
    world = both_in_the_kitchen(do("Walk", CUP))
    after, failures = tick(world, {0: do("Grab", CUP), 1: do("Walk", BED, agent=1)})
    assert not failures
    assert after.holding() == {0: (CUP,), 1: ()}
    assert Edge(B, "INSIDE", BEDROOM) in after.edges()
    assert Edge(A, "INSIDE", KITCHEN) in after.edges()


def test_what_another_holds_cannot_be_grabbed():
    world = both_in_the_kitchen(do("Walk", CUP), do("Grab", CUP), do("Walk", A, agent=1), do("Find", CUP, agent=1))
    failure = act(world, do("Grab", CUP, agent=1))
    assert isinstance(failure, Failure)
    assert failure.code is Code.HELD_BY_OTHER
    assert failure.objects == (CUP, A)
    assert failure.actual == "held by char0"


def test_handing_over_needs_a_free_hand_at_the_other_end():
    world = both_in_the_kitchen(do("Walk", CUP), do("Grab", CUP), do("Walk", B))
    given = act(world, do("PutBack", CUP, B))
    assert given.holding() == {0: (), 1: (CUP,)}
    assert {Edge(B, "HOLDS_RH", CUP), Edge(B, "CLOSE", A), Edge(A, "CLOSE", B), Edge(CUP, "CLOSE", B)} <= set(
        given.edges()
    )
    assert Edge(CUP, "ON", B) not in given.edges()
    back = act(act(given, do("Walk", A, agent=1)), do("PutBack", CUP, A, agent=1))
    assert back.holding() == {0: (CUP,), 1: ()}
    full = both_in_the_kitchen(
        do("Walk", FRIDGE), do("Open", FRIDGE), do("Walk", JUICE), do("Grab", JUICE), do("Walk", SHELF),
        do("Grab", SHELF), do("Walk", CUP, agent=1), do("Grab", CUP, agent=1), do("Walk", A, agent=1),
    )  # fmt: skip
    failure = act(full, do("PutBack", CUP, A, agent=1))
    assert failure.code is Code.NO_FREE_HAND
    assert failure.objects[1:] == (SHELF, JUICE) or set(failure.objects[1:]) == {SHELF, JUICE}


def test_who_walks_to_another_arrives_where_that_one_has_gone():
    world = both_in_the_kitchen(do("Walk", CUP), do("Grab", CUP))
    after, failures = tick(world, {0: do("Walk", BED), 1: do("Walk", A, agent=1)})
    assert not failures
    edges = set(after.edges())
    assert {Edge(A, "INSIDE", BEDROOM), Edge(B, "INSIDE", BEDROOM), Edge(CUP, "INSIDE", BEDROOM)} <= edges
    assert {Edge(A, "CLOSE", B), Edge(B, "CLOSE", A)} <= edges
    alone = act(after, do("Walk", CUP))
    assert not any(e.relation == "CLOSE" and {e.source, e.target} == {A, B} for e in alone.edges())


def test_one_seat_two_sitters():
    nodes = (*GRAPH.nodes, node(20, "chair"))
    home = Home.from_graph(EnvironmentGraph(nodes, (*EDGES, Edge(20, "INSIDE", KITCHEN))), "", default())
    world = with_agents(World.start(home), 2)
    chair = node(20, "chair")
    for agent in (0, 1):
        world = act(world, bound_step("Walk", [chair], agent))
    after, failures = tick(world, {n: bound_step("Sit", [chair], n) for n in (0, 1)})
    assert codes(failures) == {1: Code.CONFLICT}
    assert after.has_state(A, "SITTING")
    assert "OCCUPIED" in failures[1].actual


def test_two_instructions_of_one_agent_in_one_tick_are_refused():
    world = both_in_the_kitchen()
    execution = run(world, Program(steps=(do("Walk", CUP), replace(do("Walk", BED), joins=True))))
    assert execution.failure is not None
    assert execution.failure.code is Code.CONFLICT
    assert execution.final is world


def test_reset_adds_the_agents_a_home_lacks_and_the_seed_decides_their_rooms():
    env = Env()
    views = env.reset(Home.from_graph(GRAPH, "", default()), agents=3, seed=4)
    assert sorted(views) == [0, 1, 2]
    rooms = [view.me.room for view in views.values()]
    assert rooms[0] == KITCHEN
    again = Env().reset(Home.from_graph(GRAPH, "", default()), agents=3, seed=4)
    assert [view.me.room for view in again.values()] == rooms
    other = {
        seed: Env().reset(Home.from_graph(GRAPH, "", default()), agents=3, seed=seed)[2].me.room for seed in range(8)
    }
    assert set(other.values()) == {KITCHEN, BEDROOM}
    with pytest.raises(HearthError, match="NO_ROOM"):
        Env().reset(Home.from_graph(EnvironmentGraph((NODES[CUP],)), "", default()), agents=1)
    with pytest.raises(HearthError, match="UNKNOWN_AGENT"):
        env.observe(3)


def test_an_episode_goes_on_from_a_world_in_mid_execution():
    world = both_in_the_kitchen(do("Walk", CUP), do("Grab", CUP))
    env = Env()
    env.reset(world, agents=3)
    assert env.world.holding() == {0: (CUP,), 1: (), 2: ()}
    assert not env.step({0: do("PutObjBack", CUP)}).failures


def test_an_agent_sees_its_room_but_not_what_is_shut_away():
    env = Env()
    env.reset(Home.from_graph(GRAPH, "", default()))
    seen = env.observe(0)
    assert seen.ids == (KITCHEN, BEDROOM, A, FRIDGE, CUP, TABLE, DOOR)
    assert not seen.sees(SHELF)
    assert not seen.sees(JUICE)
    assert not seen.sees(99)
    graph = seen.graph
    assert tuple(n.id for n in graph.nodes) == seen.ids
    assert set(graph.edges) == {e for e in env.world.edges() if e.source in seen.ids and e.target in seen.ids}
    env.step({0: do("Walk", FRIDGE)})
    env.step({0: do("Open", FRIDGE)})
    assert {SHELF, JUICE} <= set(env.observe(0).ids)
    env.step({0: do("Walk", CUP)})
    env.step({0: do("Grab", CUP)})
    env.step({0: do("Walk", BED)})
    assert env.observe(0).ids == (KITCHEN, BEDROOM, A, CUP, BED, DOOR)
    env.partial = False
    assert env.observe(0).ids == tuple(sorted(NODES))


def test_agents_see_how_the_others_stand_and_what_they_did():
    env = Env()
    env.reset(both_in_the_kitchen(do("Walk", CUP), do("Grab", CUP)))
    assert [p.last for p in env.observe(1).others] == [None]
    env.step({0: do("TurnTo", TABLE), 1: do("Grab", BED, agent=1)})
    (other,) = env.observe(1).others
    assert (other.agent, other.node, other.room, other.posture) == (0, A, KITCHEN, "standing")
    assert (other.holding, other.facing) == ((CUP,), (TABLE,))
    assert other.last.instruction == do("TurnTo", TABLE)
    (other,) = env.observe(0).others
    assert other.last.failure.code is Code.NOT_AFFORDED
    assert env.observe(1).me.last == other.last
    env.step({0: do("Walk", BED)})
    assert env.observe(1).others == ()
    assert env.observe(1).tick == 2
    env.step({0: do("Lie", BED)})
    me = env.observe(0).me
    assert (me.posture, me.on, me.room) == ("lying", (BED,), BEDROOM)


def test_a_step_says_what_changed_and_keeps_the_worlds():
    env = Env()
    env.reset(Home.from_graph(GRAPH, "", default()), agents=2)
    before, graph = env.world, env.world.graph()
    done = env.step({0: do("Walk", CUP), 1: do("Grab", CUP, agent=1)})
    assert codes(done.failures) == {1: Code.NOT_CLOSE}
    assert done.change == env.world.changes(before)
    assert done.world is env.world
    assert env.ticks == [done]
    assert before.graph() == graph
    env.restore(before)
    assert env.world is before
    assert env.ticks == []


def test_legal_follows_what_the_agent_sees_unless_told_otherwise():
    env = Env()
    env.reset(Home.from_graph(GRAPH, "", default()))
    assert do("Walk", BED).objects[0].node not in env.legal(0).objects("Walk")
    assert BED in env.legal(0, only_visible=False).objects("Walk")
    assert BEDROOM in env.legal(0).objects("Walk")
    assert SHELF in env.legal(0, only_visible=False).objects("Walk")
    assert SHELF not in env.legal(0, only_visible=False, only_reachable=True).objects("Walk")


def test_a_home_is_named_and_instructions_are_text():
    env = Env(knowledge=default())
    assert env.reset("maple")[0].me.posture == "standing"
    done = env.step("[WALK] <Fridge> (1)")
    assert (done.instructions[0].action, done.instructions[0].objects[0].name) == ("Walk", "fridge")
    node = done.instructions[0].objects[0].node
    assert not env.step({0: f"[Open] <fridge> (1.{node})"}).failures
    assert codes(env.step({0: "[Open] <fridge> (1)"}).failures) == {0: Code.IS_OPEN}
    env.reset("maple", agents=2)
    assert set(env.step("<char1> [Walk] <fridge> (1)").instructions) == {1}
    second = env.step("[Walk] <chair> (2)").instructions[0].objects[0].node
    assert second == env.world.home.ids[sorted(indices(env.world.home.instances("chair")))[1]]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("walk to the kitchen", "SYNTAX"),
        ("", "SYNTAX"),
        ("[Fly]", "UNKNOWN_ACTION"),
        ("[Walk] <kichen> (1)", "UNKNOWN_OBJECT"),
        ("[Walk]", "WRONG_ARITY"),
        ("[Walk] <fridge> (99)", "UNBOUND"),
        ("[Walk] <fridge> (1) | <char1> [Walk] <fridge> (1)", "SYNTAX"),
        (7, "SYNTAX"),
    ],
)
def test_a_text_that_is_not_an_instruction_is_refused(text, code):
    env = Env(knowledge=default())
    env.reset("maple")
    before = env.world
    with pytest.raises(HearthError, match=code):
        env.step({0: text})
    with pytest.raises(HearthError, match=code):
        env.step(text)
    assert env.world is before and env.ticks == []


def test_a_home_that_can_not_be_found_and_an_episode_that_has_not_begun_are_refused():
    for call in (lambda env: env.reset("mapel"), lambda env: env.step("[StandUp]"), lambda env: env.world):
        with pytest.raises(HearthError, match="UNKNOWN_HOME"):
            call(Env(knowledge=default()))
    for call in (lambda env: env.reset("maple"), lambda env: env.observe(), lambda env: env.legal()):
        with pytest.raises(HearthError, match="UNKNOWN_HOME"):
            call(Env())
    assert not hasattr(Env(), "worlds")


@pytest.mark.parametrize("work_out", [ground_of, prepared])
def test_a_home_that_nobody_uses_any_more_is_freed(work_out):
    home = Home.from_graph(library.load_graph("maple", default()), "maple", default())
    found = work_out(home)
    assert found is not None and work_out(home) is found
    kept = weakref.ref(home)
    del home, found
    gc.collect()
    assert kept() is None
