"""Plans in YAML: lists of steps below `steps:`, as words or as an action with its objects."""

import re
from collections.abc import Iterator, Sequence

from hearth.kb.language.forms.form import Form, Placed, remark, step, title
from hearth.kb.language.steps_from_calls import composed_step

_LISTS = r"(?:steps|plan|actions|program|instructions|sequence|script)"
_LIST = re.compile(rf"\s*(?:-\s+)?[\"']?{_LISTS}[\"']?\s*:\s*(?:#.*)?")
_TITLE = re.compile(r"\s*(?:-\s+)?(?:task|title|name|goal|activity|instruction)\s*:\s*(\S.*)")
_KEY = re.compile(r"(?P<indent>\s*)(?P<item>-\s+)?(?P<key>[A-Za-z][\w -]{0,60}?)\s*:(?:\s+(?P<value>\S.*))?")
_ITEM = re.compile(r"\s*-\s+(?P<words>\S.*)")
_LAYOUT = re.compile(r"\s*(?:#.*|---|\.\.\.)?\s*")
_ACTIONS = ("action", "verb", "act")
_OBJECTS = frozenset(("object", "objects", "obj", "target", "targets", "args", "arg", "item", "on", "in", "to", "into"))


def _plain(value: str) -> str:
    return value.strip().strip("\"'")


def _fits(lines: Sequence[str]) -> bool:
    """Return whether every line is of YAML, one begins a list of steps, and another names the task or an action."""
    texts = [line for line in lines if not _LAYOUT.fullmatch(line)]
    if not any(map(_LIST.fullmatch, texts)) or not any(map(_ITEM.fullmatch, texts)):
        return False
    if not all(_KEY.fullmatch(line) or _ITEM.fullmatch(line) for line in texts):
        return False
    return any(_TITLE.fullmatch(line) or _action(line) for line in texts)


def _action(raw: str) -> str:
    """Return the action of a line that begins a step, `- action: walk`."""
    found = _KEY.fullmatch(raw)
    return _plain(found["value"]) if found and found["item"] and found["key"] in _ACTIONS and found["value"] else ""


def _lines(lines: Sequence[str]) -> list[Placed]:
    return [each for row, raw in enumerate(lines) for each in _of_line(row, raw, lines)]


def _of_line(row: int, raw: str, lines: Sequence[str]) -> Iterator[Placed]:
    named, item = _TITLE.fullmatch(raw), _ITEM.fullmatch(raw)
    if _LAYOUT.fullmatch(raw) or _LIST.fullmatch(raw):
        return
    if action := _action(raw):
        objects = list(_objects(lines[row + 1 :]))
        relation = objects[-1][0] if objects else ""
        yield step(row, composed_step(action, [name for _, each in objects for name in each], relation))
    elif named:
        yield title(row, _plain(named[1]))
    elif item and not _KEY.fullmatch(raw):
        yield step(row, _plain(item["words"]))
    elif (key := _KEY.fullmatch(raw)) and key["key"] not in _OBJECTS:
        yield remark(row, raw)


def _objects(below: Sequence[str]) -> Iterator[tuple[str, list[str]]]:
    """Yield the keys of a step's objects, and the names: those before the next item."""
    for raw in below:
        found = _KEY.fullmatch(raw)
        if found is None or found["item"]:
            return
        if found["key"] in _OBJECTS and found["value"]:
            yield found["key"], [_plain(each) for each in found["value"].strip("[]").split(",") if each.strip()]


YAML = Form(
    _fits,
    _lines,
    lambda raw: _ITEM.fullmatch(raw) is not None and not _TITLE.fullmatch(raw),
    re.compile(r"\s*(?:-\s+)?(?:task|title|name|goal|activity|instruction)\s*:\s*\S"),
)
