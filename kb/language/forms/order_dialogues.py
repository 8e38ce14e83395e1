"""Talks in which one orders and another obeys: `Anna: Find the lamp.`, `Robot: Here it is.`; the orders are steps."""

import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from hearth.kb.language.forms.form import Form, Placed, remark, step
from hearth.kb.language.forms.robot_logs import ROBOTS, Said, said_of
from hearth.kb.language.operator_step_syntax import names_thing, operator_step
from hearth.kb.language.plan_lines import plan_line
from hearth.kb.language.step_like_lines import is_like_step


class _Talk(NamedTuple):
    """The speaker of the steps of a talk, and the test that finds them."""

    who: str
    is_step: Callable[[str], bool]


_SENTENCES = re.compile(r"(?<=[a-z][.!?])\s+(?=[A-Z])")
_SAID = re.compile(
    r"(?:(?:great|good|nice|perfect|super|thanks|thank you|alright|right|well|excellent|lovely|ok|okay|yes)"
    r"(?: (?:job|work|done|then|now|robot|there))?\s*[,.!–—-]+\s*)+",
    re.IGNORECASE,
)
"""Words before an order that ask for nothing."""

_ANSWER = re.compile(
    r"(?:i|it|he|she|there|here|that|this|we) |(?:done|ok|okay|sure|yes|no|sorry|got it|will do)\b", re.IGNORECASE
)
_LABELS = re.compile(
    r"(?:step|action|task|goal|plan|title|note|tip|thought|obs\w*|act|question|answer|q|a)\d*", re.IGNORECASE
)
_SHARE = 0.6
_FEWEST = 2


_TOLD = re.compile(
    r"(?:(?:first|then|next|now|after that|finally|and)\s*,?\s+)*i\s+(?!am\b|have\b|was\b|had\b|do\b)(?=[a-z])", re.I
)
"""The beginning of an act of one's own."""


def _is_told(text: str) -> bool:
    words = _SAID.sub("", text, count=1)
    return _TOLD.match(words) is not None and is_like_step(words)


def _is_order(text: str) -> bool:
    words = _SAID.sub("", text, count=1)
    return not _ANSWER.match(words) and (is_like_step(words) or bool(operator_step(words)))


def _orders(text: str, is_step: Callable[[str], bool] = _is_order) -> list[str]:
    """Return the sentences of a speaker that ask for something, or report an own act."""
    return [_SAID.sub("", part, count=1) for part in _SENTENCES.split(text) if is_step(part)]


def _talk(lines: Sequence[str]) -> _Talk | None:
    """Return the speaker of the steps of a talk: of orders first, else of acts of one's own."""
    return next((_Talk(who, is_step) for is_step in (_is_order, _is_told) if (who := _who(lines, is_step))), None)


def _who(lines: Sequence[str], is_step: Callable[[str], bool]) -> str:
    """Return the name of the speaker of steps in a talk: no robot, and most of the lines are such; else empty."""
    texts = [line for line in lines if line.strip()]
    if sum(":" in line or ">" in line for line in texts) < _SHARE * len(texts):
        return ""
    said = [each for each in map(said_of, texts) if each and each.who]
    if len(said) < max(_FEWEST, _SHARE * len(texts)) or any(map(_is_plan_of_robot, said)):
        return ""
    lines_of, orders = (
        Counter(each.who for each in said),
        Counter(each.who for each in said if _orders(each.text, is_step)),
    )
    who, most = max(orders.items(), key=lambda each: each[1], default=("", 0))
    others = max((count for other, count in orders.items() if other != who), default=0)
    is_clear = most >= _FEWEST and 2 * most >= lines_of[who] and most > 2 * others
    return who if is_clear and not ROBOTS.fullmatch(who) and not _LABELS.fullmatch(who) else ""


def _is_plan_of_robot(said: Said) -> bool:
    """Return whether a robot answers with numbered steps: these are the steps, and the order is their title."""
    read = plan_line(said.text)
    return ROBOTS.fullmatch(said.who) is not None and read.numbered and is_like_step(read.text)


def _lines(lines: Sequence[str]) -> list[Placed]:
    talk = _talk(lines)
    found: list[Placed] = []
    others = ""
    for row, raw in enumerate(lines) if talk else ():
        said = said_of(raw)
        is_own = said is not None and talk is not None and said.who == talk.who
        if said and is_own and _IT.search(said.text) and _is_about_another(others):
            found.append(step(row, raw))  # `it` is what the other spoke of, which no step says
        else:
            found += _of_line(row, raw, talk) if talk else ()
        others = "" if is_own or not said else said.text
    return found


_IT = re.compile(r"\b(?:it|them)\b", re.IGNORECASE)
_YOURS = re.compile(r"\b(?:your|the|my|that|this) ([a-z]+(?: [a-z]+)?)", re.IGNORECASE)


def _is_about_another(text: str) -> bool:
    """Return whether what another says names a thing, of which `it` may then speak."""
    return any(names_thing(words) or names_thing(words.partition(" ")[0]) for words in _YOURS.findall(text))


def _of_line(row: int, raw: str, talk: _Talk) -> Iterator[Placed]:
    said = said_of(raw)
    if said is None:
        yield Placed(row, plan_line(raw)._replace(number=None, numbered=False))
    elif said.who != talk.who:
        yield remark(row, said.text)
    elif orders := _orders(said.text, talk.is_step):
        yield from (step(row, each) for each in orders)
    else:
        yield remark(row, said.text)


def orders_in(lines: Sequence[str]) -> list[int]:
    """Return the indices of the lines of a talk that order something, or tell what somebody does."""
    talk = _talk(lines)
    said = [(row, said_of(raw)) for row, raw in enumerate(lines)]
    return [row for row, each in said if each and talk and each.who == talk.who and _orders(each.text, talk.is_step)]


ORDERS = Form(
    lambda lines: _talk(lines) is not None,
    _lines,
    lambda raw: (said := said_of(raw)) is not None and (bool(_orders(said.text)) or _is_told(said.text)),
    re.compile(r"\s*(?:#|\**task\b.*:)", re.IGNORECASE),
)
