"""Named options of the engine: where the release's accidents and people's expectations differ."""

from typing import Literal, NamedTuple


class Rules(NamedTuple):
    """Options of actions.

    Attributes:
        origin: which place Grab remembers for PutObjBack when several would do. `sensible`: what the object stood on or
            in, else the nearest furniture, never the character. `release`: the accident of hash order by which the
            published end graphs were made, which decides 55 of 518 of them.
        watch_needs_on: watching something with a switch needs it ON (thesis 5.5.2); the release watches what is off.
        doors: a closed door on the only way between two rooms stops a walk; the release ignores doors.
    """

    origin: Literal["sensible", "release"] = "sensible"
    watch_needs_on: bool = True
    doors: bool = True


DEFAULT = Rules()
"""For inference, sampling, augmenting and people's own programs."""

REPLAY = Rules(origin="release", watch_needs_on=False, doors=False)
"""Reproduces the release's stored end graphs exactly."""

RULES: dict[str, Rules] = {"default": DEFAULT, "replay": REPLAY}
"""The options by the names that published executions give them."""
