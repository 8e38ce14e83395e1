"""Answers that were copied: nearly the words of another, nearly another program, one answer pasted again and again."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Sequence
from hashlib import blake2b
from itertools import pairwise
from typing import Any

from hearth.pipelines.readers import crowd
from hearth.pipelines.readers.item import Item, refused
from hearth.pipelines.rejects import Reject
from hearth.schemas.failures import Code

ALIKE_WORDS = 0.8
"""Share of common words in order from which two descriptions are one."""

ALIKE_STEPS = 0.85
"""The same for the steps of two programs that one worker wrote for one description."""

PASTED = 3
"""For so many descriptions a worker may give one program before it counts as pasted."""

_FEWEST_WORDS = 6
_FEWEST_STEPS = 4
_SKETCH = 6
_MOST_CANDIDATES = 20

Digest = bytes


class Copies:
    """Finds copies among crowd answers as they come; what it keeps of an answer is hashes of its words or steps.

    Args:
        pasted: digests of (worker, program) given for many descriptions, from a first reading.
    """

    def __init__(self, pasted: frozenset[Digest] = frozenset()) -> None:
        self._pasted = pasted
        self._by_sketch: dict[int, list[tuple[str, Sequence[int]]]] = defaultdict(list)
        self._by_worker: dict[tuple[str, str], list[tuple[str, Sequence[int]]]] = defaultdict(list)

    def checked(self, item: Item) -> Item:
        """The item, or its refusal as a copy."""
        if item.reader != crowd.NAME:
            return item
        cells = item.value["cells"]
        if item.value["stage"] == 1:
            message = self._told_before(item.record_id, _words(cells["Answer.description"]))
        elif program_digest(cells) in self._pasted:
            message = f"one program that this worker gave for {PASTED} descriptions or more"
        else:
            message = self._written_before(item.record_id, cells)
        if not message:
            return item
        fault = Reject.of(Code.NEAR_DUPLICATE, message, file=item.place, line=item.line, found=item.record_id)
        return refused(item.place, fault, item.record_id, item.line)

    def _told_before(self, record_id: str, words: Sequence[int]) -> str:
        if len(words) < _FEWEST_WORDS:
            return ""
        sketch = sorted({hash_of(f"{a} {b}") for a, b in pairwise(words)})[:_SKETCH]
        candidates = {name: other for key in sketch for name, other in self._by_sketch[key]}
        for name, other in candidates.items():
            alike = _alike(words, other)
            if alike >= ALIKE_WORDS:
                return f"nearly the words of {name} (similarity {alike:.2f})"
        for key in sketch:
            if len(self._by_sketch[key]) < _MOST_CANDIDATES:
                self._by_sketch[key].append((record_id, words))
        return ""

    def _written_before(self, record_id: str, cells: dict[str, str]) -> str:
        steps = [hash_of(step) for step in _steps(cells)]
        if len(steps) < _FEWEST_STEPS:
            return ""
        written = self._by_worker[cells["WorkerId"].strip(), cells["Input.description_id"].strip()]
        for name, other in written:
            alike = _alike(steps, other)
            if alike >= ALIKE_STEPS:
                return f"nearly the program of {name}, of the same worker (similarity {alike:.2f})"
        if len(written) < _MOST_CANDIDATES:
            written.append((record_id, steps))
        return ""


def pasted(items: Iterable[Item]) -> frozenset[Digest]:
    """Programs that one worker gave for many descriptions, as digests of worker and program."""
    found: dict[Digest, set[Digest]] = defaultdict(set)
    for item in items:
        if item.reader == crowd.NAME and item.value["stage"] == 2:
            cells = item.value["cells"]
            digest = program_digest(cells)
            if digest and len(found[digest]) < PASTED:
                found[digest].add(_digest(cells["Input.description_id"].strip() or cells["Input.description"]))
    return frozenset(digest for digest, described in found.items() if len(described) >= PASTED)


def program_digest(cells: dict[str, Any]) -> Digest:
    """A worker and what they wrote, spaces and case aside; empty for a program of very few steps."""
    steps = _steps(cells)
    return _digest("\n".join([cells["WorkerId"].strip(), *steps])) if len(steps) >= _FEWEST_STEPS else b""


def _steps(cells: dict[str, Any]) -> list[str]:
    return ["".join(line.lower().split()) for line in cells["Answer.program"].split("\n") if line.strip()]


def _words(text: str) -> list[int]:
    return [hash_of(word) for word in re.findall(r"\w+", text.lower())]


def _alike(one: Sequence[int], other: Sequence[int]) -> float:
    from rapidfuzz.distance import Indel

    return Indel.normalized_similarity(one, other)


def hash_of(text: str) -> int:
    """A number that stands for a text; equal in every process, unlike `hash`."""
    return int.from_bytes(blake2b(text.encode("utf-8", "surrogatepass"), digest_size=4).digest(), "little")


def _digest(text: str) -> Digest:
    return blake2b(text.encode("utf-8", "surrogatepass"), digest_size=12).digest()
