"""What the actions share: the shape of an action, refusing, checking and setting states."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from hearth.schemas.failures import Code, Failure
from hearth.schemas.vocabulary import STATE_ID, STATES
from hearth.simulation import rows
from hearth.simulation.agent import Agent
from hearth.simulation.rules import Rules

if TYPE_CHECKING:
    from hearth.simulation.world import World

Action = Callable[["World", int, int, int, Rules], "World | Failure"]
"""(world, agent number, index of the first object, of the second, rules) -> the next world, or why not.
Indices of objects that the action does not take are -1."""

CLOSED, OPEN, OFF, ON, DIRTY, CLEAN, PLUGGED_OUT, PLUGGED_IN, SITTING, LYING = range(len(STATES))


def refuse(world: World, code: Code, expected: str, actual: str, *objects: int) -> Failure:
    """A failure about these indices; the engine fills in tick, agent and action."""
    home = world.home
    ids = tuple(home.ids[i] for i in objects if i >= 0)
    names = tuple(home.classes[i] for i in objects if i >= 0)
    return Failure(code, objects=ids, names=names, expected=expected, actual=actual)


def with_state(states: tuple[int, ...], state: int, bit: int) -> tuple[int, ...]:
    """The states after a node enters one; it leaves the opposite."""
    new = list(states)
    new[state] |= bit
    new[state ^ 1] &= ~bit
    return tuple(new)


def need_able(world: World, action: str, o: int, position: int = 0) -> Failure | None:
    """Refuse an object that the knowledge does not allow for this argument."""
    if world.home.able(action, position) >> o & 1:
        return None
    requirement = str(world.home.knowledge.actions[action].needs[position])
    return refuse(world, Code.NOT_AFFORDED, requirement, "none of these", o)


def need_close(world: World, agent: Agent, o: int) -> Failure | None:
    """Refuse what the character is not close to."""
    if rows.is_close(world, agent, o):
        return None
    return refuse(world, Code.NOT_CLOSE, "the character close to it", "no CLOSE edge, direct or by one hop", o)


def need_free_hand(world: World, agent: Agent, o: int) -> Failure | None:
    """Refuse when both hands hold something."""
    if not agent.right or not agent.left:
        return None
    return refuse(world, Code.NO_FREE_HAND, "a free hand", "both hands hold something", o, *rows.held_indices(agent))


def need_holding(world: World, agent: Agent, o: int) -> Failure | None:
    """Refuse what neither hand holds."""
    if (agent.right | agent.left) >> o & 1:
        return None
    return refuse(world, Code.NOT_HOLDING, "the object in a hand", "in neither hand", o)


def need_state(world: World, code: Code, state: int, o: int) -> Failure | None:
    """Refuse what is not in a state; what is in neither of a pair is refused too."""
    if world.states[state] >> o & 1:
        return None
    other = STATES[state ^ 1]
    found = other if world.states[state ^ 1] >> o & 1 else f"neither {STATES[state]} nor {other}"
    return refuse(world, code, STATES[state], found, o)


def need_reachable(world: World, o: int) -> Failure | None:
    """Refuse what is inside something closed, naming the container."""
    container = rows.closed_container(world, o)
    if container < 0:
        return None
    return refuse(world, Code.INSIDE_CLOSED, "its container OPEN", "CLOSED", o, container)


def state_id(name: str) -> int:
    """The index of a state's set in `World.states`."""
    return STATE_ID[name]
