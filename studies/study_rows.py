"""A row of every table that `study export` writes; each column has its meaning next to its type."""

from typing import Annotated, TypedDict


class ParticipantRow(TypedDict):
    """A person who took part."""

    study: Annotated[str, "name of the study"]
    participant: Annotated[str, "salted id: equal in all tables of an export, and nothing else is known by it"]
    simulated: Annotated[bool, "an agent was in a person's place"]
    place: Annotated[int, "the place in the study, from 0; a successor of a person who left has the same"]
    stage: Annotated[str, "done, left, or how far the person is"]
    trials: Annotated[int, "that the person did"]
    seconds: Annotated[float, "of all trials"]
    left: Annotated[str, "why the person left; empty if not"]
    began: Annotated[float, "when the person joined, in seconds since 1970, UTC; 0 of simulated people"]
    flags: Annotated[list[str], "signs of little care, such as `attention`; reports count the person all the same"]
    ended: Annotated[float | None, "when the person finished or left, in the same seconds; null of a person under way"]


class StudyTrialRow(TypedDict):
    """A trial: a task that was played, or a film that was watched."""

    study: Annotated[str, "name of the study"]
    participant: Annotated[str, "who"]
    simulated: Annotated[bool, "an agent was in the person's place"]
    counted: Annotated[bool, "the person finished the study; reports count no others"]
    trial: Annotated[int, "number of the trial among the person's, from 0"]
    item: Annotated[int, "number of the task or program in the study"]
    task_id: Annotated[str, "the task; empty where a program was judged"]
    condition: Annotated[str, "name of the condition"]
    repeat: Annotated[int, "which of the trials of this task under this condition, from 0"]
    seconds: Annotated[float, "that it took"]
    success: Annotated[bool | None, "whether the goal was reached; null where a film was watched, as all that follows"]
    ticks: Annotated[int | None, "that were played"]
    length: Annotated[int | None, "ticks that it counts as: all there are where the goal was not reached"]
    reward: Annotated[float | None, "1 if the goal was reached, less 0.004 a tick of its length"]
    conflicts: Annotated[int | None, "predicates of the other's goal that held and that the person or helper undid"]
    needless: Annotated[int | None, "things the helper moved that in the end neither count nor are where they were"]
    end: Annotated[str, "code of the reason that ended it before its time; else empty"]
    helper_fault: Annotated[str, "code of the helper's fault that ended it, for which reports leave it out; else empty"]


class DecisionRow(TypedDict):
    """The attempt of the person or the helper in a tick of a trial."""

    study: Annotated[str, "name of the study"]
    participant: Annotated[str, "whose trial"]
    simulated: Annotated[bool, "an agent was in the person's place"]
    trial: Annotated[int, "number of the trial among the person's, from 0"]
    tick: Annotated[int, "from 0"]
    agent: Annotated[int, "0 is the person, 1 the helper"]
    action: Annotated[str, "name of the action"]
    objects: Annotated[list[int], "node ids"]
    failure: Annotated[str, "code of why it could not be done; empty if it was"]
    seconds: Annotated[
        float | None, "from the beginning of the trial until the person decided; null of simulated people"
    ]


class RatingRow(TypedDict):
    """An answer to a question."""

    study: Annotated[str, "name of the study"]
    participant: Annotated[str, "who"]
    simulated: Annotated[bool, "an agent was in the person's place, and a stated model gave the answer"]
    counted: Annotated[bool, "the person finished the study"]
    trial: Annotated[int, "number of the trial among the person's, from 0; -1 at the end of the study"]
    item: Annotated[int, "number of the task or program; -1 at the end"]
    condition: Annotated[str, "name of the condition; empty at the end"]
    group: Annotated[str, "what films are compared by: the condition, or the band of a program"]
    question: Annotated[str, "name of the question"]
    value: Annotated[float | None, "a number of a scale; null for other questions"]
    text: Annotated[str, "a choice, or words; empty for a scale"]
