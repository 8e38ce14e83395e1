"""A repaired program does each step of the original in the circumstances in which the original does it."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from repair_worlds import ROOMS, small_world, steps_of
from test_augmentation import home, programs

from hearth.grounding.preconditions.postconditions import achieved
from hearth.repair.augmentation import Augmented, Options, augment
from hearth.repair.repair_loop import repair
from hearth.repair.step_context import circumstances
from hearth.schemas.failures import Code
from hearth.schemas.literals import CHARACTER, Literal
from hearth.schemas.syntax import print_step
from hearth.simulation.engine import run
from hearth.simulation.literal_truth import holds

BRINGS = {"Open": "OPEN", "SwitchOn": "ON"}
ENDS = {"Close": "OPEN", "SwitchOff": "ON"}
RESTS = {"Sit": "SITTING", "Lie": "LYING"}
PUTS = ("PutBack", "PutIn", "PutObjBack", "Drop", "Release", "PutOn")


def demands(program, posture):
    """Return the demands of the earlier steps on each step of a program, by an oracle that reads the text."""
    found, holding, states = [], set(), set()
    for step in program.steps:
        wanted = {Literal.of("HOLDS", CHARACTER, key) for key in holding}
        wanted |= {Literal.of(state, key) for state, key in states}
        found.append((wanted, posture))
        key = step.objects[0].key if step.objects else None
        if step.action in RESTS:
            posture = RESTS[step.action]
        elif step.action == "StandUp":
            posture = None
        elif step.action == "Grab":
            holding.add(key)
        elif step.action in PUTS:
            holding.discard(key)
        elif step.action == "Pour":
            holding.discard(key)  # water leaves the hand
        elif step.action in BRINGS:
            states.add((BRINGS[step.action], key))
        elif step.action in ENDS:
            states.discard((ENDS[step.action], key))
    return found


def posture_in(world):
    return next((state for state in RESTS.values() if holds(Literal.of(state, CHARACTER), world)), None)


def contradictions(original, pair):
    """The kept steps that a repaired program does otherwise, by the oracle."""
    wishes = demands(original.program, posture_in(original.worlds[0]))
    nodes = {ref.key: ref.node for ref in pair.environment.program.objects()}
    odd = []
    for step, source, world in zip(pair.program.steps, pair.sources, pair.execution.worlds, strict=False):
        if source < 0:
            continue
        wanted, posture = wishes[source]
        now = posture_in(world)
        lost = [str(fact) for fact in wanted if not holds(fact, world, nodes)]
        if lost or posture != now:
            odd.append((print_step(step), posture, now, lost))
    return odd


@given(
    st.integers(0, 10_000),
    st.integers(0, 9),
    st.sampled_from(["maple", "birch", "willow", "rowan"]),
    st.sampled_from(["mild", "thesis"]),
)
@settings(max_examples=120)
def test_every_kept_step_is_done_as_in_the_original(which, seed, name, strength):
    record_id, program = programs()[which % len(programs())]
    found = augment(program, home(name), seed, record_id, Options(3, strength=strength))
    for pair in found.pairs if isinstance(found, Augmented) else ():
        if pair.failure is None:
            assert contradictions(found.execution, pair) == []


@pytest.mark.parametrize("strength", ["mild", "thesis"])
@pytest.mark.parametrize(("rest", "then"), [("Sit", "Type"), ("Sit", "Eat"), ("Sit", "Watch"), ("Lie", "Sleep")])
def test_nobody_sits_only_after_what_it_sat_for(rest, then, strength):
    tried = 0
    for record_id, program in programs():
        actions = [step.action for step in program.steps]
        if not {rest, then} <= {*actions} or actions.index(rest) > actions.index(then):
            continue
        found = augment(program, home("birch"), 1, record_id, Options(4, strength=strength))
        for pair in found.pairs if isinstance(found, Augmented) else ():
            if pair.failure is None:
                tried += 1
                after = [step.action for step in pair.program.steps]
                assert after.index(rest) < len(after) - 1 - after[::-1].index(then), pair.program.steps
    assert tried >= 10


OFFICE = ROOMS + "20 desk inside 1\n21 chair inside 1 close 20\n22 keyboard on 20 inside 1 close 20\n"
AWAY = ROOMS + "20 desk inside 1\n21 chair inside 1 close 20\n22 keyboard inside 2\n"
TYPING = "[Walk] <desk> (1.20)\n[Sit] <chair> (1.21)\n[Type] <keyboard> (1.22)\n[Touch] <keyboard> (1.22)"


def kept(text, at_home, elsewhere):
    """The repair of a program of one small world in another."""
    program, start = steps_of(text), small_world(at_home)
    original = run(start, program)
    assert original.failure is None
    known = start.home.knowledge
    return repair(program, small_world(elsewhere), achieved(original), known, wanted=circumstances(original))


def test_what_is_used_in_a_seat_is_brought_before_the_seat_is_taken():
    result = kept(TYPING, OFFICE, AWAY)
    assert result.failure is None
    assert [print_step(step) for step in result.program.steps] == [
        "[Walk] <keyboard> (1.22)",
        "[Grab] <keyboard> (1.22)",
        "[Walk] <desk> (1.20)",
        "[PutBack] <keyboard> (1.22) <desk> (1.20)",
        "[Sit] <chair> (1.21)",
        "[Type] <keyboard> (1.22)",
        "[Touch] <keyboard> (1.22)",
    ]


def test_the_chair_is_moved_to_what_can_not_be_brought():
    text = "[Walk] <chair> (1.21)\n[Sit] <chair> (1.21)\n[SwitchOn] <television> (1.20)"
    near = ROOMS + "20 television OFF PLUGGED_IN inside 1\n21 chair inside 1 close 20\n"
    result = kept(text, near, near.replace("inside 1 close 20", "inside 2"))
    assert result.failure is None
    actions = [step.action for step in result.program.steps]
    assert actions.index("Release") < actions.index("Sit") < actions.index("SwitchOn")


def test_a_step_that_can_not_be_done_seated_any_more_is_refused():
    text = "[Walk] <couch> (1.21)\n[Sit] <couch> (1.21)\n[SwitchOn] <television> (1.20)"
    near = ROOMS + "20 television OFF PLUGGED_IN inside 1\n21 couch inside 1 close 20\n"
    result = kept(text, near, near.replace("inside 1 close 20", "inside 2"))
    assert result.failure is not None
    assert result.failure.code is Code.NO_HANDLER


def test_who_is_found_seated_gets_up_for_what_the_original_does_standing():
    text = "[TurnTo] <television> (1.20)\n[Walk] <television> (1.20)"
    world = ROOMS + "20 television inside 1\n21 couch inside 1\n"
    seated = world.replace("10 character inside 1", "10 character SITTING inside 1 on 21")
    result = kept(text, world, seated)
    assert [step.action for step in result.program.steps] == ["StandUp", "TurnTo", "Walk"]
    assert Code.CIRCUMSTANCES_LOST in [attempt.failure.code for attempt in result.attempts]


def test_who_is_found_standing_sits_down_for_what_the_original_does_seated():
    text = "[TurnTo] <television> (1.20)\n[StandUp]\n[Walk] <television> (1.20)"
    world = ROOMS + "20 television inside 1\n21 couch inside 1\n"
    seated = world.replace("10 character inside 1", "10 character SITTING inside 1 on 21")
    result = kept(text, seated, world)
    assert [step.action for step in result.program.steps] == ["Walk", "Sit", "TurnTo", "StandUp", "Walk"]


def test_what_is_held_and_open_belongs_to_the_circumstances():
    world = small_world(ROOMS + "20 fridge CLOSED OFF inside 1\n21 cup inside 1\n")
    steps = "[Walk] <fridge> (1.20)\n[Open] <fridge> (1.20)\n[Walk] <cup> (1.21)\n[Grab] <cup> (1.21)\n"
    found = [set(map(str, facts)) for facts in circumstances(run(world, steps_of(f"{steps}[Find] <cup> (1.21)")))]
    assert "OPEN(fridge (1))" not in found[1]
    assert "OPEN(fridge (1))" in found[2] & found[4]
    assert "not HOLDS(character (1), cup (1))" in found[3]
    assert "HOLDS(character (1), cup (1))" in found[4]
