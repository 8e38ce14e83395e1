"""Sets of nodes as rows of 64-bit words, and how kernels are compiled.

A set has a word for each 64 nodes. `home`, `task` and `world` are records (see `record_types`); no node and no room are
-1. Kernels are compiled at their first call and cached in the folder of the source, or in the user's cache
folder if that is not writable. They release the interpreter's lock.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from hashlib import blake2b
from pathlib import Path
from typing import Any, TypeVar, cast

import numpy as np

from hearth.homes.plans.walkable_floor import REACH
from hearth.schemas.optional_libraries import library
from hearth.simulation.motion.navigation import BODY_RADIUS

F = TypeVar("F", bound=Callable[..., Any])

_njit = library("numba").njit
_types = library("numba").types
_intrinsic = library("numba.extending").intrinsic
_ir = library("llvmlite.ir")


_OPTIONS = {"nogil": True, "error_model": "numpy", "_nrt": False, "no_cfunc_wrapper": True}
"""Results are those of Python's floats, so there is no fast math. Kernels allocate nothing, so they count no
references, and have no wrappers for Python, so that they compile sooner."""


def kernel(function: F) -> F:
    """Compile a function that other kernels call, at the first call."""
    return cast(F, _njit(no_cpython_wrapper=True, **_OPTIONS)(function))


def entry(function: F) -> F:
    """Compile a function that Python calls, at the first call, and cache it with all that it calls.

    The cache looks at the function's own file, and at the variables of its closure: `sources` must be one of them.
    """
    return cast(F, _njit(cache=True, **_OPTIONS)(function))


def sources() -> int:
    """Return a digest of all that compiled kernels depend on, for the key of their cache."""
    here = Path(__file__).parent
    files = [*sorted(here.glob("*.py")), here.parent / "instruction_table.py", here.parent / "mask_tracing.py"]
    text = b"".join(file.read_bytes() for file in files) + repr((REACH, BODY_RADIUS)).encode()
    return int.from_bytes(blake2b(text, digest_size=7).digest(), "little")


def _lowest(typing: Any, word: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.cttz(arguments[0], _ir.Constant(_ir.IntType(1), 0))

    return _types.int64(_types.uint64), generate


def _count(typing: Any, word: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.ctpop(arguments[0])

    return _types.int64(_types.uint64), generate


lowest = _intrinsic(_lowest)
"""The lowest bit of a word that is not 0."""

count = _intrinsic(_count)
"""The number of bits of a word."""

CLOSE, FACING, SEATS, WORN, CONTENTS = range(5)
"""An agent's own rows in a world."""

ON, INSIDE, ROOM, NEXT_TO = range(4)
"""The places of a lifted thing in a world: what it is ON, what it is in, its room, what it is CLOSE to."""

SPLIT = 134217729.0
"""2**27 + 1, which splits a float into two halves (Veltkamp)."""

ONE = np.uint64(1)
NONE = np.uint64(0)
ALL = ~np.uint64(0)

EVERYTHING, ROOMS, DOORS, FURNITURE, BEDDING, LIEABLE, SURFACES, ELSEWHERE, HOLDERS, CARRIERS, RESTS, LEFT, MOVABLE = (
    range(13)
)
"""Places of `instruction_table.KNOWN_SETS` in a task."""


@kernel
def bit(node):
    """Return the word of a node's bit."""
    return ONE << np.uint64(node & 63)


@kernel
def has(row, node):
    """Return whether a set has a node; -1 is in no set."""
    return node >= 0 and (row[node >> 6] & bit(node)) != 0


@kernel
def put(row, node):
    """Add a node to a set."""
    row[node >> 6] |= bit(node)


@kernel
def take(row, node):
    """Take a node out of a set."""
    row[node >> 6] &= ~bit(node)


@kernel
def hypot(x, z):
    """Return `math.hypot` as Python rounds it; that of C differs in the last bit, which can change a count of parts."""
    c = SPLIT * x
    x_high = c - (c - x)
    c = SPLIT * z
    z_high = c - (c - z)
    x_low, z_low = x - x_high, z - z_high
    a, b = x * x, z * z
    a_rest = ((x_high * x_high - a) + 2 * x_high * x_low) + x_low * x_low
    b_rest = ((z_high * z_high - b) + 2 * z_high * z_low) + z_low * z_low
    if a < b:
        a, a_rest, b, b_rest = b, b_rest, a, a_rest
    total = a + b
    rest = (a - total) + b + a_rest + b_rest
    root = math.sqrt(total + rest)
    if root == 0.0:
        return root
    c = SPLIT * root
    high = c - (c - root)
    low = root - high
    square = root * root
    square_rest = ((high * high - square) + 2 * high * low) + low * low
    return root + ((total - square) - square_rest + rest) / (2 * root)
