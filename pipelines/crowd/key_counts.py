"""A set of seen keys with counts, in a dozen bytes a key, so that millions of records fit in little memory."""

import json
from array import array
from hashlib import blake2b
from typing import Any

import orjson

_MOST = 255


class SeenSet:
    """Keys with the number of times each was added, up to 255; keys are digests of 64 bits."""

    def __init__(self) -> None:
        self._room(1 << 10)
        self._used = 0

    def _room(self, slots: int) -> None:
        self._keys, self._counts, self._mask = array("Q", bytes(8 * slots)), bytearray(slots), slots - 1

    def add(self, key: int) -> int:
        """Add a key; the number of times it was added before."""
        slot = self._slot(key)
        before = self._counts[slot]
        if not before:
            self._keys[slot] = key
            self._used += 1
        if before < _MOST:
            self._counts[slot] = before + 1
        if self._used * 3 > self._mask * 2:
            self._grow()
        return before

    def __contains__(self, key: int) -> bool:
        return self._counts[self._slot(key)] > 0

    def __len__(self) -> int:
        return self._used

    def _slot(self, key: int) -> int:
        """Return the slot of a key, or the free slot for it."""
        keys, counts, mask = self._keys, self._counts, self._mask
        slot = key & mask
        while counts[slot] and keys[slot] != key:
            slot = (slot + 1) & mask
        return slot

    def _grow(self) -> None:
        keys, counts = self._keys, self._counts
        self._room(2 * len(keys))
        for key, count in zip(keys, counts, strict=True):
            if count:
                slot = self._slot(key)
                self._keys[slot], self._counts[slot] = key, count


def digest(value: Any) -> int:
    """Return a digest of a JSON value of 64 bits, the same in every process."""
    try:
        data = orjson.dumps(value, option=orjson.OPT_SORT_KEYS)
    except TypeError:
        # Bytes that are not text are read as lone surrogates, which orjson refuses.
        data = json.dumps(value, sort_keys=True).encode()
    return int.from_bytes(blake2b(data, digest_size=8).digest(), "little")
