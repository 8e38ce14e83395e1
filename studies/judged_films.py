"""What people judge: films of episodes by people and agents, or of programs that were written for descriptions."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from hearth.challenges.definition import challenge
from hearth.challenges.episodes import Record
from hearth.challenges.result_files import episode_data
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import rng
from hearth.studies.study import Study
from hearth.studies.study_trials import tasks_of


@dataclass(frozen=True, slots=True)
class JudgedFilm:
    """A film that is judged.

    Attributes:
        item: number of its task or program.
        condition: whose it is, a condition's name.
        name: of its file.
        group: what films are compared by: the condition, or the band of a program.
        about: what people read beside it: the goal, or the description.
        home: where it is.
        measure: what it is worth by itself: the ticks of an episode, or the normalised LCS of a program.
        content: the episode's record, or the program's lines.
    """

    item: int
    condition: str
    name: str
    group: str
    about: str
    home: str
    measure: float
    content: Any

    def as_json(self) -> dict[str, Any]:
        """As the file of films has it."""
        return asdict(self)


def films_of(data: Sequence[Mapping[str, Any]]) -> tuple[JudgedFilm, ...]:
    """The inverse of `JudgedFilm.as_json`."""
    return tuple(JudgedFilm(**each) for each in data)


def of_episodes(
    study: Study, people: Mapping[str, Sequence[Record]], agent: Mapping[str, Record], titles: Callable[[str], str]
) -> Iterator[JudgedFilm]:
    """Films of every task by a person, one drawn of those who did it, and by the human-like agent (thesis B.4.3).

    Args:
        study: the judges'.
        people: what people did, by task.
        agent: what the human-like agent did, by task.
        titles: a task's goal in words.

    Raises:
        HearthError: EMPTY: nobody did a task.
    """
    for item, task in enumerate(tasks_of(study)):
        for condition in study.conditions:
            done = people.get(task.id, ()) if condition.actor == "person" else [agent[task.id]]
            if not done:
                raise HearthError.of(Code.EMPTY, f"nobody of `{study.films and study.films.study}` did {task.id}")
            record = rng(study.seed, "film", task.id).choice(list(done))
            name = f"{item:03d}-{condition.name}"
            length = float(record.metrics["length"])
            about = titles(task.id)
            yield JudgedFilm(item, condition.name, name, condition.name, about, task.home, length, episode_data(record))


def goal_in_words(study: Study, task_id: str) -> str:
    """A task's goal as its judges read it: each predicate with its count."""
    task = next(each for each in tasks_of(study) if each.id == task_id)
    grammar = challenge(task.challenge).grammar
    titles = " and ".join(grammar.sets[name].asked for name in task.sets)
    return f"{titles}: " + ", ".join(f"{number} x {name}" for name, number in grammar.written(task.goal).items())


def read_films(path: Path) -> tuple[JudgedFilm, ...]:
    """The films of a study's folder.

    Raises:
        HearthError: MISSING_FILE: they were not prepared.
    """
    from hearth.storage.files import read_json

    data = read_json(path)
    if not isinstance(data, list):
        remedy = "`study prepare STUDY --out DIR` makes it"
        raise HearthError.of(Code.MISSING_FILE, "there is no list of films", file=str(path), suggestion=remedy)
    return films_of(data)
