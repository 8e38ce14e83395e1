"""Beds stay made in sampled environments, unless the rules count the bedding; a repair leaves it where it is."""

import pytest

from hearth.grounding.environments.sampling import sample
from hearth.grounding.preconditions.conditions import Condition
from hearth.grounding.preconditions.postconditions import achieved
from hearth.grounding.preconditions.precondition_inference import infer
from hearth.repair.repair_loop import repair
from hearth.repair.step_context import circumstances
from hearth.schemas.literals import Literal
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.simulation.rules import DEFAULT
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices

BED = ("bed", 1)
COUNTED = DEFAULT._replace(made_bed=False)


def program(*steps):
    return Program("Rest", steps=tuple(Step(act, tuple(ObjectRef(name, 1) for name in names)) for act, *names in steps))


def on_bed(world, bound):
    seat = next(ref.node for ref in bound.objects() if ref.name == "bed")
    return sorted(world.home.classes[i] for i in indices(edge_rows.bearing(world, world.home.index[seat])))


@pytest.mark.parametrize("action", ["Lie", "Sit"])
@pytest.mark.parametrize("seed", range(3))
def test_bedding_stays_on_the_bed(action, seed, maple):
    environment, execution = sample(program(("Walk", "bed"), (action, "bed")), maple, seed)
    assert execution.executable and execution.rules == DEFAULT
    assert on_bed(environment.world, environment.program) == ["blanket", "pillow", "pillow", "pillow"]


def test_where_bedding_counts_it_is_taken_off(maple):
    environment, execution = sample(program(("Walk", "bed"), ("Lie", "bed")), maple, 0, rules=COUNTED)
    assert execution.executable and on_bed(environment.world, environment.program) == []


@pytest.mark.parametrize("steps", [
    (("Walk", "bed"), ("Lie", "bed")),
    (("Walk", "bed"), ("Find", "pillow"), ("Grab", "pillow"), ("Lie", "bed")),
])  # fmt: skip
def test_an_occupied_bed_is_cleared_of_all_but_its_bedding(steps, maple, knowledge):
    resting = program(*steps)
    conditions = infer(resting, knowledge)
    free = next(each for each in conditions if each.name == "free")
    more = [Condition(Literal("in", (("pillow", 1), BED)), 1)] if len(steps) > 2 else []
    occupied = conditions.without(free).plus(*more, free.instead("occupied"))
    environment, execution = sample(resting, maple, 3, conditions=occupied, must_run=False)
    assert execution.failure.code == "OCCUPIED" and not {"pillow", "blanket"} & set(execution.failure.names)
    done = repair(environment.program, environment.world, (), knowledge)
    taken = {ref.name for ref in done.program.objects()} - {name for _, *names in steps for name in names}
    assert done.failure is None and taken and not taken & {"pillow", "blanket", "sheets", "comforter"}


def test_who_lies_at_the_start_may_lie_in_a_made_bed(maple):
    resting = program(("WakeUp",), ("StandUp",))
    places = [sample(resting, maple, seed)[0].world.agents[0].on for seed in range(12)]
    assert any(place & maple.by_class["bed"] for place in places)


@pytest.mark.parametrize("rules", [DEFAULT, COUNTED])
def test_a_blanket_that_is_brought_is_put_on_the_bed(rules, maple, knowledge):
    resting = program(("Walk", "bed"), ("Lie", "bed"), ("Pull", "blanket"))
    conditions = infer(resting, knowledge, rules)
    near = [each for each in conditions if ("blanket", 1) in each.objects]
    far = conditions.without(*near).plus(Condition(Literal("not_near", (("blanket", 1), BED)), 2))
    environment, _ = sample(resting, maple, 1, conditions=far, must_run=False, rules=rules)
    _, original = sample(resting, maple, 1, rules=rules)
    wanted = circumstances(original)
    done = repair(environment.program, environment.world, achieved(original), knowledge, rules, wanted=wanted)
    put = [[ref.name for ref in step.objects] for step in done.program.steps if step.action == "PutBack"]
    assert done.failure is None and (["blanket", "bed"] in put) is rules.made_bed, done.program.steps
