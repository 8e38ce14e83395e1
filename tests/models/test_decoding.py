"""Decoding with the engine in the loop: with random scores, too, every program parses and runs."""

from __future__ import annotations

from collections import Counter
from itertools import islice
from random import Random

import numpy as np
import pytest
from oracles.scorers import BY_ACTION, BY_OBJECT, WHOLE, Knowing, RandomScorer

from hearth.models.decoding.equal_scores import best_places
from hearth.models.decoding.next_step_options import NONE, Grammar, Partial
from hearth.models.decoding.search import Search, Start, decode, numbered
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.scoring.metrics.executability import executability
from hearth.scoring.metrics.parsability import parsability
from hearth.simulation.actions.legal import legal
from hearth.simulation.engine import act, run, tick, together
from hearth.simulation.rules import DEFAULT
from hearth.simulation.world.world import World

SEARCHES = {
    "greedy": Search(longest=30),
    "beam": Search(beam=3, longest=8),
    "samples": Search(temperature=1.0, longest=20),
}


@pytest.fixture(scope="module")
def actions(knowledge):
    return [name for name, action in knowledge.actions.items() if action.executed]


def starts_of(worlds):
    return [Start(world, number, Random(number)) for number, world in enumerate(worlds)]


@pytest.mark.parametrize("order", [BY_OBJECT, BY_ACTION, WHOLE], ids=["object first", "action first", "whole steps"])
@pytest.mark.parametrize("search", SEARCHES.values(), ids=SEARCHES)
def test_random_scores_write_programs_that_parse_and_run(environments, actions, knowledge, order, search):
    programs = decode(RandomScorer(actions, order), starts_of(environments), search)
    assert len(programs) == 200
    for world, steps in zip(environments, programs, strict=True):
        assert not steps or parsability(steps, knowledge).parsable
        assert not steps or executability(steps, world).executable
    if order != WHOLE:
        assert all(programs)
        assert len({step.action for steps in programs for step in steps}) > 15


def test_free_decoding_does_not(environments, actions):
    """The mask is what makes programs run."""
    programs = decode(RandomScorer(actions), starts_of(environments), Search(constrained=False))
    assert sum(executability(s, w).executable for w, s in zip(environments, programs, strict=True)) < 20


def test_options_are_what_the_engine_does_and_the_score_affords(environments, knowledge):
    """Against the engine and the scorer, instruction by instruction."""
    counts = []
    for number, world in enumerate(environments[::20]):
        options, index = Grammar(world.home).options(world), world.home.index
        every = list(islice(legal(world), 20_000))
        each = {action: [step for step in every if step.action == action] for action in legal(world).masks}
        steps = [step for found in each.values() for step in Random(number).sample(found, min(8, len(found)))]
        sound = [executability([step], world).executable for step in steps]
        assert [options.allows(s.action, [index[ref.node] for ref in s.objects]) for s in steps] == sound
        counts.append((sum(sound), len(sound)))
    assert all(some > 0 for some, _ in counts)
    assert sum(some < all_ for some, all_ in counts) > 5


def test_a_choice_of_one_part_leaves_the_others_some(environments):
    for world in environments:
        options = Grammar(world.home).options(world)
        for action, masks in options.masks.items():
            assert all(masks)
            for node in [n for n in range(len(world.home)) if masks and masks[0] >> n & 1][:5]:
                assert action in options.actions(Partial(first=node))
                assert len(masks) < 2 or options.second(Partial(action, node))
            if not masks:
                assert action in options.actions(Partial(first=NONE))


def test_a_program_does_not_depend_on_its_neighbours(environments, actions):
    starts = starts_of(environments[:12])
    for name, search in SEARCHES.items():
        scorer = RandomScorer(actions)
        whole = decode(scorer, starts, search)
        again = [Start(each.world, each.given, Random(each.given)) for each in starts]
        assert [decode(scorer, [each], search)[0] for each in again[::-1]] == whole[::-1] or name == "samples"


def test_samples_differ_by_their_generator_alone(environments, actions):
    def sampled(seed):
        return decode(RandomScorer(actions), [Start(environments[3], 1, Random(seed))], Search(temperature=1.0))

    assert sampled(5) == sampled(5)
    assert len({tuple(sampled(seed)[0]) for seed in range(6)}) > 3


def test_programs_end(environments, actions):
    """A model that never ends is ended; one that only walks is made to do something else."""
    long = decode(RandomScorer(actions, end=-1e9), starts_of(environments[:20]), Search(longest=25))
    assert {len(steps) for steps in long} == {25}
    walking = decode(Walking(actions), starts_of(environments[:5]), Search(longest=30, free_moves=4, repeats=2))
    for steps in walking:
        assert max(Counter(steps).values()) <= 2
        assert all({step.action for step in steps[n : n + 5]} - {"Walk"} for n in range(len(steps) - 4))


class Walking(RandomScorer):
    """Wants to walk for ever."""

    def _score(self, asked, part):
        scores = super()._score(asked, part)
        if part is Part_ACTION:
            scores.values[self.actions.index("Walk")] = 99.0
        if part is self.order[0]:
            scores.values[-1] = -1e9
        return scores


Part_ACTION = BY_OBJECT[1]


@pytest.mark.parametrize("order", [BY_OBJECT, BY_ACTION], ids=["object first", "action first"])
def test_what_a_model_is_sure_of_is_written(environments, actions, order):
    """The search finds a program that can be done, whatever the order of the parts."""
    for world in environments[:10]:
        (program,) = decode(RandomScorer(actions), [Start(world, 7)], Search(longest=12))
        for beam in (1, 3):
            assert decode(Knowing(actions, program, order), [Start(world, 0)], Search(beam=beam)) == [program]


def test_a_wider_beam_finds_a_better_program(environments, actions):
    def total(world, number, beam):
        scorer = Adding(actions)
        decode(scorer, [Start(world, number)], Search(beam=beam, longest=6))
        return scorer

    assert total(environments[0], 0, 4).asked > total(environments[0], 0, 1).asked


class Adding(RandomScorer):
    """Counts the programs that it was asked about."""

    asked = 0

    def score(self, asked, part):
        self.asked += len(asked)
        return super().score(asked, part)


def test_nodes_are_numbered_by_class(environments):
    a, b = (Step("Walk", (ObjectRef("cup", 1, node),)) for node in (9, 4))
    assert [step.objects[0].instance for step in numbered([a, b, a])] == [1, 2, 1]


def test_too_few_objects_are_a_typed_failure(environments, actions, knowledge):
    """For each action, with each wrong number of objects, by every way into the engine."""
    world = environments[0]
    ref = ObjectRef("fridge", 1, world.home.ids[0])
    for action in actions:
        for count in {0, 1, 2, 3} - {knowledge.arity[action]}:
            step = Step(action, (ref,) * count)
            for found in (act(world, step), together(world, [step], DEFAULT), tick(world, {0: step})[1][0]):
                assert isinstance(found, Failure)
                assert found.code is Code.WRONG_ARITY
            ran = run(world, Program(steps=(step,)))
            assert ran.failure is not None and ran.failure.code is Code.WRONG_ARITY
            assert not executability([step], world).executable


def test_a_world_in_which_nothing_can_be_done_ends_the_program(environments, actions):
    world = environments[0]
    bare = World.start(world.home.copy())
    scorer = RandomScorer([])
    assert decode(scorer, [Start(bare, 0)], Search()) == [()]


def test_rounding_does_not_choose_between_equal_scores():
    values = np.array([0.1, 0.7, 0.7, -np.inf, 0.7, 0.2])
    for seed in range(20):
        rounded = values + np.random.default_rng(seed).normal(0, 1e-6, len(values))
        assert best_places(rounded) == [1]
        assert best_places(rounded, 4) == [1, 2, 4, 5]
        assert best_places(rounded, 9) == [1, 2, 4, 5, 0]
    assert best_places(np.full(3, -np.inf), 2) == [0]
