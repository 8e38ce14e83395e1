"""The demonstrator of a task: a human-like agent that sometimes does something else.

A clean demonstration gives the goal away: counting placements infers every goal. People open the wrong cupboard, put
away something in passing, and change their minds.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import reduce
from operator import or_

from hearth.agents.distractions import Errand
from hearth.agents.human_like import HumanLike
from hearth.challenges.challenge_definition import Challenge
from hearth.challenges.goal_grammar import instance, wanted_things
from hearth.challenges.tasks import Task
from hearth.schemas.goals import Goal
from hearth.schemas.literals import Literal
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.rng import derive, rng
from hearth.simulation.actions.legal import Legal
from hearth.simulation.goals import Progress
from hearth.simulation.observation.views import View
from hearth.simulation.world.bits import indices
from hearth.simulation.world.states import CLOSED, OPEN

ERRAND = 40
"""Ticks after which something else is given up."""

FIRST = 5
"""Ticks before which nothing else is begun."""


class Demonstrator:
    """The human-like agent with habits that have nothing to do with its goal.

    Attributes:
        began: the habits that it acted on, each with its tick and the habit's name.
    """

    def __init__(self, which: Challenge, task: Task, habits: Mapping[str, float]) -> None:
        self.which, self.task, self.habits = which, task, habits
        self.main = HumanLike()

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin (see `agents.protocol`)."""
        self.main.reset(observation, goal, seed)
        self.chooser = rng(seed, "habits")
        self.seed = seed
        self.began: list[tuple[int, str]] = []
        self.errand: Errand | None = None
        once = ("distractor", "change_of_mind")
        self.waiting = [name for name in once if self.chooser.random() < self.habits[name]]

    def act(self, observation: View, legal: Legal) -> Step | None:
        """Return its current instruction: for its goal, or for something else."""
        free = not observation.world.agents[observation.agent].held
        if self.errand is None and free and observation.tick >= FIRST:
            if (failing := self._failing(observation)) is not None:
                return failing
            self._begin(observation)
        if self.errand is not None:
            step = self.errand.act(observation, legal)
            if step is not None:
                return step
            self.errand = None
        return self.main.act(observation, legal)

    def _failing(self, view: View) -> Step | None:
        """Something that can't be done, now and then."""
        if self.chooser.random() >= self.habits["failed_try"]:
            return None
        world, home = view.world, view.world.home
        near = world.agents[view.agent].close
        far = home.properties["GRABBABLE"] & view.mask & ~near
        tries = [("OPEN", near & world.states[OPEN] & home.able("Open")), ("HOLDS_RH", far)]
        name, mask = self.chooser.choice(tries)
        some = list(indices(mask))
        if not some:
            return None
        i = self.chooser.choice(some)
        self.began.append((view.tick, "failed_try"))
        action = "Open" if name == "OPEN" else "Grab"
        return Step(action, (ObjectRef(home.classes[i], 0, home.ids[i]),), view.agent)

    def _begin(self, view: View) -> None:
        """Begin something else, if it is time and there is something."""
        names = [*self.waiting, *(["detour"] if self.chooser.random() < self.habits["detour"] else [])]
        for name in names:
            choices = list(self._errands(name, view))
            if not choices:
                continue
            wanted = self.chooser.choice(choices)
            habits = replace(self.main.habits, closes=self.chooser.random() < 0.5)
            self.errand = Errand(wanted, view, ERRAND, derive(self.seed, "errand", view.tick), habits)
            self.began.append((view.tick, name))
            self.waiting = [each for each in self.waiting if each != name]
            return

    def _errands(self, name: str, view: View) -> Iterator[Literal[str | int]]:
        if name == "distractor":
            return self._distractors(view)
        return self._changes(view) if name == "change_of_mind" else self._detours(view)

    def _distractors(self, view: View) -> Iterator[Literal[str | int]]:
        """Seen things that the goal does not want, to where goals of other sets want such things."""
        wanted = wanted_things(self.task.goal)
        others = [one for name, one in self.which.grammar.sets.items() if name not in self.task.sets]
        for predicate in dict.fromkeys(each for one in others for each in one.predicates if each not in one.always):
            target = instance(str(predicate.target), view.world.home)
            if str(predicate.subject) not in wanted:
                there = _met(Progress.at(Goal.of(Literal.of(predicate.name, predicate.subject, target)), view.world))
                for i in indices(view.world.home.instances(str(predicate.subject)) & view.mask & ~there):
                    yield Literal.of(predicate.name, view.world.home.ids[i], target)

    def _changes(self, view: View) -> Iterator[Literal[str | int]]:
        """Things that are where they are wanted, to furniture in the room where nothing is wanted."""
        home = view.world.home
        targets = {instance(name, home) for name in self.which.grammar.furniture}
        surfaces = home.properties["SURFACES"] & home.furniture & view.mask & ~home.properties["SITTABLE"]
        places = [home.ids[i] for i in indices(surfaces) if home.ids[i] not in targets]
        there = _met(Progress.at(self.main.goal, view.world))
        for i in indices(there & view.mask & home.properties["GRABBABLE"]):
            yield from (Literal.of("ON", home.ids[i], place) for place in places)

    def _detours(self, view: View) -> Iterator[Literal[str | int]]:
        """Seen furniture that is closed, to be opened."""
        home = view.world.home
        closed = view.world.states[CLOSED] & home.able("Open") & home.furniture & view.mask & ~home.doors
        return (Literal.of("OPEN", home.ids[i]) for i in indices(closed))


def _met(progress: Progress) -> int:
    """Return all nodes that count for a goal."""
    return reduce(or_, (mask for watch in progress.watches for mask in watch.met), 0)
