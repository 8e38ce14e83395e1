"""Logs and talks: steps behind the time, the level and the name of a robot that takes them, `Robot: walk to desk`."""

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from hearth.kb.language.forms.form import Form, Placed, remark, step, title
from hearth.kb.language.operators import operator_step
from hearth.kb.language.plan_lines import PlanLine, is_said_around, plan_line
from hearth.kb.language.unmarked_lines import is_like_step

_CLOCK = r"\d{1,2}:\d\d(?::\d\d(?:[.,]\d{1,9})?)?(?:\s?[ap]m)?"
_DATE = (
    r"(?:\d{4}[-/]\d\d[-/]\d\d|\d{1,2}[./-]\d{1,2}[./-]\d{2,4}"
    r"|(?:jan|feb|mar|apr|may|jun|jul|aug|sep|oct|nov|dec)[a-z]*\s+\d{1,2})"
)
_STAMP = rf"(?:\[?\d{{9,13}}(?:\.\d{{1,9}})?\]?|[\[(]?(?:{_DATE}(?:T|,?\s+))?{_CLOCK}(?:Z|[+-]\d\d:?\d\d)?[\])]?|[\[(]{_DATE}[\])])"
_LEVEL = r"(?-i:\[?(?:INFO|DEBUG|WARN(?:ING)?|ERROR|TRACE|FATAL)\]?|\[(?:ACTION|EXEC|STEP)\]|(?<=[\d\]Z] )(?:ACTION|EXEC|STEP))"
_LOGGER = r"(?:(?:[\w.-]+\s+)?[\w.-]+\[\d+\]:|\[[\w./-]+\]:?|[\w.-]+(?:\s+-\s+|:(?=\S)))"
_HEAD = rf"(?P<head>(?:{_STAMP}|{_LEVEL}(?=[\s:|-]))(?:\s*[:|,–-]*\s+|:)(?:{_LOGGER}\s*)?(?:(?:{_STAMP}|{_LEVEL}(?=[\s:|-]))\s*[:|,–-]*\s*)*(?:{_LOGGER}\s+)?)"
"""Times, levels and the name of the program, in the order in which loggers write them."""

_LINE = re.compile(
    rf"\s*(?:\[[A-Za-z][\w ./#-]{{0,30}}\d\]\s+)?{_HEAD}?(?:[-–]\s+)?(?:<(?P<nick>[\w.@+-]{{1,20}})>\s*:?|\**(?P<who>[A-Za-z][\w.-]{{0,20}}(?: [A-Z][\w.-]{{0,20}})?)\**\s*:\**)\s+(?P<said>[^\s\[<].*|\[\d.*|<(?!\w+>\s*\().*)",
    re.IGNORECASE,
)
_TIMED = re.compile(rf"\s*{_HEAD}(?P<said>\S.*)", re.IGNORECASE)
_LEVELS = re.compile(_LEVEL)
_ACTS = re.compile(r"\W*(?:INFO|DEBUG|ACTION|EXEC|STEP)\W*")
_QUESTION = re.compile(r"\s*\**\s*Q(?:uestion)?\s*\d*\s*:\s*(?P<said>[^*]*)\**\s*")
ROBOTS = re.compile(
    r"(?:step|action|do|doing|execut(?:e|ing|ed)|perform(?:ing|ed)?|running|sending|calling|robot|bot|agent|exec(?:utor)?|controller|skill|robo|assistant|ai|gpt|a|answer)\d{0,2}",
    re.IGNORECASE,
)
"""Names of those that do what they say; `A` answers where a question stands above."""

_PEOPLE = re.compile(r"(?:human|person|operator|owner)\d{0,2}", re.IGNORECASE)
_TASK = re.compile(r"(?:task|goal)\s*[=:]\s*[\"']?([^\"']+)[\"']?")
_JOINT = re.compile(r"\s*(?:->|=>|→|;)\s*|\s+>\s+")
_NEXT = re.compile(r"(?:^|\s)[(\[]?\d{1,2}[.):\]]\s+")
_IT = re.compile(r"^(?:it|he|she|the robot)\s+(?=[a-z])", re.IGNORECASE)
_SHARE = 0.6
_MOST = 1_000


class Said(NamedTuple):
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
    found = _LINE.fullmatch(raw)
    who = (found["who"] or found["nick"]) if found else ""
    if not found or _LEVELS.fullmatch(who):
        timed = _TIMED.fullmatch(raw)
        levels = _LEVELS.findall(timed["head"]) if timed else []
        is_step = timed is not None and all(map(_ACTS.fullmatch, levels)) and _reads(timed["said"])
        return Said("", timed["said"], is_step) if timed else None
    levels = _LEVELS.findall(found["head"] or "")
    is_step = ROBOTS.fullmatch(who) is not None and all(map(_ACTS.fullmatch, levels))
    return Said(who.lower(), found["said"], is_step)


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
    return [each for row, raw in enumerate(lines) for each in _of_line(row, raw)]


def _of_line(row: int, raw: str) -> Iterator[Placed]:
    said = said_of(raw)
    if said is None:
        yield Placed(row, plan_line(raw)._replace(number=None, numbered=False))
    elif said.is_step:
        read = plan_line(said.text)
        if not read.text.endswith(":") and not (read.number is None and is_said_around(read.text)):
            yield from (step(row, part.strip(" ,")) for part in _parts(read, said.text) if part.strip(" ,."))
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
        rf"\s*(?:(?:human|person|operator|owner)\d*:\s+(?!.*\bthank)|\**\s*Q(?:uestion)?\s*\d*\s*:|(?:{_STAMP}\s+)?(?:(?!robot|bot|agent)[A-Za-z]\w{{0,20}}):\s+.*\?\s*$|.*\btask\s*=)",
        re.IGNORECASE,
    ),
)
