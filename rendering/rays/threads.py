"""A few threads for work that lets go of the interpreter: compiled loops."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from typing import TypeVar

T = TypeVar("T")
R = TypeVar("R")


def count() -> int:
    """How many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@cache
def _pool(process: int) -> ThreadPoolExecutor:
    """Threads do not survive a fork: each process has its own."""
    return ThreadPoolExecutor(count(), "pixels")


def each(work: Callable[[T], R], items: Iterable[T]) -> list[R]:
    """`work` of every item, side by side; results in the items' order."""
    known = list(items)
    if len(known) < 2 or count() == 1:
        return [work(item) for item in known]
    return list(_pool(os.getpid()).map(work, known))
