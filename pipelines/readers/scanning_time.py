"""A limit on the time for scanning a packed file: a small file may hold far more than a person would read."""

import time
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

from hearth.pipelines.engine.record_deadline import Deadline, OverTime
from hearth.pipelines.readers.reader_items import Item, refused
from hearth.schemas.failures import Code
from hearth.storage.archives import GZIP, ZSTD, Member, Place
from hearth.storage.input_files import read_start
from hearth.storage.rejects import Reject

SECONDS = 60.0
"""The time limit of a record, unless another is given."""

_BASE = 1 / 6
_OF_A_MEGABYTE = 1 / 2
"""Shares of that limit that a packed file has, for itself and for each megabyte: 10 seconds and 30.

People's archives take a tenth of that or less. A limit on size alone would not do: within those of `archives` some
kilobytes may unpack to millions of empty rows, on which a scanner works for minutes.
"""


class ScanningTime:
    """Limits the time of scanning packed files, each by its size; of an archive, that of all members together.

    It counts the processor's time while a scanner looks for its next record: neither the load of a machine nor the work
    on the records changes the refusals.

    Args:
        seconds: the time limit of a record; 0 for none.
    """

    def __init__(self, seconds: float) -> None:
        self._seconds = seconds
        self._spent: dict[Path, float] = defaultdict(float)
        self._deadline = Deadline(seconds * _BASE, time.process_time)

    def close(self) -> None:
        """Stop watching."""
        self._deadline.close()

    def within(self, path: Place, place: str, found: Iterator[Item]) -> Iterator[Item]:
        """Yield the items that a scanner finds; at the end of the time, a reject for the rest of the file."""
        file = _packed(path)
        if file is None or not self._seconds:
            yield from found
            return
        limit = self._seconds * (_BASE + _OF_A_MEGABYTE * file.stat().st_size / 1_000_000)
        while self._spent[file] < limit:
            self._deadline.seconds, began = limit - self._spent[file], time.process_time()
            try:
                with self._deadline:
                    item = next(found, None)
            except OverTime:
                break
            finally:
                self._spent[file] += time.process_time() - began
            if item is None:
                return
            yield item
        self._spent[file] = limit  # for other members of the archive, too
        message = f"packed, and scanning it takes more than {limit:.0f} s"
        reject = Reject.of(Code.TIMED_OUT, message, file=place, suggestion="unpack it, or raise --time-limit")
        yield refused(place, reject, f"{place}~")


def _packed(path: Place) -> Path | None:
    """Return the packed file that a place is in or is; None for a file that is not packed."""
    if isinstance(path, Member):
        return path.archive
    if not path.is_file():
        return None
    return path if read_start(path, 4).startswith((GZIP, ZSTD, b"PK")) else None
