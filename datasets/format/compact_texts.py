"""Many texts in a few bytes each; sequences of anything are texts, too, with a letter for each element."""

from __future__ import annotations

from array import array
from bisect import bisect_left
from collections.abc import Hashable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, overload

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


SURROGATES = 0xD800, 0x800
"""The first of the code points that stand for no character, and their number."""


def letter(number: int) -> str:
    """Return a character for a number from 0 to a million; small ones have the fewest bytes."""
    first, count = SURROGATES
    return chr(number if number < first else number + count)


class Letters(dict[Hashable, str]):
    """A letter for each element that was seen, given when it is first asked for."""

    def __missing__(self, element: Hashable) -> str:
        self[element] = given = letter(len(self))
        return given

    def text(self, elements: Iterable[Hashable]) -> str:
        """Return a sequence of elements as a text."""
        return "".join(map(self.__getitem__, elements))


class Texts(Sequence[str]):
    """Texts in one piece of memory, 2 GiB at most: each as a string of its own takes 60 bytes more.

    They are made when asked for.
    """

    def __init__(self, texts: Iterable[str] = ()) -> None:
        self._bytes = bytearray()
        self._bounds = array("i", [0])  # where each begins, and where the last one ends
        for text in texts:
            self.append(text)

    def append(self, text: str) -> None:
        """Add a text at the end."""
        self._bytes += text.encode()
        self._bounds.append(len(self._bytes))

    def __len__(self) -> int:
        return len(self._bounds) - 1

    @overload
    def __getitem__(self, place: int) -> str: ...
    @overload
    def __getitem__(self, place: slice) -> Texts: ...
    def __getitem__(self, place: int | slice) -> str | Texts:
        if isinstance(place, slice):
            return Texts(map(self.__getitem__, range(len(self))[place]))
        if place < 0:
            place += len(self)
            if place < 0:
                raise IndexError(place - len(self))
        return self._bytes[self._bounds[place] : self._bounds[place + 1]].decode()

    def __iter__(self) -> Iterator[str]:
        return map(self.__getitem__, range(len(self)))

    def order(self) -> NDArray[np.int64]:
        """Return (texts,) the places of the texts in alphabetical order; of equal ones, the earlier first.

        Its `data` gives them one at a time; a list of them would take 40 bytes each.
        """
        import numpy as np
        import pyarrow as pa
        import pyarrow.compute as pc

        column = pa.StringArray.from_buffers(len(self), pa.py_buffer(self._bounds), pa.py_buffer(self._bytes))
        return np.asarray(pc.sort_indices(column)).view(np.int64)

    def find(self, text: str) -> int | None:
        """Return the place of a text, where all are in alphabetical order; None if it is none of them."""
        place = bisect_left(self, text)
        return place if place < len(self) and self[place] == text else None
