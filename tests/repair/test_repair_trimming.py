"""Nothing that is not needed stays in a repaired program."""

from __future__ import annotations

import pytest
from repair_worlds import ROOMS, small_world, steps_of

from hearth.repair.repair_trimming import INSERTED, STAYING, resume, trim
from hearth.schemas.syntax import print_step
from hearth.simulation.engine import run
from hearth.simulation.rules import DEFAULT


def trimmed(world: str, program: str, inserted: set[int], goal=(), of=INSERTED) -> list[str]:
    """The program's steps after trimming; those of these numbers, from 0, are repairs, of this source."""
    repaired = steps_of(program)
    original = repaired.with_steps(s for n, s in enumerate(repaired.steps) if n not in inserted)
    execution = run(small_world(ROOMS + world), repaired)
    assert execution.failure is None
    kept = iter(range(len(original.steps)))
    sources = tuple(of if number in inserted else next(kept) for number in range(len(repaired.steps)))
    left, of_original = trim(original, execution, sources, goal, DEFAULT)
    assert [original.steps[n] for n in of_original if n >= 0] == [
        step for step, n in zip(left.program.steps, of_original, strict=True) if n >= 0
    ]
    return [print_step(step) for step in left.program.steps]


def test_a_repair_that_is_not_needed_goes_and_the_same_step_of_the_original_stays():
    world = "20 cup inside 1\n21 table inside 1"
    program = "[Walk] <cup> (1.20)\n[TurnTo] <cup> (1.20)\n[Walk] <table> (1.21)"
    assert trimmed(world, program, {1}) == ["[Walk] <cup> (1.20)", "[Walk] <table> (1.21)"]
    assert trimmed(world, program, {0}) == ["[TurnTo] <cup> (1.20)", "[Walk] <table> (1.21)"]
    assert trimmed(world, program, set()) == program.split("\n")


def test_no_walk_leads_to_where_the_last_one_went():
    world = "20 fridge CLOSED inside 1\n21 milk inside 20"
    program = "[Walk] <fridge> (1.20)\n[Open] <fridge> (1.20)\n[Walk] <fridge> (1.20)\n[Grab] <milk> (1.21)"
    assert trimmed(world, program, {0}) == program.split("\n")[:2] + program.split("\n")[3:]
    assert trimmed(world, program, set()) == program.split("\n"), "it did so before"


def test_what_is_opened_only_to_be_closed_again_stays_closed():
    world = "20 fridge CLOSED inside 1\n21 milk inside 1"
    program = "[Walk] <fridge> (1.20)\n[Open] <fridge> (1.20)\n[Close] <fridge> (1.20)\n[Walk] <milk> (1.21)"
    assert trimmed(world, program, {1}) == ["[Walk] <fridge> (1.20)", "[Walk] <milk> (1.21)"]
    assert trimmed(world, program, set()) == program.split("\n"), "the original does it"


def test_hands_end_up_as_they_were_left():
    world = "20 cat inside 1"
    program = "[Walk] <cat> (1.20)\n[Grab] <cat> (1.20)\n[Release] <cat> (1.20)"
    assert trimmed(world, program, {1, 2}) == ["[Walk] <cat> (1.20)"]
    assert trimmed(world, program, {2}) == program.split("\n")


@pytest.mark.parametrize("inserted", [{1}, {1, 2}, {2, 3}, {1, 2, 3}])
def test_a_repair_that_stays_is_not_removed(inserted):
    world = "20 cat inside 1"
    program = "[Walk] <cat> (1.20)\n[Find] <cat> (1.20)\n[Grab] <cat> (1.20)\n[Release] <cat> (1.20)"
    assert trimmed(world, program, inserted, of=STAYING) == program.split("\n")
    assert len(trimmed(world, program, inserted)) < 4


def test_running_on_gives_what_running_all_gives():
    world = small_world(ROOMS + "20 fridge CLOSED inside 1\n21 milk inside 20")
    program = steps_of("[Walk] <milk> (1.21)\n[Grab] <milk> (1.21)")
    longer = steps_of("[Walk] <milk> (1.21)\n[Open] <fridge> (1.20)\n[Grab] <milk> (1.21)\n[Sit] <milk> (1.21)")
    first = run(world, program)
    again = resume(first, longer, 1, DEFAULT)
    assert again == run(world, longer)
    assert again.failure.tick == 3
    assert again.worlds[1] is first.worlds[1]


def test_running_on_from_behind_the_end_runs_all():
    world = small_world(ROOMS + "20 fridge CLOSED inside 1")
    program = steps_of("[Grab] <fridge> (1.20)\n[Walk] <fridge> (1.20)\n[Open] <fridge> (1.20)")
    first = run(world, program)
    assert len(first.worlds) == 1
    for number in (1, 2, 3):
        assert resume(first, program, number, DEFAULT) == first
