"""Programs of films: without a home by what clips look like, with the engine by what can be done."""

from __future__ import annotations

import numpy as np
import pytest

import hearth
from hearth.models.films.clip_data import Instruction
from hearth.models.films.film_programs import NO_STEPS, Filter, alone, described, even_moves, followed
from hearth.schemas.program import Program

DONE = (
    Instruction("Walk", ("sofa",)),
    Instruction("Sit", ("sofa",)),
    Instruction("StandUp", ()),
    Instruction("Open", ("fridge",)),
    Instruction("Walk", ("fridge",)),
)


def scores(sequence, sure=6.0):
    found = np.zeros((len(sequence), len(DONE)), np.float32)
    found[np.arange(len(sequence)), sequence] = sure
    return found


def names(program):
    return [(step.action, *(ref.name for ref in step.objects)) for step in program.steps]


@pytest.fixture(scope="module")
def world():
    return hearth.World.start(hearth.home("maple"))


def test_what_is_clear_is_read_alike_by_both(world):
    clear = scores([0, 0, 0, 1, 1, 2, 4, 4, 3, 3])
    expected = [("Walk", "sofa"), ("Sit", "sofa"), ("StandUp",), ("Walk", "fridge"), ("Open", "fridge")]
    assert names(described(clear, DONE)) == expected
    assert names(followed(clear, DONE, world)) == names(alone(clear, DONE)) == expected
    assert described(clear, DONE).starts == followed(clear, DONE, world).starts == (0, 3, 5, 6, 8)


def test_one_odd_clip_in_a_walk_is_not_an_instruction(world):
    odd = scores([0, 0, 0, 3, 0, 0, 1, 1])
    odd[3] = 0
    odd[3, 3] = 1.0
    assert names(described(odd, DONE)) == names(followed(odd, DONE, world)) == [("Walk", "sofa"), ("Sit", "sofa")]


def test_what_cannot_be_done_is_not_what_is_seen(world):
    """Standing up before sitting: the clips say so, and the engine does not believe it."""
    unlikely = scores([0, 0, 2, 2, 1, 1])
    assert ("StandUp",) in names(described(unlikely, DONE))
    program = followed(unlikely, DONE, world)
    assert ("StandUp",) not in names(program)[:2]
    assert hearth.run(world, Program(steps=program.steps)).failure is None


@pytest.mark.parametrize("seed", range(20))
def test_whatever_is_seen_the_program_runs(world, seed):
    noise = np.random.default_rng(seed).normal(0, 5, (12, len(DONE))).astype(np.float32)
    program = followed(noise, DONE, world, even_moves(len(DONE), 1.0), Filter(beam=4))
    assert hearth.run(world, Program(steps=program.steps)).failure is None


def test_a_step_that_no_clip_shows_is_inserted(world):
    """Only the opening may be seen: without repairs there is nothing to do."""
    only, seen = DONE[3:4], np.zeros((4, 1), np.float32)
    assert followed(seen, only, world, how=Filter(repaired=0)) == NO_STEPS
    program = followed(seen, only, world)
    assert names(program) == [("Walk", "fridge"), ("Open", "fridge")] and program.starts == (0, 0)
    assert hearth.run(world, Program(steps=program.steps)).failure is None
    assert followed(seen, only, world, how=Filter(inserted=99.0)) == NO_STEPS


def test_no_clips_no_program(world):
    assert described(scores([]), DONE) == followed(scores([]), DONE, world) == alone(scores([]), DONE) == NO_STEPS


def test_the_order_of_steps_decides_between_what_looks_alike(world):
    """Sit and stand up look alike in the second half: who sits does not sit down again."""
    alike = scores([0, 0, 1, 1, 1, 2, 2])
    alike[5:, 1] = 6.1
    moves = even_moves(len(DONE), 1.0)
    moves[1, 2] = -3.0
    assert names(described(alike, DONE, moves))[-1] == ("StandUp",)
    assert names(described(alike, DONE))[-1] == ("Sit", "sofa")
