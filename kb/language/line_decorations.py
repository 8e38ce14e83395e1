"""Marks around the lines of a text that are not part of it: branches of a tree, counts of any shape, cue times."""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

from hearth.kb.language.action_keys import names_action
from hearth.kb.language.counted_lines import counting_of
from hearth.kb.language.plan_lines import cleaned
from hearth.kb.language.step_like_lines import is_like_step

_SHARE = 0.6
_MOST = 1_000
"""Characters of a line at most from which anything is taken."""


class Bare(str):
    """A line without what stands around it; `raw` is the line as the file has it."""

    __slots__ = ("raw",)
    raw: str


Unwrap = Callable[[str], str]
"""Returns a line without its wrapping."""


class Wrapping(NamedTuple):
    """One way of wrapping lines.

    Attributes:
        of: what unwraps the lines of a text of which these are the first; None for a text that is not wrapped so.
        hint: matches some line of every text that is wrapped so.
    """

    of: Callable[[Sequence[str]], Unwrap | None]
    hint: re.Pattern[str]


_MARKED = re.compile(r"\s*(?:(?:[-*+•]|(?:[Ss]tep )?\d{1,4}[.:)])\s+[A-Za-z]|\[[A-Za-z]+\]\s*<)")
"""A step as most are marked, which nothing stands around."""


def unwrapping(first: Sequence[str]) -> Unwrap | None:
    """Return what unwraps the lines of a text, by its first lines; None where nothing has to be."""
    if any(map(_MARKED.match, first)):
        return None
    for wrapping in WRAPPINGS.values():
        if any(map(wrapping.hint.match, first)) and (found := wrapping.of(first)):
            return found
    return None


def unwrapped(lines: Iterable[str], unwrap: Unwrap | None) -> Iterator[str]:
    """Yield the lines without their wrapping."""
    return (bare(raw, unwrap) for raw in lines)


def bare(raw: str, unwrap: Unwrap | None) -> str:
    """Return a line without its wrapping; one that changes knows what it was."""
    if len(raw) > _MOST:
        return raw
    text = cleaned(raw)
    text = unwrap(text) if unwrap else text
    if text == raw:
        return raw
    found = Bare(text)
    found.raw = raw
    return found


def raw_of(line: str) -> str:
    """Return a line as the file has it."""
    return line.raw if isinstance(line, Bare) else line


def _texts(lines: Sequence[str]) -> list[str]:
    return [line for line in lines if line.strip() and len(line) <= _MOST]


_BRANCH = re.compile(
    r"(?P<stem>[\s|│]*)(?:[|+`\\├└╰]-{1,3}>?|[├└╰]─{0,3}|-{1,2}>)\s*(?:\[[-+ox*✓✔✕✗✘ ]\]\s*)?(?=[^\s|])"
)
_STATE = re.compile(r"\s*\[[-+ox*✓✔✕✗✘ ]\]\s*$")
_ROOT = re.compile(
    r"\s*(?:[\[{(/][-+ox*_ ]?[\]})/]\s*)?(?:(?:root|sequence|selector|tree|plan|task)\s*[:=]\s*)?(?P<name>\w.*)",
    re.IGNORECASE,
)
_CONTROL = re.compile(r"(?:\W*(?:root|sequence|selector|fallback|parallel|repeat|retry|inverter)\W*)$", re.IGNORECASE)
"""A node of a behavior tree that does nothing itself."""


def _tree(lines: Sequence[str]) -> Unwrap | None:
    """Unwrap trees as tools print them, `|-- Walk(kitchen)`, below the line that names them."""
    texts = _texts(lines)
    branches = [found for line in texts if (found := _BRANCH.match(line))]
    if len(branches) < 2 or len(branches) < _SHARE * len(texts) or _BRANCH.match(texts[0]):
        return None

    def unwrap(raw: str) -> str:
        branch = _BRANCH.match(raw)
        text = _STATE.sub("", raw[branch.end() :] if branch else raw)
        if _CONTROL.match(text):
            return ""
        if branch:
            return f"{' ' * len(branch['stem'])}- {text}"
        root = _ROOT.fullmatch(text)
        return f"Task: {root['name'].replace('_', ' ')}" if root else raw

    return unwrap


_CUE = re.compile(r"\s*(?:\d{1,2}:)?\d{1,2}:\d\d[.,]\d{1,3}\s*-->\s*(?:\d{1,2}:)?\d{1,2}:\d\d[.,]\d{1,3}.*")
_NO_CUE = re.compile(r"\s*(?:\d{1,5}|WEBVTT.*|NOTE\b.*|)\s*")
_SPOKEN = re.compile(r"\s*(?:<[^<>]*>\s*|[-–]\s+)*")


def _subtitles(lines: Sequence[str]) -> Unwrap | None:
    """Unwrap subtitles: each text below a time is a line of its own."""
    if not any(map(_CUE.fullmatch, lines)):
        return None

    def unwrap(raw: str) -> str:
        is_layout = _CUE.fullmatch(raw) or _NO_CUE.fullmatch(raw)
        return "" if is_layout else f"- {_SPOKEN.sub('', raw, count=1)}"

    return unwrap


_ARROW = re.compile(r"\s*(?:[↓⬇▼→⟶➔➜➡⇒]\ufe0f?|-+>|=+>)\s*")
_DOWN = re.compile(r"\s*(?:[↓⬇▼→⇓]\ufe0f?|[|v]|-+>|=+>)\s*")


def _arrows(lines: Sequence[str]) -> Unwrap | None:
    """Unwrap steps that arrows join over lines, on lines of their own or before all steps but the first."""
    texts = _texts(lines)
    steps = [line for line in texts if not _DOWN.fullmatch(line)]
    led = [line for line in steps if _ARROW.match(line)]
    is_led = len(led) > 1 and len(led) >= _SHARE * len(steps)
    if not (is_led and is_like_step(steps[0].strip()) and _GOES.match(steps[0])) and len(texts) - len(steps) < 2:
        return None

    def unwrap(raw: str) -> str:
        text = _ARROW.sub("", raw, count=1)
        is_step = is_led or is_like_step(text.strip())
        return "" if not raw.strip() or _DOWN.fullmatch(raw) else f"- {text}" if is_step else text

    return unwrap


_GOES = re.compile(r"\s*(?:walk|go|head|move|run|get|stand|take|grab|pick|open|turn|switch)\b", re.IGNORECASE)

_COMMENT = re.compile(r"\s*(?P<mark>#+|//+|--+|%+|;+|'|REM\b)\s*(?=\S)")


def _comments(lines: Sequence[str]) -> Unwrap | None:
    """Unwrap steps of which each stands behind the mark of a comment, or MediaWiki's of a list."""
    texts = [line for line in _texts(lines) if not HEADING.fullmatch(line)]
    marks = [found["mark"] if (found := _COMMENT.match(line)) else "" for line in texts]
    if len(texts) < 2 or not marks[0] or set(marks) != {marks[0]}:
        return None
    words = [_COMMENT.sub("", line, count=1) for line in texts]
    if not all(map(is_like_step, words[1:])) or any(line.strip().startswith("#include") for line in texts):
        return None

    def unwrap(raw: str) -> str:
        found = None if HEADING.fullmatch(raw) else _COMMENT.match(raw)
        text = raw[found.end() :] if found else raw
        return f"- {text}" if found and is_like_step(text) else text

    return unwrap


HEADING = re.compile(r"\s*(?P<mark>={1,6})\s+(?P<text>[^=\s][^=]*?)\s*(?P=mark)?\s*|\s*h[1-6]\.\s+(?P<other>\S.*)")
"""A heading of MediaWiki and AsciiDoc, `== Title ==`, or of Textile, `h1. Title`."""

_QUOTED = re.compile(r"\s*(?:[\"“](?P<said>[^\"“”]{3,})[\"”]|'(?P<other>[^']{3,})')\s*[,;]?\s*")


def _quotes(lines: Sequence[str]) -> Unwrap | None:
    """Unwrap steps in quotation marks, each on a line."""
    texts = _texts(lines)
    found = [each for line in texts if (each := _QUOTED.fullmatch(line))]
    like = sum(is_like_step(each["said"] or each["other"]) for each in found)
    if len(found) < 2 or like < _SHARE * len(texts):
        return None

    def unwrap(raw: str) -> str:
        quoted = _QUOTED.fullmatch(raw)
        return f"- {quoted['said'] or quoted['other']}" if quoted else raw

    return unwrap


_SCENARIO = re.compile(r"\s*(?P<word>Feature|Scenario(?: Outline)?|Background)\s*:\s*(?P<name>.*)")
_CLAUSE = re.compile(r"\s*(?:Given|When|Then|And|But|\*)\s+(?P<said>\S.*)")


def _scenarios(lines: Sequence[str]) -> Unwrap | None:
    """Unwrap scenarios of Gherkin: `Given I walk to the desk`."""
    texts = _texts(lines)
    if not any(map(_SCENARIO.match, texts)) or sum(map(bool, map(_CLAUSE.match, texts))) < 2:
        return None

    def unwrap(raw: str) -> str:
        named, clause = _SCENARIO.fullmatch(raw), _CLAUSE.fullmatch(raw)
        if named:
            return f"Task: {named['name']}" if named["word"].startswith("Scenario") and named["name"] else ""
        return f"- {clause['said']}" if clause else raw

    return unwrap


_SECTION = re.compile(r"\s*\[+(?P<name>[A-Za-z_][\w .-]*)\]+\s*(?:[#;].*)?")
_SETTING = re.compile(r"\s*[\"']?(?P<key>[A-Za-z_0-9][\w .-]{0,40}?)[\"']?\s*[=:]\s*(?P<value>\S.*)")
_STEPS = re.compile(r"(?:(?:step|action|act|do|task|command|s|a)s?[ ._-]*\d*|\d{1,3})", re.IGNORECASE)
_LISTS = re.compile(r"(?:steps|plan|actions|program|sequence|commands)", re.IGNORECASE)
_NAMES = re.compile(r"(?:title|name|task|goal|activity)", re.IGNORECASE)
_GENERAL = re.compile(r"(?:plan|steps?|actions?|program|routine|task|main|default|sequence)", re.IGNORECASE)
_ENTRY = re.compile(r"\s*[\"'](?P<said>[^\"']+)[\"']\s*,?\s*\]?\s*")


def _sections(lines: Sequence[str]) -> Unwrap | None:
    """Unwrap settings in sections, as in INI and TOML: `[rest]` above `step1 = walk to sofa`, or a list of steps."""
    texts = _texts(lines)
    settings = [found for line in texts if (found := _SETTING.fullmatch(line))]
    keyed = [each for each in settings if _STEPS.fullmatch(each["key"]) or _LISTS.fullmatch(each["key"])]
    is_list = any(_LISTS.fullmatch(each["key"]) and each["value"].startswith("[") for each in settings)
    has_sections = any(map(_section, texts))
    if not (has_sections and keyed) and not (is_list and any(_NAMES.fullmatch(each["key"]) for each in settings)):
        return None
    return _unsectioned


def _section(raw: str) -> str:
    """Return the name of a section; an action in brackets is a step."""
    found = _SECTION.fullmatch(raw)
    return found["name"] if found and not names_action(found["name"]) else ""


def _unsectioned(raw: str) -> str:
    section, setting, entry = _section(raw), _SETTING.fullmatch(raw), _ENTRY.fullmatch(raw)
    if section:
        return "" if _GENERAL.fullmatch(section) else f"## {section.replace('_', ' ')}"
    if entry:
        return f"- {entry['said']}"
    if not setting:
        return "" if raw.strip() in ("]", "],", "[") else raw
    key, value = setting["key"], setting["value"].rstrip(",")
    if _NAMES.fullmatch(key):
        return f"Task: {value.strip(chr(34) + chr(39))}"
    if _LISTS.fullmatch(key) and value.strip() in ("[", '"""'):
        return ""
    is_step = _STEPS.fullmatch(key) or _LISTS.fullmatch(key)
    return f"- {value if value.startswith('[') else value.strip(chr(34) + chr(39))}" if is_step else raw


WRAPPINGS: dict[str, Wrapping] = {
    "subtitles": Wrapping(_subtitles, re.compile(r".*\d-->|.*\d\s-->\s*\d")),
    "scenarios": Wrapping(_scenarios, _SCENARIO),
    "sections": Wrapping(_sections, re.compile(r"\s*\[|[^=:]{1,40}[=:]\s*\[")),
    "arrows": Wrapping(_arrows, re.compile(rf"{_DOWN.pattern}$|{_ARROW.pattern}")),
    "tree": Wrapping(_tree, _BRANCH),
    "comments": Wrapping(_comments, _COMMENT),
    "quotes": Wrapping(_quotes, re.compile(r"\s*[\"'“]")),
    "counts": Wrapping(counting_of, re.compile(r"\W*\w")),
}
"""Wrappings by name, in the order in which they are tried."""
