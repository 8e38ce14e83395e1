"""What a look at a program found: the kind, the step, and what would mend it."""

from __future__ import annotations

from typing import NamedTuple

from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Step


class Finding(NamedTuple):
    """Something that looks wrong with a step (-1: with the whole program), and what would mend it.

    Attributes:
        code: the kind.
        step: number of the step, from 0.
        message: the fault.
        remedy: what to do, in words.
        before: steps to write before it.
        remove: whether the step should go.
        found: the offending words.
        object: the object at fault, for underlining.
    """

    code: Code
    step: int
    message: str
    remedy: str = ""
    before: tuple[Step, ...] = ()
    remove: bool = False
    found: str = ""
    object: ObjectRef | None = None
