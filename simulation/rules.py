"""Named options of the engine: where the release's accidents and people's expectations differ."""

from collections.abc import Mapping
from typing import Any, Literal, NamedTuple, get_args

from hearth.kb.knowledge import Knowledge
from hearth.schemas.literals import Key
from hearth.schemas.program import Program

Origin = Literal["sensible", "release"]


class Rules(NamedTuple):
    """Options of actions.

    Attributes:
        origin: which place Grab remembers for PutObjBack when several would do. `sensible`: what the object stood on or
            in, else the nearest furniture, never the character. `release`: the accident of hash order by which the
            published end graphs were made, which decides 55 of 518 of them.
        watch_needs_on: watching something with a switch needs it ON (thesis 5.5.2); the release watches what is off.
        doors: a closed door on the only way between two rooms stops a walk; the release ignores doors.
        bodies: characters at places do not walk by metres through each other.
        one_grip: what one holds is not grabbed again. The release takes it into the other hand, too.
        made_bed: bedding on what one can lie on takes no room there: it is turned back. The release counts it, so that
            a made bed is occupied.
    """

    origin: Origin = "sensible"
    watch_needs_on: bool = True
    doors: bool = True
    bodies: bool = False
    one_grip: bool = False
    made_bed: bool = False


DEFAULT = Rules(made_bed=True)
"""For inference, sampling, augmenting and people's own programs."""

REPLAY = Rules(origin="release", watch_needs_on=False, doors=False)
"""Reproduces the release's stored end graphs exactly."""

WATCHING_OFF = DEFAULT._replace(watch_needs_on=False)
"""For programs that watch what they themselves keep off (see `suited`)."""

RULES: dict[str, Rules] = {
    "made_bed": DEFAULT,
    "made_bed_watching_off": WATCHING_OFF,
    "replay": REPLAY,
    "default": DEFAULT._replace(made_bed=False),
    "watching_off": WATCHING_OFF._replace(made_bed=False),
}
"""The options by the names that published executions give them. The last two are of datasets from before `made_bed`;
what a name stands for never changes."""


def read(given: Mapping[str, Any]) -> Rules:
    """Options by name, as `Rules._asdict` gives them; what is not named is as it was before there was a choice.

    Raises:
        TypeError: one of them is unknown.
        ValueError: one of them has a value that it cannot have.
    """
    rules = Rules(**given)
    switches = {name: value for name, value in rules._asdict().items() if name != "origin"}
    odd = [name for name, value in switches.items() if not isinstance(value, bool)]
    if rules.origin not in get_args(Origin):
        odd.append("origin")
    if odd:
        raise ValueError(f"the rule `{odd[0]}` is {given[odd[0]]!r:.40}")
    return rules


def suited(program: Program, knowledge: Knowledge, rules: Rules = DEFAULT) -> Rules:
    """The rules by which a program says what its author meant.

    Who switches something on only after watching it, or off before, watches what is off: the release has such programs,
    and by the thesis's rule (5.5.2) they contradict themselves.
    """
    on, off = knowledge.achieving("ON"), knowledge.achieving("OFF")
    now: dict[Key, bool] = {}
    watched: set[Key] = set()
    for step in program.steps:
        for key in (ref.key for ref in step.objects[:1]):
            first_on = step.action in on and key not in now
            if (step.action == "Watch" and not now.get(key, True)) or (first_on and key in watched):
                return rules._replace(watch_needs_on=False)
            if step.action == "Watch":
                watched.add(key)
            elif step.action in on | off:
                now[key] = step.action in on
    return rules
