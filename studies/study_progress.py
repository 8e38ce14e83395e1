"""A study under way: each person's stage, and the possible next events; for people and for agents in their places."""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.studies.assignment import Planned, Slots, assignment
from hearth.studies.events import PLACES, Event, Ledger, salted
from hearth.studies.study import PLAY, Condition, Question, Study
from hearth.studies.study_file import groups_of
from hearth.studies.study_trials import checked

CONSENT, TUTORIAL, PRACTICE, TRIAL, QUESTIONS, EXIT, DONE, LEFT = STAGES = (
    "consent", "tutorial", "practice", "trial", "questions", "exit", "done", "left",
)  # fmt: skip
"""The stages of a person in a study, in this order."""


@dataclass(frozen=True, slots=True)
class Standing:
    """The stage of a person in a study.

    Attributes:
        person: the id.
        place: number of the place among those of the study.
        stage: one of `STAGES`.
        number: of the trial or practice trial that is to come, or that was done last where its questions are asked.
        events: all that the person did.
    """

    person: str
    place: int
    stage: str
    number: int
    events: tuple[Event, ...]

    @property
    def finished(self) -> bool:
        """Return whether the person has done all."""
        return self.stage == DONE


class Conduct:
    """A study that people take part in.

    Args:
        study: its design.
        ledger: keeps the events.
        known: gives the knowledge.
        clock: the time, in seconds since 1970.
    """

    def __init__(
        self, study: Study, ledger: Ledger, known: Callable[[], Knowledge], clock: Callable[[], float] = time.time
    ) -> None:
        self.study, self.ledger, self.known, self.clock = study, ledger, known, clock
        self.slots: Slots = assignment(study, groups_of(study))

    def join(self, person: str) -> Standing:
        """Give a person a place: one that nobody had, else that of the first who joined and has left.

        Raises:
            HearthError: BAD_ARGUMENT: every place is taken; CONFLICT: others joined at the same moment, each time.
        """
        for _ in range(100):
            joined = self.ledger.read(PLACES)
            mine = [each for each in joined if each.data["person"] == person]
            if mine:
                return self.standing(person)
            place = self._open_place(joined)
            if place is None:
                raise HearthError.of(Code.BAD_ARGUMENT, "every place in this study is taken", suggestion="come later")
            event = Event(PLACES, len(joined), "joined", self.clock(), {"person": person, "place": place})
            if self.ledger.append(event):
                return self.standing(person)
        raise HearthError.of(Code.CONFLICT, "too many people join at this moment", suggestion="try again")

    def has_room(self) -> bool:
        """Return whether a person who joins now gets a place."""
        return next(self._open_places(self.ledger.read(PLACES)), None) is not None

    def _open_place(self, joined: Sequence[Event]) -> int | None:
        """Return the place of the next person; a person silent there for too long counts as having left from now on."""
        return next((place for place, person in self._open_places(joined) if not person or self._gone(person)), None)

    def _open_places(self, joined: Sequence[Event]) -> Iterator[tuple[int, str]]:
        """Yield the open places, each with the last person there who is to be counted as gone, if there is one."""
        last = {each.data["place"]: each for each in joined}
        yield from ((place, "") for place in range(len(self.slots)) if place not in last)
        for event in sorted(last.values(), key=lambda each: each.number):
            person = event.data["person"]
            if not person or (standing := self.standing(person)).stage == LEFT or self.is_silent(standing):
                yield int(event.data["place"]), person

    def _gone(self, person: str) -> bool:
        """Return whether a person has left, once silence is kept as leaving."""
        try:
            self.leave(person, "idle")
        except HearthError as error:  # this person does something at this very moment
            if error.diagnostics[0].code != Code.CONFLICT:
                raise
            return False
        return True

    def is_silent(self, standing: Standing) -> bool:
        """Return whether a person under way gave no sign for as long as the study allows."""
        return standing.stage not in (DONE, LEFT) and (
            self.clock() - self.last_sign(standing) >= self.study.limits.idle_hours * 3600
        )

    def last_sign(self, standing: Standing) -> float:
        """Return when a person did something last."""
        return max([each.at for each in standing.events] or [self.joined_at(standing.person)])

    def code(self, person: str) -> str:
        """Return the code of a person.

        The person gets the code at the end, and the desk and the tables have it as the id.
        """
        return salted(self.ledger.secret("participants"), person)

    def joined_at(self, person: str) -> float:
        """Return when a person joined."""
        return next(each.at for each in self.ledger.read(PLACES) if each.data["person"] == person)

    def standing(self, person: str) -> Standing:
        """Return where a person is.

        Raises:
            HearthError: UNKNOWN_ID: nobody of this id takes part.
        """
        joined = [each for each in self.ledger.read(PLACES) if each.data["person"] == person]
        if not joined or not person:
            raise HearthError.of(Code.UNKNOWN_ID, "nobody of this id takes part")
        place = int(joined[-1].data["place"])
        events = tuple(self.ledger.read(person))
        stage, number = stage_of(self.study, self.slots[place], events)
        return Standing(person, place, stage, number, events)

    def trial(self, standing: Standing) -> Planned:
        """Return the trial that is to come, or whose questions are asked."""
        return self.slots[standing.place][standing.number]

    def condition(self, standing: Standing) -> Condition:
        """Return the condition of that trial."""
        return self.study.condition(self.trial(standing).condition)

    def questions(self, standing: Standing) -> tuple[Question, ...]:
        """Return the present questions."""
        if standing.stage == EXIT:
            return self.study.exit
        return self.study.asked(self.condition(standing)) if standing.stage == QUESTIONS else ()

    def consent(self, person: str, came: Mapping[str, str] | None = None) -> Standing:
        """Record that a person agrees to take part.

        Args:
            person: who.
            came: what the link of a platform said that the person came by.
        """
        return self._go_on(person, CONSENT, "consented", {"came": dict(came)} if came else {})

    def read(self, person: str) -> Standing:
        """Record that a person has read the tutorial."""
        return self._go_on(person, TUTORIAL, "read", {})

    def practised(self, person: str) -> Standing:
        """Record that a person has done a practice trial."""
        return self._go_on(person, PRACTICE, "practised", {})

    def played(
        self, person: str, record: Mapping[str, Any], seconds: float = 0.0, times: Sequence[float] = (), opened: int = 1
    ) -> Standing:
        """Record that a person has played a trial.

        Args:
            person: who.
            record: all actions, as `result_files.episode_data` writes them; they are replayed here.
            seconds: that it took.
            times: when the person decided in each tick, in seconds since it was begun; none where that is not known.
            opened: how often its page was opened.

        Raises:
            HearthError: BAD_ARGUMENT: something else is to come; those of `trials.checked`.
        """
        standing = self._expected(person, TRIAL)
        planned = self.trial(standing)
        data = checked(self.study, planned, record, self.known())
        kept: dict[str, Any] = {"times": list(times)} if times else {}
        if opened != 1:
            kept["opened"] = opened
        return self._append(standing, "did", {**_named(planned), "seconds": seconds, **kept, "record": data})

    def watched(self, person: str, seconds: float = 0.0) -> Standing:
        """Record that a person has watched a film."""
        standing = self._expected(person, TRIAL)
        return self._append(standing, "did", {**_named(self.trial(standing)), "seconds": seconds})

    def answer(self, person: str, answers: Mapping[str, Any]) -> Standing:
        """Record that a person answers the questions after a trial, or those at the end.

        Raises:
            HearthError: BAD_ARGUMENT: there is no question, an answer is lacking, or one is not of its question.
        """
        standing = self.standing(person)
        if standing.stage not in (QUESTIONS, EXIT):
            raise _wrong(standing.stage, QUESTIONS)
        asked = self.questions(standing)
        unknown = sorted(set(answers) - {each.name for each in asked})
        faults = [f"`{each.name}`: {fault}" for each in asked if (fault := each.fault(answers.get(each.name)))]
        faults += [f"`{each[:40]}` is not asked" for each in unknown]
        if faults:
            raise HearthError.of(Code.BAD_ARGUMENT, "; ".join(faults))
        given = {each.name: answers[each.name] for each in asked if answers.get(each.name) not in (None, "")}
        if standing.stage == EXIT:
            return self._append(standing, "finished", {"answers": given})
        named = _named(self.trial(standing))
        return self._append(standing, "answered", {**named, "answers": given})

    def leave(self, person: str, why: str = "left") -> Standing:
        """Let a person leave, unless the person is done; the place goes to the next person who joins."""
        standing = self.standing(person)
        if standing.stage in (DONE, LEFT):
            return standing
        return self._append(standing, "left", {"why": why})

    def forget(self, person: str) -> None:
        """Delete all that is known of a person; the place is open again.

        Raises:
            HearthError: UNKNOWN_ID: nobody of this id takes part.
        """
        self.standing(person)
        self.ledger.forget(person)

    def _go_on(self, person: str, stage: str, kind: str, data: Mapping[str, Any]) -> Standing:
        return self._append(self._expected(person, stage), kind, data)

    def _expected(self, person: str, stage: str) -> Standing:
        standing = self.standing(person)
        if standing.stage != stage:
            raise _wrong(standing.stage, stage)
        return standing

    def _append(self, standing: Standing, kind: str, data: Mapping[str, Any]) -> Standing:
        event = Event(standing.person, len(standing.events), kind, self.clock(), data)
        if not self.ledger.append(event):
            raise HearthError.of(Code.CONFLICT, "this was done already, perhaps in another window", suggestion="reload")
        return self.standing(standing.person)


def _named(planned: Planned) -> dict[str, Any]:
    return {"item": planned.item, "condition": planned.condition, "repeat": planned.repeat}


def _wrong(stage: str, expected: str) -> HearthError:
    return HearthError.of(Code.BAD_ARGUMENT, f"the study is at `{stage}`, not at `{expected}`", suggestion="reload")


def stage_of(study: Study, slot: Sequence[Planned], events: Sequence[Event]) -> tuple[str, int]:
    """Return where the events of a person lead: a stage, and the number of a trial or practice trial."""
    kinds = [each.kind for each in events]
    done, practised = kinds.count("did"), kinds.count("practised")
    if kinds and kinds[-1] in ("left", "finished"):
        return (LEFT if kinds[-1] == "left" else DONE), done
    if "consented" not in kinds:
        return CONSENT, 0
    if study.tutorial and "read" not in kinds:
        return TUTORIAL, 0
    if study.room == PLAY and practised < study.practice:
        return PRACTICE, practised
    if done and kinds[-1] == "did" and study.asked(study.condition(slot[done - 1].condition)):
        return QUESTIONS, done - 1
    return (TRIAL, done) if done < len(slot) else (EXIT, done)
