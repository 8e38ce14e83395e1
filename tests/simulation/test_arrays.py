"""The batched engine equals the plain one, tick by tick, and refuses what it lacks before the first step."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

pytest.importorskip("numba")

from oracles.array_engine import chosen, paired, step

from hearth.challenges.array_homes import begins_of
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.household import household_tasks
from hearth.challenges.published_tasks import tasks
from hearth.envs.rewards import Rewards
from hearth.envs.session import opening
from hearth.homes.procedural.home_generator import generate
from hearth.homes.scene_graph import scene
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.simulation.actions.common import Action, Becomes, checked, close, unchanged
from hearth.simulation.actions.registry import EVERY
from hearth.simulation.arrays.batch import Batch, Payment
from hearth.simulation.arrays.distance_pool import DistancePool
from hearth.simulation.arrays.home_records import HomeShape, bucket_of
from hearth.simulation.arrays.instruction_table import BECOMES, EFFECT, KERNELS, action_table
from hearth.simulation.arrays.record_types import BUCKETS
from hearth.simulation.arrays.task_records import Begin
from hearth.simulation.rules import DEFAULT, REPLAY
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.states import CLEAN

PLAYED = sorted(default().group("played"))
MEDIUM = BUCKETS[1]
"""One bucket for all tests, so that kernels are compiled once."""

REWARDS = Rewards(1.0, -0.004, 0.5)


def batch_of(begins, rules, worlds=None, **settings):
    """A batch whose world number i plays the task number i."""
    begins = tuple(begins)
    batch = Batch(begins, worlds or len(begins), PLAYED, rules, payment=Payment(*REWARDS_OF), bucket=MEDIUM, **settings)
    batch.reset()
    batch.begin_tasks(np.arange(len(batch)) % len(begins))
    return batch


REWARDS_OF = (REWARDS.success, REWARDS.tick, REWARDS.predicate)


def of_challenge(name, agents, limit):
    which = challenge(name)
    begins = begins_of(tasks(name, "train", limit=limit), which, default(), agents)
    return batch_of(begins, which.rules, partial=which.partial, limit=30)


def generated():
    known = default()
    home = Home.from_graph(scene(generate(4, 3, known), known), "home_4_3", known)
    goal = "CLOSED(fridge) and ON(agent, chair) and HOLDS(agent, cup) and not ON(light) and ON(cup, table): 2"
    begin = opening([home], goal, 1)
    begins = [Begin(str(seed), *begin(seed)) for seed in range(3)]
    return batch_of(begins, DEFAULT, partial=True, limit=30)


def household():
    which = challenge("household")
    some = [task for task in household_tasks("train", 5) if not task.goal.parts]
    return batch_of(begins_of(some, which, default(), 1), which.rules, partial=True, limit=30)


CASES = {
    "wah": lambda: of_challenge("wah", 1, 6),
    "owah": lambda: of_challenge("owah", 2, 5),
    "household": household,
    "generated": generated,
}


def differences(batch, ticks, seed=1, wild=0.07):
    """Whatever differs in a run of random actions, and how often each action was tried."""
    pairs, rng, counts = paired(batch, REWARDS), np.random.default_rng(seed), Counter()
    for _ in range(ticks):
        step(pairs, chosen(batch, rng, wild), counts)
    return [pair.apart for pair in pairs if pair.apart], counts


@pytest.mark.parametrize("case", CASES)
def test_worlds_are_those_of_the_engine_tick_by_tick(case):
    found, counts = differences(CASES[case](), 60)
    assert not found
    assert {"Walktowards", "Grab", "Open", "PutBack", "refused"} <= set(counts)


@pytest.mark.parametrize("broken", ["effect", "mask", "home", "goal"])
def test_one_changed_entry_of_a_table_is_found(broken):
    batch = CASES["generated" if broken == "goal" else "wah"]()
    if broken == "effect":
        row = next(row for row in batch.table.rows if row[EFFECT] == BECOMES)
        row[1] ^= 1
    elif broken == "mask":
        batch.table.program[0, 1] = 0
    elif broken == "home":
        batch.homes["near"][:, :, 0] = 0
    else:
        batch.tasks["negated"] ^= 1
    assert differences(batch, 40)[0]


def test_closed_doors_that_turn_no_way_share_its_field(maple):
    shape = HomeShape(maple)
    pool = DistancePool([shape], bucket_of([shape]))
    cells = len(shape.ground.ways.cells)
    for key in range(0, len(shape.targets), 9):
        for closed in range(1 << len(shape.doors)):
            pool.fill(np.array([[0, key, closed]]))
            doors = sum(1 << door for k, door in enumerate(shape.doors) if closed >> k & 1)
            exact = shape.ground.ways.detour(shape.targets[key], shape.ground.shut(doors))
            row = pool.rows[0, key, closed]
            there = np.isfinite(np.array(exact.distance))
            assert np.array_equal(pool.distance[row, :cells][there], np.array(exact.distance)[there])
            assert np.array_equal(pool.following[row, :cells][there], np.maximum(exact.following, -1)[there])


def test_an_action_of_literals_needs_no_kernel(monkeypatch, knowledge):
    monkeypatch.setitem(EVERY, "Wash", checked("Wash", close, effect=Becomes(CLEAN)))
    monkeypatch.setitem(EVERY, "Touch", checked("Touch", close))
    assert EVERY["Touch"].effect is unchanged and {"Wash", "Touch"}.isdisjoint(KERNELS)
    table = action_table([*PLAYED, "Wash", "Touch"], knowledge, DEFAULT)
    effects = {of_row[0]: row[EFFECT] for of_row, row in zip(table.of_row, table.rows, strict=True) if of_row}
    assert effects["Wash"] == BECOMES and effects["Touch"] == 0


def test_an_action_whose_effect_is_a_function_is_refused(monkeypatch, knowledge):
    monkeypatch.setitem(EVERY, "Wash", checked("Wash", close, effect=lambda world, *_: world))
    with pytest.raises(HearthError, match="need a kernel"):
        action_table(["Wash"], knowledge, DEFAULT)
    monkeypatch.setitem(EVERY, "Wash", Action("Wash", None, lambda s: (s.me.origins,)))
    with pytest.raises(HearthError, match="effect of Wash is a function"):
        action_table(["Wash"], knowledge, DEFAULT)


@pytest.mark.parametrize("names, rules, message", [
    (["PutObjBack"], DEFAULT, "effect of PutObjBack"),
    (["Fly"], DEFAULT, "not an action"),
    (PLAYED, REPLAY, "rule `"),
    (PLAYED, DEFAULT._replace(bodies=True), "rule `bodies`"),
])  # fmt: skip
def test_actions_and_rules_out_of_scope_are_refused(names, rules, message, knowledge):
    with pytest.raises(HearthError, match=message):
        action_table(names, knowledge, rules)


@pytest.mark.parametrize("goal, message", [
    ("HOLDS(agent, milk) or HOLDS(agent, cup)", "joins goals"),
    ("CLOSE(agent, fridge)", "not about a state"),
    ("[Grab](milk)", "not about a state"),
])  # fmt: skip
def test_goals_out_of_scope_are_refused(goal, message):
    with pytest.raises(HearthError, match=message):
        Batch([Begin("one", *opening("maple", goal, 1)(0))], 1, PLAYED)


def test_a_home_too_large_is_refused(maple, monkeypatch):
    monkeypatch.setattr("hearth.simulation.arrays.home_records.BUCKETS", (BUCKETS[0]._replace(doors=2),))
    with pytest.raises(HearthError, match="`maple` is too large for arrays: 3 doors"):
        bucket_of([HomeShape(maple)])


def test_numbers_out_of_range_change_nothing():
    batch = CASES["wah"]()
    before = batch.worlds.copy()
    for wrong in (batch.size, -1, 1.5):
        with pytest.raises(HearthError, match="actions are"):
            batch.step(np.full(len(batch), wrong))
    assert np.array_equal(before, batch.worlds)


def test_starts_with_hands_that_grabbed_nothing_are_refused():
    world, goal = opening("maple", "CLOSED(fridge)", 1)(0)
    agent = world.agents[0]
    milk = next(indices(world.home.instances("milk")))
    holding = world.with_agent(0, agent._replace(right=1 << milk))
    with pytest.raises(HearthError, match="holds a thing that it did not grab"):
        Batch([Begin("one", holding, goal)], 1, PLAYED)


def test_threads_change_nothing():
    one, two = CASES["wah"](), CASES["wah"]()
    many = [batch_of(one.begins, one.table.rules, worlds=600, limit=30, threads=threads) for threads in (1, 2)]
    rng = np.random.default_rng(3)
    for _ in range(5):
        numbers = chosen(many[0], rng, 0.05)
        for batch in many:
            batch.step(numbers)
    assert np.array_equal(many[0].worlds, many[1].worlds) and np.array_equal(many[0].shown.mask, many[1].shown.mask)
    assert len(two) == len(one)
