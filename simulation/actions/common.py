"""The record of an action, and the checks that actions share.

A check is made for one object by the engine and for all nodes at once by `legal`; both readings of it stand together.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from operator import attrgetter
from typing import Any, NamedTuple

from hearth.schemas.failures import Code, Failure
from hearth.schemas.vocabulary import STATES
from hearth.simulation.actions.situation import Situation
from hearth.simulation.rules import Rules
from hearth.simulation.world import edge_rows
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.states import OPEN, with_state
from hearth.simulation.world.world import World

Rule = Callable[[World, int, int, int, Rules], World | Failure]
"""(world, agent number, index of the first object, of the second, rules) -> the next world, or why not.
Indices of objects that the action does not take are -1."""

Masks = tuple[int, ...] | None
"""For each argument the nodes it may be, independently of the other; None when the action can't be done at all."""

Mask = Callable[[Situation], Masks]

Effect = Callable[[World, int, int, Rules], World]
"""(world, agent number, index of the object, rules) -> the next world, once all checks hold."""


class Action(NamedTuple):
    """An action that is executed.

    Attributes:
        name: as in the knowledge, which has its roles, needs, literals and groups.
        rule: does it, or refuses.
        mask: the objects for which the rule does not refuse.
        effect: what it does once its checks hold, as a value (`Becomes`, `unchanged`) or a function; None where only
            the rule knows.
        variant: chooses the record that is in force by the rules; None where there is one record.
    """

    name: str
    rule: Rule
    mask: Mask
    effect: Effect | None = None
    variant: Callable[[Rules], Any] | None = None

    def under(self, rules: Rules) -> Action:
        """Return the record that is in force by the rules."""
        record = self
        while record.variant is not None:
            record = record.variant(rules)
        return record


class Check(NamedTuple):
    """One thing that must hold before an action of one object.

    Attributes:
        refuse: (world, character, index of the object, name of the action) -> the failure where it does not hold.
        mask: (situation, name of the action) -> the nodes for which it holds.
    """

    refuse: Callable[[World, Agent, int, str], Failure | None]
    mask: Callable[[Situation, str], int]


@dataclass(frozen=True, slots=True)
class Becomes:
    """The effect that the object enters a state, as a value that other engines can read.

    Attributes:
        state: its number; the object leaves the opposite.
    """

    state: int

    def __call__(self, world: World, number: int, o: int, rules: Rules) -> World:
        """Return the world in which the object is in the state."""
        return World(world.home, with_state(world.states, self.state, 1 << o), world.agents, world.moved)


becomes = Becomes
"""The same, as 0.2 named it."""


def unchanged(world: World, number: int, o: int, rules: Rules) -> World:
    """Return the same world: the effect of an action that changes nothing."""
    return world


def checked(name: str, *checks: Check, effect: Effect | None = None) -> Action:
    """Return the action of one object that makes these checks in order and then has this effect, or has none."""
    refusals = tuple(check.refuse for check in checks)
    by_hands = tuple(_need_near if refusal is need_close else refusal for refusal in refusals)
    masks = tuple(check.mask for check in reversed(checks))  # the last are the cheapest and most often empty

    def rule(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
        agent = world.agents[number]
        for refusal in by_hands if rules.near_hands else refusals:
            failure = refusal(world, agent, o, name)
            if failure is not None:
                return failure
        return world if effect is None else effect(world, number, o, rules)

    def mask(situation: Situation) -> Masks:
        found = situation.home.everything
        for holding in masks:
            found &= holding(situation, name)
            if not found:
                return None
        return (found,)

    return Action(name, rule, mask, unchanged if effect is None else effect)


def by_rule(name: str, on: Action, off: Action) -> Action:
    """Return the action that is `on` where a rule is on, else `off`.

    So a check need not know the rules: those that a rule replaces or adds stand in another list of checks.

    Args:
        name: of the rule, a switch of `Rules`.
        on, off: the action by either value of it, both of the same name.
    """
    is_on: Callable[[Rules], bool] = attrgetter(name)

    def rule(world: World, number: int, o: int, s: int, rules: Rules) -> World | Failure:
        return (on if is_on(rules) else off).rule(world, number, o, s, rules)

    def mask(situation: Situation) -> Masks:
        return (on if is_on(situation.rules) else off).mask(situation)

    return Action(on.name, rule, mask, variant=lambda rules: on if is_on(rules) else off)


def refuse(world: World, code: Code, expected: str, actual: str, *objects: int) -> Failure:
    """Return a failure about these indices; the engine fills in tick, agent and action."""
    home = world.home
    ids = tuple(home.ids[i] for i in objects if i >= 0)
    names = tuple(home.classes[i] for i in objects if i >= 0)
    return Failure(code, objects=ids, names=names, expected=expected, actual=actual)


def some(mask: int) -> Masks:
    """Return the masks of an action of one object; None when no object is left."""
    return (mask,) if mask else None


def need_able(world: World, agent: Agent, o: int, action: str, position: int = 0) -> Failure | None:
    """Refuse an object that the knowledge does not allow for this argument."""
    if world.home.able(action, position) >> o & 1:
        return None
    requirement = str(world.home.knowledge.actions[action].needs[position])
    return refuse(world, Code.NOT_AFFORDED, requirement, "none of these", o)


def need_close(world: World, agent: Agent, o: int, action: str = "", near_hands: bool = False) -> Failure | None:
    """Refuse what the character is not close to, by the rule `near_hands` or without it."""
    if edge_rows.is_near(world, agent, o, near_hands) if near_hands else edge_rows.is_close(world, agent, o):
        return None
    return refuse(world, Code.NOT_CLOSE, "the character close to it", "no CLOSE edge, direct or by one hop", o)


def _need_near(world: World, agent: Agent, o: int, action: str = "") -> Failure | None:
    return need_close(world, agent, o, action, near_hands=True)


def need_another(world: World, o: int, s: int) -> Failure | None:
    """Refuse to do something with a thing and itself."""
    return refuse(world, Code.NOT_AFFORDED, "two different things", "the same twice", o) if o == s else None


def need_free_hand(world: World, agent: Agent, o: int, action: str = "") -> Failure | None:
    """Refuse when both hands hold something."""
    if not agent.right or not agent.left:
        return None
    return refuse(
        world, Code.NO_FREE_HAND, "a free hand", "both hands hold something", o, *edge_rows.held_indices(agent)
    )


def need_holding(world: World, agent: Agent, o: int, action: str = "") -> Failure | None:
    """Refuse what neither hand holds."""
    if (agent.right | agent.left) >> o & 1:
        return None
    return refuse(world, Code.NOT_HOLDING, "the object in a hand", "in neither hand", o)


def need_facing(world: World, agent: Agent, o: int, action: str = "") -> Failure | None:
    """Refuse what the character does not face."""
    if edge_rows.is_facing(world, agent, o):
        return None
    return refuse(world, Code.NOT_FACING, "the character facing it", "no FACING edge, direct or by one hop", o)


def need_open(world: World, s: int) -> Failure | None:
    """Refuse a container that is not open, though it can be."""
    if not world.home.properties["CAN_OPEN"] >> s & 1 or world.states[OPEN] >> s & 1:
        return None
    return refuse(world, Code.IS_CLOSED, "OPEN", "CLOSED", s)


def need_state(world: World, code: Code, state: int, o: int) -> Failure | None:
    """Refuse what is not in a state; what is in neither of a pair is refused too."""
    if world.states[state] >> o & 1:
        return None
    other = STATES[state ^ 1]
    found = other if world.states[state ^ 1] >> o & 1 else f"neither {STATES[state]} nor {other}"
    return refuse(world, code, STATES[state], found, o)


def need_reachable(world: World, agent: Agent, o: int, action: str = "") -> Failure | None:
    """Refuse what is inside something closed, naming the container."""
    container = edge_rows.closed_container(world, o)
    if container < 0:
        return None
    return refuse(world, Code.INSIDE_CLOSED, "its container OPEN", "CLOSED", o, container)


def in_state(state: int, code: Code) -> Check:
    """Return the object is in a state."""

    def refusal(world: World, agent: Agent, o: int, action: str) -> Failure | None:
        return None if world.states[state] >> o & 1 else need_state(world, code, state, o)

    return Check(refusal, lambda s, _: s.states[state])


def not_in_state(state: int, code: Code) -> Check:
    """Return the object is not in a state; it may be in neither of a pair."""

    def refusal(world: World, agent: Agent, o: int, action: str) -> Failure | None:
        if not world.states[state] >> o & 1:
            return None
        return refuse(world, code, f"not {STATES[state]}", STATES[state], o)

    return Check(refusal, lambda s, _: ~s.states[state])


able = Check(need_able, lambda s, action: s.able(action))
close = Check(need_close, lambda s, _: s.close)
facing = Check(need_facing, lambda s, _: s.facing)
free_hand = Check(need_free_hand, lambda s, _: -1 if s.free_hand else 0)
held = Check(need_holding, lambda s, _: s.held)
reachable = Check(need_reachable, lambda s, _: ~s.hidden)
