"""Perturbations: which conditions, how often, and that environments then have them."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import pytest
from repair_worlds import steps_of

from hearth.grounding.environments.default_state import prepared
from hearth.grounding.environments.sampling import Size, draw
from hearth.grounding.preconditions.condition_checks import unmet
from hearth.grounding.preconditions.conditions import Condition, Preconditions
from hearth.grounding.preconditions.precondition_inference import infer
from hearth.grounding.preconditions.usual_states import usual_states
from hearth.repair.perturbation import PERTURBATIONS, Case, Chances, applied, candidates, distinct
from hearth.repair.perturbation_strengths import STRENGTHS_FILE, load_strengths, strength
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.literals import CHARACTER, Literal
from hearth.schemas.rng import rng

TELEVISION = """[Walk] <living_room> (1)
[Walk] <couch> (1)
[Sit] <couch> (1)
[Find] <remote_control> (1)
[Grab] <remote_control> (1)
[SwitchOn] <television> (1)
[TurnTo] <television> (1)
[Watch] <television> (1)"""
SEE = """[Walk] <television> (1)
[SwitchOn] <television> (1)
[Walk] <couch> (1)
[Sit] <couch> (1)
[Watch] <television> (1)"""
DISHES = """[Walk] <kitchen> (1)
[Walk] <cupboard> (1)
[Open] <cupboard> (1)
[Find] <cup> (1)
[Grab] <cup> (1)
[Close] <cupboard> (1)
[Walk] <sink> (1)
[Wash] <cup> (1)"""
GET_UP = "[StandUp]\n[Walk] <bedroom> (1)\n[SwitchOff] <light> (1)"
WAKE_UP = "[WakeUp]\n[StandUp]"
UNPLUG = "[Walk] <television> (1)\n[PlugIn] <television> (1)\n[SwitchOn] <television> (1)"
READ = "[Read] <book> (1)"
MILD = strength("mild").chances

KINDS = {
    "sitting": GET_UP,
    "lying": WAKE_UP,
    "at_reach": TELEVISION,
    "plugged": UNPLUG,
    "on": TELEVISION,
    "open": DISHES,
    "free": TELEVISION,
    "facing": SEE,
    "holding": READ,
    "container": DISHES,
    "location": TELEVISION,
    "full_hands": DISHES,
    "dirty": DISHES,
    "door": TELEVISION,
    "pet": TELEVISION,
    "seated": DISHES,
}
"""For every kind of perturbation, a program it applies to."""


def case_of(text: str, home) -> Case:
    program = steps_of(text)
    conditions = infer(program, home.knowledge)
    assert isinstance(conditions, Preconditions), conditions
    return Case(program, conditions, prepared(home))


def only(kind: str) -> Chances:
    return Chances({kind: 1.0}, {"each": 1.0})


def test_every_kind_is_tried_here_and_has_a_probability():
    of_set_3 = {row.violated[0] for row in usual_states().values() if row.violated} | {"done"}
    assert set(KINDS) | of_set_3 == set(PERTURBATIONS) == set(MILD.kinds)  # those: test_usual_states.py


@pytest.mark.parametrize("kind", KINDS)
def test_environments_are_as_the_perturbation_says(kind, maple):
    case = case_of(KINDS[kind], maple)
    found = list(distinct(case, only(kind), rng(1), 1))
    assert found, f"{kind} does not apply"
    for seed in range(3):
        environment = draw(case.program, case.base, found[0].conditions, seed, "", 0, Size())
        nodes = {ref.key: ref.node for ref in environment.program.objects()}
        assert unmet(found[0].conditions, environment.world, nodes) == ()
        dropped = [c for one in found[0].perturbations for c in one.dropped if c.name not in ("location", "nearby")]
        gone = Preconditions(tuple(dropped))
        assert not dropped or unmet(gone, environment.world, nodes), f"{dropped} still hold"


def test_a_swap_takes_the_condition_for_its_opposite(maple):
    case = case_of(DISHES, maple)
    (one,) = [p for p in candidates(case) if p.kind == "open"]
    assert str(one) == "open: closed(cupboard (1)) -> open(cupboard (1))"
    after = applied(case.conditions, [one])
    assert after.has("open", ("cupboard", 1))
    assert not after.has("closed", ("cupboard", 1))


def test_a_thing_that_is_elsewhere_keeps_no_other_place(maple):
    case = case_of(TELEVISION, maple)
    (one,) = [p for p in candidates(case) if p.kind == "at_reach" and p.about.objects[0] == ("remote_control", 1)]
    names = {c.name for c in applied(case.conditions, [one]).about(("remote_control", 1))}
    assert names == {"not_near"}


def test_no_two_draws_are_the_same_and_none_is_the_original(maple):
    case = case_of(TELEVISION, maple)
    found = list(distinct(case, MILD, rng(5), 40))
    facts = [frozenset(c.literal for c in one.conditions) for one in found]
    assert len(set(facts)) == len(facts) > 10
    assert frozenset(c.literal for c in case.conditions) not in facts
    assert found == list(distinct(case, MILD, rng(5), 40))


@pytest.mark.parametrize(("way", "most"), [("one", 1), ("two", 2), ("each", 3)])
def test_as_many_at_once_as_asked_for(way, most, maple):
    case = case_of(TELEVISION, maple)
    chances = replace(MILD, draws={way: 1.0}, most=3)
    sizes = Counter(len(one.perturbations) for one in distinct(case, chances, rng(2), 30))
    assert max(sizes) == most


def test_two_that_settle_the_same_exclude_each_other(maple):
    case = case_of(TELEVISION, maple)
    chances = Chances(dict.fromkeys(PERTURBATIONS, 1.0), {"each": 1.0}, most=99)
    for one in distinct(case, chances, rng(3), 10):
        claims = [claim for p in one.perturbations for claim in p.claims()]
        assert len(claims) == len(set(claims))
        kinds = {p.kind for p in one.perturbations}
        assert not {"free", "pet"} <= kinds


def test_what_is_never_wanted_never_comes(maple):
    case = case_of(TELEVISION, maple)
    assert list(distinct(case, Chances({"lying": 1.0}, {"each": 1.0}), rng(1), 5)) == []
    assert list(distinct(case, Chances({}, {"one": 1.0}), rng(1), 5)) == []


def test_full_hands_leave_alone_what_is_held_already(maple):
    case = case_of(READ, maple)
    assert any(c.name == "holds" and CHARACTER in c.objects for c in case.conditions)
    assert all(p.kind != "full_hands" for p in candidates(case))


def test_the_thesis_own_perturbations_are_as_likely_as_there():
    kinds = MILD.kinds
    assert {kinds[k] for k in ("sitting", "lying", "at_reach", "plugged", "on", "open", "free")} == {0.7}


def test_the_thesis_perturbs_every_condition_with_its_probability(maple):
    thesis = strength("thesis").chances
    assert thesis.kinds == dict.fromkeys(PERTURBATIONS, 0.7) and thesis.draws == {"each": 1}
    case = case_of(TELEVISION, maple)
    claims = {claim for one in candidates(case) for claim in one.claims()}
    assert thesis.most > len(claims)
    sizes = [len(one.perturbations) for one in distinct(case, thesis, rng(4), 40)]
    mild = [len(one.perturbations) for one in distinct(case, MILD, rng(4), 40)]
    assert sum(sizes) / len(sizes) > 1.3 * sum(mild) / len(mild)


def test_an_unknown_strength_is_reported_with_the_known_ones():
    with pytest.raises(HearthError, match="unknown strength `brutal`") as caught:
        strength("brutal")
    assert caught.value.diagnostics[0].suggestion == "strengths are mild, thesis"


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("open: 0.7", "opne: 0.7", "`opne` is none of the kinds"),
        ("open: 0.7", "open: 7", "7 is not a probability of `open`"),
        ("each: 6", "eech: 6", "`eech` is none of the draws"),
        ("draws:", "drawn:", "`kinds` or `draws` is missing"),
        ("most: 6", "most: none", "`most` is not a count"),
        ("most: 6", "most: 0", "`most` is not a count"),
        ("each: 6", "each: -1", "-1 is not a weight of `each`"),
        ("each: 6", "each: none", "'none' is not a weight of `each`"),
        ("clears: all", "clears: some", "`clears` is not one of enough, all, in `thesis`"),
        ("says:", "said:", "`said` does not belong to a strength, in `mild`"),
    ],
)
def test_a_fault_in_the_probabilities_is_named(old, new, fault, tmp_path):
    text = STRENGTHS_FILE.read_text()
    assert old in text
    path = tmp_path / "perturbations.yaml"
    path.write_text(text.replace(old, new))
    with pytest.raises(HearthError, match=fault):
        load_strengths(path)


def test_the_least_values_of_probabilities_weights_and_counts_are_allowed(tmp_path):
    path = tmp_path / "perturbations.yaml"
    text = STRENGTHS_FILE.read_text()
    path.write_text(text.replace("open: 0.7", "open: 0").replace("most: 6", "most: 1"))
    found = load_strengths(path).values()
    assert 0 in {each.chances.kinds["open"] for each in found} and 1 in {each.chances.most for each in found}


@pytest.mark.parametrize(("dirty", "expected"), [("clean", 1), ("dirty", 0)])
def test_what_is_dirty_already_is_not_made_dirty(dirty, expected, maple):
    program = steps_of(DISHES)
    key = program.steps[-1].objects[0].key
    known = Preconditions((Condition(Literal(dirty, (key,)), 7),))
    case = Case(program, known, prepared(maple))
    assert len(list(PERTURBATIONS["dirty"](case))) == expected
