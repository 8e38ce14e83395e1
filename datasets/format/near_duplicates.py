"""Sequences and texts that are nearly the same, among many, without comparing each with each."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Hashable, Iterator, Sequence
from math import ceil, inf
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_ROUNDING = 1e-6


def near_sequences(rows: Sequence[Sequence[Hashable]], least: float) -> Iterator[tuple[int, int]]:
    """Pairs of places, the smaller first, whose sequences' LCS is at least so much of the longer one.

    Exact, and nearly linear where most steps are rare: two such sequences have so many elements in common, order
    aside, that one of the few rarest of the one is among the few rarest of the other (prefix filtering, as in joins of
    similar sets); only pairs that share one are compared.

    Args:
        rows: sequences of hashable elements.
        least: from 0 to 1.
    """
    from rapidfuzz.distance import LCSseq

    told = _numbered(rows)
    lengths = [len(each) for each in told]
    seen: dict[str, list[int]] = defaultdict(list)
    for number in sorted(range(len(told)), key=lambda place: (lengths[place], place)):
        mine = told[number]
        rarest = _rarest(mine, least)
        shortest = least * len(mine) - _ROUNDING
        for other in sorted({other for token in rarest for other in seen[token] if lengths[other] >= shortest}):
            if LCSseq.normalized_similarity(mine, told[other], score_cutoff=least - _ROUNDING):
                yield (other, number) if other < number else (number, other)
        for token in rarest:
            seen[token].append(number)


def _numbered(rows: Sequence[Sequence[Hashable]]) -> list[str]:
    """Sequences of characters instead of elements: the rarer an element, the smaller. Texts are compared fastest."""
    seen = Counter(element for sequence in rows for element in sequence)
    letter = {element: chr(_FIRST + place) for place, (element, _) in enumerate(reversed(seen.most_common()))}
    return ["".join(map(letter.__getitem__, sequence)) for sequence in rows]


_FIRST = 0xE000
"""Beyond the surrogates, which are no characters; up to a million different elements."""


def _rarest(letters: str, least: float) -> set[str]:
    """So many of the rarest elements that a sequence without any of them is too different; a mark for an empty one."""
    common = ceil(least * len(letters) - _ROUNDING)
    return set(sorted(letters)[: len(letters) - common + 1]) or {""}


def near_texts(texts: Sequence[str], least: float) -> Iterator[tuple[int, int]]:
    """Pairs of places, the smaller first, whose texts' similarity (insertions and deletions) is at least so much.

    Exact: only those are compared that their lengths, and how often each has which characters, do not keep apart (an
    insertion changes one such count by one). Still each is held against each of about its length, but by sums of a few
    small numbers.

    Args:
        texts: any.
        least: from 0 to 1; twice what two texts have in common, in order, over the sum of their lengths.
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
        near = one + 1 + np.flatnonzero(_apart(few[:, one + 1 : end], few[:, one]) <= allowed)
        near = near[_apart(counts[:, near], counts[:, one]) <= allowed[near - one - 1]]
        for other in near.tolist():
            if fuzz.ratio(text, ordered[other], score_cutoff=100 * (least - _ROUNDING)):
                a, b = order[one], order[other]
                yield (a, b) if a < b else (b, a)


_KINDS, _FEW = 32, 8
"""Characters are counted in so many kinds, and for a first look in fewer."""


def _apart(counts: NDArray[np.int32], mine: NDArray[np.int32]) -> NDArray[np.int32]:
    """(texts,) insertions and deletions at the least, from (kinds, texts) counts to those of one text."""
    found: NDArray[np.int32] = abs(counts - mine[:, None]).sum(0, dtype=counts.dtype)
    return found


def _character_counts(texts: Sequence[str]) -> NDArray[np.int32]:
    """(_KINDS, texts) how often each has characters of each kind."""
    codes = (np.frombuffer(text.encode("utf-32-le", "surrogatepass"), np.uint32) % _KINDS for text in texts)
    counts = [np.bincount(each, minlength=_KINDS) for each in codes]
    return np.array(counts, np.int32).reshape(-1, _KINDS).T.copy()
