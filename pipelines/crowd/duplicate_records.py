"""Records that were read before: the same id, the same answer of a worker, or the same text in an archive too."""

import re
from collections.abc import Iterable, Iterator
from typing import Any

from hearth.pipelines.crowd.key_counts import SeenSet, digest
from hearth.pipelines.readers import crowd, json_records, natural_language_plans, program_text
from hearth.pipelines.readers.reader_items import Item, refused
from hearth.schemas.failures import Code
from hearth.storage.rejects import Reject

_ARCHIVE = re.compile(r".*?\.zip(?=/)", re.IGNORECASE)
"""The archive in a file's place."""


class Repeated:
    """Finds copies of earlier records across all sources.

    The ids of programs of text are a file and a running number, of which only the count is kept.
    """

    def __init__(self) -> None:
        self._seen = SeenSet()
        self._numbered: dict[str, int] = {}
        self._likely = False
        self._texts: dict[str, SeenSet] = {}

    def first(self, items: Iterable[Item], reader: str, place: str) -> Iterator[Item]:
        """Yield the items of a file, copies as refusals."""
        items = self._new_texts(items, place)
        if reader != program_text.NAME or self._likely:
            yield from map(self._checked, items)
            return
        count = 0
        for count, item in enumerate(items, 1):  # noqa: B007 - its last value is kept
            yield item
        self._numbered[f"{program_text.NAME}:{place}"] = count

    def _new_texts(self, items: Iterable[Item], place: str) -> Iterator[Item]:
        """Yield the items; those whose text was in a folder or archive other than this file's, as refusals."""
        archive = _ARCHIVE.match(place)
        mine = archive[0] if archive else ""
        for item in items:
            key = _text_key(item)
            if key is not None:
                if any(key in seen for other, seen in self._texts.items() if other != mine):
                    yield _copy("this text", item)
                    continue
                self._texts.setdefault(mine, SeenSet()).add(key)
            yield item

    def _checked(self, item: Item) -> Item:
        if item.reader == "refused":
            return item
        name = item.record_id
        if name.startswith(f"{program_text.NAME}:"):
            self._likely = True
        answer = _answer(item)
        if self._was_numbered(name) or self._seen.add(digest(name)):
            what = "this id"
        elif answer is not None and self._seen.add(digest(answer)):
            what = "this text" if item.reader == natural_language_plans.NAME else "this answer of the same worker"
        else:
            return item
        return _copy(what, item)

    def _was_numbered(self, name: str) -> bool:
        place, _, number = name.rpartition("#")
        if number.isdecimal() and place in self._numbered:
            return 1 < int(number) <= self._numbered[place]
        return self._numbered.get(name, 0) > 0


def _copy(what: str, item: Item) -> Item:
    name = item.record_id
    fault = Reject.of(Code.DUPLICATE, f"{what} was read before", file=item.place, line=item.line, found=name)
    return refused(item.place, fault, name, item.line)


def _text_key(item: Item) -> int | None:
    """Return a digest of text whose id is only its place, which differs between a folder and an archive of it."""
    if item.reader not in (program_text.NAME, json_records.NAME) or not item.record_id.startswith(f"{item.reader}:"):
        return None
    try:
        return digest([item.reader, item.value.get("text", item.value)])
    except (TypeError, ValueError, AttributeError, RecursionError):  # it is refused when it is to be stored
        return None


def _answer(item: Item) -> Any:
    """Return the content by which copies are found.

    A crowd worker's answer without its id, or natural-language steps.
    """
    if item.reader == natural_language_plans.NAME:
        return [natural_language_plans.NAME, item.value["text"]]
    if item.reader != crowd.NAME:
        return None
    return {name: cell for name, cell in item.value["cells"].items() if name in crowd.COLUMNS}
