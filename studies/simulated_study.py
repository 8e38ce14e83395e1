"""A study simulated with all that it needs: the other study that it is about, the agent's episodes, the films."""

from collections.abc import Callable
from pathlib import Path

from hearth.challenges.episodes import Known
from hearth.storage.lock import locked
from hearth.storage.names import inside
from hearth.storage.parallel import Seen, unseen
from hearth.studies.study import EPISODES, Study
from hearth.studies.study_folder import (
    Collected,
    alone_lengths,
    first_records,
    opened,
    prepare_films,
    references,
    related,
)  # fmt: skip
from hearth.studies.study_simulation import Crowd, simulate

Watch = Callable[[str], Seen]


def simulated_study(
    study: Study,
    crowd: Crowd,
    out: Path,
    known: Known,
    workers: int = 1,
    watch: Watch = lambda what: unseen,
    beside: Path | None = None,
) -> Collected:
    """Simulate a study into the folder of its name in `out`, and first, if need be, the study that it is about.

    Args:
        study: the design.
        crowd: the people that take part.
        out: gets a folder for each study.
        known: gives the knowledge.
        workers: processes.
        watch: for the name of a task, the function that is called with the number done.
        beside: the folder of other studies' files.

    Raises:
        HearthError: LOCKED, if another process simulates into the same folder; UNWRITABLE; errors of `simulate`.
    """
    folder = inside(out, study.name)
    with locked(folder, "simulating"):
        return _simulated(study, crowd, out, folder, known, workers, watch, beside)


def _simulated(
    study: Study, crowd: Crowd, out: Path, folder: Path, known: Known, workers: int, watch: Watch, beside: Path | None
) -> Collected:
    other = related(study, beside)
    people = simulated_study(other, crowd, out, known, workers, watch, beside).records() if other else {}
    results = references(study, folder, known, workers, lambda name: watch(f"{study.name}: agent, {name}"))
    films = []
    if study.films is not None:
        agent = first_records(results["alone"]) if study.films.of == EPISODES else {}
        films = prepare_films(study, folder, known(), people, agent)
    seen = watch(f"{study.name}: simulated people")
    simulate(study, crowd, folder, known, films, alone_lengths(results), workers, seen)
    return opened(folder, known)
