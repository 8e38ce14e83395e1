"""JSON inside a text, as language models answer: in a code fence, or behind what is said before it."""

import json
import re
from collections.abc import Iterator

from hearth.kb.language.plan_lines import plan_line
from hearth.pipelines.readers import json_records
from hearth.pipelines.readers.field_columns import Asked
from hearth.pipelines.readers.json_documents import located
from hearth.pipelines.readers.reader_items import Item, opened
from hearth.pipelines.readers.records_in_json import holds_program, named
from hearth.pipelines.readers.step_rows_by_task import Entry
from hearth.pipelines.readers.texts_with_positions import Located
from hearth.schemas.program_boundaries import TITLE
from hearth.storage.archives import Place, size_of

NAME = "enclosed"

LARGEST = 4_000_000
"""Bytes of a text at most in which JSON is looked for."""

_BEGINS = re.compile(r"^[^\S\n]*(?:[\w *#-]{1,40}:[^\S\n]*)?(?=[{\[][^\S\n]*(?:[\"{\[]|$))", re.MULTILINE)
_MOST = 1_000
"""Places at most at which JSON may begin."""


def scan(path: Place, place: str, asked: Asked) -> Iterator[Item]:
    """Yield the items of each JSON value in a text."""
    yield from json_records.of_entries(_entries(path, place), place, asked)


def holds_programs(path: Place, place: str) -> bool:
    """Return whether JSON with steps stands in a text."""
    return size_of(path) <= LARGEST and any(holds_program(entry.value.value) for entry in _entries(path, place))


def _entries(path: Place, place: str) -> Iterator[Entry]:
    with opened(path) as (file, encoding):
        text = file.read(LARGEST).decode(encoding, "replace").replace("\r\n", "\n")
    end = tried = 0
    decoder = json.JSONDecoder()
    for found in _BEGINS.finditer(text):
        if found.end() < end or tried > _MOST:
            continue
        tried += 1
        try:
            _, stop = decoder.raw_decode(text, found.end())
        except (ValueError, RecursionError):
            continue
        line, column = text.count("\n", 0, found.end()) + 1, found.end() - text.rfind("\n", 0, found.end())
        value = located(text[found.end() : stop], place, line, column)
        if isinstance(value, Located):
            yield Entry(_titled(value, text[end : found.start()]), line, f"{place}:{line}")
        end = stop


def _titled(found: Located, above: str) -> Located:
    """Return a value with the title that stands above it, where it has none."""
    read = [plan_line(line) for line in above.split("\n")]
    title = next((TITLE.sub("", line.text, count=1) for line in reversed(read) if line.heading), "")
    if isinstance(found.value, list):
        found.value = {"title": title, "steps": found.value} if title else {"steps": found.value}
    elif title and isinstance(found.value, dict) and "title" not in named(found.value, {}):
        found.value = {"title": title, **found.value}
    return found
