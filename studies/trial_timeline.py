"""A trial of a study, tick by tick: what was done, when, and why it failed; and the same in 3D for a browser."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from hearth.analysis.episode_figure import ticks_of
from hearth.challenges.episodes import Record
from hearth.challenges.tasks import Task
from hearth.homes.library import load_graph
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failure_words import sentence
from hearth.schemas.optional_libraries import library
from hearth.schemas.program import Program, Step
from hearth.simulation.engine import Execution
from hearth.simulation.world.home import Home


@dataclass(frozen=True)
class Act:
    """An attempt of one character.

    Attributes:
        agent: 0 is the person, 1 the helper.
        step: the attempt.
        failure: why it failed, in words; "" if it did not.
    """

    agent: int
    step: Step
    failure: str


@dataclass(frozen=True)
class Moment:
    """A tick of a trial.

    Attributes:
        tick: from 0.
        seconds: when the person decided, since the trial was begun; None if that is not known.
        acts: the attempts; a character that waited has none.
        shown: the step of the 3D replay that shows the home after this tick.
    """

    tick: int
    seconds: float | None
    acts: tuple[Act, ...]
    shown: int


def timeline(task: Task, record: Record, times: Sequence[float], knowledge: Knowledge) -> tuple[Home, list[Moment]]:
    """Return the home of a trial, and its ticks."""
    start, ticks = ticks_of(task, record, knowledge)
    found: list[Moment] = []
    shown = 0
    for number, tick in enumerate(ticks):
        acts = []
        for agent, step in sorted(tick.instructions.items()):
            failure = tick.failures.get(agent)
            acts.append(Act(agent, step, sentence(failure, code=False) if failure else ""))
        shown += any(not act.failure for act in acts)
        seconds = times[number] if number < len(times) else None
        found.append(Moment(number, seconds, tuple(acts), shown))
    return start.home, found


def replayed(task: Task, record: Record, knowledge: Knowledge, title: str = "") -> Execution:
    """Return a trial as the execution of a program: failed attempts are left out."""
    start, ticks = ticks_of(task, record, knowledge)
    steps, worlds = [], [start]
    for tick in ticks:
        done = [step for agent, step in sorted(tick.instructions.items()) if agent not in tick.failures]
        if done:
            steps += [replace(step, joins=place > 0) for place, step in enumerate(done)]
            worlds.append(tick.world)
    return Execution(Program(title=title, steps=tuple(steps)), tuple(worlds))


def replay_data(task: Task, record: Record, knowledge: Knowledge) -> dict[str, Any]:
    """Return the browser player's input: `home`, the shapes of the home, and `run`, the differences tick by tick.

    Raises:
        HearthError: MISSING_FILE: libraries for pictures are not installed.
    """
    library("trimesh")
    from hearth.rendering.film.replay_3d import home_shapes, run_shapes
    from hearth.rendering.scene.home_geometry import with_geometry

    place = with_geometry(load_graph(task.home, knowledge), task.home, knowledge).graph
    return {
        "home": home_shapes(place, knowledge),
        "run": run_shapes(replayed(task, record, knowledge), place, knowledge),
    }
