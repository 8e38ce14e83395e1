"""Sampled environments hold what they promise, and depend on nothing but seed, program and home."""

import zipfile
from functools import partial

import orjson
import pytest

from hearth.grounding.environments.default_state import prepared
from hearth.grounding.environments.sampling import Size, sample
from hearth.grounding.environments.sampling_for_several_characters import sample_together
from hearth.grounding.environments.soundness import unsound
from hearth.grounding.preconditions.condition_checks import unmet
from hearth.grounding.preconditions.conditions import Condition, Preconditions
from hearth.grounding.preconditions.precondition_inference import infer
from hearth.homes import library
from hearth.homes.lint import lint
from hearth.kb import action_grammar
from hearth.kb.loading.load import default, load
from hearth.schemas.failure_words import why
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge, EnvironmentGraph, Node, from_release
from hearth.schemas.literals import Literal
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.syntax import parse_program
from hearth.schemas.vocabulary import FIRST_ADDED_ID
from hearth.simulation.engine import run
from hearth.simulation.literal_truth import holds
from hearth.simulation.world.edit import extended
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

BREAKFAST = """Breakfast
Milk from the fridge.


[Walk] <kitchen> (1)
[Walk] <fridge> (1)
[Open] <fridge> (1)
[Find] <milk> (1)
[Grab] <milk> (1)
[Close] <fridge> (1)
[Walk] <table> (1)
[Sit] <chair> (1)
[Drink] <milk> (1)
[PutBack] <milk> (1) <table> (1)
"""


def read(text, knowledge):
    program, faults = parse_program(text)
    program, wrong = action_grammar.check(program, knowledge)
    assert not faults and not wrong
    return program


def nodes_of(environment):
    return {ref.key: ref.node for ref in environment.program.objects()}


@pytest.fixture
def breakfast(knowledge):
    return read(BREAKFAST, knowledge)


def test_what_is_sampled_holds_and_runs(breakfast, maple):
    environment, execution = sample(breakfast, maple, 0)
    assert execution.executable
    assert not unmet(environment.conditions, environment.world, nodes_of(environment))
    milk = environment.program.steps[3].objects[0].node
    fridge = environment.program.steps[1].objects[0].node
    assert Literal.of("inside", ("milk", 1), ("fridge", 1)) in {c.literal for c in environment.conditions}
    assert any(edge[:3] == (milk, "INSIDE", fridge) for edge in environment.world.edges())


def test_the_check_can_fail(breakfast, maple, knowledge):
    base = prepared(maple)
    nodes = {
        ref.key: base.home.ids[base.instances(ref.name)[0]] for ref in breakfast.objects() if base.instances(ref.name)
    }
    assert unmet(infer(breakfast, knowledge), base.start, nodes)


def test_equal_seeds_give_equal_environments_and_others_differ(breakfast, maple):
    first, again, other = (sample(breakfast, maple, seed)[0] for seed in (7, 7, 8))
    assert (first.nodes, first.added, first.removed, first.states) == (
        again.nodes,
        again.added,
        again.removed,
        again.states,
    )
    assert (first.nodes, first.added) != (other.nodes, other.added)


def test_the_difference_from_the_base_rebuilds_the_environment(breakfast, maple):
    environment, _ = sample(breakfast, maple, 3)
    edges = {tuple(edge) for edge in World.start(environment.base).edges()} - {tuple(e) for e in environment.removed}
    close = {(b, r, a) for a, r, b in environment.added if r == "CLOSE"}
    gone = {(b, r, a) for a, r, b in environment.removed if r == "CLOSE"}
    assert (edges - gone) | {tuple(e) for e in environment.added} | close == {
        tuple(edge) for edge in environment.world.edges()
    }


def test_a_release_sized_environment_has_280_to_300_nodes(breakfast, knowledge, real_data):
    data = orjson.loads((real_data / "homes/TrimmedTestScene2_graph.json").read_bytes())
    home = Home.from_release(data, "home2", knowledge)
    for seed in range(5):
        environment, _ = sample(breakfast, home, seed, size=Size(280, 300))
        assert 270 <= len(environment.world.home) <= 310


def test_the_character_starts_in_another_room(breakfast, maple):
    for seed in range(5):
        environment, _ = sample(breakfast, maple, seed)
        agent = environment.world.agents[0]
        kitchen = environment.world.home.index[nodes_of(environment)[("kitchen", 1)]]
        assert not agent.inside >> kitchen & 1


def test_the_release_sample_runs_in_every_home(real_data, knowledge, maple):
    """All but the one that watches a television before switching it on, which is said to contradict itself."""
    homes = [maple]
    for number in range(1, 8):
        data = orjson.loads((real_data / f"homes/TrimmedTestScene{number}_graph.json").read_bytes())
        homes.append(Home.from_release(data, f"home{number}", knowledge))
    refused, failed = [], []
    with zipfile.ZipFile(real_data / "activityprograms-sample.zip") as archive:
        names = [name for name in sorted(archive.namelist()) if "/withoutconds/" in name and name.endswith(".txt")]
        for number, name in enumerate(names):
            program = read(archive.read(name).decode(), knowledge)
            conditions = infer(program, knowledge)
            if isinstance(conditions, Failure):
                refused.append((name.rpartition("/")[2], conditions.code))
                continue
            home = homes[number % len(homes)]
            found = sample(program, home, 0, name, conditions)
            if isinstance(found, Failure):
                failed.append((name, home.name, found.message()))
            elif number % 10 == 0:
                environment, _ = found
                assert run(environment.world, environment.program).executable
    assert refused == []
    assert failed == []


def test_what_is_sampled_is_a_sound_graph(breakfast, maple):
    for seed in range(3):
        environment, _ = sample(breakfast, maple, seed)
        assert unsound(environment.world) is None
        assert lint(environment.world.graph(), default()) == ()


@pytest.mark.parametrize(
    ("edges", "states", "code", "named"),
    [
        ([("cup", "INSIDE", "bathroom")], {}, Code.BAD_GRAPH, ["cup"]),
        ([("cup", "INSIDE", "fridge"), ("cup", "INSIDE", "dishwasher")], {}, Code.BAD_GRAPH, ["cup"]),
        ([("fridge", "INSIDE", "fridge")], {}, Code.LOOP, ["fridge"]),
        (
            [("cup", "INSIDE", "fridge"), ("fridge", "INSIDE", "dishwasher"), ("dishwasher", "INSIDE", "cup")],
            {},
            Code.LOOP,
            None,
        ),
        ([("character", "HOLDS_RH", "cup"), ("character", "HOLDS_RH", "fridge")], {}, Code.CONFLICT, ["cup", "fridge"]),
        ([], {"fridge": ()}, Code.CONDITION_UNMET, ["fridge"]),
        ([("cup", "INSIDE", "fridge")], {"fridge": ("OPEN", "OFF")}, None, []),
    ],
)
def test_what_lint_would_say_of_a_changed_home_is_found(maple, edges, states, code, named):
    home = prepared(maple).home
    node = {
        name: home.ids[home.classes.index(name)] for name in ("cup", "fridge", "dishwasher", "bathroom", "character")
    }
    added = [Edge(node[a], relation, node[b]) for a, relation, b in edges]
    changed = extended(home, (), added, (), {node[name]: now for name, now in states.items()})
    fault = unsound(World.start(changed))
    assert (fault and fault.code) == code
    if named is not None:
        assert set(fault.objects if fault else ()) == {node[name] for name in named}
    assert bool(lint(World.start(changed).graph(), default())) == (code is not None)


def test_a_room_that_the_home_lacks_is_named(knowledge):
    nodes = [Node(1, "bedroom", "Rooms"), Node(2, "kitchen", "Rooms"), Node(3, "character", "Characters")]
    flat = Home(nodes, [Edge(3, "INSIDE", 1)], "flat", knowledge)
    bath = read("Bath\nIn it.\n\n\n[Walk] <bedroom> (1)\n[Walk] <bathroom> (1)\n", knowledge)
    failure = sample(bath, flat, 0)
    assert (failure.code, failure.tick, failure.names) == (Code.NO_ROOM, 1, ("bathroom",))
    assert "bathroom" in failure.expected and failure.actual == "flat has bedroom, kitchen"
    standing_in = read("Study\nThere.\n\n\n[Walk] <dining_room> (1)\n", knowledge)
    assert not isinstance(sample(standing_in, flat, 0), Failure)


@pytest.mark.parametrize("room", ["kitchen", "dining_room"])
def test_a_room_that_serves_as_another_does_for_conditions_too(knowledge, room):
    nodes = [Node(1, "bedroom", "Rooms"), Node(2, "dining_room", "Rooms"), Node(3, "character", "Characters")]
    flat = Home(nodes, [Edge(3, "INSIDE", 1)], "flat", knowledge)
    program = read("Cup\nIt.\n\n\n[Walk] <cup> (1)\n[Touch] <cup> (1)\n", knowledge)
    conditions = Preconditions((Condition(Literal("location", (("cup", 1), (room, 1)))),))
    environment, execution = sample(program, flat, 0, conditions=conditions)
    start = environment.world
    assert execution.executable and holds(Literal.of("INSIDE", "cup", "kitchen"), start)
    assert holds(Literal("location", (("cup", 1), ("kitchen", 1))), start, {("cup", 1): program_node(environment)})
    assert not holds(Literal.of("INSIDE", "cup", "bedroom"), start)


def program_node(environment):
    return environment.program.steps[0].objects[0].node


def test_what_does_not_hold_is_said_in_words(knowledge, maple):
    program = read("Milk\nIt.\n\n\n[Walk] <fridge> (1)\n[Open] <fridge> (1)\n[Find] <milk> (1)\n", knowledge)
    wanted = [("inside", ("milk", 1), ("fridge", 1)), ("in", ("milk", 1), ("fridge", 1)), ("in_closed_container",)]
    literals = [Literal(name, keys or (("milk", 1), ("fridge", 1))) for name, *keys in wanted]
    said = [Condition(literal._replace(terms=tuple(literal.terms)), 2).in_words() for literal in literals]
    assert said == ["milk (1) is inside fridge (1)", "milk (1) is on fridge (1)", "milk (1) is in something closed"]
    both = [Condition(Literal(name, (("fridge", 1),)), 1) for name in ("open", "closed")]
    failure = sample(program, maple, 0, conditions=Preconditions(tuple(both)))
    assert (failure.code, failure.tick, failure.action) == (Code.CONDITION_UNMET, 1, "Open")
    assert failure.expected == "fridge (1) is open, as step 2, [Open] <fridge> (1), needs"


def test_who_puts_back_takes_from_a_place(knowledge):
    """As the phone of a real home, which stands on nothing: putting it back would be a NO_ORIGIN."""
    nodes = [
        Node(1, "bedroom", "Rooms"), Node(2, "character", "Characters"),
        Node(4, "phone", "Electronics", ("GRABBABLE",)),
        Node(5, "desk", "Furniture", ("SURFACES",)),
    ]  # fmt: skip
    flat = Home(nodes, [Edge(2, "INSIDE", 1), Edge(4, "INSIDE", 1), Edge(5, "INSIDE", 1)], "flat", knowledge)
    program = read("Phone\nIt.\n\n\n[Find] <phone> (1)\n[Grab] <phone> (1)\n[PutObjBack] <phone> (1)\n", knowledge)
    for seed in range(5):
        environment, execution = sample(program, flat, seed)
        assert execution.executable and program_node(environment) != 4
    taken = read("Phone\nIt.\n\n\n[Find] <phone> (1)\n[Grab] <phone> (1)\n", knowledge)
    assert {program_node(sample(taken, flat, seed)[0]) for seed in range(5)} == {4}


@pytest.mark.parametrize("own", [(1000,), (1000, 1001, 2000), (2500,)])
def test_homes_whose_own_ids_reach_those_of_new_nodes(knowledge, maple, own):
    """As every home has to which something was added, and every graph of the release."""
    fridge = maple.by_class["fridge"].bit_length() - 1
    apples = [Node(node_id, "apple", "Food", ("EATABLE", "GRABBABLE"), ("CLEAN",)) for node_id in own]
    home = extended(maple, apples, [Edge(apple.id, "INSIDE", maple.ids[fridge]) for apple in apples])
    program = read("Laptop\nIt.\n\n\n[Walk] <cup> (1)\n[Walk] <laptop> (1)\n[Touch] <laptop> (1)\n", knowledge)
    environment, execution = sample(program, home, 0)
    assert execution.executable and len(set(environment.world.home.ids)) == len(environment.world.home.ids)
    assert environment.world.home.ids[-1] > max(2000, *own)
    assert set(own) <= set(environment.world.home.ids)


def test_a_program_of_the_release_in_its_own_graph(knowledge, real_data):
    with zipfile.ZipFile(real_data / "activityprograms-sample.zip") as archive:
        name = min(name for name in archive.namelist() if "/init_and_final_graphs/" in name and name.endswith(".json"))
        graph = from_release(orjson.loads(archive.read(name))["init_graph"])
        text = archive.read(name.replace("init_and_final_graphs", "executable_programs")[:-5] + ".txt").decode()
    home = Home.from_graph(graph, "own", knowledge)
    assert home.ids[-1] >= FIRST_ADDED_ID
    environment, execution = sample(read(text, knowledge).unbound(), home, 0)
    assert execution.executable and environment.world.home.ids[-1] > home.ids[-1]


def test_a_thing_that_belongs_nowhere_is_named(maple, tmp_path):
    (tmp_path / "objects_things.csv").write_text(
        "id,name,category,hypernym,properties,states,rooms,size,gloss,same_as,source\n"
        "9900,zither,Props,instrument,GRABBABLE,,,0.6 0.1 0.3,strings on a box,,ours\n"
    )
    known = load(overlay=tmp_path)
    home = Home.from_graph(library.load_graph("maple", default()), "maple", known)
    failure = sample(read("Zither\nFind it.\n\n\n[Walk] <zither> (1)\n", known), home, 0)
    assert (failure.code, failure.names) == (Code.NO_PLACE, ("zither",))
    assert "no place is usual for it" in why(failure)


@pytest.mark.parametrize("draw", [sample, partial(sample_together, agents=2)])
def test_a_home_without_rooms_is_a_failure(draw):
    nodes = (Node(3, "character", "Characters"), Node(4, "cup", "Props", ("GRABBABLE",)))
    home = Home.from_graph(EnvironmentGraph(nodes), "bare", default())
    walk = Program("Walk", "", (Step("Walk", (ObjectRef("cup", 1),)),))
    found = draw(walk, home, seed=0)
    assert isinstance(found, Failure)
    assert (found.code, found.actual) == (Code.NO_ROOM, "bare has none")


def test_what_nodes_alone_name_stays_apart_in_another_home(maple):
    refs = [ObjectRef("cup", 0, node) for node in (1, 2)]
    take = Program("Take", "", tuple(Step(name, (ref,)) for ref in refs for name in ("Walk", "Grab")))
    found = infer(take, default())
    assert isinstance(found, Preconditions)
    for conditions in (None, found):
        environment, execution = sample(take, maple, 0, "apart", conditions)
        assert execution.executable
        assert len({ref.node for ref in environment.program.objects()}) == 2


@pytest.mark.parametrize("name", ["milk", "juice", "wine", "beer"])
def test_a_carton_or_a_bottle_stands_in_no_glass(maple, knowledge, name):
    base = prepared(maple)
    spots = [(maple.classes[place], relation) for _, place, relation in base.spots(name).choices]
    assert spots
    assert not [place for place, _ in spots if "drinkware" in knowledge.ancestors(place)]


def test_what_is_poured_stands_in_a_cup(maple):
    spots = {maple.classes[place] for _, place, _ in prepared(maple).spots("coffee").choices}
    assert spots & {"cup", "mug"}
