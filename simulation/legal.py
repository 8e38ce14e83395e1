"""Which instructions could be done now: a bit set for each argument of each action, instructions listed lazily."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import product
from typing import TYPE_CHECKING

from hearth.schemas.program import ObjectRef, Step
from hearth.simulation import moved as kinds
from hearth.simulation import reach, rows
from hearth.simulation.actions.common import CLOSED, LYING, OFF, ON, OPEN, PLUGGED_IN, PLUGGED_OUT, SITTING
from hearth.simulation.agent import Agent
from hearth.simulation.bits import indices, mask_of
from hearth.simulation.rules import DEFAULT, Rules

if TYPE_CHECKING:
    from hearth.simulation.home import Home
    from hearth.simulation.world import World

Masks = tuple[int, ...] | None
"""For each argument the nodes it may be, independently of the other; None when the action can't be done at all."""


@dataclass(frozen=True, slots=True)
class Legal:
    """The instructions one agent could do in one world.

    Attributes:
        home: whose nodes the masks are about.
        agent: whose instructions.
        masks: action -> masks, for the executed actions that can be done.
    """

    home: Home
    agent: int
    masks: Mapping[str, tuple[int, ...]]

    def __contains__(self, instruction: Step) -> bool:
        masks = self.masks.get(instruction.action)
        if masks is None or len(masks) != len(instruction.objects) or instruction.agent != self.agent:
            return False
        index = self.home.index
        return all(
            ref.node in index and mask >> index[ref.node] & 1
            for ref, mask in zip(instruction.objects, masks, strict=True)
        )

    def __iter__(self) -> Iterator[Step]:
        """Instructions by action name, then node ids; made one by one as they are asked for."""
        for action in sorted(self.masks):
            for objects in product(*map(self._references, self.masks[action])):
                yield Step(action, objects, self.agent)

    def __len__(self) -> int:
        total = 0
        for masks in self.masks.values():
            count = 1
            for mask in masks:
                count *= mask.bit_count()
            total += count
        return total

    def objects(self, action: str, position: int = 0) -> tuple[int, ...]:
        """Ids of the nodes that an argument of an action may be, ascending; none when it can't be done."""
        masks = self.masks.get(action)
        return tuple(self.home.ids[i] for i in indices(masks[position])) if masks else ()

    def _references(self, mask: int) -> Iterator[ObjectRef]:
        home = self.home
        return (ObjectRef(home.classes[i], 0, home.ids[i]) for i in indices(mask))


def legal(
    world: World, agent: int = 0, rules: Rules = DEFAULT, *, only_visible: bool = False, only_reachable: bool = False
) -> Legal:
    """What an agent could do now: exactly the instructions that `engine.act` would not refuse.

    Args:
        world: now.
        agent: number of the agent.
        rules: as the engine is to read the actions.
        only_visible: leave out instructions about what the agent does not see (see `reach.visible`).
        only_reachable: leave out instructions about what closed doors or containers keep from it, even where the
            action itself would not mind.
    """
    situation = Situation(world, agent, rules)
    keep = -1
    if only_visible:
        keep &= reach.visible(world, situation.me)
    if only_reachable:
        keep &= reach.reachable(world, situation.me)
    found: dict[str, tuple[int, ...]] = {}
    for action, masks_of in MASKS.items():
        masks = masks_of(situation)
        if masks is not None:
            kept = tuple([mask & keep for mask in masks])
            if all(kept):
                found[action] = kept
    return Legal(world.home, agent, found)


class Situation:
    """A world as one agent meets it; what several actions ask is found out once, when first asked."""

    def __init__(self, world: World, number: int, rules: Rules) -> None:
        self.world = world
        self.home = world.home
        self.number = number
        self.rules = rules
        self.me: Agent = world.agents[number]
        self.states = world.states
        self.held = self.me.held
        self.free_hand = not (self.me.right and self.me.left)
        self.sitting = bool(world.states[SITTING] & self.me.bit)
        self.lying = bool(world.states[LYING] & self.me.bit)
        self.resting = self.sitting or self.lying
        self.close = reach.close_to(world, self.me)

    @cached_property
    def facing(self) -> int:
        """What the agent faces."""
        return reach.faced_by(self.world, self.me)

    @cached_property
    def hidden(self) -> int:
        """What is shut away."""
        return reach.hidden(self.world)

    @cached_property
    def walkable(self) -> int:
        """What can be walked to, once the agent stands."""
        return reach.walkable(self.world, self.me, self.rules.doors)

    @cached_property
    def touchable(self) -> int:
        """What is close and not shut away."""
        return self.close & ~self.hidden

    @cached_property
    def held_by_others(self) -> int:
        """What other characters hold."""
        found = 0
        for number, other in enumerate(self.world.agents):
            if number != self.number:
                found |= other.held
        return found

    @cached_property
    def full_handed(self) -> int:
        """Other characters that can't be handed anything."""
        others = (a for n, a in enumerate(self.world.agents) if n != self.number)
        return mask_of(a.index for a in others if a.right and a.left)

    def able(self, action: str, position: int = 0) -> int:
        """What the knowledge allows for an argument."""
        return self.home.able(action, position)


def _one(mask: int) -> Masks:
    return (mask,) if mask else None


def _walk(s: Situation) -> Masks:
    return None if s.resting else _one(s.walkable)


def _find(s: Situation) -> Masks:
    if s.resting:
        return _one(s.close)
    near = s.home.properties["BODY_PART"] | s.me.worn
    return _one(s.close | s.walkable & ~near)


def _sit(s: Situation) -> Masks:
    return None if s.sitting else _one(_unoccupied(s, s.able("Sit") & s.close, lying=False))


def _lie(s: Situation) -> Masks:
    return None if s.lying else _one(_unoccupied(s, s.able("Lie") & s.close, lying=True))


def _unoccupied(s: Situation, places: int, lying: bool) -> int:
    world, home = s.world, s.home
    return mask_of(i for i in indices(places) if rows.bearing(world, i).bit_count() < home.limit(i, lying))


def _resting(s: Situation) -> Masks:
    return () if s.resting else None


def _grab(s: Situation) -> Masks:
    return _one(s.able("Grab") & s.touchable & ~s.held_by_others) if s.free_hand else None


def _put_back(s: Situation) -> Masks:
    return (s.held, s.close & ~s.full_handed) if s.held else None


def _put_in(s: Situation) -> Masks:
    return (s.held, s.close & (~s.home.properties["CAN_OPEN"] | s.states[OPEN])) if s.held else None


def _put_obj_back(s: Situation) -> Masks:
    shut = s.home.properties["CAN_OPEN"] & ~s.states[OPEN]
    mask = 0
    for o, place, kind in s.me.origins:
        if s.held >> o & 1 and s.close >> place & 1 and not (kind == kinds.INSIDE and shut >> place & 1):
            mask |= 1 << o
    return _one(mask)


def _held(s: Situation) -> Masks:
    return _one(s.held)


def _held_able(action: str, s: Situation) -> Masks:
    return _one(s.held & s.able(action))


def _open(s: Situation) -> Masks:
    return _one(s.able("Open") & s.close & s.states[CLOSED] & ~s.states[ON]) if s.free_hand else None


def _close(s: Situation) -> Masks:
    return _one(s.able("Close") & s.close & s.states[OPEN])


def _switch_on(s: Situation) -> Masks:
    return _one(s.able("SwitchOn") & s.close & s.states[OFF] & ~s.states[PLUGGED_OUT])


def _switch_off(s: Situation) -> Masks:
    return _one(s.able("SwitchOff") & s.close & s.states[ON])


def _plug_in(s: Situation) -> Masks:
    return _one(s.able("PlugIn") & s.close & s.states[PLUGGED_OUT]) if s.free_hand else None


def _plug_out(s: Situation) -> Masks:
    return _one(s.able("PlugOut") & s.close & s.states[PLUGGED_IN]) if s.free_hand else None


def _turn_to(s: Situation) -> Masks:
    return _one(s.home.everything)


def _facing(s: Situation) -> Masks:
    return _one(s.facing)


def _watch(s: Situation) -> Masks:
    mask = s.able("Watch") & s.facing
    if s.resting:
        mask &= s.me.facing | s.home.by_class.get("computer", 0)
    if s.rules.watch_needs_on:
        mask &= ~s.home.properties["HAS_SWITCH"] | s.states[ON]
    if mask:
        room = rows.agent_room(s.world, s.me)
        mask = mask_of(i for i in indices(mask) if rows.room_of(s.world, i) == room)
    return _one(mask)


def _eat(s: Situation) -> Masks:
    food = s.home.properties["EATABLE"]
    plates = mask_of(i for i in indices(s.close & ~food) if rows.bearing(s.world, i) & food)
    return _one(s.close & food | plates)


def _cut(s: Situation) -> Masks:
    knife = any("knife" in s.home.classes[i] for i in indices(s.held))
    return _one(s.close & s.able("Cut")) if knife and s.free_hand else None


def _pour(s: Situation) -> Masks:
    return s.able("Pour") & s.held, s.able("Pour", 1) & s.close


def _touch(s: Situation) -> Masks:
    return _one(s.touchable)


def _shift(action: str, s: Situation) -> Masks:
    return _one(s.able(action) & s.touchable) if s.free_hand else None


def _wipe(s: Situation) -> Masks:
    return _one(s.close) if s.held else None


def _wash(s: Situation) -> Masks:
    return _one(s.close)


def _close_able(action: str, s: Situation) -> Masks:
    return _one(s.close & s.able(action))


def _squeeze(s: Situation) -> Masks:
    return _close_able("Squeeze", s) if s.free_hand else None


def _put_off(s: Situation) -> Masks:
    return _one(s.me.worn & s.able("PutOff"))


def _greet(s: Situation) -> Masks:
    return _one(s.able("Greet"))


MASKS: dict[str, Callable[[Situation], Masks]] = {
    "Close": _close,
    "Cut": _cut,
    "Drink": partial(_held_able, "Drink"),
    "Drop": _held,
    "Eat": _eat,
    "Find": _find,
    "Grab": _grab,
    "Greet": _greet,
    "Lie": _lie,
    "LookAt": _facing,
    "Move": partial(_shift, "Move"),
    "Open": _open,
    "PlugIn": _plug_in,
    "PlugOut": _plug_out,
    "PointAt": _facing,
    "Pour": _pour,
    "Pull": partial(_shift, "Pull"),
    "Push": partial(_shift, "Push"),
    "PutBack": _put_back,
    "PutIn": _put_in,
    "PutObjBack": _put_obj_back,
    "PutOff": _put_off,
    "PutOn": partial(_held_able, "PutOn"),
    "Read": partial(_held_able, "Read"),
    "Release": _held,
    "Rinse": _wash,
    "Run": _walk,
    "Scrub": _wash,
    "Sit": _sit,
    "Sleep": _resting,
    "Squeeze": _squeeze,
    "StandUp": _resting,
    "SwitchOff": _switch_off,
    "SwitchOn": _switch_on,
    "Touch": _touch,
    "TurnTo": _turn_to,
    "Type": partial(_close_able, "Type"),
    "WakeUp": _resting,
    "Walk": _walk,
    "Wash": _wash,
    "Watch": _watch,
    "Wipe": _wipe,
}
"""The masks of each executed action: the checks of `actions`, made for all objects at once."""
