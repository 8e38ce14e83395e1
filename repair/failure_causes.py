"""The perturbation of a program's environment that caused a failure."""

from collections.abc import Sequence

from hearth.repair.perturbation import Perturbation
from hearth.repair.repair_loop import Attempt
from hearth.schemas.failures import Code
from hearth.schemas.literals import CHARACTER
from hearth.schemas.program import Program

MATTERS: dict[Code, str] = {
    **dict.fromkeys((Code.NOT_CLOSE, Code.NOT_IN_ROOM, Code.INSIDE_CLOSED, Code.NO_ORIGIN, Code.NOT_WORN), "place"),
    **dict.fromkeys((Code.SITTING, Code.LYING, Code.NOT_SITTING_OR_LYING), "posture"),
    **dict.fromkeys((Code.DOOR_CLOSED, Code.NO_PATH), "way"),
    **dict.fromkeys((Code.NO_FREE_HAND, Code.NOT_HOLDING), "hands"),
    **dict.fromkeys((Code.IS_OPEN, Code.IS_CLOSED, Code.NOT_OPENABLE_STATE), "door"),
    **dict.fromkeys((Code.IS_ON, Code.IS_OFF), "switch"),
    **dict.fromkeys((Code.IS_PLUGGED, Code.IS_UNPLUGGED), "plug"),
    **dict.fromkeys((Code.OCCUPIED, Code.NO_ROOM), "seat"),
    Code.NOT_FACING: "view",
}
"""The subject of a failure, in the words of `Perturbation.claims`."""


def cause(perturbations: Sequence[Perturbation], attempt: Attempt, program: Program) -> int | None:
    """Return the number of the perturbation that a failure comes of.

    The only perturbation of a run caused all its failures, directly or by way of a repair. Of several, it is the one
    that settles what fails (a seat, a door, a posture) for an object of the failure or for the character; or else the
    only one about an object of the failure.

    Args:
        perturbations: all of the environment.
        attempt: the failure, with its repair.
        program: the original, bound in the environment.

    Returns:
        None where none of them fits, or several do.
    """
    if len(perturbations) == 1:
        return 0
    failed = {*attempt.failure.objects}
    about = {ref.key for ref in program.objects() if ref.node in failed}
    about.update(key for literal in attempt.missed for key in literal.terms)
    matter = MATTERS.get(attempt.failure.code)
    claims = [one.claims() for one in perturbations]
    for fits in (
        [
            any(what == matter and (key in about or key == CHARACTER or what == "way") for what, key in own)
            for own in claims
        ],
        [any(key in about for _, key in own) for own in claims],
    ):
        if any(fits):
            return fits.index(True) if sum(fits) == 1 else None
    return None
