"""Logs and talks: steps behind the time, the level and the name of a robot that takes them, `Robot: walk to desk`."""

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from hearth.kb.language.forms.form import Form, Placed, remark, step, title
from hearth.kb.language.forms.log_heads import STAMP, head_of
from hearth.kb.language.operator_step_syntax import operator_step
from hearth.kb.language.plan_lines import PlanLine, is_said_around, plan_line
from hearth.kb.language.step_like_lines import is_like_step

_LINE = re.compile(
    r"(?:[-–]\s+)?(?:<(?P<nick>[\w.@+-]{1,20})>\s*:?"
    r"|\**(?P<who>[A-Za-z][\w.-]{0,20}(?: (?:[A-Z][\w.-]{0,20}|action|thought|act|step))?)\**\s*:\**)\s+"
    r"(?P<said>[^\s\[<].*|\[\d.*|<(?!\w+>\s*\().*)"
)
_ACTS = frozenset(("", "INFO", "DEBUG", "ACTION", "EXEC", "STEP"))
"""Levels of acts."""

_QUESTION = re.compile(r"\s*\**\s*Q(?:uestion)?\s*\d*\s*:\s*(?P<said>[^*]*)\**\s*")
ROBOTS = re.compile(
    r"(?:(?:robot|agent|bot) )?(?:step|action|act|do|doing|execut(?:e|ing|ed)|perform(?:ing|ed)?|running|sending"
    r"|calling|robot|bot|agent|exec(?:utor)?|controller|skill|robo|assistant|ai|gpt|a|answer)\d{0,2}",
    re.IGNORECASE,
)
"""Names of those that do what they say; `A` answers where a question stands above."""

_PEOPLE = re.compile(r"(?:human|person|operator|owner|instruction)\d{0,2}", re.IGNORECASE)
_TASK = re.compile(r"(?:task|goal)\s*[=:]\s*[\"']?([^\"']+)[\"']?")
_JOINT = re.compile(r"\s*(?:->|=>|→|;)\s*|\s+>\s+")
_NEXT = re.compile(r"(?:^|\s)[(\[]?\d{1,2}[.):\]]\s+")
_IT = re.compile(r"^(?:it|he|she|the robot)\s+(?=[a-z])", re.IGNORECASE)
_COURTESY = re.compile(
    r"(?:sure(?: thing)?|of course|certainly|absolutely|okay|ok|great|alright|all right|yes|no problem|will do)"
    r"\s*[.!,]+\s+(?=\S)",
    re.IGNORECASE,
)
"""An assent before a step, which asks for nothing."""

_SHARE = 0.6
_MOST = 1_000


class Said(NamedTuple):
    """The words of a line, their speaker, and the answer whether a robot does them."""

    who: str
    text: str
    is_step: bool


def said_of(raw: str) -> Said | None:
    """Return a line's speaker and words; None where it has neither a speaker nor a level."""
    if len(raw) > _MOST:
        return None
    asked = _QUESTION.fullmatch(raw)
    if asked:
        return Said("q", asked["said"], False)
    head = head_of(raw)
    is_done = head.level in _ACTS
    found = _LINE.fullmatch(raw, head.end)
    if not found:
        said = raw[head.end :]
        return Said("", said, is_done and _reads(said)) if head.is_timed and said.strip() else None
    who = found["who"] or found["nick"]
    return Said(who.lower(), found["said"], is_done and ROBOTS.fullmatch(who) is not None)


def _reads(text: str) -> bool:
    return is_like_step(text) or bool(operator_step(text))


def _fits(lines: Sequence[str]) -> bool:
    """Return whether most lines have a speaker, and a robot says steps, or answers a question."""
    texts = [line for line in lines if line.strip()]
    said = [each for each in map(said_of, texts) if each]
    if len(said) < _SHARE * len(texts) or not any(each.is_step for each in said):
        return False
    who = {each.who for each in said}
    if len({each.who for each in said if each.is_step}) > 1:
        return False  # Each of several robots has a plan of its own.
    if who & {"a", "answer"}:
        return "q" in who or "question" in who
    steps = [each for each in said if each.is_step]
    return sum(_is_step(each.text) for each in steps) > (0 if len(who) > 1 else 1)


def _is_step(text: str) -> bool:
    read = plan_line(text)
    return read.number is not None or _reads(read.text)


def _lines(lines: Sequence[str]) -> list[Placed]:
    found: list[Placed] = []
    is_robot = False
    for row, raw in enumerate(lines):
        said = said_of(raw)
        found += _of_line(row, raw, said, is_robot)
        is_robot = said.is_step if said else is_robot
    return found


def _of_line(row: int, raw: str, said: Said | None, is_robot: bool) -> Iterator[Placed]:
    """Yield the steps of a line; one without a speaker goes on with the words of the last, whose list may be steps."""
    if said is None:
        line = plan_line(raw)
        yield Placed(row, line if is_robot and line.numbered else line._replace(number=None, numbered=False))
    elif said.is_step:
        words = _COURTESY.sub("", said.text, count=1)
        read = plan_line(words)
        if read.text.endswith(":") or (read.number is None and is_said_around(read.text)):
            yield remark(row, said.text)
        else:
            yield from (step(row, part.strip(" ,")) for part in _parts(read, words) if part.strip(" ,."))
    elif task := _TASK.search(said.text):
        yield title(row, task[1])
    elif said.who == "q" or _PEOPLE.fullmatch(said.who):
        yield Placed(row, plan_line(said.text)._replace(number=None, numbered=False, heading=True))
    else:
        yield remark(row, said.text)


def _parts(read: PlanLine, text: str) -> list[str]:
    """Return the steps of a robot's words, which may be numbered: `1. find a cup, 2. pick up the cup`."""
    if read.bracketed:
        return [read.text]
    numbered = _NEXT.split(text)
    return numbered if len(numbered) > 2 else _JOINT.split(_IT.sub("", read.text, count=1))


SPEAKERS = Form(
    _fits,
    _lines,
    lambda raw: (said := said_of(raw)) is not None and said.is_step,
    re.compile(
        rf"\s*(?:(?:human|person|operator|owner|instruction)\d*:\s+(?!.*\bthank)|\**\s*Q(?:uestion)?\s*\d*\s*:|(?:{STAMP}\s+)?(?:(?!robot|bot|agent)[A-Za-z]\w{{0,20}}):\s+.*\?\s*$|.*\btask\s*=)",
        re.IGNORECASE,
    ),
)
