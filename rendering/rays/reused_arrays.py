"""Reused memory: allocating fresh pages costs more than most loops over them."""

import ctypes
import threading
from functools import cache
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray


class _Kept(threading.local):
    """The buffers of a thread, by use and type of their values."""

    def __init__(self) -> None:
        self.buffers: dict[tuple[str, Any], NDArray[Any]] = {}


_kept = _Kept()


def scratch(use: str, *shape: int, dtype: Any = np.float32) -> NDArray[Any]:
    """Return an uninitialised array, valid until the calling thread asks for another of the same use."""
    size = prod(shape)
    buffer = _kept.buffers.get((use, dtype))
    if buffer is None or buffer.size < size:
        buffer = _kept.buffers[use, dtype] = np.empty(size, dtype)
    return buffer[:size].reshape(shape)


TRIM_THRESHOLD, TOP_PAD, MMAP_THRESHOLD = -1, -2, -3
"""Numbers of glibc's `mallopt`."""


@cache
def keep() -> bool:
    """Let the C library keep up to 128 MB of freed memory for reuse; returns whether it does."""
    try:
        mallopt = ctypes.CDLL(None).mallopt
    except (AttributeError, OSError):
        return False
    return bool(mallopt(MMAP_THRESHOLD, 1 << 25) and mallopt(TRIM_THRESHOLD, 1 << 27) and mallopt(TOP_PAD, 1 << 22))
