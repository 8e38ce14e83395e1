"""The films that people judge: of episodes by people and agents, or of programs written for descriptions."""

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import orjson

from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episodes import Record
from hearth.challenges.result_files import episode_data, episode_of
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import rng
from hearth.storage.input_files import read_input
from hearth.studies.study import Study
from hearth.studies.study_trials import tasks_of


@dataclass(frozen=True, slots=True)
class JudgedFilm:
    """A film that is judged.

    Attributes:
        item: number of its task or program.
        condition: whose it is, a condition's name.
        name: of its file.
        group: the group of compared films: the condition, or the band of a program.
        about: the text that people read next to it: the goal, or the description.
        home: where it is.
        measure: its own score: the ticks of an episode, or the normalised LCS of a program.
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
        """Return the film as the file of films has it."""
        return asdict(self)


def films_of(data: Any, file: str) -> tuple[JudgedFilm, ...]:
    """Return the films of a list, the inverse of `JudgedFilm.as_json`; the list may be a stranger's.

    Raises:
        HearthError: BAD_JSON with the number of the film.
    """
    if not isinstance(data, list):
        raise HearthError.of(Code.BAD_JSON, "it is not a list of films", file=file, suggestion=REMEDY)
    found = []
    for number, each in enumerate(data):
        if fault := _fault_of(each):
            raise HearthError.of(Code.BAD_JSON, f"film {number}: {fault}", file=file, suggestion=REMEDY)
        found.append(JudgedFilm(**each))
    if len({(film.item, film.condition) for film in found}) < len(found):
        raise HearthError.of(Code.DUPLICATE, "two films are of one task under one condition", file=file)
    return tuple(found)


REMEDY = "`study prepare STUDY --out DIR` makes it"

_NAME = re.compile(r"[0-9]{3,6}-[a-z][a-z0-9_-]{0,59}")
"""Names of films' files."""

_MOST = {"condition": 60, "name": 70, "group": 60, "about": 10_000, "home": 200}
"""Characters of texts."""


def _fault_of(film: Any) -> str:
    """Return the fault of a film as JSON; "" if there is none."""
    if not isinstance(film, dict) or film.keys() != {each.name for each in fields(JudgedFilm)}:
        return "it has other keys than a film"
    for name, most in _MOST.items():
        if not isinstance(film[name], str) or len(film[name]) > most:
            return f"`{name}` is not a text of at most {most:,} characters"
    if not _NAME.fullmatch(film["name"]):
        return "`name` is not a number and a name"
    if not isinstance(film["item"], int) or isinstance(film["item"], bool) or not 0 <= film["item"] < 100_000:
        return "`item` is not a number of a task"
    if not isinstance(film["measure"], (int, float)) or not math.isfinite(film["measure"]):
        return "`measure` is not a number"
    return _content_fault(film["content"])


def _content_fault(content: Any) -> str:
    if isinstance(content, list):
        few = len(content) <= 10_000 and all(isinstance(line, str) and len(line) <= 1_000 for line in content)
        return "" if few else "`content` is not a program"
    return "" if isinstance(content, dict) and episode_of(content) else "`content` is neither program nor episode"


def of_episodes(
    study: Study, people: Mapping[str, Sequence[Record]], agent: Mapping[str, Record], titles: Callable[[str], str]
) -> Iterator[JudgedFilm]:
    """Films of every task by a person, one drawn of those who did it, and by the human-like agent (thesis B.4.3).

    Args:
        study: the judges'.
        people: people's records, by task.
        agent: the human-like agent's records, by task.
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
    """Return a task's goal as its judges read it: each predicate with its count."""
    task = next(each for each in tasks_of(study) if each.id == task_id)
    grammar = challenge(task.challenge).grammar
    titles = " and ".join(grammar.sets[name].asked for name in task.sets)
    return f"{titles}: " + ", ".join(f"{number} x {name}" for name, number in grammar.written(task.goal).items())


def read_films(path: Path) -> tuple[JudgedFilm, ...]:
    """Return the films of a study's folder.

    Raises:
        HearthError: MISSING_FILE: they were not prepared; BAD_JSON with the number of the film.
    """
    try:
        return films_of(orjson.loads(read_input(path)), str(path))
    except orjson.JSONDecodeError as error:
        raise HearthError.of(Code.BAD_JSON, f"not JSON: {error}", file=str(path), suggestion=REMEDY) from error
