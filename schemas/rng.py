"""Randomness that depends on nothing but (seed, stage, record id)."""

import hashlib
import random


def derive(seed: int, *parts: object) -> int:
    """Return a 64-bit seed derived from `seed` and the words that name its use; equal on every machine."""
    text = "\x1f".join([str(seed), *map(str, parts)])
    return int.from_bytes(hashlib.blake2b(text.encode(), digest_size=8).digest(), "little")


def rng(seed: int, *parts: object) -> random.Random:
    """Return a generator for one record of one stage: `rng(seed, "sample", record_id)`."""
    return random.Random(derive(seed, *parts))
