"""Repairing in a small world; finds `repair_worlds` beside it."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from repair_worlds import small_world, steps_of

from hearth.repair.repair_loop import repair
from hearth.schemas.syntax import print_step


@pytest.fixture
def repaired():
    """Repairs a program in a small world; gives the result, its steps as text, and the names of the repairs.

    What the knowledge says of a repair has to be what was done: its entry is for that failure of that action.
    """

    def run(world: str, program: str, goal=(), **more):
        start = small_world(world)
        result = repair(steps_of(program), start, goal, start.home.knowledge, **more)
        if "handlers" not in more:
            for attempt in (one for one in result.attempts if one.after):
                row = start.home.knowledge.repairs[attempt.handler]
                assert row.code is attempt.failure.code
                assert not row.actions or attempt.before[attempt.step].action in row.actions
        return result, [print_step(step) for step in result.program.steps], [a.handler for a in result.attempts]

    return run
