"""A study: its people's tasks, under its conditions, and its questions (thesis 6.6, B.4, C.5)."""

from dataclasses import dataclass
from functools import cached_property
from hashlib import blake2b
from typing import Literal

from hearth.studies.recruitment import Recruitment

PLAY, JUDGE = "play", "judge"
ROOMS = (PLAY, JUDGE)
"""The tasks of people: to act in homes, or to judge films."""

EPISODES, PROGRAMS = "episodes", "programs"
SOURCES = (EPISODES, PROGRAMS)
"""The contents of films: people and agents at tasks, or programs that were written for descriptions."""

FILM, REPLAY = "film", "replay"
SHOWN = (FILM, REPLAY)
"""The presentation to judges: a film that was made before, or 3D in the browser, seen from anywhere."""

AFTER = ("trial", "helped")
"""The times of a question: after every trial, or after trials with a helper."""

Kind = Literal["scale", "choice", "text"]


@dataclass(frozen=True, slots=True)
class Page:
    """A page of the tutorial."""

    title: str
    text: str


@dataclass(frozen=True, slots=True)
class Question:
    """Something people are asked.

    Attributes:
        name: of its answers in tables.
        text: as people read it.
        kind: `scale` (whole numbers), `choice` or `text`.
        low, high: ends of a scale.
        labels: number -> its words.
        choices: the possible answers.
        required: whether it must be answered.
        after: one of `AFTER`.
        correct: the one right answer of a question that tests attention; None of others.
    """

    name: str
    text: str
    kind: Kind
    low: int = 1
    high: int = 1
    labels: tuple[tuple[int, str], ...] = ()
    choices: tuple[str, ...] = ()
    required: bool = True
    after: str = "trial"
    correct: int | str | None = None

    def fault(self, answer: object) -> str:
        """Return the fault of an answer; "" if there is none."""
        if answer is None or answer == "":
            return "it needs an answer" if self.required else ""
        if self.kind == "scale":
            whole = isinstance(answer, int) and not isinstance(answer, bool)
            fits = whole and isinstance(answer, int) and self.low <= answer <= self.high
            return "" if fits else f"a whole number from {self.low} to {self.high} is asked"
        if self.kind == "choice":
            return "" if answer in self.choices else f"one of {', '.join(self.choices)} is asked"
        return "" if isinstance(answer, str) and len(answer) <= MOST_TEXT else f"at most {MOST_TEXT:,} characters"


LANGUAGES = ("en", "de", "qps-plocm")
"""The languages of participants' pages; the last is for trying (see `hearth.web.phrases`)."""

MOST_TEXT = 4_000
"""Characters of an answer in words."""


@dataclass(frozen=True, slots=True)
class Condition:
    """Under which trials are done.

    Attributes:
        name: in tables.
        title: in reports.
        helper, goal: the helper and its goal (see `challenges.episode_agents.Lineup`); no helper where `none`.
        actor: whose episodes films show: `person` or `agent`; "" where people play.
    """

    name: str
    title: str
    helper: str = "none"
    goal: str = ""
    actor: str = ""

    @property
    def helped(self) -> bool:
        """Return whether there is a helper."""
        return self.helper != "none"


@dataclass(frozen=True, slots=True)
class Tasks:
    """The tasks of a challenge that a study is about: the first of a split, whose goal sets come in turn.

    Attributes:
        challenge, split: theirs.
        number: how many.
    """

    challenge: str
    split: str
    number: int


@dataclass(frozen=True, slots=True)
class Band:
    """Programs of a quality: normalised LCS with the reference from `low` to below `high` (1 is in the last)."""

    name: str
    title: str
    low: float
    high: float

    def holds(self, lcs: float) -> bool:
        """Return whether a program's score is in the band."""
        return self.low <= lcs < self.high or lcs == self.high == 1


@dataclass(frozen=True, slots=True)
class Films:
    """The films to judge.

    Attributes:
        of: one of `SOURCES`.
        study: name of the study whose people are shown, where they show episodes.
        bands: of programs.
        each: programs of each band.
        shown: one of `SHOWN`.
    """

    of: str
    study: str = ""
    bands: tuple[Band, ...] = ()
    each: int = 0
    shown: str = FILM


@dataclass(frozen=True, slots=True)
class Limits:
    """Times after which the study no longer waits.

    Attributes:
        minutes: of a trial.
        least_seconds: of a trial; one that took less is flagged at the desk.
        idle_hours: without a sign of a person, who then counts as having left.
    """

    minutes: float = 20.0
    idle_hours: float = 24.0
    least_seconds: float = 0.0


@dataclass(frozen=True)
class Study:
    """The contents of a study's file.

    Attributes:
        name: its identifier.
        title: for people.
        source: where the design comes from.
        room: one of `ROOMS`.
        seed: of all that is drawn.
        people: how many take part.
        consent: the text that they agree to.
        tutorial: the text that they read first.
        practice: trials that do not count.
        tasks: the tasks; None where programs are judged.
        films: the films to judge; None where people play.
        interface: in which they play: `symbolic` or `visual`.
        conditions: at least one.
        repeats: how often each task is done under each condition.
        least: trials that everybody has under each condition.
        limits: of time.
        alone: name of the study whose lengths are those without a helper; "" where one of the conditions is.
        questions: after trials.
        exit: at the end.
        text: the file.
        recruitment: the platform by which its people come; None for none.
        language: of its pages, one of `LANGUAGES`; "" for that of each person's browser.
    """

    name: str
    title: str
    source: str
    room: str
    seed: int
    people: int
    consent: str
    tutorial: tuple[Page, ...]
    practice: int
    tasks: Tasks | None
    films: Films | None
    interface: str
    conditions: tuple[Condition, ...]
    repeats: int
    least: int
    limits: Limits
    alone: str
    questions: tuple[Question, ...]
    exit: tuple[Question, ...]
    text: str
    recruitment: Recruitment | None = None
    language: str = ""

    @cached_property
    def digest(self) -> str:
        """32 hexadecimal digits of the file's text."""
        return blake2b(self.text.encode(), digest_size=16).hexdigest()

    @property
    def items(self) -> int:
        """Return the number of tasks, or of programs."""
        if self.tasks is not None:
            return self.tasks.number
        assert self.films is not None
        return self.films.each * len(self.films.bands)

    @property
    def trials(self) -> int:
        """Return all trials that count."""
        return self.items * len(self.conditions) * self.repeats

    def condition(self, name: str) -> Condition:
        """Return a condition by name."""
        return next(each for each in self.conditions if each.name == name)

    def asked(self, condition: Condition) -> tuple[Question, ...]:
        """Return the questions after a trial under a condition."""
        return tuple(each for each in self.questions if each.after == "trial" or condition.helped)
