"""Helpers with a veto: they ask the engine before they act, and do nothing that starts a hazard or can't be undone.

A veto is laid over any other helper. What that helper chooses is done in a copy of the world that it believes in:

- An act that is a hazard at once, or that breaks or uses up something that the goal does not ask for, is refused.
- An act that becomes a hazard only once it lasts, such as an opened fridge, is allowed where an act ends it. The helper
  ends it before it goes elsewhere, unless its work is there and it is back in time.
- A goal that holds only where there is a hazard is refused: the helper waits.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from hearth.agents.expected_time_helper import ExpectedTime
from hearth.agents.foreseen_harm import Foreseen, ending, foreseen, is_lasting, needs_hazard
from hearth.agents.goal_space import GoalsIn
from hearth.agents.hierarchical_helper import Hierarchical
from hearth.agents.nopa import Nopa
from hearth.agents.protocol import Choice
from hearth.agents.random_helper import RandomHelper
from hearth.agents.walk_distances import Distances
from hearth.schemas.goals import Goal
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.actions.legal import Legal
from hearth.simulation.engine import tick
from hearth.simulation.hazards import Place, present
from hearth.simulation.observation.masked_world import as_seen
from hearth.simulation.observation.views import View
from hearth.simulation.processes import widened
from hearth.simulation.rules import rules_of
from hearth.simulation.wasted_acts import goal_nodes
from hearth.simulation.world import edge_rows
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

if TYPE_CHECKING:

    class _Base:
        """The helper that comes after the veto among the base classes."""

        def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
            """Begin an episode."""

        def act(self, observation: View, legal: Legal) -> Any:
            """Return the helper's choice."""

else:
    _Base = object

MARGIN = 2
"""Ticks before the end of a hazard's time by which what was begun is ended: others may stand in the way."""


class Begun(NamedTuple):
    """A condition that the helper began and that is a hazard once it lasts.

    Attributes:
        until: the last tick in which it is to be ended.
        contents: what was in and on its thing in the tick after, when an opened thing shows it; while that is so, the
            thing has not been used yet. None before that.
    """

    until: int
    contents: int | None = None


class Veto(_Base):
    """The veto over the agent that comes after it among the base classes.

    Attributes:
        tries: how often the agent is asked for another act in a tick where one was refused. Planners give the same one.
        refused: how many acts were refused in the episode.
    """

    tries = 1

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode (see `agents.protocol`)."""
        super().reset(observation, goal, seed)
        world = _believed(observation)
        self._rules = rules_of(world.home.knowledge)
        self._ways = Distances(world.home, observation.me.stride)
        self._given: set[Place] = set(dict(present(world)))
        self._begun: dict[Place, Begun] = {}
        self._goal = goal
        self._refuses = goal is not None and needs_hazard(goal, world)
        self.refused = 0

    def act(self, observation: View, legal: Legal) -> Any:
        """Return the agent's choice, an act that ends a hazard in time, or None where the choice is refused."""
        world = _believed(observation)
        idle = dict(present(tick(world, {}, self._rules)[0]))
        self._given &= idle.keys()
        self._begun = {
            place: each if each.contents is not None else each._replace(contents=_contents(world, place))
            for place, each in self._begun.items()
            if place in idle
        }
        for _ in range(self.tries):
            choice: Choice = super().act(observation, legal)
            if self._refuses:
                return None
            if not isinstance(choice, Step):
                return self._in_time(world, world, observation, legal) or choice
            harm = foreseen(world, choice, self._rules, idle)
            if harm is None:
                return choice  # the engine refuses it
            if not self._is_refused(harm, legal):
                return self._checked(choice, harm, world, observation, legal)
            self.refused += 1
        return self._in_time(world, world, observation, legal)

    def _is_refused(self, harm: Foreseen, legal: Legal) -> bool:
        """Return whether an act does harm that can't be ended in time, or that the goal does not need."""
        needed = goal_nodes(self._goal, harm.world) if harm.lost and self._goal is not None else 0
        if harm.lost & ~needed:
            return True
        known = harm.world.home.knowledge
        return any(
            not is_lasting(place, known) or self._ending(place, harm.world, legal) is None for place in harm.begun
        )

    def _checked(self, choice: Step, harm: Foreseen, world: World, view: View, legal: Legal) -> Step | None:
        """Return an act that does no harm of its own, unless something that was begun has to be ended first."""
        instead = self._in_time(world, harm.world, view, legal)
        if instead is not None:
            return instead
        for place in harm.left:
            if place not in self._given:
                return self._ended(place, world, legal)
        for place in harm.begun:
            after = world.home.knowledge.hazards[place[0]].after
            self._begun[place] = Begun(view.tick + after - MARGIN)
        return choice

    def _in_time(self, world: World, after: World, view: View, legal: Legal) -> Step | None:
        """Return an act against something that was begun and that can't wait; None where all of it can.

        Args:
            world: as it is now.
            after: the same after the choice.
            view: the observation.
            legal: the possible acts.
        """
        for place, begun in self._begun.items():
            can_now = self._ending(place, world, legal) is not None
            can_later = self._ending(place, after, legal) is not None
            back = 0 if can_later else self._way_back(place, after, legal.agent)
            if view.tick + 1 + back > begun.until or (can_now and not can_later and not self._returns(place, world)):
                return self._ended(place, world, legal)
        return None

    def _returns(self, place: Place, world: World) -> bool:
        """Return whether the helper may leave what it began: it comes back in time, because its work is there.

        Something that has been used and is not where the helper takes things now is ended before the helper leaves.
        """
        target = getattr(getattr(self, "subgoal", None), "target", None)
        return target in place[1] or _contents(world, place) == self._begun[place].contents

    def _way_back(self, place: Place, world: World, agent: int) -> int:
        """Return the ticks of the walk from where the helper would be."""
        cell = self._ways.cell(world.agents[agent].pose)
        return max(1, self._ways.ticks(self._ways.leg(cell, place[1][0])[0]))

    def _ended(self, place: Place, world: World, legal: Legal) -> Step | None:
        """Return an act that ends a condition, or a walk to its thing; None to stay where neither is possible."""
        step = self._ending(place, world, legal)
        if step is not None:
            return step
        home, i = world.home, place[1][0]
        for name in sorted(legal.masks.keys() & home.knowledge.group("goes")):
            if legal.masks[name] and legal.masks[name][0] >> i & 1:
                return Step(name, (ObjectRef(home.classes[i], 0, home.ids[i]),), legal.agent)
        return None

    def _ending(self, place: Place, world: World, legal: Legal) -> Step | None:
        return ending(place, world, legal.agent, legal.asked, self._rules)


def _contents(world: World, place: Place) -> int:
    """Return what is in or on the thing of a condition."""
    i = place[1][0]
    return edge_rows.contents(world, i) | edge_rows.bears(world, i)


def _believed(view: View) -> World:
    """Return a copy of the world as far as an agent sees it."""
    whole = not view.world.home.everything & ~view.mask
    return widened(view.world if whole else as_seen(view.world, view.mask))


class VetoRandom(Veto, RandomHelper):
    """Draws another act where one is refused."""

    tries = 20


class VetoHierarchical(Veto, Hierarchical):
    """The planner of a goal that it knows, with a veto."""


class _WithoutHazards:
    """The goals of a home that need no hazard."""

    def __init__(self, goals: GoalsIn) -> None:
        self._goals = goals

    def __call__(self, home: Home) -> Mapping[Goal, float]:
        """Return the goals with their probabilities; all of them where each needs a hazard."""
        found, world = self._goals(home), World.start(home)
        literals = {literal for goal in found for literal, _ in goal}
        harmful = {each for each in literals if needs_hazard(Goal.of(each), world)}
        rest = {goal: share for goal, share in found.items() if not any(each in harmful for each, _ in goal)}
        return rest or found


class VetoNopa(Veto, Nopa):
    """NOPA with a veto; goals that need a hazard are not reckoned with."""

    def __init__(self, goals: GoalsIn, *more: Any) -> None:
        super().__init__(_WithoutHazards(goals), *more)


class VetoExpectedTime(Veto, ExpectedTime):
    """The helper that saves the most expected ticks, with a veto; goals that need a hazard are not reckoned with."""

    def __init__(self, goals: GoalsIn, *more: Any) -> None:
        super().__init__(_WithoutHazards(goals), *more)
