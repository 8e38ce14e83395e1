"""Markdown tables of steps: `| 1 | Walk to fridge |`."""

import re
from collections.abc import Sequence

from hearth.kb.language.forms.composed import composed_step
from hearth.kb.language.forms.form import Form, Placed, step
from hearth.kb.language.plan_lines import plan_line

_ROW = re.compile(r"\s*\|(.*)\|\s*")
_LINE = re.compile(r"\s*\|?(?:\s*:?-{2,}:?\s*\|)+(?:\s*:?-{2,}:?\s*)?\s*")
_WORDS = re.compile(r"[^\W\d]")
_NAMED = re.compile(r"(?:action|step|what|instruction|do|task|activity)s?", re.IGNORECASE)

_THINGS = re.compile(
    r"(?:objects?|targets?|things?|items?|receptacle|location|arg(?:ument)?s?)(?: ?\d)?", re.IGNORECASE
)


def _cells(raw: str) -> list[str]:
    row = _ROW.fullmatch(raw)
    return [cell.strip().strip("*`") for cell in row[1].split("|")] if row else []


def _fits(lines: Sequence[str]) -> bool:
    return any("-" in line and "|" in line and len(line) < 1000 and _LINE.fullmatch(line) for line in lines) and any(
        map(_cells, lines)
    )


def _lines(lines: Sequence[str]) -> list[Placed]:
    """Return the rows below a line of dashes as steps: the cell below `Action` or `Step`, else the first of words."""
    found: list[Placed] = []
    column, things = -1, list[int]()
    for row, raw in enumerate(lines):
        cells = _cells(raw)
        if not cells:
            column = column if not raw.strip() else -1
            found.append(Placed(row, plan_line(raw)))
        elif _LINE.fullmatch(raw[:1000]):
            head = _cells(lines[row - 1]) if row else []
            column = next((n for n in range(len(head) - 1, -1, -1) if _NAMED.fullmatch(head[n]) and n), 0)
            things = [n for n, name in enumerate(head) if _THINGS.fullmatch(name)]
        elif column >= 0:
            words = cells[column] if column < len(cells) else ""
            objects = [cells[n] for n in things if n < len(cells) and _WORDS.search(cells[n])]
            if objects and words:
                found.append(step(row, composed_step(words, objects)))
                continue
            words = words if _WORDS.search(words) else next((cell for cell in cells if _WORDS.search(cell)), "")
            found += [step(row, words)] if words else []
    return found


MARKDOWN_TABLE = Form(_fits, _lines, lambda raw: bool(_cells(raw)), re.compile(r"\s*(?:#|\**task\b.*:)", re.IGNORECASE))
