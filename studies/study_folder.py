"""The folder of a study: its events, the episodes of the human-like agent, the films that are judged."""

from collections import defaultdict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hearth.challenges.episodes import Known, Record
from hearth.challenges.metrics import of_tasks
from hearth.challenges.result_files import Results, read
from hearth.challenges.suite_runs import run
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.files import write_json
from hearth.storage.names import inside
from hearth.storage.parallel import Seen, unseen
from hearth.studies.event_checks import check_events
from hearth.studies.events import FORMAT, FileLedger, Ledger, header_of, salted
from hearth.studies.films_to_judge import JudgedFilm, goal_in_words, of_episodes
from hearth.studies.programs_to_judge import judged_programs
from hearth.studies.study import EPISODES, Condition, Study
from hearth.studies.study_file import SHIPPED, named, study_of
from hearth.studies.study_progress import Conduct
from hearth.studies.study_trials import check_helpers, lineup_of, record_of, suite_of

EVENTS, FILMS, REFERENCES = "events.jsonl", "films.json", "references"


def header(study: Study, seed: int, drop_outs: int) -> dict[str, Any]:
    """Return the first line of a simulation's events; the study's whole text is in it."""
    return {"format": FORMAT, "study": study.text, "simulated": {"seed": seed, "drop_outs": drop_outs}}


@dataclass(frozen=True)
class Collected:
    """A study with all that was collected in it.

    Attributes:
        conduct: the study and its events.
        simulated: whether agents were in people's places.
        folder: where films and the agent's episodes are; None where there are none.
    """

    conduct: Conduct
    simulated: bool
    folder: Path | None = None

    @property
    def study(self) -> Study:
        """Return the design."""
        return self.conduct.study

    @property
    def ledger(self) -> Ledger:
        """Return the events."""
        return self.conduct.ledger

    def records(self, finished: bool = True) -> dict[str, list[Record]]:
        """Return people's records, by task; only of people who finished, unless all are asked for."""
        found = defaultdict(list)
        for person in self.ledger.streams():
            if not finished or self.conduct.standing(person).finished:
                for event in self.ledger.read(person):
                    if event.kind == "did" and "record" in event.data:
                        found[event.data["record"]["task"]].append(record_of(event.data["record"]))
        return dict(found)


def opened(folder: Path, known: Known) -> Collected:
    """Return the simulated study of a folder.

    Raises:
        HearthError: MISSING_FILE; BAD_JSON; every fault of the study.
    """
    first = header_of(folder / EVENTS)
    study = study_of(str(first.get("study")), str(folder / EVENTS), begun=True)
    simulated = first.get("simulated")
    if not isinstance(simulated, dict):
        raise HearthError.of(Code.BAD_JSON, "it does not say how it was simulated", file=str(folder / EVENTS))
    salt = salted(study.digest, str(simulated.get("seed")))
    conduct = Conduct(study, FileLedger(folder / EVENTS, first, salt), known)
    check_events(study, conduct.slots, conduct.ledger, str(folder / EVENTS))
    return Collected(conduct, True, folder)


def beside(collected: Collected) -> Collected | None:
    """Return the simulated study in the neighboring folder, with the lengths without a helper; None if absent."""
    name = collected.study.alone
    if not name or collected.folder is None:
        return None
    folder = inside(collected.folder.parent, name)
    return opened(folder, collected.conduct.known) if (folder / EVENTS).is_file() else None


def related(study: Study, files: Path | None) -> Study | None:
    """Return the study whose people another one needs: whom it films, or whose lengths are those alone.

    Args:
        study: the other one.
        files: a folder that may have its file, `NAME.yaml`; else one that comes with Hearth is meant.

    Raises:
        HearthError: MISSING_FILE: there is none of that name.
    """
    name = study.films.study if study.films and study.films.of == EPISODES else study.alone
    if not name:
        return None
    if files is not None and (path := inside(files, f"{name}.yaml")).is_file():
        return named(str(path))
    if name not in SHIPPED:
        raise HearthError.of(Code.MISSING_FILE, f"there is no study `{name}`", suggestion=f"put {name}.yaml next to it")
    return named(name)


def references(
    study: Study, folder: Path, known: Known, workers: int = 1, watch: Callable[[str], Seen] | None = None
) -> dict[str, Results]:
    """Return the human-like agent's results in the same tasks and conditions; results in the folder are kept.

    Args:
        study: whose tasks and conditions are meant.
        folder: of the study.
        known: gives the knowledge.
        workers: processes.
        watch: for the name of a condition, the function that is called with the number of episodes done.

    Returns:
        Condition -> results; episodes alone are in each.

    Raises:
        HearthError: MISSING_FILE: helpers ask networks, and the extra `models` is not installed.
    """
    if study.tasks is None:
        return {}
    check_helpers(study)
    (folder / REFERENCES).mkdir(parents=True, exist_ok=True)
    found: dict[str, Results] = {}
    for condition in (Condition("alone", "Alone"), *study.conditions):
        if condition.actor or (condition.name in found):
            continue
        out, seen = inside(folder / REFERENCES, f"{condition.name}.jsonl"), watch(condition.name) if watch else unseen
        alone = found.get("alone")
        suite = suite_of(study.tasks)
        found[condition.name] = run(suite, lineup_of(condition), study.repeats, out, known, workers, seen, alone)
    return found


def references_of(collected: Collected) -> dict[str, Results]:
    """Return the references that a study's folder has."""
    if collected.folder is None:
        return {}
    paths = sorted((collected.folder / REFERENCES).glob("*.jsonl"))
    return {path.stem: read(path) for path in paths}


def alone_lengths(results: Mapping[str, Results]) -> dict[str, float]:
    """Task -> mean ticks of the human-like agent alone."""
    return of_tasks(results["alone"].outcomes(False), "length") if "alone" in results else {}


def prepare_films(
    study: Study,
    folder: Path,
    knowledge: Knowledge,
    people: Mapping[str, list[Record]],
    agent: Mapping[str, Record],
    predictions: Path | None = None,
) -> list[JudgedFilm]:
    """Return the films to judge in the study's folder; see `judged_films`."""
    assert study.films is not None
    if study.films.of == EPISODES:
        films = list(of_episodes(study, people, agent, lambda task: goal_in_words(study, task)))
    else:
        films = judged_programs(study, knowledge, predictions)
    folder.mkdir(parents=True, exist_ok=True)
    write_json(folder / FILMS, [film.as_json() for film in films])
    return films


def first_records(results: Results) -> dict[str, Record]:
    """Return the agent's first record alone, by task."""
    return {each.task: each for each in results.records if not each.helped and each.seed == 0}
