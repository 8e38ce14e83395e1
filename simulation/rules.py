"""Named options of the engine: where the release's accidents and people's expectations differ."""

from collections.abc import Mapping
from typing import Any, Literal, NamedTuple, get_args

from hearth.kb.action_sets import LATEST
from hearth.kb.knowledge import Knowledge
from hearth.schemas.literals import Key
from hearth.schemas.program import Program

Origin = Literal["sensible", "release"]

Near = Literal["release", "evolving_graph"]


class Rules(NamedTuple):
    """Options of actions.

    Attributes:
        origin: which place Grab remembers for PutObjBack when several would do. `sensible`: what the object stood on or
            in, else the nearest furniture, never the character. `release`: the accident of hash order by which the
            published end graphs were made, which decides 55 of 518 of them.
        watch_needs_on: watching something with a switch needs it ON (thesis 5.5.2); the release watches what is off.
        doors: a closed door on the only way between two rooms stops a walk; the release ignores doors.
        bodies: characters at places do not walk by metres through each other. They go around each other; of two that
            stop each other the higher number steps aside, and so does a character that does nothing.
        one_grip: what one holds is not grabbed again. The release takes it into the other hand, too.
        made_bed: bedding on a bed or couch takes no room there: it is turned back. The release counts it, so that
            a made bed is occupied.
        near: what a walk brings one close to. `release`: its goal, a room too, what that is INSIDE, what is ON it, and
            one's body parts. `evolving_graph`: its goal, what that is INSIDE and ON, what is INSIDE it if it can be
            opened, and one's body parts; nothing after a walk into a room.
        near_hands: one's body parts make near only what is in the room that one is in. By the rules of the release and
            of `evolving_graph` hands that are CLOSE to a sink make it near from any room.
        leaves_seat: a character that stands up, or changes to another seat, is no longer ON the one before, which is
            free then; and nobody takes a seat that is in use. In the release one stays ON every seat ever used.
        consequences: action set 3 (`version.NEXT_ACTION_SET`): acts change temperature, cleanliness, wholeness,
            every action is executed, and heating, washing and drying take time (`processes`).
    """

    origin: Origin = "sensible"
    watch_needs_on: bool = True
    doors: bool = True
    bodies: bool = False
    one_grip: bool = False
    made_bed: bool = False
    near: Near = "release"
    near_hands: bool = False
    leaves_seat: bool = False
    consequences: bool = False


DEFAULT = Rules(made_bed=True, near_hands=True, leaves_seat=True)
"""For inference, sampling, augmenting and people's own programs."""

REPLAY = Rules(origin="release", watch_needs_on=False, doors=False)
"""Reproduces the release's stored end graphs exactly."""

EVOLVING_GRAPH = Rules(origin="release", watch_needs_on=False, doors=False, one_grip=True, near="evolving_graph")
"""Reads actions as the simulator `evolving_graph` of VirtualHome 2.x and the Embodied Agent Interface does today.

What is in an opened thing that one stands at is within reach, and nothing in a room that one has only walked into. It
checks no doors either.
"""

WATCHING_OFF = DEFAULT._replace(watch_needs_on=False)
"""For programs that watch what they themselves keep off (see `suited`)."""

CONSEQUENCES = DEFAULT._replace(consequences=True)
"""Action set 3."""

RULES: dict[str, Rules] = {
    "consequences": CONSEQUENCES,
    "consequences_watching_off": CONSEQUENCES._replace(watch_needs_on=False),
    "leaves_seat": DEFAULT,
    "leaves_seat_watching_off": WATCHING_OFF,
    "replay": REPLAY,
    "evolving_graph": EVOLVING_GRAPH,
    "near_hands": DEFAULT._replace(leaves_seat=False),
    "near_hands_watching_off": WATCHING_OFF._replace(leaves_seat=False),
    "made_bed": DEFAULT._replace(leaves_seat=False, near_hands=False),
    "made_bed_watching_off": WATCHING_OFF._replace(leaves_seat=False, near_hands=False),
    "default": DEFAULT._replace(leaves_seat=False, near_hands=False, made_bed=False),
    "watching_off": WATCHING_OFF._replace(leaves_seat=False, near_hands=False, made_bed=False),
}
"""The options by the names that published executions give them. The last six are of datasets from before `leaves_seat`,
four of them from before `near_hands`, two from before `made_bed`; what a name stands for never changes."""

CHOICES: dict[str, Rules] = {
    "default": DEFAULT,
    "replay": REPLAY,
    "evolving_graph": EVOLVING_GRAPH,
    "consequences": CONSEQUENCES,
}
"""Rules from which `--rules` of a command chooses: ours, the release of 2018, VirtualHome 2.x, action set 3."""


def read(given: Mapping[str, Any]) -> Rules:
    """Options by name, as `Rules._asdict` gives them; what is not named is as it was before there was a choice.

    Raises:
        TypeError: one of them is unknown.
        ValueError: one of them has a value that it cannot have.
    """
    rules = Rules(**given)
    words = {"origin": get_args(Origin), "near": get_args(Near)}
    odd = [name for name, value in rules._asdict().items() if name not in words and not isinstance(value, bool)]
    odd += [name for name, known in words.items() if getattr(rules, name) not in known]
    if odd:
        raise ValueError(f"the rule `{odd[0]}` is {given[odd[0]]!r:.40}")
    return rules


def rules_of(knowledge: Knowledge) -> Rules:
    """Return the rules by which inference, sampling, augmenting and people's programs read the actions of a set."""
    return CONSEQUENCES if knowledge.action_set == LATEST else DEFAULT


def suited(program: Program, knowledge: Knowledge, rules: Rules = DEFAULT) -> Rules:
    """Return the rules by which a program says what its author meant.

    A person who switches something on only after watching it, or off before, watches a dark screen: the release has
    such programs, and by the thesis's rule (5.5.2) they contradict themselves.
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
