"""A character that gets up leaves the seat: it is free then, and nobody else takes it while it is in use."""

import random

import pytest
from oracles import engine as reference
from oracles.facts import Facts
from oracles.formulas import changes, first_failure
from oracles.world import Options
from oracles.world import World as PlainWorld
from small_worlds import bound_step, node
from walks import id_of, step

from hearth.kb.loading.load import default
from hearth.repair.handlers.registry import HANDLERS
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge, EnvironmentGraph
from hearth.schemas.literals import Literal
from hearth.simulation.actions.legal import legal
from hearth.simulation.engine import act
from hearth.simulation.env import with_agents
from hearth.simulation.literal_truth import holds
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.motion.positions import placed
from hearth.simulation.rules import DEFAULT, REPLAY, RULES, read
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

KNOWN = default()
ME, CHAIR, STOOL, BED, RUG = 2, 3, 4, 5, 6
NODES = (
    node(1, "bedroom"),
    node(ME, "character"),
    node(CHAIR, "chair", properties=("SITTABLE", "GRABBABLE")),
    node(STOOL, "chair", properties=("SITTABLE", "GRABBABLE")),
    node(BED, "bed", properties=("LIEABLE", "SITTABLE", "GRABBABLE")),  # a mattress that can be taken
    node(RUG, "table", properties=("SURFACES",)),
)
BY_ID = {each.id: each for each in NODES}


def start(*more: Edge) -> World:
    edges = [Edge(i, "INSIDE", 1) for i in BY_ID if i != 1]
    return World.start(Home.from_graph(EnvironmentGraph(NODES, (*edges, *more)), "", KNOWN))


def done(world, *steps, rules=DEFAULT):
    """The world after steps, or the first failure."""
    for action, *ids in steps:
        world = act(world, bound_step(action, [BY_ID[i] for i in ids]), rules)
        if isinstance(world, Failure):
            break
    return world


def on(world):
    return {edge.target for edge in world.edges() if edge.source == ME and edge.relation == "ON"}


def test_who_stands_up_is_on_no_seat_and_the_seat_is_free():
    up = done(start(), ("Walk", CHAIR), ("Sit", CHAIR), ("StandUp",))
    assert on(up) == set() and holds(Literal.of("free", CHAIR), up)
    assert not isinstance(done(up, ("Sit", CHAIR)), Failure)


def test_who_changes_from_a_bed_to_a_chair_is_on_the_chair_alone():
    both = done(start(), ("Walk", BED), ("Find", CHAIR), ("Find", BED), ("Lie", BED))
    assert on(both) == {BED}
    world = done(start(Edge(ME, "CLOSE", CHAIR), Edge(ME, "CLOSE", BED)), ("Lie", BED), ("Sit", CHAIR))
    assert on(world) == {CHAIR} and world.has_state(ME, "SITTING") and not world.has_state(ME, "LYING")
    assert on(done(world, ("Lie", BED))) == {BED}


def test_what_is_no_seat_stays_under_ones_feet():
    world = done(start(Edge(ME, "ON", RUG)), ("Walk", CHAIR), ("Sit", CHAIR), ("StandUp",))
    assert on(world) == {RUG}


def test_in_the_release_one_stays_on_every_seat():
    steps = (("Walk", CHAIR), ("Sit", CHAIR), ("StandUp",), ("Walk", STOOL), ("Sit", STOOL), ("StandUp",))
    assert on(done(start(), *steps, rules=REPLAY)) == {CHAIR, STOOL}
    assert done(start(), *steps[:3], ("Sit", CHAIR), rules=REPLAY).code is Code.OCCUPIED
    assert on(done(start(), *steps)) == set()


@pytest.mark.parametrize(
    ("action", "seat", "code"), [("Sit", CHAIR, "SITTING"), ("Sit", BED, "SITTING"), ("Lie", BED, "LYING")]
)
def test_nobody_takes_the_seat_that_they_rest_on(action, seat, code):
    world = done(start(), ("Walk", seat), (action, seat))
    refused = done(world, ("Grab", seat))
    assert refused.code == code and refused.objects == (seat,) and Code(code) in HANDLERS
    assert bound_step("Grab", [BY_ID[seat]]) not in legal(world)
    taken = done(world, ("StandUp",), ("Grab", seat), ("Walk", RUG))
    assert not isinstance(taken, Failure) and taken.holding() == {0: (seat,)}
    assert not isinstance(done(world, ("Grab", seat), rules=REPLAY), Failure)


def test_nobody_takes_the_seat_of_another():
    world = with_agents(done(start(), ("Walk", CHAIR), ("Sit", CHAIR)), 2)
    grab = bound_step("Grab", [BY_ID[CHAIR]], agent=1)
    world = act(world, bound_step("Walk", [BY_ID[CHAIR]], agent=1))
    refused = act(world, grab)
    assert refused.code is Code.OCCUPIED and refused.objects == (CHAIR, ME) and grab not in legal(world, 1)
    stands = act(world, bound_step("StandUp", []))
    assert grab in legal(stands, 1) and isinstance(act(stands, grab), World)


def test_getting_up_is_beside_the_seat_in_use_and_not_one_sat_on_before(maple):
    here = placed(World.start(maple))
    couch, chair = id_of(maple, "couch"), id_of(maple, "chair")
    for first, second in ((couch, chair), (chair, couch)):
        world = here
        for each in (("Walk", first), ("Sit", first), ("StandUp",), ("Walk", second), ("Sit", second)):
            world = act(world, step(*each), DEFAULT)
        sat = world.agents[0]
        up = act(world, step("StandUp"), DEFAULT).agents[0]
        box = maple.node(maple.index[second]).box
        reach = max(box.size[0], box.size[2]) / 2 + 1.0
        assert abs(up.pose.x - sat.pose.x) < reach and abs(up.pose.z - sat.pose.z) < reach and up.inside == sat.inside
        ways = ground_of(maple).ground.ways
        assert ways.main[ways.at(*up.pose.point)]


def test_engine_mask_plain_engine_and_literals_agree_on_random_steps_about_seats():
    compared = 0
    for seed in range(300):
        rng = random.Random(seed)
        more = [Edge(ME, "CLOSE", seat) for seat in (CHAIR, STOOL, BED) if rng.random() < 0.7]
        graph = EnvironmentGraph(NODES, (*(Edge(i, "INSIDE", 1) for i in BY_ID if i != 1), *more))
        rules = rng.choice([DEFAULT, RULES["near_hands"]])
        world, plain = World.start(Home.from_graph(graph, "", KNOWN)), PlainWorld(graph)
        named = frozenset(name for name, value in rules._asdict().items() if value is True)
        for _ in range(12):
            action = rng.choice(["Sit", "Sit", "Lie", "StandUp", "StandUp", "Grab", "Drop", "Walk"])
            objects = [] if action == "StandUp" else [BY_ID[rng.choice([CHAIR, STOOL, BED])]]
            instruction = bound_step(action, objects)
            facts, entry = Facts.of(world.graph()), KNOWN.actions[action]
            binding = {"a": ME, **dict(zip("o", (each.id for each in objects), strict=False))}
            failed = first_failure(KNOWN, facts, entry, binding, named)
            result = act(world, instruction, rules)
            code = result.code if isinstance(result, Failure) else None
            assert code == reference.step(plain, instruction, Options(leaves_seat=rules.leaves_seat))
            assert code == (failed and failed.code), (seed, instruction)
            assert (instruction in legal(world, 0, rules)) is (code is None)
            if isinstance(result, World):
                world = result
                after = facts.after(changes(KNOWN, facts, entry, binding, named))
                edges = {tuple(e) for e in world.edges()}
                assert edges == plain.edges(), (seed, instruction)
                assert edges == after.edges() or action == "Grab"  # literals remember any place that there is
                compared += 1
    assert compared > 1000


def test_datasets_and_episodes_from_before_stay_as_they_were():
    found = {name.removesuffix("_watching_off") for name, rules in RULES.items() if rules.leaves_seat}
    assert found == {"leaves_seat", "consequences"}
    assert not read({"near_hands": True}).leaves_seat
