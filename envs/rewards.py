"""The reward of a learner in a tick.

Source: thesis 6.5.1 (1 for the goal, -0.004 a tick); B.3.3 (2 for a predicate, -0.1 a tick: a policy over subgoals).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.simulation.goals import Progress, Watch
from hearth.simulation.motion import positions
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.world.bits import indices
from hearth.simulation.world.world import World

IN_HAND = 10.0
"""Metres by which a thing in a hand is nearer to its place than one that is still to be fetched."""


Moment = tuple[Progress, World]
"""The progress of the goal and the world, before or after a tick."""

Reward = Callable[[Moment, Moment, int], float]
"""Gives the reward of an agent for a tick, from the moments before and after it: `Rewards`, or any function."""


@dataclass(frozen=True, slots=True)
class Rewards:
    """The parts of a reward; all agents get the same, but for `approach`.

    Attributes:
        success: when the goal is reached.
        tick: for every tick.
        predicate: for every count of a literal that comes to hold, up to the wanted count; taken back where it ends.
        approach: for every meter nearer to a missing literal (see `metres_left`), and taken back for every meter away
            from it, so that going in circles is worth nothing.
    """

    success: float = 1.0
    tick: float = -0.004
    predicate: float = 0.0
    approach: float = 0.0

    def __call__(self, before: Moment, after: Moment, number: int) -> float:
        """Return the reward of an agent for a tick; the same as `of`."""
        return self.of(before, after, number)

    def of(self, before: Moment, after: Moment, number: int) -> float:
        """Return the reward of an agent for a tick, from the states before and after it."""
        (old, was), (new, now) = before, after
        found = self.tick + (self.success if new.satisfied and not old.satisfied else 0.0)
        if self.predicate:
            found += self.predicate * (counted(new) - counted(old))
        if self.approach:
            found += self.approach * (metres_left(old, was, number) - metres_left(new, now, number))
        return found


USUAL_REWARDS = Rewards()
"""1 for the goal, and -0.004 a tick (thesis 6.5.1)."""

HIERARCHICAL = Rewards(success=0.0, tick=-0.1, predicate=2.0)
"""Rewards of a policy over subgoals (B.3.3)."""


def checked_reward(given: object) -> Reward:
    """Return a reward that can be called.

    Raises:
        HearthError: BAD_ARGUMENT: it is neither `Rewards` nor a function.
    """
    if callable(given):
        return given
    message = f"a reward is {type(given).__name__}, which can't be called"
    remedy = "Rewards(...), or a function(before, after, agent) of (progress, world) before and after a tick"
    raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=remedy)


def counted(progress: Progress) -> int:
    """Return how many of the required counts hold."""
    pairs = zip(progress.counts, progress.goal, strict=True)
    return sum(min(found, wanted) for found, (_, wanted) in pairs)


def metres_left(progress: Progress, world: World, number: int) -> float:
    """Return about how far an agent is from the missing literals of a goal, in meters.

    Each missing literal counts the way to the nearest thing that would make it hold. A thing that is to be brought to a
    place and is not in the agent's hands counts `IN_HAND` more. The least value of each literal is summed. The sum is 0
    if nothing is missing or no way is known.
    """
    return sum(_missing(watch, world, number) for watch in progress.watches if watch.count < watch.wanted)


def _missing(watch: Watch, world: World, number: int) -> float:
    literal, _, candidates, met = watch.literal, watch.wanted, watch.candidates, watch.met
    done = met[0] if len(met) == 1 else 0
    if candidates.by_target:
        return _nearest(candidates.targets & ~done, world, number)
    rest = candidates.subjects & ~done
    if len(literal.terms) == 1:
        return _nearest(rest, world, number)
    agent = world.agents[number]
    if agent.held & rest:
        return _nearest(candidates.targets, world, number)
    return IN_HAND + _nearest(rest, world, number)


def _nearest(nodes: int, world: World, number: int) -> float:
    """Metres of the shortest way to one of some nodes; 0 where there is none."""
    here, pose = ground_of(world.home), world.agents[number].pose
    if here is None or pose is None:
        return 0.0
    ends = sorted({cell for i in indices(nodes) for cell in positions.ends(world, here, i)})
    if not ends:
        return 0.0
    ways = here.ground.ways
    metres, first = ways.left(ways.field(tuple(ends)), pose.x, pose.z)
    return metres if first >= 0 else 0.0
