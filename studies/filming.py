"""Films of what is judged: small, quickened, by the camera that sees the step best."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from hearth.analysis.episode_drawing import ticks_of
from hearth.challenges.episodes import Known
from hearth.challenges.tasks import Task
from hearth.homes.library import load_graph
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import Program
from hearth.simulation.engine import Execution
from hearth.simulation.world.home import Home
from hearth.storage.names import inside
from hearth.studies.judged_films import JudgedFilm
from hearth.studies.judged_programs import execution_in, program_of
from hearth.studies.study_trials import record_of

SIZE, RATE = (320, 240), 5.0
"""Width and height in pixels, and pictures a second."""

QUICK = {True: 4.0, False: 2.0}
"""How much faster than life: episodes, and programs."""

FOLDER, SUFFIX = "films", ".webm"


@dataclass(frozen=True)
class Shoot:
    """A film that is to be made.

    Attributes:
        film: of what.
        task: of an episode; None of a program.
        seed: of the study.
        folder: gets the film.
        known: gives the knowledge.
    """

    film: JudgedFilm
    task: Task | None
    seed: int
    folder: Path
    known: Known


def film_path(folder: Path, film: JudgedFilm) -> Path:
    """Where a film of a study's folder is."""
    return inside(folder, f"{FOLDER}/{film.name}{SUFFIX}")


def shoot(job: Shoot) -> Path:
    """Make a film, unless it is there.

    Raises:
        HearthError: NOT_RENDERED: its program does not run; MISSING_FILE: libraries for pictures are not installed.
    """
    from hearth.rendering.film.snapshots import AUTO, trajectory_of
    from hearth.rendering.film.video import record
    from hearth.rendering.scene.variation import PLAIN
    from hearth.rendering.scene.with_geometry import with_geometry

    path = film_path(job.folder, job.film)
    if path.exists():
        return path
    known = job.known()
    place = with_geometry(load_graph(job.film.home, known), job.film.home, known).graph
    variation = replace(PLAIN, seed=job.seed, speed=QUICK[job.task is not None])
    trajectory = trajectory_of(_execution(job, known), place, known, variation=variation)
    made = path.parent / path.stem
    made.mkdir(parents=True, exist_ok=True)
    done = record(trajectory, place, made, AUTO, size=SIZE, fps=RATE, suffixes=(SUFFIX,))
    done.files[0].replace(path)
    made.rmdir()
    return path


def _execution(job: Shoot, knowledge: Knowledge) -> Execution:
    if job.task is not None:
        return _episode(job, knowledge)
    home = Home.from_graph(load_graph(job.film.home, knowledge), job.film.home, knowledge)
    found = execution_in(program_of(job.film), home, job.seed)
    if found is None:
        raise HearthError.of(Code.NOT_RENDERED, f"the program of film {job.film.name} does not run")
    return found


def _episode(job: Shoot, knowledge: Knowledge) -> Execution:
    """An episode as the execution of a program: what was tried and failed is left out."""
    assert job.task is not None
    start, ticks = ticks_of(job.task, record_of(job.film.content), knowledge)
    steps, worlds = [], [start]
    for tick in ticks:
        done = [step for agent, step in sorted(tick.instructions.items()) if agent not in tick.failures]
        if done:
            steps += [replace(step, joins=place > 0) for place, step in enumerate(done)]
            worlds.append(tick.world)
    return Execution(Program(title=job.film.about, steps=tuple(steps)), tuple(worlds))
