"""The rule `made_bed`: bedding on what one can lie on takes no room there; the release counts it."""

from __future__ import annotations

import random

import pytest
from oracles import engine as reference
from oracles.facts import Facts
from oracles.formulas import first_failure
from oracles.world import Options
from oracles.world import World as PlainWorld
from small_worlds import node

from hearth.datasets.export.pddl_problems import Task, problem
from hearth.homes import library
from hearth.kb.formula import parse_formula
from hearth.kb.loading.load import default
from hearth.kb.tools.pddl import options
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Failure
from hearth.schemas.graph import Edge, EnvironmentGraph
from hearth.schemas.literals import Literal
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.actions.legal import legal
from hearth.simulation.engine import act
from hearth.simulation.literal_truth import holds
from hearth.simulation.rules import DEFAULT, REPLAY, RULES, read
from hearth.simulation.step_explanations import checks
from hearth.simulation.world.affordance import of_kind
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

KNOWN = default()
ROOM, ME, BED = 1, 2, 3
BEDDING, OTHERS = ("pillow", "blanket", "comforter", "sheets"), ("cat", "book", "mattress", "towel", "cushion")
BEDS = {"bed": (4, 3), "couch": (4, 2), "bench": (2, 1), "bunk_bed": (1, 1)}
MADE = ("pillow", "pillow", "pillow", "blanket")
RULE_SETS = (DEFAULT, REPLAY, REPLAY._replace(made_bed=True))


def bedroom(things, seat="bed", posture=()):
    """A graph with the character close to a seat with these things on it."""
    properties = ("SURFACES", "SITTABLE") + (() if seat == "chair" else ("LIEABLE",))
    nodes = [node(ROOM, "bedroom"), node(ME, "character", "Characters", ("PERSON",), posture)]
    nodes += [node(BED, seat, "Furniture", properties)]
    nodes += [node(number, name, "Props", ("GRABBABLE",)) for number, name in enumerate(things, 4)]
    edges = [Edge(each.id, "INSIDE", ROOM) for each in nodes[1:]] + [Edge(each.id, "ON", BED) for each in nodes[3:]]
    return EnvironmentGraph(tuple(nodes), (*edges, Edge(ME, "CLOSE", BED), Edge(BED, "CLOSE", ME)))


def start(*given, **named):
    return World.start(Home.from_graph(bedroom(*given, **named), "", KNOWN))


def step(action, name="bed"):
    return Step(action, (ObjectRef(name, 1, BED),))


def code(result):
    return result.code if isinstance(result, Failure) else None


@pytest.mark.parametrize("action", ["Lie", "Sit"])
def test_a_made_bed_is_free_except_in_the_release(action):
    world = start(MADE)
    assert not isinstance(act(world, step(action), DEFAULT), Failure)
    refused = act(world, step(action), REPLAY)
    assert refused.code == "OCCUPIED" and refused.objects == (BED, 4, 5, 6, 7) and "besides" not in refused.expected


def test_other_things_take_room_and_only_they_are_named():
    refused = act(start((*MADE, "cat", "book", "towel")), step("Lie"), DEFAULT)
    assert refused.code == "OCCUPIED" and refused.names == ("bed", "cat", "book", "towel")
    assert refused.expected == "fewer than 3 on it besides bedding" and refused.actual == "3"
    assert act(start(("cat", "book", "towel")), step("Lie"), DEFAULT).expected == "fewer than 3 on it"


def test_a_pillow_takes_the_room_on_a_chair():
    assert act(start(("pillow",), seat="chair"), step("Sit", "chair"), DEFAULT).code == "OCCUPIED"


@pytest.mark.parametrize("seed", range(150))
def test_engine_mask_plain_engine_literals_and_conditions_agree(seed):
    rng = random.Random(seed)
    seat = rng.choice(tuple(BEDS))
    graph = bedroom(rng.choices(BEDDING + OTHERS, k=rng.randrange(7)), seat, rng.choice([(), ("SITTING",), ("LYING",)]))
    world = World.start(Home.from_graph(graph, "", KNOWN))
    for rules in RULE_SETS:
        for action in ("Sit", "Lie"):
            found = code(act(world, step(action, seat), rules))
            plain = PlainWorld(graph, rules.origin == "release")
            assert found == reference.step(
                plain, step(action, seat), Options(made_bed=rules.made_bed, near_hands=rules.near_hands)
            )
            on = frozenset(("made_bed",) if rules.made_bed else ())
            failed = first_failure(KNOWN, Facts.of(graph), KNOWN.actions[action], {"a": ME, "o": BED}, on)
            assert found == (failed and failed.code)
            assert (step(action, seat) in legal(world, 0, rules)) is (found is None)
    free = sum(name not in BEDDING for name in world.home.classes[3:]) < max(BEDS[seat])
    assert holds(Literal.of("free", seat), world) is free is not holds(Literal.of("occupied", seat), world)


def test_every_option_of_the_knowledge_is_a_rule():
    named = {check.option for action in KNOWN.actions.values() for check in action.preconditions} - {""}
    assert options(KNOWN) == ["leaves_seat", "made_bed", "near_hands"] and named | {"made_bed"} <= {*DEFAULT._fields}


def test_the_bedding_of_the_knowledge_are_its_classes_of_bedding():
    home = Home.from_graph(library.load_graph("maple", KNOWN), "maple", KNOWN)
    found = {home.classes[i] for i in range(len(home)) if home.bedding >> i & 1}
    assert found == {"pillow", "blanket"} and all(KNOWN.object_class(name) for name in BEDDING)


def test_an_explanation_names_what_is_turned_back():
    by = {rules.made_bed: list(checks(start(("cat", "pillow")), step("Lie"), rules))[-1].by for rules in RULE_SETS}
    assert by[True] == "on it: cat (4); turned back: pillow (5)" and by[False] == "on it: cat (4), pillow (5)"


@pytest.mark.parametrize("rules", RULE_SETS)
def test_a_planning_problem_states_the_rule(rules):
    task = Task("made", start(MADE), (ROOM, ME, BED, 4, 5, 6, 7), ((ME, "LYING", True),), (), rules=rules)
    assert ("(option-made-bed)" in problem(task)) is rules.made_bed


LATER = ("leaves_seat", "near_hands", "made_bed")


def test_datasets_and_episodes_from_before_are_read_with_the_bedding_counted():
    made = [f"{name}{end}" for name in ("consequences", *LATER) for end in ("", "_watching_off")]
    assert [name for name, rules in RULES.items() if rules.made_bed] == made
    assert [name for name, rules in RULES.items() if rules.near_hands] == made[:6]
    assert [name for name, rules in RULES.items() if rules.leaves_seat] == made[:4]
    before = DEFAULT._replace(made_bed=False, near_hands=False, leaves_seat=False)
    assert RULES["default"] == before and not RULES["watching_off"].made_bed
    assert not read({"origin": "sensible", "watch_needs_on": True, "doors": True}).made_bed
    assert len(set(RULES.values())) == len(RULES)


@pytest.mark.parametrize(
    ("formula", "found"),
    [
        ("class(x, pillow) | class(x, cat)", 0b011),
        ("class_contains(x, pil) & not property(x, SOFT)", 0b001),
        ("not (class(x, pillow) | property(x, SOFT))", 0b100),
        ("property(x, SOFT) & class(x, cat)", 0b010),
    ],
)
def test_a_kind_is_read_off_classes_and_properties(formula, found):
    classes = {"pillow": 0b001, "cat": 0b010, "book": 0b100}
    assert of_kind(parse_formula(formula), {"SOFT": 0b010}, classes, 0b111) == found


def test_a_kind_that_depends_on_relations_is_refused():
    with pytest.raises(HearthError, match="not about a class or property"):
        of_kind(parse_formula("some y: ON(x, y)"), {}, {}, 1)
