"""Usual states of action set 3: conditions, environments that have them, violations, and repairs."""

from collections import Counter

import pytest

from hearth.grounding.environments.default_state import prepared
from hearth.grounding.environments.sampling import sample
from hearth.grounding.preconditions.condition_checks import unmet
from hearth.grounding.preconditions.precondition_inference import infer
from hearth.grounding.preconditions.usual_states import usual_states
from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.repair.augmentation import Options, augment
from hearth.repair.perturbation import PERTURBATIONS, Case, Chances, candidates
from hearth.repair.perturbation_strengths import STRENGTHS_FILE, Strength, load_strengths
from hearth.schemas.failures import Failure
from hearth.schemas.literals import LACK_OF_SET_3, STATE_OF, STATE_OF_SET_3
from hearth.schemas.syntax import parse_program
from hearth.schemas.vocabulary import EVERY_STATE_ID
from hearth.simulation.actions.registry import EVERY
from hearth.simulation.engine import run
from hearth.simulation.rules import CONSEQUENCES, DEFAULT
from hearth.simulation.world.home import Home

KNOWN = default().of_set(3)

DRINKING = ("[Walk] <water_glass> (1)", "[Grab] <water_glass> (1)", "[Drink] <water_glass> (1)")
COFFEE = ("[Walk] <coffee> (1)", "[Grab] <coffee> (1)", "[Drink] <coffee> (1)")
CUTTING = (
    "[Walk] <knife> (1)",
    "[Grab] <knife> (1)",
    "[Walk] <food_bread> (1)",
    "[Cut] <food_bread> (1)",
    "[Grab] <food_bread> (1)",
)
BOILING = ("[Walk] <kettle> (1)", "[SwitchOn] <kettle> (1)", "[Wait]", "[TurnTo] <kettle> (1)")
FOLDING = ("[Walk] <towel> (1)", "[Grab] <towel> (1)", "[Fold] <towel> (1)")

CASES = {
    "soiled": (DRINKING, {"clean", "full"}, ["Wash"]),
    "emptied": (DRINKING, {"clean", "full"}, ["Pour"]),
    "emptied kettle": (BOILING, {"full"}, ["PutIn", "SwitchOn", "SwitchOff"]),
    "cooled": (COFFEE, {"hot"}, ["PutIn", "SwitchOn", "Wait"]),
    "sliced": (CUTTING, {"uncut"}, []),
    "done": (FOLDING, set(), []),
}
"""For each perturbation a program, the conditions that it takes for granted, and acts among those that repair it."""


def program(*steps: str):
    found, faults = parse_program("Acts\n\n" + "\n".join(steps) + "\n", "")
    assert not faults
    return found


@pytest.fixture(scope="module")
def maple() -> Home:
    return Home.from_graph(library.load_graph("maple", KNOWN), "maple", KNOWN)


@pytest.mark.parametrize("case", CASES)
def test_what_is_taken_for_granted_is_violated_and_repaired(maple, case):
    steps, conditions, acts = CASES[case]
    kind = case.split()[0]
    found = infer(program(*steps), KNOWN, CONSEQUENCES)
    assert not isinstance(found, Failure) and conditions <= {each.name for each in found}
    power = Strength(Chances({kind: 1.0}, {"one": 1.0}))
    result = augment(program(*steps), maple, 0, case, Options(count=1, strength=power, rules=CONSEQUENCES))
    assert not isinstance(result, Failure), result
    (pair,) = result.pairs
    assert pair.failure is None and [each.kind for each in pair.perturbations] == [kind], pair.failure
    done = Counter(step.action for step in pair.program.steps)
    before = Counter(step.action for step in program(*steps).steps)
    assert set(acts) <= set(done - before) if acts else set(before - done), (done, before)
    assert run(pair.environment.world, pair.program, CONSEQUENCES).executable


@pytest.mark.parametrize("case", CASES)
def test_environments_have_what_is_taken_for_granted(maple, case):
    drawn = sample(program(*CASES[case][0]), maple, 3, case, rules=CONSEQUENCES)
    assert not isinstance(drawn, Failure), drawn
    environment, execution = drawn
    nodes = {ref.key: ref.node for ref in environment.program.objects()}
    assert execution.executable and not unmet(environment.conditions, environment.world, nodes)
    for each in environment.conditions:
        if each.name == "full" and each.objects[0][0] == "water_glass":
            inside = {e.source for e in environment.world.edges() if e.target == nodes[each.objects[0]]}
            assert inside, "a full glass has something in it"


@pytest.mark.parametrize("case", CASES)
def test_sets_1_and_2_take_nothing_for_granted(case):
    known, steps = default(), CASES[case][0]
    if any(step.action not in EVERY for step in program(*steps).steps):
        return
    found = infer(program(*steps), known, DEFAULT)
    home = Home.from_graph(library.load_graph("maple", known), "maple", known)
    kinds = {row.violated[0] for row in usual_states().values() if row.violated} | {"done"}
    assert not isinstance(found, Failure)
    assert not {each.name for each in found} & {*STATE_OF_SET_3, *LACK_OF_SET_3}
    assert not kinds & {each.kind for each in candidates(Case(program(*steps), found, prepared(home)))}


def test_rows_name_known_conditions_actions_and_classes():
    names = {*STATE_OF, *STATE_OF_SET_3, *LACK_OF_SET_3}
    assert {*STATE_OF_SET_3.values()} <= {*EVERY_STATE_ID}
    for row in usual_states().values():
        assert {row.condition, *(row.violated[1:] if row.violated else ())} <= names
        assert {*row.acts, *row.seen_to_by} <= {*KNOWN.actions}
        assert all(KNOWN.object_class(name) for name in row.classes)
        assert row.kinds <= {kind for name in KNOWN.objects for kind in KNOWN.ancestors(name)}
        for way in row.restored:
            assert all(KNOWN.object_class(name) for classes in way.classes.values() for name in classes)
            assert all(len(objects) == KNOWN.actions[action].arity for action, objects in way.steps)
            assert {name for _, objects in way.steps for name in objects} == {"x", *way.classes}
        if row.violated:
            assert row.violated[0] in PERTURBATIONS
            assert all(row.violated[0] in each.chances.kinds for each in load_strengths(STRENGTHS_FILE).values())
