"""Steps as Python writes them in lists: `("grab", "milk"),` or `"grab milk",` on a line of its own."""

import re
from collections.abc import Sequence

from hearth.kb.language.forms.form import Form, Placed, step, title
from hearth.kb.language.plan_lines import plan_line
from hearth.kb.language.steps_from_calls import composed_step

_TEXT = r"(?:\"(?:[^\"\\]|\\.)*\"|'(?:[^'\\]|\\.)*')"
_TUPLE = re.compile(rf"\s*[(\[]\s*({_TEXT}(?:\s*,\s*{_TEXT})*)\s*,?\s*[)\]]\s*,?\s*(?:#.*)?")
_STRING = re.compile(rf"\s*({_TEXT})\s*,?\s*(?:#.*)?")
_QUOTED = re.compile(_TEXT)
_KEY = r"(?P<quote>[\"'])(?P<key>[^\"']{1,80})(?P=quote)\s*:"
_BEGINS = re.compile(rf"\s*(?:(?P<name>[A-Za-z_]\w*)\s*(?::\s*[\w\[\], ]+)?=|{_KEY})\s*[\[(]\s*")
_LAYOUT = re.compile(r"\s*(?:[\])}]\s*,?|[A-Za-z_]\w*\s*=\s*\{|#.*|`{3}.*|(?:from|import)\b.*)?\s*")
_MOST = 1_000
_USUAL = frozenset(("plan", "steps", "actions", "traj", "trajectory", "program", "demo", "sequence"))
"""Names of lists that say nothing about the task."""


_INLINE = re.compile(
    rf"\s*(?:[A-Za-z_]\w*\s*=\s*)?\[\s*(?:[(\[]\s*{_TEXT}(?:\s*,\s*{_TEXT})*\s*,?\s*[)\]]\s*,?\s*)+\]\s*,?\s*"
)
_INNER = re.compile(rf"[(\[]\s*({_TEXT}(?:\s*,\s*{_TEXT})*)\s*,?\s*[)\]]")


def _inline(raw: str) -> list[list[str]]:
    """Return the tuples of a list on one line."""
    if len(raw) > _MOST or not _INLINE.fullmatch(raw):
        return []
    return [[text[1:-1] for text in _QUOTED.findall(each)] for each in _INNER.findall(raw)]


def _parts(raw: str) -> list[str]:
    """Return the texts of a line that is a tuple or a text; none of another."""
    found = (_TUPLE.fullmatch(raw) or _STRING.fullmatch(raw)) if len(raw) <= _MOST else None
    return [text[1:-1] for text in _QUOTED.findall(found[1])] if found else []


def _fits(lines: Sequence[str]) -> bool:
    """Return whether a list begins, and two lines at least, and most, are its entries."""
    if any(len(_inline(line)) > 1 for line in lines):
        return all(_inline(line) or _LAYOUT.fullmatch(line) for line in lines)
    texts = [line for line in lines if line.strip() and not _BEGINS.fullmatch(line) and not _LAYOUT.fullmatch(line)]
    found = sum(bool(_parts(line)) for line in texts)
    return found > 1 and 3 * found >= 2 * len(texts) and any(map(_BEGINS.fullmatch, lines))


def _lines(lines: Sequence[str]) -> list[Placed]:
    found: list[Placed] = []
    for row, raw in enumerate(lines):
        begins, parts = _BEGINS.fullmatch(raw), _parts(raw)
        if inline := _inline(raw):
            found += [step(row, composed_step(each[0], each[1:])) for each in inline]
        elif begins:
            name = begins["name"] or begins["key"]
            found += [] if name.lower() in _USUAL else [title(row, name.replace("_", " "))]
        elif len(parts) > 1:
            found.append(step(row, composed_step(parts[0], parts[1:])))
        elif parts:
            read = plan_line(parts[0])
            found.append(Placed(row, read) if read.bracketed else step(row, read.text))
        elif not _LAYOUT.fullmatch(raw):
            found.append(Placed(row, plan_line(raw)))
    return found


TUPLES = Form(_fits, _lines, lambda raw: bool(_parts(raw)), _BEGINS)
