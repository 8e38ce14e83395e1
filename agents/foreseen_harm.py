"""Questions to the engine about harm: what an act would begin, which act ends it, and whether a goal needs a hazard."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.schemas.goals import Goal
from hearth.schemas.literals import Literal, Name
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.vocabulary import EVERY_STATE_ID
from hearth.simulation.engine import tick
from hearth.simulation.hazards import Place, present
from hearth.simulation.lasting_changes import undone
from hearth.simulation.literal_truth import nodes
from hearth.simulation.processes import widened
from hearth.simulation.rules import Rules
from hearth.simulation.world.bits import indices
from hearth.simulation.world.edit import edit
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

WITNESSES = 3
"""Things of a class with which a goal is tried: it needs a hazard where it brings one with each of them."""


class Foreseen(NamedTuple):
    """The harm of an act that an agent has not done yet, compared with doing nothing.

    Attributes:
        world: after the act.
        begun: the conditions of hazards that would begin, each with whether it is a hazard at once or once it lasts.
        left: the conditions that hold already and that would become hazards, since nobody would be there any more.
        lost: the things that would be broken or used up for good.
    """

    world: World
    begun: dict[Place, bool]
    left: tuple[Place, ...]
    lost: int


def foreseen(world: World, step: Step, rules: Rules, known: dict[Place, bool] | None = None) -> Foreseen | None:
    """Return the harm of an act; None where the act can't be done.

    Args:
        world: as the agent believes it to be.
        step: what it would do.
        rules: of actions.
        known: `present` of the world in which it does nothing, if that was asked for already.
    """
    world = widened(world)
    after, failures = tick(world, {step.agent: step}, rules)
    if failures:
        return None
    idle = tick(world, {}, rules)[0]
    before, now = dict(present(idle)) if known is None else known, dict(present(after))
    begun = {place: is_one for place, is_one in now.items() if place not in before}
    left = tuple(place for place, is_one in now.items() if is_one and before.get(place) is False)
    return Foreseen(after, begun, left, _lost(idle, after))


def _lost(idle: World, after: World) -> int:
    """Return the things that an act brings into a state of harm which nothing ends."""
    idle, after, found = widened(idle), widened(after), 0
    for number in harm_states(after.home.knowledge):
        came = after.states[number] & ~idle.states[number]
        found |= came & ~undone(after.home, number) if came else 0
    return found


def harm_states(knowledge: Knowledge) -> tuple[int, ...]:
    """Return the numbers of the states in which a thing is harmed or used up."""
    names = (name for group in knowledge.state_groups.values() for name in group.harm)
    return tuple(EVERY_STATE_ID[name] for name in names if name in EVERY_STATE_ID)


def is_lasting(place: Place, knowledge: Knowledge) -> bool:
    """Return whether a condition is a hazard only once it has lasted, so that it may be begun and ended in time."""
    return knowledge.hazards[place[0]].after > 0


def ending(place: Place, world: World, agent: int, actions: Collection[str], rules: Rules) -> Step | None:
    """Return an act on one of its things that ends a condition now; None where there is none.

    Args:
        place: the condition.
        world: in which it holds.
        agent: the number of the agent that would act.
        actions: those that the agent may do.
        rules: of actions.
    """
    home = world.home
    for i in place[1]:
        for step in _acts_on(home, i, agent, actions):
            after, failures = tick(world, {agent: step}, rules)
            if not failures and after is not world and place not in dict(present(after)):
                return step
    return None


def _acts_on(home: Home, i: int, agent: int, actions: Collection[str]) -> Iterator[Step]:
    """Yield the acts that change the state of a thing."""
    known = home.knowledge
    for name in sorted(actions):
        if known.arity[name] == 1 and known.state_of(name):
            yield Step(name, (ObjectRef(home.classes[i], 0, home.ids[i]),), agent)


def needs_hazard(goal: Goal, world: World) -> bool:
    """Return whether a goal holds only where there is a hazard, such as a fork in a microwave that is on.

    The agent that reaches the goal can prevent a hazard that asks that nobody is there, or that has to last.
    """
    return _has_hazard(tuple(goal.counts), world) or any(
        (all if part.join == "or" else any)(needs_hazard(each, world) for each in part.goals)
        for part in goal.parts
        if part.join not in ("not", "never")
    )


def _has_hazard(wanted: Iterable[tuple[Literal[Name], int]], world: World) -> bool:
    literals = [literal for literal, number in wanted if number > 0 and not literal.negated]
    if not literals:
        return False
    before = set(dict(present(world)))
    return all(_brings(literals, world, before, number) for number in range(WITNESSES))


def _brings(literals: list[Literal[Name]], world: World, before: set[Place], number: int) -> bool:
    """Return whether a hazard comes at once where literals are made true with a witness of each class."""
    home = world.home
    place: dict[int, tuple[str, int]] = {}
    states: list[tuple[int, str]] = []
    for literal in literals:
        found = [_witness(term, home, number) for term in literal.terms]
        if None in found:
            continue
        ids = [home.ids[i] for i in found if i is not None]
        if literal.name in EVERY_STATE_ID and len(ids) == 1:
            states.append((ids[0], literal.name))
        elif literal.name in ("ON", "INSIDE") and len(ids) == 2 and ids[0] != ids[1]:
            place[ids[0]] = (literal.name, ids[1])
    made = edit(widened(world), place=place, set=states, check=False)
    if not isinstance(made, World):
        return False
    rows = home.knowledge.hazards
    return any(
        is_one and not rows[name].after and not rows[name].alone and not rows[name].asleep
        for (name, things), is_one in present(made)
        if (name, things) not in before
    )


def _witness(term: Name, home: Home, number: int) -> int | None:
    found = list(indices(nodes(term, home)))
    return found[number % len(found)] if found else None
