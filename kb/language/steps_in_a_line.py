"""The steps of a line that holds several: a list, calls, numbers, or what joins them."""

import re
from collections.abc import Iterator

from hearth.kb.language.forms.code_calls import calls_of
from hearth.kb.language.operator_step_syntax import operator_step
from hearth.kb.language.step_like_lines import chained, clauses, is_like_step

_BREAK = re.compile(r"\s*<br\s*/?>\s*", re.IGNORECASE)
_MARK = re.compile(r"(?:[(\[]?\d{1,2}[.):\]]|[-*•])\s+")
_NUMBER = re.compile(r"(?:^|\s)[(\[]?\d{1,2}[.):\]]\s+")
_LISTED = re.compile(
    r"(?:[\w ]{1,30}?\s*(?::=|=|:)\s*|\w+\(\s*\w+\s*,\s*)?[\[(]\s*(?P<inside>.*?)\s*,?\s*[\])][\s).,;]*"
)
_TEXT = re.compile(r"\"((?:[^\"\\]|\\.)*)\"|'((?:[^'\\]|\\.)*)'")
_LEVEL = re.compile(r"[()\[\]{},]")


def parts_of(text: str) -> list[str]:
    """Return the steps of a line that holds several in a list, calls, numbers, or joined; none where it does not."""
    if _BREAK.search(text):
        return [_MARK.sub("", part, count=1) for part in _BREAK.split(text) if part.strip()]
    piped = text.strip(" |").split("|")
    if len(piped) > 1 and 2 * sum(is_like_step(part.strip()) for part in piped) > len(piped):
        return [part.strip() for part in piped]
    if found := listed(text) or calls_of(text):
        return found
    if _NUMBER.match(text) and len(_NUMBER.findall(text)) > 1:
        return [part.strip() for part in _NUMBER.split(text) if part.strip()]
    return [part for each in chained(text) for part in (clauses(each) or [each])]


def listed(text: str) -> list[str]:
    """Return the steps of a list on a line, `plan = ["walk to desk", "find lamp"]` or `[walk(desk), find(lamp)]`."""
    found = _LISTED.fullmatch(text) if "[" in text or text.startswith("(") else None
    if not found:
        return []
    inside = found["inside"]
    if inside[:1] in ("'", '"'):
        texts = [one or other for one, other in _TEXT.findall(inside)]
        is_whole = not _TEXT.sub("", inside).strip(" ,")
        return texts if is_whole and (len(texts) > 1 or text.startswith("[")) else []
    entries = [each.strip() for each in _entries(inside)]
    steps = [operator_step(each) or each for each in entries]
    are_steps = all(
        step != each or (" " in each and is_like_step(each)) for step, each in zip(steps, entries, strict=True)
    )
    return steps if len(steps) > 1 and are_steps else []


def _entries(inside: str) -> Iterator[str]:
    """Part a list at the commas outside of brackets."""
    start = depth = 0
    for found in _LEVEL.finditer(inside):
        if found[0] == "," and not depth:
            yield inside[start : found.start()]
            start = found.end()
        elif found[0] != ",":
            depth += 1 if found[0] in "([{" else -1
    yield inside[start:]
