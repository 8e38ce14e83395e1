"""Episodes as executions, so that the cameras of programs can film agents and people."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from hearth.schemas.program import Program, Step
from hearth.simulation.engine import Execution
from hearth.simulation.env import Tick
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.world import World


def execution_of(start: World, ticks: Sequence[Tick], title: str = "", rules: Rules = DEFAULT) -> Execution:
    """Return an episode as the execution of a program of its successful actions.

    Ticks in which no agent succeeded are left out: the world is the same after them.

    Args:
        start: the world at its start.
        ticks: all of them.
        title: of the program.
        rules: how actions were read.
    """
    steps: list[Step] = []
    worlds = [start]
    for tick in ticks:
        done = [step for number, step in sorted(tick.instructions.items()) if number not in tick.failures]
        if done:
            steps += [replace(step, joins=number > 0) for number, step in enumerate(done)]
            worlds.append(tick.world)
    return Execution(Program(title, steps=tuple(steps)), tuple(worlds), rules=rules)
