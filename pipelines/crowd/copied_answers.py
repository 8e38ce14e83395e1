"""Copied answers: near-duplicate descriptions and programs, and one program given for many descriptions."""

import re
from array import array
from collections.abc import Iterable, Iterator, Sequence
from hashlib import blake2b
from itertools import pairwise
from typing import Any

from hearth.pipelines.crowd.key_counts import SeenSet, digest
from hearth.pipelines.readers import crowd
from hearth.pipelines.readers.reader_items import Item, refused
from hearth.schemas.failures import Code
from hearth.storage.rejects import Reject

ALIKE_WORDS = 0.8
"""Similarity of the words of two descriptions from which they are near-duplicates."""

ALIKE_STEPS = 0.85
"""Least similarity of the steps of two programs by one worker for one description that count as copies."""

PASTED = 3
"""Number of descriptions from which one program by one worker counts as pasted."""

_FEWEST_WORDS = 6
_FEWEST_STEPS = 4
_SKETCH = 6
_MOST_CANDIDATES = 20

RECENT = 20_000
"""Answers of each stage that are compared; copies are made within a batch."""


class Copies:
    """Finds copies among crowd answers in one pass; of an answer it keeps hashes of the words or steps.

    Args:
        pasted: digests of (worker, program) given for many descriptions, from an earlier pass.
        recent: number of answers of each stage that are kept for comparison.
    """

    def __init__(self, pasted: frozenset[int] = frozenset(), recent: int = RECENT) -> None:
        self._pasted = pasted
        self._descriptions = _Recent(recent)
        self._programs = _Recent(recent)

    def checked(self, item: Item) -> Item:
        """Return the item, or its refusal as a copy."""
        if item.reader != crowd.NAME:
            return item
        cells = item.value["cells"]
        if item.value["stage"] == 1:
            message = self._copied_description(item.record_id, _words(cells["Answer.description"]))
        elif program_digest(cells) in self._pasted:
            message = f"one program that this worker gave for {PASTED} descriptions or more"
        else:
            message = self._copied_program(item.record_id, cells)
        if not message:
            return item
        fault = Reject.of(Code.NEAR_DUPLICATE, message, file=item.place, line=item.line, found=item.record_id)
        return refused(item.place, fault, item.record_id, item.line)

    def _copied_description(self, record_id: str, words: Sequence[int]) -> str:
        if len(words) < _FEWEST_WORDS:
            return ""
        sketch = sorted({hash_of(f"{a} {b}") for a, b in pairwise(words)})[:_SKETCH]
        for name, other in self._descriptions.among(sketch):
            alike = _alike(words, other)
            if alike >= ALIKE_WORDS:
                return f"nearly the words of {name} (similarity {alike:.2f})"
        self._descriptions.keep(record_id, words, sketch)
        return ""

    def _copied_program(self, record_id: str, cells: dict[str, str]) -> str:
        steps = [hash_of(step) for step in _steps(cells)]
        if len(steps) < _FEWEST_STEPS:
            return ""
        task = hash_of("\0".join((cells["WorkerId"].strip(), cells["Input.description_id"].strip())))
        for name, other in self._programs.among([task]):
            alike = _alike(steps, other)
            if alike >= ALIKE_STEPS:
                return f"nearly the program of {name}, of the same worker (similarity {alike:.2f})"
        self._programs.keep(record_id, steps, [task])
        return ""


_SHARES = 64


class _Recent:
    """The last `most` answers, found by any of their keys; each key has at most `_MOST_CANDIDATES` of them."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._kept: dict[int, tuple[str, array[int], tuple[int, ...]]] = {}
        # Several dictionaries, because one that grows is copied whole.
        self._by_key: tuple[dict[int, int | tuple[int, ...]], ...] = tuple({} for _ in range(_SHARES))
        self._next = 0

    def among(self, keys: Iterable[int]) -> Iterator[tuple[str, Sequence[int]]]:
        """Names and contents of the answers that share a key, each once."""
        for number in dict.fromkeys(number for key in keys for number in self._numbers(key)):
            name, content, _ = self._kept[number]
            yield name, content

    def keep(self, name: str, content: Sequence[int], keys: Iterable[int]) -> None:
        """Keep one more answer, and forget the oldest."""
        own = tuple(key for key in keys if len(self._numbers(key)) < _MOST_CANDIDATES)
        self._kept[self._next] = (name, array("I", content), own)
        for key in own:
            self._put(key, (*self._numbers(key), self._next))
        self._next += 1
        if len(self._kept) > self._most:
            self._forget(self._next - 1 - self._most)

    def _forget(self, number: int) -> None:
        for key in self._kept.pop(number)[2]:
            self._put(key, tuple(other for other in self._numbers(key) if other != number))

    def _numbers(self, key: int) -> tuple[int, ...]:
        found = self._by_key[key % _SHARES].get(key, ())
        return (found,) if isinstance(found, int) else found

    def _put(self, key: int, numbers: tuple[int, ...]) -> None:
        # Nearly every key has one answer: a plain number takes a third of the memory of a tuple.
        share = self._by_key[key % _SHARES]
        if numbers:
            share[key] = numbers if len(numbers) > 1 else numbers[0]
        else:
            del share[key]


def pasted(items: Iterable[Item]) -> frozenset[int]:
    """Programs that one worker gave for many descriptions, as digests of worker and program."""
    answers, given = SeenSet(), SeenSet()
    found: set[int] = set()
    for item in items:
        if item.reader == crowd.NAME and item.value["stage"] == 2:
            cells = item.value["cells"]
            program = program_digest(cells)
            described = cells["Input.description_id"].strip() or cells["Input.description"]
            if program and not answers.add(digest([program, described])) and given.add(program) + 1 == PASTED:
                found.add(program)
    return frozenset(found)


def program_digest(cells: dict[str, Any]) -> int:
    """Return a digest of a worker and their program, ignoring spaces and case; 0 for a program of very few steps."""
    steps = _steps(cells)
    return digest([cells["WorkerId"].strip(), *steps]) if len(steps) >= _FEWEST_STEPS else 0


def _steps(cells: dict[str, Any]) -> list[str]:
    return ["".join(line.lower().split()) for line in cells["Answer.program"].split("\n") if line.strip()]


def _words(text: str) -> list[int]:
    return [hash_of(word) for word in re.findall(r"\w+", text.lower())]


def _alike(one: Sequence[int], other: Sequence[int]) -> float:
    from rapidfuzz.distance import Indel

    return Indel.normalized_similarity(one, other)


def hash_of(text: str) -> int:
    """Return a hash of a text of 32 bits, the same in every process, unlike `hash`."""
    return int.from_bytes(blake2b(text.encode("utf-8", "surrogatepass"), digest_size=4).digest(), "little")
