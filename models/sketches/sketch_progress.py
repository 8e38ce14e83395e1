"""The progress of a program through its sketch: the next step of the sketch, and the plan for it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from hearth.models.sketches.text_features import NO_CLUES, Clues
from hearth.repair.sketch_plan import Planned, plan
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

Steps = tuple[Step, ...]


@dataclass(frozen=True)
class Progress:
    """A program on its way.

    Attributes:
        sketch: bound to nodes.
        world: as it is now.
        next: the number of the sketch's step that comes next.
        plan: the planner's steps from here.
        steps: done so far.
        since: how many of them since the last step of the sketch.
        rules: of the engine.
        clues: the clues of the text.
    """

    sketch: Steps
    world: World
    next: int
    plan: tuple[Planned, ...]
    steps: Steps = ()
    since: int = 0
    rules: Rules = DEFAULT
    clues: Clues = NO_CLUES

    @classmethod
    def start(cls, sketch: Sequence[Step], world: World, rules: Rules = DEFAULT, clues: Clues = NO_CLUES) -> Progress:
        """Before the first step."""
        bare = tuple(plain(step, world.home) for step in sketch)
        return cls(bare, world, 0, plan(bare, world, rules), rules=rules, clues=clues)

    @property
    def coming(self) -> Step | None:
        """Return the sketch's next step; None at its end, or if nothing makes the rest possible."""
        number = self._coming
        return None if number is None else self.sketch[number]

    @property
    def _coming(self) -> int | None:
        return next((self.next + each.source for each in self.plan if each.source >= 0), None)

    def _number(self, step: Step) -> int:
        """Return the number of the sketch's step that a step is.

        The next one, or the next that the plan does; else -1.
        """
        for number in (self.next, self._coming):
            if number is not None and self.sketch[number : number + 1] == (step,):
                return number
        return -1

    @property
    def proposed(self) -> Step | None:
        """Return the planner's next step."""
        return self.plan[0].step if self.plan else None

    def after(self, step: Step, world: World) -> Progress:
        """After a step that led to a world."""
        step = plain(step, world.home)
        done = self._number(step)
        following = done + 1 if done >= 0 else self.next
        rest = self.plan[1:]
        if self.proposed == step and (self.plan[0].source < 0) == (done < 0):
            ahead = following - self.next
            kept = tuple(Planned(each.step, each.source - ahead if each.source >= 0 else -1) for each in rest)
        else:
            kept = plan(self.sketch[following:], world, self.rules)
        since = 0 if done >= 0 else self.since + 1
        return replace(self, world=world, next=following, plan=kept, steps=(*self.steps, step), since=since)


def plain(step: Step, home: Home) -> Step:
    """Return a bound step as the search writes it: a node has the name of its class, and no number."""
    nodes = [home.index[ref.node] for ref in step.objects if ref.node is not None]
    return Step(step.action, tuple(ObjectRef(home.classes[node], 1, home.ids[node]) for node in nodes))
