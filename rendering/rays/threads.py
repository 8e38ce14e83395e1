"""Threads for compiled loops, which release the interpreter's lock."""

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from typing import TypeVar

T = TypeVar("T")
R = TypeVar("R")


def count() -> int:
    """Return the number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@cache
def _pool(process: int) -> ThreadPoolExecutor:
    """Return the threads of a process; they do not survive a fork."""
    return ThreadPoolExecutor(count(), "pixels")


def each(work: Callable[[T], R], items: Iterable[T]) -> list[R]:
    """Apply `work` to every item in parallel; results in the items' order."""
    known = list(items)
    if len(known) < 2 or count() == 1:
        return [work(item) for item in known]
    return list(_pool(os.getpid()).map(work, known))
