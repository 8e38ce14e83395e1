"""A whole study with agents in people's places, by the code that people's trials go through.

It goes on where it was stopped, and ends with the same bytes for any number of workers.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import orjson

from hearth.agents.demonstration_goals import agreement
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episodes import Known, played
from hearth.challenges.result_files import episode_data
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import derive, rng
from hearth.storage.parallel import Seen, spread, unseen
from hearth.studies.assignment import Planned
from hearth.studies.events import FileLedger, salted
from hearth.studies.films_to_judge import JudgedFilm
from hearth.studies.simulated_people import (
    SECONDS_A_TICK,
    Impression,
    SimulatedPerson,
    answers,
    likeness,
    simulated_person,
)  # fmt: skip
from hearth.studies.study import PLAY, Study
from hearth.studies.study_folder import EVENTS, header
from hearth.studies.study_progress import CONSENT, DONE, EXIT, LEFT, PRACTICE, QUESTIONS, TUTORIAL, Conduct, Standing
from hearth.studies.study_trials import job_of, tasks_of


@dataclass(frozen=True, slots=True)
class Crowd:
    """The simulated people of a study.

    Attributes:
        seed: of all that they do.
        drop_outs: how many of them leave in the middle.
    """

    seed: int
    drop_outs: int


@dataclass(frozen=True, slots=True)
class Visit:
    """A simulated person who comes to a study.

    Attributes:
        number: of the person.
        place: that the person gets.
        trials: that the person does; fewer than there are if the person leaves.
    """

    number: int
    place: int
    trials: int


def visits(sizes: Sequence[int], crowd: Crowd) -> list[Visit]:
    """Return the visits to a study whose places have these numbers of trials, until every place is finished."""
    chooser = rng(crowd.seed, "drop-outs")
    leaving = set(chooser.sample(range(len(sizes)), min(crowd.drop_outs, len(sizes))))
    waiting = list(range(len(sizes)))
    found: list[Visit] = []
    while waiting:
        number, place = len(found), waiting.pop(0)
        trials = sizes[place]
        if number in leaving:
            trials = chooser.randrange(sizes[place])
            waiting.append(place)
        found.append(Visit(number, place, trials))
    return found


@dataclass(frozen=True, slots=True)
class Ahead:
    """A trial that a simulated person is to do; a job for another process."""

    study: Study
    planned: Planned
    person: SimulatedPerson
    known: Known


def simulate(
    study: Study,
    crowd: Crowd,
    folder: Path,
    known: Known,
    films: Sequence[JudgedFilm] = (),
    alone: dict[str, float] | None = None,
    workers: int = 1,
    seen: Seen = unseen,
) -> Conduct:
    """Let simulated people take part in a study until it is complete; all that they do is in the folder's events.

    Args:
        study: the design.
        crowd: the people that take part.
        folder: of the study; events that a stopped simulation had written are kept.
        known: gives the knowledge.
        films: the films to judge.
        alone: task -> ticks of the human-like agent alone, by which simulated people judge help.
        workers: processes.
        seen: called with the number of trials done.

    Raises:
        HearthError: BAD_ARGUMENT: the folder has another study or another simulation.
    """
    salt = salted(study.digest, str(crowd.seed))
    ledger = FileLedger(folder / EVENTS, header(study, crowd.seed, crowd.drop_outs), salt)
    clock = _Clock()
    conduct = Conduct(study, ledger, known, clock)
    people = visits([len(slot) for slot in conduct.slots], crowd)
    done = {salted(salt, f"person {each.number}"): each for each in people}
    before = {person: len([e for e in ledger.read(person) if e.kind == "did"]) for person in done}
    ahead = [
        Ahead(study, planned, simulated_person(crowd.seed, visit.number), known)
        for person, visit in done.items()
        for planned in conduct.slots[visit.place][before[person] : visit.trials]
    ]
    records = spread(play_ahead, ahead, workers, seen) if study.room == PLAY else iter(())
    judged = {(film.item, film.condition): film for film in films}
    for person, visit in done.items():
        way = _Way(conduct, clock, crowd, visit, judged, alone or {})
        way.go(person, records)
    return conduct


def play_ahead(ahead: Ahead) -> dict[str, Any]:
    """Return the record of a trial that a simulated person does."""
    record = played(job_of(ahead.study, ahead.planned, ahead.known, ahead.person))
    return dict(orjson.loads(orjson.dumps(episode_data(record))))


class _Clock:
    """The time of a simulation: seconds since the person joined."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


@dataclass(frozen=True, slots=True)
class _Way:
    """A simulated person's way through a study, one stage after another."""

    conduct: Conduct
    clock: _Clock
    crowd: Crowd
    visit: Visit
    films: dict[tuple[int, str], JudgedFilm]
    alone: dict[str, float]

    def go(self, person: str, records: Iterator[dict[str, Any]]) -> None:
        """Go on until the study is done, or the person leaves."""
        standing = self.conduct.join(person)
        if standing.place != self.visit.place:
            message = f"person {self.visit.number} got place {standing.place}, not {self.visit.place}"
            raise HearthError.of(Code.CONTRADICTION, message)
        while standing.stage not in (DONE, LEFT):
            self.clock.now = max([each.at for each in standing.events] or [0.0]) + 10.0
            standing = self._one(standing, records)
        self.clock.now = 0.0

    def _one(self, standing: Standing, records: Iterator[dict[str, Any]]) -> Standing:
        person, conduct = standing.person, self.conduct
        simple = {CONSENT: conduct.consent, TUTORIAL: conduct.read, PRACTICE: conduct.practised}
        if standing.stage in simple:
            return simple[standing.stage](person)
        if standing.stage in (QUESTIONS, EXIT):
            return conduct.answer(person, self._answers(standing))
        if standing.number == self.visit.trials:
            return conduct.leave(person, "simulated")
        if conduct.study.room != PLAY:
            self.clock.now += 30.0
            return conduct.watched(person, 30.0)
        record = next(records)
        seconds = len(record["actions"]) * SECONDS_A_TICK
        self.clock.now += seconds
        return conduct.played(person, record, seconds)

    def _answers(self, standing: Standing) -> dict[str, Any]:
        person = simulated_person(self.crowd.seed, self.visit.number)
        chooser = rng(derive(self.crowd.seed, "answers", self.visit.number), standing.stage, standing.number)
        seen = Impression() if standing.stage == EXIT else self._impression(standing)
        return answers(person, self.conduct.questions(standing), seen, chooser)

    def _impression(self, standing: Standing) -> Impression:
        """Return the impression of the last trial."""
        study, planned = self.conduct.study, self.conduct.trial(standing)
        film = self.films.get((planned.item, planned.condition))
        if film is not None:
            if isinstance(film.content, list):
                return Impression(looks=film.measure)
            lengths = {c.name: self.films[planned.item, c.name].measure for c in study.conditions}
            return Impression(looks=likeness(lengths, planned.condition))
        record = next(each for each in reversed(standing.events) if each.kind == "did").data["record"]
        task = tasks_of(study)[planned.item]
        knew = 0.5
        if record["helper_goal"] is not None:
            guess = agreement(challenge(task.challenge).grammar.read(record["helper_goal"]), task.goal)
            total = guess.precision + guess.recall
            knew = 2 * guess.precision * guess.recall / total if total else 0.0
        length, usual = record["metrics"]["length"], self.alone.get(task.id, record["metrics"]["length"])
        return Impression(knew, min(1.0, max(0.0, 0.5 + (usual - length) / max(usual, 1.0))))
