"""The preparation of a study with people: the agent's episodes in its tasks, and the films to judge."""

from pathlib import Path
from typing import Any

from hearth.challenges.episodes import Known
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.names import inside
from hearth.storage.parallel import Seen, spread, unseen
from hearth.studies.films_to_judge import read_films
from hearth.studies.judged_film_recording import Shoot, shoot
from hearth.studies.study import EPISODES, Study
from hearth.studies.study_folder import FILMS, Collected, first_records, prepare_films, references
from hearth.studies.study_trials import tasks_of


def prepared(
    study: Study,
    out: Path,
    known: Known,
    people: Collected | None = None,
    predictions: Path | None = None,
    workers: int = 1,
    seen: Seen = unseen,
) -> dict[str, Any]:
    """Make the files that a study needs in the folder of its name; existing ones are kept.

    Args:
        study: the design.
        out: gets the folder.
        known: gives the knowledge.
        people: the study whose people are filmed.
        predictions: a model's programs to be judged.
        workers: processes.
        seen: called with the number of films made.

    Raises:
        HearthError: BAD_ARGUMENT: films of people are to be made, and `people` is None, or they are simulated.
    """
    if people is not None and people.simulated:
        message = "the people there are simulated, and real ones would judge them as people"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="--people FOLDER of a server")
    folder = inside(out, study.name)
    folder.mkdir(parents=True, exist_ok=True)
    results = references(study, folder, known, workers)
    facts: dict[str, Any] = {"study": study.name, "out": str(folder)}
    facts["episodes"] = sum(len(each.records) for each in results.values())
    if study.films is None:
        return {**facts, "films": 0}
    if not (folder / FILMS).is_file() or predictions is not None:
        if study.films.of == EPISODES and people is None:
            remedy = f"--people FOLDER, where `{study.films.study}` is"
            raise HearthError.of(Code.BAD_ARGUMENT, "its films show people", suggestion=remedy)
        agent = first_records(results["alone"]) if "alone" in results else {}
        prepare_films(study, folder, known(), people.records() if people else {}, agent, predictions)
    films = read_films(folder / FILMS)
    tasks = tasks_of(study) if study.tasks else ()
    for film in films:
        if film.item >= study.items or isinstance(film.content, dict) != bool(tasks):
            message = f"film {film.name} is not of this study"
            raise HearthError.of(Code.BAD_JSON, message, file=str(folder / FILMS), suggestion="delete the file")
    jobs = [
        Shoot(film, tasks[film.item] if tasks else None, study.seed, folder, known, study.films.shown) for film in films
    ]
    made = list(spread(shoot, jobs, workers, seen))
    return {**facts, "films": len(made), "bytes": sum(path.stat().st_size for path in made)}
