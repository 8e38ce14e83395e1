"""Lines that count their steps in any shape: `Action 1:`, `step_1 =`, `(1/3)`, `t=0`, `0x01`, `Step A:`, `1st,`."""

import itertools
import re
from collections import Counter
from collections.abc import Callable, Sequence
from typing import NamedTuple

from hearth.kb.language.plan_lines import PlanLine, plan_line
from hearth.kb.language.step_like_lines import is_like_step
from hearth.schemas.program_boundaries import TITLE

_WORDS = (
    "one two three four five six seven eight nine ten eleven twelve",
    "first second third fourth fifth sixth seventh eighth ninth tenth eleventh twelfth",
    "i ii iii iv v vi vii viii ix x xi xii",
)
_COUNTS = [{word: number for number, word in enumerate(words.split(), 1)} for words in _WORDS]
_SPELLED = "|".join(sorted((word for words in _COUNTS for word in words), key=len, reverse=True))
_LINE = re.compile(
    rf"\s{{0,40}}+[(<\[{{\"'*#]{{0,6}}+\s{{0,3}}+(?P<path>(?:[a-z][a-z0-9]{{0,20}}[._-]){{0,4}})(?P<word>[a-z]{{1,12}}?)?"
    rf"(?P<gap>[\s._#=:-]{{0,4}})(?<![a-z0-9])?"
    rf"(?P<count>0x[0-9a-f]{{1,4}}|\d{{1,4}}|(?<![a-z])(?:{_SPELLED}|[a-z]))(?:st|nd|rd|th)?(?![a-z0-9])"
    rf"(?:\s?(?:/|of)\s?\d{{1,4}})?[)>\]}}\"'*]{{0,4}}(?P<mark>\s{{0,3}}[:=.,)\]>|–—-]{{0,3}}\s{{0,9}})(?P<said>[^\s:=.,)\]>|–—-].*)",
    re.IGNORECASE,
)
_SECTION = re.compile(r"\s*\[+(?P<name>[A-Za-z][\w .-]*)\]+\s*")
_NAMED = re.compile(r"\s*(?:title|name|task|goal)\s*[=:]\s*(?P<name>\S.*)", re.IGNORECASE)
_QUOTED = re.compile(r"([\"'])(?P<said>.*)\1\s*,?\s*")
_OF_STEPS = frozenset(
    [
        "step",
        "steps",
        "s",
        "action",
        "actions",
        "act",
        "a",
        "task",
        "subtask",
        "t",
        "tick",
        "time",
        "no",
        "nr",
        "move",
        "phase",
        "stage",
        "instruction",
        "line",
        "command",
        "skill",
    ]
)
"""Words before a count that say that steps are counted."""

_FEWEST = 2
_SHARE = 0.6
_LETTERS = 3


class _Counted(NamedTuple):
    """A line with its count; `shape` is what lines of one list have in common."""

    shape: tuple[str, bool, str, str]
    number: int
    said: str


def counting_of(lines: Sequence[str]) -> Callable[[str], str] | None:
    """Return what turns counted lines into numbered ones; None where the lines count nothing, or are numbered as usual.

    Lines count if their counts go up by equal steps, and the words behind most counts read as steps do.
    """
    texts = [line for line in lines if line.strip() and len(line) <= _LONGEST]
    read = list(map(plan_line, texts))
    if any(line.numbered for line in read) or (any(map(TITLE.match, texts)) and any(_is_marked(line) for line in read)):
        return None
    for kind in range(len(_COUNTS) + 2):
        found = [counted for line in texts if (counted := _counted(line, kind))]
        shape = next((shape for shape, _ in Counter(each.shape for each in found).most_common(1)), None)
        if shape and _goes_up(own := [each for each in found if each.shape == shape]) and _are_steps(own, texts, kind):
            return lambda raw, kind=kind, shape=shape: _numbered(raw, kind, shape)  # type: ignore[misc]
    return None


_LONGEST = 1_000


def _is_marked(line: PlanLine) -> bool:
    return line.number is not None


def _counted(raw: str, kind: int) -> _Counted | None:
    """Return a line's count of a kind: in digits, then in words, and in letters at last."""
    found = _LINE.match(raw)
    if not found or TITLE.match(raw.lstrip("# *")):
        return None
    text, word = found["count"].lower(), (found["word"] or "").lower()
    if word and word not in _OF_STEPS:
        return None
    number = _number(text, kind)
    if number is None or (not text.isdigit() and not word and not found["mark"].strip() and not text.startswith("0x")):
        return None
    said = found["said"].strip()
    quoted = _QUOTED.fullmatch(said)
    is_open = bool(raw[: found.start("path")].strip())
    return _Counted(
        (word, is_open, found["gap"].strip(), found["mark"].strip()), number, quoted["said"] if quoted else said
    )


def _number(text: str, kind: int) -> int | None:
    if not kind:
        return int(text, 16) if text.startswith("0x") else int(text) if text.isdigit() else None
    if kind <= len(_COUNTS):
        return _COUNTS[kind - 1].get(text)
    return ord(text) - ord("a") + 1 if len(text) == 1 and text.isalpha() else None


def _goes_up(found: Sequence[_Counted]) -> bool:
    """Return whether counts go up by one, or ten, from the first, and perhaps begin again."""
    first = found[0].number
    stride = found[1].number - first if len(found) > 1 else 0
    if len(found) < _FEWEST or stride not in (1, 10) or first not in (0, stride):
        return False
    numbers = [each.number for each in found]
    return all(two in (one + stride, first) for one, two in itertools.pairwise(numbers))


def _are_steps(found: Sequence[_Counted], texts: Sequence[str], kind: int) -> bool:
    """Return whether counted lines are steps: most lines are such, or their word says so, and they read as steps."""
    like = sum(is_like_step(each.said) for each in found)
    if kind > len(_COUNTS) and len(found) < _LETTERS and found[0].shape[0] not in _OF_STEPS:
        return False
    counted = len(found) + sum(bool(_SECTION.fullmatch(line) or _NAMED.fullmatch(line)) for line in texts)
    is_named = found[0].shape[0] in _OF_STEPS and len(found) > _FEWEST
    return 2 * like >= len(found) and (is_named or counted >= _SHARE * len(texts))


def _numbered(raw: str, kind: int, shape: tuple[str, bool, str, str]) -> str:
    counted = _counted(raw, kind) if len(raw) <= _LONGEST else None
    if counted and counted.shape == shape:
        return f"{counted.number}. {counted.said}"
    section, named = _SECTION.fullmatch(raw), _NAMED.fullmatch(raw)
    if section and shape[3] in ("=", ":"):
        return f"## {section['name'].replace('_', ' ')}"
    return f"Task: {named['name'].strip(chr(34) + chr(39))}" if named else raw
