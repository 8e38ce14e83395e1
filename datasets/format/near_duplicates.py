"""Near-duplicate sequences and texts, found without comparing all pairs."""

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
    """Pairs of indices, the smaller first, of sequences whose LCS is at least the share `least` of the longer one.

    Exact, and nearly linear if most elements are rare (prefix filtering, as in set similarity joins): similar sequences
    share one of their few rarest elements, and only pairs that share one are compared.

    Args:
        rows: sequences of hashable elements.
        least: from 0 to 1.
    """
    from rapidfuzz.distance import LCSseq

    sequences = _numbered(rows)
    lengths = [len(each) for each in sequences]
    seen: dict[str, list[int]] = defaultdict(list)
    for number in sorted(range(len(sequences)), key=lambda place: (lengths[place], place)):
        mine = sequences[number]
        rarest = _rarest(mine, least)
        shortest = least * len(mine) - _ROUNDING
        for other in sorted({other for token in rarest for other in seen[token] if lengths[other] >= shortest}):
            if LCSseq.normalized_similarity(mine, sequences[other], score_cutoff=least - _ROUNDING):
                yield (other, number) if other < number else (number, other)
        for token in rarest:
            seen[token].append(number)


def _numbered(rows: Sequence[Sequence[Hashable]]) -> list[str]:
    """Sequences as strings, which compare fastest; the rarer an element, the smaller its character."""
    seen = Counter(element for sequence in rows for element in sequence)
    letter = {element: chr(_FIRST + place) for place, (element, _) in enumerate(reversed(seen.most_common()))}
    return ["".join(map(letter.__getitem__, sequence)) for sequence in rows]


_FIRST = 0xE000
"""First code point after the surrogates, which are not characters; leaves a million different elements."""


def _rarest(letters: str, least: float) -> set[str]:
    """The rarest elements, of which every similar sequence has at least one; a marker for an empty sequence."""
    common = ceil(least * len(letters) - _ROUNDING)
    return set(sorted(letters)[: len(letters) - common + 1]) or {""}


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
    """(texts,) lower bounds of the edits between texts with (classes, texts) counts and one text's counts."""
    found: NDArray[np.int32] = abs(counts - mine[:, None]).sum(0, dtype=counts.dtype)
    return found


def _character_counts(texts: Sequence[str]) -> NDArray[np.int32]:
    """(_KINDS, texts) number of characters of each class in each text."""
    codes = (np.frombuffer(text.encode("utf-32-le", "surrogatepass"), np.uint32) % _KINDS for text in texts)
    counts = [np.bincount(each, minlength=_KINDS) for each in codes]
    return np.array(counts, np.int32).reshape(-1, _KINDS).T.copy()
