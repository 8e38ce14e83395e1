"""The stages of a study at which a post is expected, and the notes about unexpected posts."""

from collections.abc import Collection, Mapping

from hearth.schemas.failures import Code
from hearth.studies.study import JUDGE, PLAY, Study
from hearth.studies.study_progress import (
    CONSENT,
    DONE,
    EXIT,
    PRACTICE,
    QUESTIONS,
    STAGES,
    TRIAL,
    TUTORIAL,
    Standing,
)  # fmt: skip
from hearth.web.phrases import say
from hearth.web.web_errors import WebError

UNASKED = "unasked"
"""The field of an address that makes a person's page say that the last post is not asked for."""

HERE = f"/study/?{UNASKED}=1"
"""The address that browsers are sent to then."""

BOTH = {"agree": (CONSENT,), "understood": (TUTORIAL,), "leave": tuple(each for each in STAGES if each != DONE)}

TURNS: Mapping[str, Mapping[str, tuple[str, ...]]] = {
    PLAY: {**BOTH, "begin": (PRACTICE, TRIAL), "answer": (QUESTIONS, EXIT)},
    JUDGE: {**BOTH, "begin": (), "answer": (TRIAL, QUESTIONS, EXIT)},
}
"""The stages at which each post is expected, by kind of study."""


def in_turn(study: Study, standing: Standing | None, post: str) -> Standing:
    """Return where a person is, if a post is asked for there.

    Args:
        study: the study.
        standing: the person's stage; None of a person who has not agreed to take part.
        post: the last part of its address, such as `answer`.

    Raises:
        WebError: OUT_OF_ORDER: it is asked for at other stages; UNKNOWN_ID: the person has not agreed.
    """
    if standing is None:
        raise WebError(Code.UNKNOWN_ID, "person", "somebody who agreed to take part", "somebody who did not", HERE)
    asked = TURNS[study.room][post]
    if standing.stage not in asked:
        raise WebError(Code.OUT_OF_ORDER, "stage", " or ".join(asked) or "no stage of this study", standing.stage, HERE)
    return standing


def check_answers(standing: Standing, asked: Collection[str], given: Collection[str], trial: str) -> None:
    """Refuse answers to other questions, and those of the page of another trial, such as a form that is sent twice.

    Args:
        standing: where the person is.
        asked: names of the questions that are asked there.
        given: names of those that were answered.
        trial: the number of the trial on the page that they come from; "" where it is not said.

    Raises:
        WebError: OUT_OF_ORDER.
    """
    if trial and trial != str(standing.number):
        raise WebError(Code.OUT_OF_ORDER, "trial", str(standing.number), trial, HERE)
    other = [name for name in given if name not in asked]
    if other:
        raise WebError(Code.OUT_OF_ORDER, "answer", " or ".join(asked) or "no answers", other[0][:40], HERE)


def unasked_line(study: Study, standing: Standing | None) -> str:
    """Return the note of a person's stage about a post that is not expected there."""
    stage = standing.stage if standing else CONSENT
    return say("study", "unasked", comes=say("study", f"first_{study.room if stage == TRIAL else stage}"))
