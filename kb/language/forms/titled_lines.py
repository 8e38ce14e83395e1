"""A plan on each line, behind its title: `Rest: walk to couch -> lie on couch`, `get book = ["find book"]`."""

import re
from collections.abc import Iterator, Sequence

from hearth.kb.language.forms.code_calls import calls_of
from hearth.kb.language.forms.form import Form, Placed, step, title
from hearth.kb.language.plan_lines import META, plan_line
from hearth.kb.language.unmarked_lines import chained, clauses, is_like_step

_TITLED = re.compile(
    r"\s*(?:[-*+•–▪]\s+)?(?P<title>\**[^\W\d_][^:=;>→\[\]()]{1,70}?\**)\s*(?::\**\s*|=(?!>)\s*|\s[-–—]\s+)(?P<steps>\S.{8,})"
)
_ROW = re.compile(r"\s*\|(?:[^|]{0,80}\|)??(?P<title>[^|]{2,80})\|(?P<steps>[^|]+(?:<br|;|->|→|\d[.)]\s)[^|]*)\|\s*")
"""A row of a Markdown table with a whole plan in a cell."""

_HTML_ROW = re.compile(r"\s*(?:<t(?:able|body)\b[^>]*>\s*)?<tr\b[^>]*>\s*<t[dh]\b", re.IGNORECASE)
_CELLS = re.compile(r"(?:\s*</?(?:table|tbody|tr|td|th)\b[^>]*>)+\s*", re.IGNORECASE)
_PIPED = re.compile(r"(?P<title>[^|]{2,80})\|(?P<steps>[^|]{8,}|[^|]{3,}(?:\|[^|]{3,})+)\|?\s*")
"""Title and steps between pipes, `write letter | sit on chair | grab pen`."""

_LAYOUT = re.compile(r"[\s|:-]*|\s*\|[^.]*\|\s*")
_BREAK = re.compile(r"\s*<br\s*/?>\s*", re.IGNORECASE)
_MARK = re.compile(r"(?:[(\[]?\d{1,2}[.):\]]|[-*•])\s+")
_LABEL = re.compile(
    r"(?:task|title|activity|goal|plan|steps?|answer|actions?|note|tip|thought|act|obs\w*)\b", re.IGNORECASE
)
_LISTED = re.compile(r"""[\[(]\s*(["'].*["'])\s*,?\s*[\])]\s*[,;]?""")
_QUOTED = re.compile(r"\"((?:[^\"\\]|\\.)*)\"|'((?:[^'\\]|\\.)*)'")
_NUMBER = re.compile(r"(?:^|\s)[(\[]?\d{1,2}[.):\]]\s+")
_HALF = 0.5
_LONGEST = 5_000


_BEGINS = re.compile(
    r"(?!\s*\|\s*:?-)\s*(?:[-*+•–▪]\s+)?(?:\**[^\W\d_][^:=;>→\[\]()]{1,70}?\**\s*[:=–—-]|\|(?=.*(?:<br|;|->|→|\d[.)]\s))|\|.*[a-z]\.\s*\|\s*$|[^|\[(<]{2,80}\|[^|]{3,}|\s*(?:<t(?:able|body)\b[^>]*>\s*)?<tr\b[^>]*>\s*<td\b)"
)


def parts_of(text: str) -> list[str]:
    """Return the steps of a line that holds several in a list, calls, numbers, or joined; none where it does not."""
    if _BREAK.search(text):
        return [_MARK.sub("", part, count=1) for part in _BREAK.split(text) if part.strip()]
    piped = text.strip(" |").split("|")
    if len(piped) > 1 and 2 * sum(is_like_step(part.strip()) for part in piped) > len(piped):
        return [part.strip() for part in piped]
    listed = _LISTED.fullmatch(text)
    if listed:
        return [one or other for one, other in _QUOTED.findall(listed[1])]
    if calls := calls_of(text):
        return calls
    if _NUMBER.match(text) and len(_NUMBER.findall(text)) > 1:
        return [part.strip() for part in _NUMBER.split(text) if part.strip()]
    return [part for each in chained(text) for part in (clauses(each) or [each])]


def _titled(raw: str) -> re.Match[str] | None:
    if len(raw) > _LONGEST:
        return None
    raw = _CELLS.sub("|", raw) if _HTML_ROW.match(raw) else raw
    found = _ROW.fullmatch(raw) if raw.lstrip().startswith("|") else _PIPED.fullmatch(raw) or _TITLED.match(raw)
    if not found or _LABEL.match(found["title"].strip("*")) or META.match(raw.strip()):
        return None
    return found if len(parts_of(found["steps"].strip())) > 1 else None


def _fits(lines: Sequence[str]) -> bool:
    """Return whether half of the lines at least are titled plans."""
    texts = [line for line in lines if line.strip() and (_titled(line) or not (_is_table(line) or _is_tag(line)))]
    found = sum(_titled(line) is not None for line in texts)
    return found > 0 and found >= _HALF * len(texts)


def _is_tag(raw: str) -> bool:
    return raw.lstrip().startswith("<") and not _CELLS.sub("", raw).strip()


def _is_table(raw: str) -> bool:
    return raw.lstrip().startswith("|") and _LAYOUT.fullmatch(raw) is not None


def _lines(lines: Sequence[str]) -> list[Placed]:
    return [each for row, raw in enumerate(lines) for each in _line(row, raw)]


def _line(row: int, raw: str) -> Iterator[Placed]:
    found = _titled(raw)
    if found is None and (_is_table(raw) or _HTML_ROW.match(raw)):
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
