"""Films to judge: small, accelerated, by the camera that sees the step best; or replays for a browser's 3D player."""

from dataclasses import dataclass, replace
from pathlib import Path

from hearth.challenges.episodes import Known
from hearth.challenges.tasks import Task
from hearth.homes.library import load_graph
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.optional_libraries import library
from hearth.simulation.engine import Execution
from hearth.simulation.world.home import Home
from hearth.storage.files import write_json
from hearth.storage.names import inside
from hearth.studies.films_to_judge import JudgedFilm
from hearth.studies.programs_to_judge import execution_in, program_of
from hearth.studies.study import FILM, REPLAY
from hearth.studies.study_trials import record_of
from hearth.studies.trial_timeline import replayed

SIZE, RATE = (320, 240), 5.0
"""Width and height in pixels, and pictures a second."""

QUICK = {True: 4.0, False: 2.0}
"""Acceleration of films: of episodes, and of programs."""

FOLDERS = {FILM: ("films", ".webm"), REPLAY: ("replays", ".json")}
"""The folder, and the ending of the files, of films and of replays."""


@dataclass(frozen=True)
class Shoot:
    """A film that is to be made.

    Attributes:
        film: the film's content.
        task: of an episode; None of a program.
        seed: of the study.
        folder: gets the film.
        known: gives the knowledge.
        shown: as a film or as a replay.
    """

    film: JudgedFilm
    task: Task | None
    seed: int
    folder: Path
    known: Known
    shown: str = FILM


def film_path(folder: Path, film: JudgedFilm, shown: str = FILM) -> Path:
    """Return where a film, or a replay, of a study's folder is."""
    place, ending = FOLDERS[shown]
    return inside(folder, f"{place}/{film.name}{ending}")


def shoot(job: Shoot) -> Path:
    """Make a film or a replay, unless it is there.

    Raises:
        HearthError: NOT_RENDERED: its program does not run; MISSING_FILE: libraries for pictures are not installed.
    """
    from hearth.rendering.scene.home_geometry import with_geometry

    path = film_path(job.folder, job.film, job.shown)
    if path.exists():
        return path
    known = job.known()
    place = with_geometry(load_graph(job.film.home, known), job.film.home, known).graph
    path.parent.mkdir(parents=True, exist_ok=True)
    if job.shown == REPLAY:
        _write_replay(job, place, known, path)
    else:
        _record(job, place, known, path)
    return path


def _write_replay(job: Shoot, place: EnvironmentGraph, known: Knowledge, path: Path) -> None:
    """Write the browser player's input: `home`, the shapes of the home, and `run`, the differences tick by tick."""
    from hearth.rendering.film.replay_3d import home_shapes, run_shapes

    library("trimesh")
    write_json(path, {"home": home_shapes(place, known), "run": run_shapes(_execution(job, known), place, known)})


def _record(job: Shoot, place: EnvironmentGraph, known: Knowledge, path: Path) -> None:
    from hearth.rendering.film.execution_keyframes import trajectory_of
    from hearth.rendering.film.execution_pictures import AUTO
    from hearth.rendering.film.video import record
    from hearth.rendering.scene.film_variation import PLAIN

    variation = replace(PLAIN, seed=job.seed, speed=QUICK[job.task is not None])
    trajectory = trajectory_of(_execution(job, known), place, known, variation=variation)
    made = path.parent / path.stem
    made.mkdir(parents=True, exist_ok=True)
    done = record(trajectory, place, made, AUTO, size=SIZE, fps=RATE, suffixes=(path.suffix,))
    done.files[0].replace(path)
    made.rmdir()


def _execution(job: Shoot, knowledge: Knowledge) -> Execution:
    if job.task is not None:
        return replayed(job.task, record_of(job.film.content), knowledge, job.film.about)
    home = Home.from_graph(load_graph(job.film.home, knowledge), job.film.home, knowledge)
    found = execution_in(program_of(job.film), home, job.seed)
    if found is None:
        raise HearthError.of(Code.NOT_RENDERED, f"the program of film {job.film.name} does not run")
    return found
