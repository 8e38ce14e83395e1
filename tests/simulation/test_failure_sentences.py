"""Failures of runs in people's words: every failure that the engine gives, and every requirement of an action."""

from __future__ import annotations

import re
from itertools import product

import pytest
from action_home import NODES, after, step
from small_worlds import bound_step
from test_actions import FAILURES

from hearth.grounding.grounded_run import LEAST, as_given, attempt
from hearth.kb.loading.load import default
from hearth.repair.remedies import stop_reason
from hearth.schemas.failure_words import REMEDIES, sentence
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.spoken_words import PROPERTY_WORDS, requirement_words, spoken
from hearth.schemas.syntax import parse_program
from hearth.schemas.vocabulary import PROPERTIES
from hearth.simulation.engine import act, together
from hearth.simulation.rules import CONSEQUENCES, DEFAULT

INTERNAL = re.compile(
    r"[A-Z]{2,}|\w_\w|\b(?:edge|hop|tick|literal|predicate|role|agent|affords|holds\(|close\(|state\(|none of these)\b"
)
"""Words of data: codes, states, properties, classes with underscores, predicates."""

STARTS = ("", "Walk bed; Sit bed", "Walk bed; Lie bed", "Walk cup; Grab cup; Walk plate; Grab plate", "Walk fridge")


def words_of(failure: Failure) -> str:
    """The sentence without its code and without names of actions."""
    said = sentence(failure)
    assert said.endswith(f"({failure.code})"), said
    return re.sub(r"\[\w+\]", "", said.removesuffix(f"({failure.code})"))


def assert_plain(failure: Failure) -> None:
    said = words_of(failure)
    assert not INTERNAL.search(said), (INTERNAL.search(said), said, failure)


@pytest.mark.parametrize(("before", "text", "code", "objects"), FAILURES, ids=str)
def test_every_failure_of_an_action_is_in_peoples_words(before, text, code, objects):
    failure = act(after(before), step(text))
    assert isinstance(failure, Failure) and failure.code is code
    assert_plain(failure)


@pytest.mark.parametrize("rules", [DEFAULT, CONSEQUENCES], ids=["set 2", "set 3"])
def test_every_action_with_every_object_fails_in_peoples_words(rules):
    things, codes = list(NODES.values()), set()
    for start in STARTS:
        world = after(start)
        for action in default().actions.values():
            for objects in product(things, repeat=min(action.arity, 1)):
                for second in things[::6] if action.arity == 2 else [None]:
                    named = [*objects, second] if second is not None else list(objects)
                    found = act(world, bound_step(action.name, named), rules)
                    if isinstance(found, Failure):
                        codes.add(found.code)
                        assert_plain(found)
    assert {Code.NOT_AFFORDED, Code.NOT_CLOSE, Code.SITTING, Code.LYING, Code.NOT_HOLDING, Code.NO_FREE_HAND} <= codes
    assert len(codes) > 15


def test_every_requirement_of_the_knowledge_is_in_peoples_words():
    assert set(PROPERTY_WORDS) == set(PROPERTIES)
    for action in default().actions.values():
        for needs in action.needs:
            said = requirement_words(str(needs))
            assert said and not INTERNAL.search(said), said
    assert requirement_words("CAN_OPEN or `desk` or `window`") == "something that opens, or one of these: desk, window"
    assert requirement_words("HAS_SWITCH or `keyboard`") == "something with a switch or a keyboard"
    assert requirement_words("CUTTABLE and EATABLE") == "something that can be cut and is food"
    assert requirement_words("a class named *brush*, not `tooth_brush`") == (
        "something with `brush` in its name, but not tooth brush"
    )
    assert requirement_words("MAGIC_THING") == "a thing of the kind magic thing"  # of a knowledge of one's own


def test_every_class_has_a_spoken_name():
    for name in default().objects:
        assert spoken(name) and not INTERNAL.search(spoken(name)), name
    said = {name: spoken(name) for name in ("hands_both", "feet_left", "eyes_both", "food_ice_cream", "food_food")}
    assert said == {
        "hands_both": "hands", "feet_left": "left foot", "eyes_both": "eyes", "food_ice_cream": "ice cream",
        "food_food": "food",
    }  # fmt: skip


def failures_of_programs():
    """Programs that fail otherwise than by a check: no such number, no such thing, two acts of one character."""
    yield act(after(""), Step("Walk", (ObjectRef("cup", 1),)))
    yield act(after(""), Step("Walk", (ObjectRef("cup", 1, 4711),)))
    yield act(after(""), bound_step("Walk", [NODES["cup"]], agent=3))
    yield act(after(""), bound_step("Walk", []))
    yield act(after(""), bound_step("Fly", [NODES["cup"]]))
    yield act(after(""), bound_step("Crawl", [NODES["bed"]]))
    yield together(after(""), [bound_step("Walk", [NODES["cup"]]), bound_step("Walk", [NODES["bed"]])], DEFAULT)


def test_programs_that_fit_no_home_fail_in_peoples_words():
    found = list(failures_of_programs())
    assert {each.code for each in found} >= {Code.UNBOUND, Code.UNKNOWN_AGENT, Code.WRONG_ARITY, Code.UNKNOWN_ACTION}
    for failure in found:
        assert isinstance(failure, Failure)
        assert_plain(failure)


PROGRAMS = [
    "[Find] <hands_both> (1)",
    "[Walk] <food_ice_cream> (1)",
    "[Walk] <fridge> (1)\n[Walk] <fridge> (2)\n[Open] <fridge> (2)",
    "[Walk] <home_office> (1)\n[Walk] <home_office> (2)\n[Walk] <coffe_maker> (9)",
    "[Walk] <television> (1)\n[Watch] <television> (1)",
    "[Walk] <fridge> (1)\n[Close] <fridge> (1)\n[Grab] <milk> (1)",
    "[Walk] <fridge> (1)\n[Grab] <milk> (1)\n[Open] <fridge> (1)\n[Open] <fridge> (1)",
    "[Sit] <coffe_maker> (1)",
    "[Walk] <chair> (1)\n[Grab] <cup> (1)\n[PutIn] <cup> (1) <kitchen_cabinet> (1)",
]


@pytest.mark.parametrize("lines", PROGRAMS)
def test_runs_in_a_home_stop_in_peoples_words(maple, lines):
    program, _ = parse_program(f"T\n\n\n{lines}\n")
    execution = as_given(program, maple).execution
    if execution.failure is not None:
        assert_plain(execution.failure)
        steps = re.sub(r"\[\w+\]( <\w+> \([\d.]+\))*", "", stop_reason(execution))
        assert not INTERNAL.search(steps.removesuffix(f"({execution.failure.code})")), steps
    sampled = attempt(program, maple, size=LEAST)
    if isinstance(sampled, Failure):
        assert_plain(sampled)


def test_no_remedy_of_a_failure_is_an_option_of_one_command():
    """A failure is printed by many commands, and by those to which the option was given already."""
    assert not [code for code, words in REMEDIES.items() if "--" in words]
