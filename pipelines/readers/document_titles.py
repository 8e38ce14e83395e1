"""Titles of documents and of their chapters, above the plans in them: they are no records."""

import re
from collections.abc import Iterator

from hearth.kb.language.plan_lines import is_aside, level_of, plan_line
from hearth.kb.language.step_like_lines import chained, is_like_step
from hearth.schemas.program_boundaries import TITLE

Block = tuple[int, list[str]]
"""The lines of a program, with the number of the first."""

_HEADING = re.compile(r"#{1,6}\s+\S")
_UNDERLINE = re.compile(r"(=+|-+)\s*")
_OF_SEVERAL = re.compile(
    r"\b(?:plans|programs|tasks|activities|routines|scripts|recipes|procedures|examples|chores|instructions|collection"
    r"|data ?set|document|overview|contents)\b",
    re.IGNORECASE,
)
_NONE = 100


def without_document_titles(blocks: Iterator[Block]) -> Iterator[Block]:
    """Yield the programs, without the headings of a document and its chapters, whose sections are programs."""
    first, second = next(blocks, None), next(blocks, None)
    if first is None or second is None:
        yield from (first,) if first is not None else ()
        return
    following = _levels(second[1])
    level = following[0][1] if following else _NONE
    if not _is_document(first[1], second[1], level):
        yield _below(first, level)
    yield _below(second, level)
    for block in blocks:
        yield _below(block, level)


def _is_document(lines: list[str], following: list[str], level: int) -> bool:
    """Return whether a text without steps only names the document: its heading is of plans, or of another kind."""
    read = [plan_line(raw) for raw in lines]
    headings = _levels(lines)
    if len(headings) != 1 or headings[0][0] or not _HEADING.match(lines[0]) or TITLE.match(read[0].text):
        return False
    if any(line.number is not None or is_like_step(line.text) or chained(line.text) for line in read[1:] if line.text):
        return False
    title = next(plan_line(raw).text for raw in following if raw.strip())
    is_same_kind = _HEADING.match(next(raw for raw in following if raw.strip())) is not None
    if not is_same_kind:
        return TITLE.match(title) is not None
    return headings[0][1] < level or _OF_SEVERAL.search(read[0].text) is not None


def _below(block: Block, level: int) -> Block:
    """Return a program from its own heading on, which has the level of those of other programs, and others above."""
    number, found = block
    headings = _levels(found)
    own = next((n for n, (_, its) in enumerate(headings) if its == level), 0)
    above = [its for _, its in headings[:own]]
    if not own or headings[0][0] or above != sorted(set(above)) or above[-1] >= level:
        return block
    at = headings[own][0]
    if any(plan_line(raw).number is not None for raw in found[:at]):
        return block
    return number + at, found[at:]


def _levels(lines: list[str]) -> list[tuple[int, int]]:
    """Return the headings among lines, each with its index and level."""
    found = []
    for n, raw in enumerate(lines):
        under = _UNDERLINE.fullmatch(lines[n + 1]) if n + 1 < len(lines) and raw.strip() else None
        if _HEADING.match(raw) or (
            plan_line(raw).heading and not TITLE.match(raw) and not is_aside(plan_line(raw).text)
        ):
            found.append((n, level_of(raw)))
        elif under and (not n or not lines[n - 1].strip()) and plan_line(raw).number is None:
            found.append((n, 1 if under[1][0] == "=" else 2))
    return found
