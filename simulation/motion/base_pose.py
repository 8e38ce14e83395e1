"""Hand and base pose of each step: the place to stand, the way to face, the hand (thesis 2.4.1)."""

from collections.abc import Iterator
from dataclasses import dataclass

from hearth.schemas.failures import Failure
from hearth.schemas.program import Step
from hearth.simulation.engine import Execution
from hearth.simulation.motion.moves import Located, do, located, spot
from hearth.simulation.motion.navigation import Pose, Ways
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.world import World

RIGHT, LEFT = "right", "left"


@dataclass(frozen=True, slots=True)
class HandAndBasePose:
    """The hand and the base pose of a character for a step.

    Attributes:
        agent: its number.
        pose: where it stands (metres) and which way it faces (degrees about y from +z).
        hand: `right` or `left`; None where no hand takes part.
    """

    agent: int
    pose: Pose
    hand: str | None


def hand_and_base_poses(
    execution: Execution, ways: Ways, rules: Rules = DEFAULT
) -> tuple[tuple[HandAndBasePose, ...], ...]:
    """For each tick done, the hand and the base pose of each acting character, once it has arrived and turned.

    Args:
        execution: in a home with geometry.
        ways: over the floor of that home.
        rules: of the run.

    Raises:
        KeyError: a character has no box.
    """
    here = located(execution.worlds[0])
    found = []
    for steps, after in zip(execution.program.ticks(), execution.worlds[1:], strict=False):
        tick = tuple(_each(here, steps, ways, rules))
        found.append(tick)
        poses = {each.agent: each.pose for each in tick}
        here = Located(after, tuple(poses.get(number, pose) for number, pose in enumerate(here.poses)))
    return tuple(found)


def _each(here: Located, steps: tuple[Step, ...], ways: Ways, rules: Rules) -> Iterator[HandAndBasePose]:
    for step in steps:
        there = do(here, step, ways, rules=rules)
        if isinstance(there, Failure):
            there = here
        hand = hand_of(step, here.world, there.world)
        pose = there.poses[step.agent]
        if hand is not None:
            pose = _turned(pose, here, step)
        yield HandAndBasePose(step.agent, pose, hand)


def _turned(pose: Pose, here: Located, step: Step) -> Pose:
    """Facing what the hand goes to: the last of the step's objects."""
    index = here.world.home.index.get(step.objects[-1].node or -1, -1) if step.objects else -1
    box = spot(here, index) if index >= 0 else None
    return pose if box is None else pose.towards((box.center[0], box.center[2]))


def hand_of(step: Step, before: World, after: World) -> str | None:
    """The hand of a step: the one that takes or gives, else a free one, else the right."""
    old, new = before.agents[step.agent], after.agents[step.agent]
    if old.right != new.right:
        return RIGHT
    if old.left != new.left:
        return LEFT
    index = before.home.index
    held = [1 << index[ref.node] for ref in step.objects if ref.node in index]
    for side, hand in ((RIGHT, old.right), (LEFT, old.left)):
        if any(bit & hand for bit in held):
            return side
    if step.action not in before.home.knowledge.group("hand"):
        return None
    return LEFT if old.right and not old.left else RIGHT
