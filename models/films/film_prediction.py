"""A film in: its clips, steps with times, and the program that runs in a home."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hearth.grounding.environments.sampling import sample
from hearth.models.films.clip_data import Clip, Clips
from hearth.models.films.film_programs import FilmProgram, described, followed
from hearth.models.films.mask_clip_model import TrainedSeenModel
from hearth.models.films.step_order import START
from hearth.models.interface import Steps
from hearth.rendering.film.clips import FRAMES, RATE
from hearth.repair.runnable_predictions import complete
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import Program
from hearth.simulation.engine import Execution, run
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

APART = 2
"""Frames from the middle of a clip to the middle of the next one."""


@dataclass(frozen=True, slots=True)
class FilmShown:
    """The results for one film.

    Attributes:
        clips: how many two-second clips it was cut into.
        seen: the steps that are seen, and the clips in which they begin.
        times: seconds from the film's start at which they begin.
        execution: of the program that runs in the home.
        failure: why nothing runs; None where something does.
    """

    clips: int
    seen: FilmProgram
    times: tuple[float, ...]
    execution: Execution
    failure: Failure | None


def cut(masks: NDArray[np.uint16]) -> Clips:
    """Return a film as clips: one every `APART` frames, whatever is done in it.

    Raises:
        HearthError: BAD_ARGUMENT, if it is shorter than a clip.
    """
    firsts = range(0, len(masks) - FRAMES + 1, APART)
    if not firsts:
        message = f"a film of {len(masks)} frames is shorter than a clip, which has {FRAMES}"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=f"a film of {FRAMES / RATE:g} seconds or more")
    return Clips(("film",), [masks], tuple(Clip(0, first, START, "", 0) for first in firsts), FRAMES)


def show_film(trained: TrainedSeenModel, masks: NDArray[np.uint16], home: Home, seed: int = 0) -> FilmShown:
    """Name the steps of a film, and follow it with the engine in a home that has the film's things.

    Args:
        trained: a classifier of clips.
        masks: (T, H, W) class numbers, `RATE` frames a second.
        home: where the program runs; an environment is drawn in which the steps can be done.
        seed: of the environment.
    """
    clips = cut(masks)
    (found,) = trained.readings(clips)
    moves = found.moves(trained.order)
    seen = described(found.scores, found.instructions, moves)
    world = _world(seen.steps, home, seed)
    program = followed(found.scores, found.instructions, world, moves)
    times = tuple(round((clips.clips[number].first + FRAMES // 2) / RATE, 2) for number in program.starts)
    execution = run(world, Program(steps=program.steps))
    failure = None if program.steps else Failure(Code.NOT_UNDERSTOOD, expected="a program", actual="no step that runs")
    return FilmShown(len(clips), program, times, execution, failure)


def _world(steps: Steps, home: Home, seed: int) -> World:
    """Return a world in which some steps can be done, else the world in which the repairable steps begin."""
    start = World.start(home)
    completion = complete(steps, start, home.knowledge)
    kept = Program(steps=completion.execution.program.unbound().steps or steps)
    wanted = replace(kept, steps=steps)
    for program in (wanted, kept):
        drawn = sample(program, home, seed, "film") if program.steps else None
        if isinstance(drawn, tuple):
            return drawn[0].world
    return start
