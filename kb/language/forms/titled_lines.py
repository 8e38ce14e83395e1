"""A plan on each line, behind its title: `Rest: walk to couch -> lie on couch`, `get book = ["find book"]`."""

import re
from collections.abc import Iterator, Sequence

from hearth.kb.language.forms.form import Form, Placed, step, title
from hearth.kb.language.plan_lines import META, plan_line
from hearth.kb.language.step_like_lines import is_like_step
from hearth.kb.language.steps_in_a_line import parts_of

_TITLED = re.compile(
    r"\s*(?:[-*+•–▪]\s+)?(?P<title>\**[^\W\d_][^:=;>→\[\]()]{1,70}?\**)\s*(?::\**\s*|=(?!>)\s*|\s[-–—]\s+)(?P<steps>\S.{8,})"
)
_ROW = re.compile(r"\s*\|(?:[^|]{0,80}\|)??(?P<title>[^|]{2,80})\|(?P<steps>[^|]+(?:<br|;|->|→|\d[.)]\s)[^|]*)\|\s*")
"""A row of a Markdown table with a whole plan in a cell."""

_PIPED = re.compile(r"(?P<title>[^|]{2,80})\|(?P<steps>[^|]{8,}|[^|]{3,}(?:\|[^|]{3,})+)\|?\s*")
"""Title and steps between pipes, `write letter | sit on chair | grab pen`."""

_LAYOUT = re.compile(r"[\s|:-]*|\s*\|[^.]*\|\s*")
_LABEL = re.compile(
    r"(?:task|title|activity|goal|plan|steps?|answer|actions?|note|tip|thought|act|obs\w*)\b", re.IGNORECASE
)
_GOING = re.compile(r"\s*(?:\(?\d{1,3}[.):]\s*)?(?:walk|go|head|run) (?:to|into)\b", re.IGNORECASE)
"""The first of several steps, and no title."""

_HALF = 0.5
_LONGEST = 5_000


_BEGINS = re.compile(
    r"(?!\s*\|\s*:?-)\s*(?:[-*+•–▪]\s+)?(?:\**[^\W\d_][^:=;>→\[\]()]{1,70}?\**\s*[:=–—-]|\|(?=.*(?:<br|;|->|→|\d[.)]\s))|\|.*[a-z]\.\s*\|\s*$|[^|\[(<]{2,80}\|[^|]{3,}|\s*(?:<t(?:able|body)\b[^>]*>\s*)?<tr\b[^>]*>\s*<td\b)"
)


def _titled(raw: str) -> re.Match[str] | None:
    if len(raw) > _LONGEST:
        return None
    found = _ROW.fullmatch(raw) if raw.lstrip().startswith("|") else _PIPED.fullmatch(raw) or _TITLED.match(raw)
    if not found or _LABEL.match(found["title"].strip("*")) or META.match(raw.strip()):
        return None
    if _GOING.match(found["title"]):
        return None
    return found if len(parts_of(found["steps"].strip())) > 1 else None


def _fits(lines: Sequence[str]) -> bool:
    """Return whether half of the lines at least are titled plans."""
    texts = [line for line in lines if line.strip() and (_titled(line) or not _is_table(line))]
    found = sum(_titled(line) is not None for line in texts)
    return found > 0 and found >= _HALF * len(texts)


def _is_table(raw: str) -> bool:
    return raw.lstrip().startswith("|") and _LAYOUT.fullmatch(raw) is not None


def _lines(lines: Sequence[str]) -> list[Placed]:
    return [each for row, raw in enumerate(lines) for each in _line(row, raw)]


def _line(row: int, raw: str) -> Iterator[Placed]:
    found = _titled(raw)
    if found is None and _is_table(raw):
        return
    if found is None and raw.lstrip().startswith("|"):
        *_, name, words = ["", *(cell.strip() for cell in raw.strip(" |").split("|"))]
        yield title(row, name)
        yield step(row, words)
        return
    if found is None:
        read = plan_line(raw)
        yield Placed(row, read._replace(number=0) if read.text and is_like_step(read.text) else read)
        return
    yield title(row, found["title"].strip("* "))
    for part in parts_of(found["steps"].strip()):
        yield step(row, part.rstrip("."))


TITLED_LINES = Form(_fits, _lines, lambda raw: _titled(raw) is not None, _BEGINS)
