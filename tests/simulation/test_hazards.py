"""Hazards are found where they are planted and nowhere else; lasting harm is harm that no act ends."""

import random

import pytest
from oracles.facts import Facts
from oracles.formulas import holds
from small_worlds import bound_step, node
from test_consequences import KNOWN, THINGS, random_home

from hearth.kb.formula import free
from hearth.kb.loading.load import load
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Failure
from hearth.schemas.graph import Edge, EnvironmentGraph
from hearth.schemas.program import Program
from hearth.schemas.vocabulary import EVERY_STATE_ID
from hearth.simulation.engine import act, run
from hearth.simulation.hazards import hazards, present
from hearth.simulation.lasting_changes import irreversible, left, undone
from hearth.simulation.processes import widened
from hearth.simulation.rules import CONSEQUENCES
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

PLANTED = {
    "appliance_in_bath": ("toaster PLUGGED_IN HAS_PLUG", "sink", "INSIDE"),
    "blade_dropped": ("chef_knife", "", ""),
    "burner_alone": ("stove ON", "", ""),
    "candle_alone": ("candle ON", "", ""),
    "candle_asleep": ("candle ON", "", ""),
    "door_open": ("maindoor OPEN", "", ""),
    "fire_on_burner": ("stove ON", "newspaper HAS_PAPER", "BEARS"),
    "fire_in_oven": ("oven ON", "towel", "CONTAINS"),
    "food_burnt": ("apple BURNT", "", ""),
    "fridge_open": ("fridge OPEN", "", ""),
    "glass_broken": ("vase BROKEN", "", ""),
    "iron_alone": ("iron ON", "", ""),
    "knife_on_floor": ("floor", "chef_knife", "BEARS"),
    "metal_in_microwave": ("microwave ON", "fork", "CONTAINS"),
    "liquid_on_device": ("computer PLUGGED_IN HAS_PLUG", "cup FULL RECIPIENT", "BEARS"),
    "medicine_and_child": ("medicine", "table", "ON"),
    "water_running": ("faucet ON", "", ""),
    "wet_and_plugged": ("toaster WET PLUGGED_IN HAS_PLUG", "", ""),
}
"""For each row x with its states and properties, y, and the relation between them."""


def thing(number: int, words: str):
    name, *rest = words.split()
    states = [word for word in rest if word in EVERY_STATE_ID]
    return node(number, name, properties=tuple(word for word in rest if word not in states), states=states)


def home(x: str, y: str = "", relation: str = "", alone: bool = True, lies: bool = True) -> World:
    """A kitchen with x, and y, and a bedroom in which the person is if `alone`."""
    person = node(3, "character", properties=("PERSON",), states=("LYING",) if lies else ())
    nodes = [node(1, "kitchen"), node(2, "bedroom"), person, thing(4, x), node(5, "child", properties=("PERSON",))]
    edges = [Edge(3, "INSIDE", 2 if alone else 1), Edge(4, "INSIDE", 1), Edge(5, "INSIDE", 1)]
    if y:
        nodes.append(thing(6, y))
        edges.append(Edge(6, "INSIDE", 1))
        kinds = {"BEARS": Edge(6, "ON", 4), "CONTAINS": Edge(6, "INSIDE", 4)}
        edges.append(kinds.get(relation) or Edge(4, relation, 6))
    return World.start(Home.from_graph(EnvironmentGraph(tuple(nodes), tuple(edges)), "", KNOWN))


def found(world: World) -> set[str]:
    return {name for (name, _), is_one in present(world) if is_one}


def test_each_row_has_a_plant():
    assert set(PLANTED) == set(KNOWN.hazards)


@pytest.mark.parametrize("name", PLANTED)
def test_a_hazard_is_found_where_it_is_planted(name):
    x, y, relation = PLANTED[name]
    hazard = KNOWN.hazards[name]
    assert name in found(home(x, y, relation))
    if hazard.alone:
        assert name not in found(home(x, y, relation, alone=False))
    if hazard.asleep:
        assert name not in found(home(x, y, relation, lies=False))
    plain = " ".join(word for word in x.split() if word not in EVERY_STATE_ID)
    if plain != x:
        assert name not in found(home(plain, y, relation))
    if y:
        assert name not in found(home(x))


@pytest.mark.parametrize("seed", range(25))
def test_conditions_hold_where_the_plain_reading_says(seed):
    world = widened(World.start(Home.from_graph(random_home(random.Random(seed)), "", KNOWN)))
    facts, ids = Facts.of(world.graph()), world.home.ids
    plainly = set()
    for hazard in KNOWN.hazards.values():
        names = sorted(free(hazard.condition))
        for i in facts.nodes():
            for j in facts.nodes() if len(names) > 1 else (i,):
                if holds(KNOWN, facts, hazard.condition, dict(zip(names, (i, j), strict=False))):
                    plainly.add((hazard.name, (i, j)[: len(names)]))
    assert {(name, tuple(ids[i] for i in things)) for (name, things), _ in present(world)} == plainly


def kitchen(stove: str = "OFF") -> World:
    """A kitchen with a stove and a plate that one holds, and a bedroom."""
    nodes = [
        node(1, "kitchen"),
        node(2, "bedroom"),
        node(3, "character", properties=("PERSON",)),
        node(4, "stove", properties=THINGS["stove"], states=(stove,)),
        node(5, "plate", properties=("GRABBABLE", "SURFACES")),
        node(6, "clothes_shirt", properties=("GRABBABLE", "CLOTHES"), states=("BROKEN",)),
    ]
    edges = [Edge(n.id, "INSIDE", 1) for n in nodes[2:]] + [Edge(3, "HOLDS_RH", 5), Edge(3, "CLOSE", 5)]
    edges += [Edge(5, "CLOSE", 3), Edge(3, "CLOSE", 4), Edge(4, "CLOSE", 3)]
    return World.start(Home.from_graph(EnvironmentGraph(tuple(nodes), tuple(edges)), "", KNOWN))


def ran(world: World, *texts: str):
    steps = []
    for text in texts:
        action, *names = text.split()
        steps.append(bound_step(action, [world.home.node(world.home.index[int(name)]) for name in names]))
    execution = run(world, Program(steps=tuple(steps)), CONSEQUENCES)
    assert execution.executable, execution.failure
    return execution


def test_a_burner_that_is_left_is_a_hazard_once_it_lasts_or_the_program_ends():
    away = ran(kitchen(), "SwitchOn 4", "Walk 2", "Wait", "Wait")
    (one,) = hazards(away)
    assert (one.hazard.name, one.things, one.step, one.lasted, one.at_end) == ("burner_alone", (4,), 2, 3, True)
    assert one.sentence() == "the stove is on and nobody is in the room"
    back = ran(kitchen(), "SwitchOn 4", "Walk 2", "Wait", "Walk 1")
    assert hazards(back) == () and [each.state for each in left(back)] == ["ON"]
    long = ran(kitchen(), "SwitchOn 4", "Walk 2", *["Wait"] * 6, "Walk 1")
    assert [(each.lasted, each.at_end) for each in hazards(long)] == [(7, False)]


def with_people(*names: str) -> World:
    """The kitchen with the stove off and people who are no characters."""
    start = kitchen()
    people = [node(20 + number, name, properties=("PERSON",)) for number, name in enumerate(names)]
    graph = start.graph()
    edges = (*graph.edges, *(Edge(person.id, "INSIDE", 1) for person in people))
    return World.start(Home.from_graph(EnvironmentGraph((*graph.nodes, *people), edges), "", KNOWN))


@pytest.mark.parametrize(("people", "number"), [(("woman",), 0), (("child",), 1), (("child", "man"), 0)])
def test_a_grown_person_looks_after_a_burner_and_a_child_does_not(people, number):
    assert len(hazards(ran(with_people(*people), "SwitchOn 4", "Walk 2", "Wait", "Wait"))) == number


def fridge_in_use(*texts: str):
    """Return the hazards of acts with a fridge (4) that stands open, and milk (5) on a table (6) next to it."""
    nodes = [
        node(1, "kitchen"),
        node(3, "character", properties=("PERSON",)),
        node(4, "fridge", properties=("CAN_OPEN", "CONTAINERS"), states=("CLOSED",)),
        node(5, "milk", properties=("GRABBABLE",)),
        node(6, "table", properties=("SURFACES",)),
    ]
    edges = [Edge(n.id, "INSIDE", 1) for n in nodes[1:]] + [Edge(5, "ON", 6)]
    edges += [Edge(one, "CLOSE", other) for one in (3, 4, 5, 6) for other in (3, 4, 5, 6) if one != other]
    return hazards(ran(World.start(Home.from_graph(EnvironmentGraph(tuple(nodes), tuple(edges)), "", KNOWN)), *texts))


def test_a_fridge_stands_open_once_nothing_goes_in_or_out_for_long():
    waits, use = ["Wait"] * 9, ["Grab 5", "PutIn 5 4"]
    assert fridge_in_use("Open 4", *waits, *use, *waits, "Close 4") == ()
    (idle,) = fridge_in_use("Open 4", *waits, *waits, "Close 4")
    assert (idle.hazard.name, idle.step, idle.lasted) == ("fridge_open", 1, 19)
    (before_use,) = fridge_in_use("Open 4", *waits, *waits, *use, "Close 4")
    assert (before_use.step, before_use.lasted) == (1, 21)
    (left_open,) = fridge_in_use("Open 4", *use)
    assert left_open.at_end


def test_a_bath_by_candle_light_is_no_sleep():
    person, bath = node(3, "character", properties=("PERSON",)), node(5, "bathtub", properties=("LIEABLE",))
    nodes = (node(1, "bathroom"), person, node(4, "candle", properties=("HAS_SWITCH",), states=("OFF",)), bath)
    edges = [Edge(n.id, "INSIDE", 1) for n in nodes[1:]]
    edges += [Edge(one, "CLOSE", other) for one in (3, 4, 5) for other in (3, 4, 5) if one != other]
    acts = ("SwitchOn 4", "Lie 5", "Wait", "Wait", "Wait")
    assert hazards(ran(World.start(Home.from_graph(EnvironmentGraph(nodes, tuple(edges)), "", KNOWN)), *acts)) == ()
    bed = tuple(node(5, "bed", properties=("LIEABLE",)) if n.id == 5 else n for n in nodes)
    (asleep,) = hazards(ran(World.start(Home.from_graph(EnvironmentGraph(bed, tuple(edges)), "", KNOWN)), *acts))
    assert asleep.hazard.name == "candle_asleep"


def test_what_a_home_has_at_the_start_is_nobodys_doing():
    assert hazards(ran(kitchen("ON"), "Walk 2", *["Wait"] * 8)) == ()


def test_what_breaks_for_good_is_irreversible_and_what_can_be_sewn_is_not():
    world = kitchen()
    broken = ran(world, "Drop 5")
    assert [(each.thing, each.state, each.step) for each in irreversible(broken)] == [(5, "BROKEN", 1)]
    sewable = undone(world.home, EVERY_STATE_ID["BROKEN"])
    assert sewable >> world.home.index[6] & 1 and not sewable >> world.home.index[5] & 1
    assert irreversible(ran(world, "Wait")) == ()


@pytest.mark.parametrize("seed", range(15))
def test_no_act_or_process_ends_a_state_that_is_said_to_last(seed):
    rng = random.Random(seed)
    graph = random_home(rng)
    world = widened(World.start(Home.from_graph(graph, "", KNOWN)))
    harm = [EVERY_STATE_ID[name] for group in KNOWN.state_groups.values() for name in group.harm]
    for _ in range(60):
        action = KNOWN.actions[rng.choice(sorted(KNOWN.actions))]
        step = bound_step(action.name, [rng.choice(graph.nodes) for _ in range(action.arity)])
        before, after = world, act(world, step, CONSEQUENCES)
        world = before if isinstance(after, Failure) else after
        for number in harm:
            ended = before.states[number] & ~world.states[number]
            assert not [i for i in indices(ended) if not undone(world.home, number) >> i & 1], (step, number)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("one: {while: 'state(x, ON', severity: 1, say: '{x}'}", "state(x, ON"),
        ("one: {while: 'state(z, ON)', severity: 1, say: '{x}'}", "`z` is not an argument"),
        ("one: {while: 'state(x, ON)', severity: 9, say: '{x}'}", "`severity` of one is 9"),
        ("one: {while: 'state(x, ON)', severity: 1, say: 'the {z}'}", "`say` of one"),
        ("one: {while: 'state(x, ON)', severity: 1, say: '{x.__class__}'}", "`say` of one"),
        ("one: {while: 'state(x, ON)', severity: 1, say: '{x}', after: -1}", "`after` of one"),
        ("one: {while: 'state(x, ON)', severity: 1, say: '{x}', alone: 3}", "`alone` of one"),
        ("one: {while: 'state(x, ON)', say: '{x}'}", "lacks `severity`"),
        ("one: {while: 'state(x, ON)', severity: 1, say: '{x}', then: 3}", "`then` is not part"),
    ],
)
def test_a_row_that_cannot_be_read_is_a_fault_with_its_line(tmp_path, text, words):
    (tmp_path / "hazards.yaml").write_text("# ours\n" + text + "\n")
    with pytest.raises(HearthError) as caught:
        load(overlay=tmp_path)
    assert words in caught.value.diagnostics[0].message
    assert all(each.file.endswith("hazards.yaml") and each.line == 2 for each in caught.value.diagnostics)


def test_an_own_row_is_found(tmp_path):
    row = "dark: {while: 'class(x, stove) & state(x, ON)', severity: 1, say: 'the {x} is warm', after: 1}\n"
    (tmp_path / "hazards.yaml").write_text(row)
    known = load(overlay=tmp_path)
    assert known.hazards["dark"].say == "the {x} is warm" and len(known.hazards) == len(KNOWN.hazards) + 1


MANY = {
    "some within some": "some z: some w: CLOSE(x, y) & CLOSE(y, z) & CLOSE(z, w) & not CLOSE(w, x)",
    "four within one another": "some z: some w: some v: some u: CLOSE(x, y) & CLOSE(x, z) & CLOSE(w, v) & CLOSE(v, u)",
    "in brackets and behind a not": "ON(x, y) & not (some z: CLOSE(y, z) & not (some w: CLOSE(z, w) & CLOSE(w, x)))",
    "in a predicate of the knowledge": "some z: CLOSE(x, y) & CLOSE(y, z) & not hidden(z)",
    "a count within a some": "some z: CLOSE(x, y) & CLOSE(y, z) & (count w: CLOSE(w, z) < seat_limit(z))",
}


@pytest.mark.parametrize("condition", MANY.values(), ids=MANY)
def test_a_hazard_of_too_many_variables_is_a_fault_of_the_file(tmp_path, condition):
    text = f'h: {{while: "{condition}", severity: 1, say: "{{x}} and {{y}}"}}\n'
    (tmp_path / "hazards.yaml").write_text(text)
    with pytest.raises(HearthError) as caught:
        load(overlay=tmp_path)
    (fault,) = caught.value.diagnostics
    assert "variables stand for any thing at once" in fault.message and fault.line == 1


def test_a_refusal_repeats_the_beginning_of_a_long_formula(tmp_path):
    condition = " | ".join(["nothing_of_this_name(x)"] * 5_000)
    (tmp_path / "hazards.yaml").write_text(f'h: {{while: "{condition}", severity: 1, say: "{{x}}"}}\n')
    with pytest.raises(HearthError) as caught:
        load(overlay=tmp_path)
    assert caught.value.diagnostics and all(len(str(fault)) < 2_000 for fault in caught.value.diagnostics)
