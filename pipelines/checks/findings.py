"""The findings of the checks: code, step, message and correction."""

from typing import NamedTuple

from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Step


class Finding(NamedTuple):
    """A probable fault of a step (-1: of the whole program), and its correction.

    Attributes:
        code: the kind.
        step: number of the step, from 0.
        message: the fault.
        remedy: the correction as text.
        before: steps to insert before it.
        remove: whether the step should be removed.
        found: the words at fault.
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
