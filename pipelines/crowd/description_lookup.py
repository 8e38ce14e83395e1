"""Programs whose description is unknown, found by the ids of the first stage, kept as digests."""

from collections.abc import Iterable, Iterator

from hearth.pipelines.crowd.key_counts import SeenSet, digest
from hearth.pipelines.readers import crowd
from hearth.pipelines.readers.reader_items import Item, refused
from hearth.schemas.failures import Code
from hearth.storage.rejects import Reject


class Described:
    """The ids of the first stage's answers; if there are none, every program is accepted."""

    def __init__(self) -> None:
        self._ids = SeenSet()

    def noted(self, items: Iterable[Item]) -> Iterator[Item]:
        """Yield the same items, and store the ids of the first stage."""
        for item in items:
            if item.reader == crowd.NAME and item.value["stage"] == 1:
                self._ids.add(digest(item.value["cells"]["HITId"].strip()))
            yield item

    def checked(self, item: Item) -> Item:
        """Return the item, or its refusal if its description is unknown."""
        if item.reader != crowd.NAME or item.value["stage"] == 1 or not len(self._ids):
            return item
        name = item.value["cells"]["Input.description_id"].strip()
        if name and digest(name) in self._ids:
            return item
        message = f"no description `{name[:60]}` in any batch of the first stage" if name else "it names no description"
        suggestion = "give the batch with its description, or programs alone"
        fault = Reject.of(
            Code.UNKNOWN_ID, message, file=item.place, line=item.line, found=name[:60], suggestion=suggestion
        )
        return refused(item.place, fault, item.record_id, item.line)
