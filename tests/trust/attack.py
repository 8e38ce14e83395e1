"""An attack, and the place where it is made."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple


class Ground(NamedTuple):
    """The place of an attack: a folder of its own, the folder that must stay as it is, and a dataset."""

    folder: Path
    guard: Path
    dataset: Path


def _deep(depth: int) -> list[Any]:
    found: list[Any] = []
    for _ in range(depth):
        found = [found]
    return found


DEEP = _deep(300)
"""A value that JSON is read with, but not written."""


@dataclass(frozen=True, slots=True)
class Attack:
    """One attack. Its call may raise HearthError; what it returns must not hold the guard's secret."""

    group: str
    name: str
    call: Callable[[Ground], Any]
