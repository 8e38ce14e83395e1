"""Sequences that are nearly the same, among many, without comparing each with each."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Hashable, Iterator, Sequence
from math import ceil, inf

_ROUNDING = 1e-6


def near_sequences(
    rows: Sequence[Sequence[Hashable]], columns: Sequence[Sequence[Hashable]], least: float
) -> Iterator[tuple[int, int]]:
    """Places (in rows, in columns), ascending, whose LCS is at least so much of the longer one.

    Exact, and nearly linear where most steps are rare: two such sequences have so many elements in common, order
    aside, that one of the few rarest of the one is among the few rarest of the other (prefix filtering, as in joins of
    similar sets); only pairs that share one are compared.

    Args:
        rows, columns: sequences of hashable elements; may be one and the same.
        least: from 0 to 1.
    """
    from rapidfuzz.distance import LCSseq

    told, told_columns = _numbered(rows, columns)
    index: dict[int, list[int]] = defaultdict(list)
    for number, tokens in enumerate(told_columns):
        for token in _rarest(tokens, least):
            index[token].append(number)
    for number, mine in enumerate(told):
        found = {other for token in _rarest(mine, least) for other in index.get(token, ())}
        fewest, most = least * len(mine) - _ROUNDING, (len(mine) + _ROUNDING) / least if least else inf
        for other in sorted(found):
            theirs = told_columns[other]
            if fewest <= len(theirs) <= most and LCSseq.normalized_similarity(mine, theirs) >= least - _ROUNDING:
                yield number, other


def _numbered(
    rows: Sequence[Sequence[Hashable]], columns: Sequence[Sequence[Hashable]]
) -> tuple[list[list[int]], list[list[int]]]:
    """Sequences of numbers instead of elements: the rarer an element, the smaller."""
    seen = Counter(element for sequence in (*rows, *columns) for element in sequence)
    number = {element: place for place, (element, _) in enumerate(reversed(seen.most_common()))}
    return tuple([[number[element] for element in sequence] for sequence in given] for given in (rows, columns))  # type: ignore[return-value]


def _rarest(numbers: list[int], least: float) -> set[int]:
    """So many of the rarest elements that a sequence without any of them is too different; a mark for an empty one."""
    common = ceil(least * len(numbers) - _ROUNDING)
    return set(sorted(numbers)[: len(numbers) - common + 1]) or {-1}
