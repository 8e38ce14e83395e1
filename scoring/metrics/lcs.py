"""Normalised longest common subsequence of programs (thesis 4.3, eq. 4.1, 4.2; tables 3.1, 4.4-4.6)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterable, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Literal, NamedTuple, get_args

from hearth.schemas.program import ObjectRef, Step
from hearth.scoring.line_sequences import Line, Lines
from hearth.scoring.signature import signature

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Level = Literal["step", "action", "object"]
"""The compared items: whole instructions, their actions only, or their objects only (first, then second)."""

LEVELS: tuple[Level, ...] = get_args(Level)

By = Literal["class", "number", "node"]
"""The kind of key that identifies an object."""

Sequences = list[list[int]]


class LcsScore(NamedTuple):
    """One pair's scores, from 0 to 1, and their mean as in tables 4.4 to 4.6."""

    step: float
    action: float
    object: float

    @property
    def mean(self) -> float:
        """Return the mean of the three."""
        return sum(self) / len(self)


def lcs_signature(level: str = "step", instances: bool = False) -> str:
    """Return the signature of a score by this module."""
    return signature("lcs", norm="max", level=level, **({"instances": "named"} if instances else {}))


def items(lines: Lines, level: Level = "step", instances: bool = False) -> list[Hashable]:
    """Return the items that are compared at a level.

    Names are compared ignoring case, spaces, hyphens and underscores. Instances are ignored (eq. 4.2) unless
    `instances` is set; then an object is identified by its node if bound, else by its number. Modifiers are ignored.
    The agent is part of a step, except the first. A line that does not parse is one item at every level.
    """
    return _levels(lines, "node" if instances else "class")[LEVELS.index(level)]


def similarity(predicted: Lines, reference: Lines, level: Level = "step", instances: bool = False) -> float:
    """|LCS| / max(|predicted|, |reference|), from 0 to 1; two empty sequences score 1 (eq. 4.1).

    Of two programs one of which names no node, instances are compared by number.
    """
    return score(predicted, reference, instances)[LEVELS.index(level)]


def score(predicted: Lines, reference: Lines, instances: bool = False) -> LcsScore:
    """Return the scores of one pair at every level, from 0 to 1 (thesis eq. 4.1).

    Examples:
        >>> from hearth.scoring.line_sequences import read
        >>> from hearth.scoring.metrics import lcs
        >>> lcs.score(read(["[Walk] <sofa> (1)", "[Sit] <sofa> (1)"]), read(["[Walk] <sofa> (1)", "[Lie] <sofa> (1)"]))
        LcsScore(step=0.5, action=0.5, object=1.0)
    """
    return score_pairs([(predicted, reference)], instances)[0]


def score_pairs(pairs: Iterable[tuple[Lines, Lines]], instances: bool = False) -> list[LcsScore]:
    """Return the scores of many pairs, in order; equal to `score` of each, but faster."""
    pairs = list(pairs)
    by = [_identity(*pair) if instances else "class" for pair in pairs]
    sides = [[_levels(pair[side], how) for pair, how in zip(pairs, by, strict=True)] for side in (0, 1)]
    columns = [_pairwise(*([found[level] for found in side] for side in sides)) for level in range(len(LEVELS))]
    return [LcsScore(*row) for row in zip(*columns, strict=True)]


def _identity(*programs: Lines) -> By:
    """Return the kind of key for the instances of some programs: nodes, if all of them name nodes."""
    steps = ([line for line in lines if isinstance(line, Step)] for lines in programs)
    named = all(any(ref.node is not None for step in found for ref in step.objects) for found in steps)
    return "node" if named else "number"


def _levels(lines: Lines, by: By) -> list[list[Hashable]]:
    """Return the items of every level."""
    found = [_items(line, by) for line in lines]
    return [[item for each in found for item in each[place]] for place in range(len(LEVELS))]


@lru_cache(maxsize=65_536)
def _items(line: Line, by: By) -> tuple[tuple[Hashable, ...], ...]:
    """Return the items of a line at every level."""
    if isinstance(line, str):
        return ((("text", line.casefold()),),) * len(LEVELS)
    objects = tuple([_named(ref, by) for ref in line.objects])
    action = _plain(line.action)
    return ((action, *objects, line.agent),), (action,), objects


def matrix(
    programs_a: Sequence[Lines],
    programs_b: Sequence[Lines],
    level: Level = "step",
    instances: bool = False,
    workers: int = -1,
) -> NDArray[np.float32]:
    """Return the similarity of every program of one list to every one of another, shape (len(a), len(b)).

    5,000 x 5,000 programs of 10 steps take about a second on two cores, and 100 MB.

    Args:
        programs_a: one program per row.
        programs_b: one program per column; may be the same list.
        level: the compared items.
        instances: whether to distinguish instances of a class.
        workers: threads; -1 takes all cores.
    """
    import numpy as np
    from rapidfuzz.distance import LCSseq
    from rapidfuzz.process import cdist

    rows = [items(lines, level, instances) for lines in programs_a]
    columns = rows if programs_a is programs_b else [items(lines, level, instances) for lines in programs_b]
    a, b = _encode(rows, columns)  # two lists even when equal: of one with itself cdist does not use wide registers
    found: NDArray[np.float32] = cdist(a, b, scorer=LCSseq.similarity, dtype=np.float32, workers=workers)
    lengths = np.array([len(sequence) for sequence in b], dtype=np.float32)
    for number, sequence in enumerate(a):
        longest = np.maximum(lengths, len(sequence))
        found[number] /= np.maximum(longest, 1)
        found[number, longest == 0] = 1
    return found


def _pairwise(predicted: Sequence[Sequence[Hashable]], reference: Sequence[Sequence[Hashable]]) -> list[float]:
    from rapidfuzz.distance import LCSseq

    a, b = _encode(predicted, reference)
    lengths = (max(len(x), len(y)) for x, y in zip(a, b, strict=True))
    return [LCSseq.similarity(x, y) / longest if longest else 1.0 for x, y, longest in zip(a, b, lengths, strict=True)]


def _encode(*sides: Sequence[Sequence[Hashable]]) -> tuple[Sequences, ...]:
    """Items as integers, the frequent ones small: below 256 rapidfuzz looks a code up in a table, above in a hash."""
    counts = Counter(item for side in sides for sequence in side for item in sequence)
    codes = {item: number for number, (item, _) in enumerate(counts.most_common())}
    return tuple([[codes[item] for item in sequence] for sequence in side] for side in sides)


def _named(ref: ObjectRef, by: By) -> Hashable:
    name = _plain(ref.name)
    if by == "class":
        return name
    return (name, by, ref.node) if by == "node" and ref.node is not None else (name, "number", ref.instance)


@lru_cache(maxsize=65_536)
def _plain(name: str) -> str:
    return name.casefold().replace("_", "").replace(" ", "").replace("-", "")
