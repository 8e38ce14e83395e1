"""Near-duplicate sequences and texts, found without comparing all pairs."""

from __future__ import annotations

from array import array
from bisect import bisect_left
from collections import Counter, defaultdict
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from itertools import chain
from math import ceil, inf
from typing import TYPE_CHECKING

import numpy as np

from hearth.datasets.format.compact_texts import Letters, Texts

if TYPE_CHECKING:
    from numpy.typing import NDArray

_ROUNDING = 1e-6


def near_sequences(rows: Sequence[Sequence[Hashable]], least: float) -> Iterator[tuple[int, int]]:
    """Pairs of indices, the smaller first, of sequences whose LCS is at least the share `least` of the longer one.

    Exact, and nearly linear if most elements are rare (prefix filtering, as in set similarity joins): similar sequences
    share one of their few rarest elements, and only pairs that share one are compared. Of these, most differ in classes
    of elements by more than similar ones can; that is seen from bits.

    Args:
        rows: sequences of hashable elements; `Texts` are compared as they are, and take least memory.
        least: from 0 to 1.
    """
    from rapidfuzz.distance import LCSseq

    texts = rows if isinstance(rows, Texts) else Texts(map(Letters().text, rows))
    rank = _ranks(texts)
    lengths = np.fromiter(map(len, texts), np.int32, len(texts))
    order = np.argsort(lengths, kind="stable").astype(np.int32)
    classes = np.fromiter((_classes(texts[place]) for place in order.data), np.uint64, len(texts))
    lengths = lengths[order]
    firsts = np.searchsorted(lengths, least * lengths - _ROUNDING)  # those before the first are too short
    seen: dict[str, array[int]] = defaultdict(lambda: array("i"))
    for number, (place, first) in enumerate(zip(order.data, firsts.data, strict=True)):
        mine = texts[place]
        common = ceil(least * len(mine) - _ROUNDING)
        found = set[int]()
        for others in (seen[token] for token in _rarest(mine, common, rank)):
            near = np.array(others[bisect_left(others, first) :], np.int32)
            lone = _ONES[(classes[near] ^ classes[number]).view(np.uint8)].reshape(-1, _BITS // 8).sum(1)
            found.update(order[near[lone <= lengths[near] + (len(mine) - 2 * common)]].tolist())
            others.append(number)
        for other in found:
            if LCSseq.normalized_similarity(mine, texts[other], score_cutoff=least - _ROUNDING):
                yield (other, place) if other < place else (place, other)


def _ranks(texts: Iterable[str]) -> dict[str, int]:
    """Return the rank of each letter; the rarer it is, the smaller."""
    seen = Counter(chain.from_iterable(texts))
    return {letter: rank for rank, (letter, _) in enumerate(reversed(seen.most_common()))}


def _rarest(letters: str, common: int, rank: Mapping[str, int]) -> set[str]:
    """Return the rarest letters, of which every text that shares `common` letters has one.

    An empty text has a marker.
    """
    return set(sorted(letters, key=rank.__getitem__)[: len(letters) - common + 1]) or {""}


def _classes(letters: str) -> int:
    """Return a bit for each class of letters that a text has: each bit of one of two alone is a letter of it alone."""
    found = 0
    for each in letters:
        found |= 1 << ord(each) % _BITS
    return found


_BITS = 64
"""Number of classes of letters."""

_ONES = np.array([number.bit_count() for number in range(256)], np.int32)
"""Number of bits that are set in a byte."""


def near_texts(texts: Sequence[str], least: float) -> Iterator[tuple[int, int]]:
    """Pairs of indices, the smaller first, of texts whose similarity is at least `least`.

    Exact: lengths and character counts give a lower bound of the insertions and deletions, and only pairs within the
    bound are compared. The bound itself is computed for all texts of similar length, with small sums.

    Args:
        texts: any.
        least: from 0 to 1; twice the length of the LCS over the sum of both lengths.
    """
    from rapidfuzz import fuzz

    order = sorted(range(len(texts)), key=lambda place: (len(texts[place]), place))
    ordered = [texts[place] for place in order]
    lengths = np.array([len(text) for text in ordered])
    counts = _character_counts(ordered)
    few = counts.reshape(_FEW, _KINDS // _FEW, len(ordered)).sum(1, dtype=np.int32)
    for one, text in enumerate(ordered):
        longest = len(text) * (2 / least - 1) if least else inf
        end = int(np.searchsorted(lengths, longest + _ROUNDING, side="right"))
        allowed = (1 - least) * (len(text) + lengths[one + 1 : end]) + _ROUNDING
        near = one + 1 + np.flatnonzero(_edit_bound(few[:, one + 1 : end], few[:, one]) <= allowed)
        near = near[_edit_bound(counts[:, near], counts[:, one]) <= allowed[near - one - 1]]
        for other in near.tolist():
            if fuzz.ratio(text, ordered[other], score_cutoff=100 * (least - _ROUNDING)):
                a, b = order[one], order[other]
                yield (a, b) if a < b else (b, a)


_KINDS, _FEW = 32, 8
"""Number of character classes that are counted, and of coarser classes for a first bound."""


def _edit_bound(counts: NDArray[np.int32], mine: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return (texts,) lower bounds of the edits between texts with (classes, texts) counts and one text's counts."""
    found: NDArray[np.int32] = abs(counts - mine[:, None]).sum(0, dtype=counts.dtype)
    return found


def _character_counts(texts: Sequence[str]) -> NDArray[np.int32]:
    """Return (_KINDS, texts) number of characters of each class in each text."""
    counts = np.empty((_KINDS, len(texts)), np.int32)
    for place, text in enumerate(texts):
        codes = np.frombuffer(text.encode("utf-32-le", "surrogatepass"), np.uint32)
        counts[:, place] = np.bincount(codes % _KINDS, minlength=_KINDS)
    return counts
