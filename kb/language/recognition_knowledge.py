"""The knowledge by which forms of text are recognized: ours, or that of the command or build that reads.

Readers try many forms, and most functions of a form see one line. The knowledge is therefore handed to all of them at
once, for the time of a reading, in a variable of the context (PEP 567): threads and other readings keep their own.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import lru_cache, wraps
from typing import TypeVar

from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import default

T = TypeVar("T")
R = TypeVar("R")

_GIVEN: ContextVar[Knowledge | None] = ContextVar("recognition", default=None)


def recognition() -> Knowledge:
    """Return the knowledge of the reading that is under way; ours where none was given."""
    return _GIVEN.get() or default()


@contextmanager
def recognizing(known: Knowledge) -> Iterator[None]:
    """Recognize forms by a knowledge.

    One that has our actions, as of a home with classes of its own, recognizes what ours does.
    """
    before = _GIVEN.get()
    _GIVEN.set(_needed(known))
    try:
        yield
    finally:
        _GIVEN.set(before)


def is_recognizing(known: Knowledge) -> bool:
    """Return whether the reading that is under way recognizes by this knowledge: most readings begin so."""
    return _GIVEN.get() is _needed(known)


def _needed(known: Knowledge) -> Knowledge | None:
    return None if known.actions is default().actions else known


def recognized_cache(maxsize: int) -> Callable[[Callable[[T], R]], Callable[[T], R]]:
    """Return a decorator like `lru_cache` for functions that ask `recognition`: answers are kept by knowledge, too."""

    def decorate(function: Callable[[T], R]) -> Callable[[T], R]:
        @lru_cache(maxsize=maxsize)
        def kept(_: Knowledge | None, argument: T) -> R:
            return function(argument)

        @wraps(function)
        def asked(argument: T) -> R:
            return kept(_GIVEN.get(), argument)

        return asked

    return decorate
