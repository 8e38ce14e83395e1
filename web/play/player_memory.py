"""A person's observations of a game so far: trails of characters, and counts of the goal as last observed."""

from dataclasses import dataclass

from hearth.envs.json_observations import SeenLiteral, seen_goal, seen_instances
from hearth.schemas.goals import Goal
from hearth.schemas.literals import AGENT
from hearth.simulation.env import Tick
from hearth.simulation.observation.views import View
from hearth.simulation.world.pose import Pose


@dataclass(frozen=True, slots=True)
class Counted:
    """A literal of the goal with how often the person last saw it hold."""

    seen: SeenLiteral
    count: int


class Remembered:
    """The observations of one person.

    Attributes:
        trails: for each character, the ticks at which it was seen and where it stood.
        counts: of the goal's literals, as the person last saw them.
        last: the tick that was done last, if any.
    """

    def __init__(self, view: View, goal: Goal | None) -> None:
        self.goal = goal
        self.trails: dict[int, list[tuple[int, Pose]]] = {}
        self.counts: tuple[Counted, ...] = ()
        self.last: Tick | None = None
        self._look(view)

    def add(self, view: View, done: Tick) -> None:
        """Look again after a tick."""
        self.last = done
        self._look(view)

    def _look(self, view: View) -> None:
        for pose in (view.me, *view.others):
            if pose.place is not None:
                self.trails.setdefault(pose.agent, []).append((view.tick, pose.place))
        before = {each.seen.literal: each for each in self.counts}
        found = list(seen_goal(Goal(self.goal.counts), view)) if self.goal is not None else []
        self.counts = tuple(
            Counted(each, each.seen or 0) if _sees_place(each, view) else before.get(each.literal, Counted(each, 0))
            for each in found
        )


def _sees_place(each: SeenLiteral, view: View) -> bool:
    """Return whether the place of a literal's things is in sight, so that things not counted do not hold."""
    terms = each.literal.terms
    place = terms[-1] if terms else None
    about_somebody = any(isinstance(term, str) and term.partition(":")[0] == AGENT for term in terms)
    if about_somebody or place is None:
        return True
    return view.sees(place) if isinstance(place, int) else bool(seen_instances(place, view.world.home, view.mask))
