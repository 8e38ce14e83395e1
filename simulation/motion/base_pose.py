"""Hand and base pose of each step: the place to stand, the way to face, the hand (thesis 2.4.1)."""

from collections.abc import Iterator
from dataclasses import dataclass

from hearth.kb.modifiers import value
from hearth.schemas.failures import Failure
from hearth.schemas.program import Step
from hearth.simulation.engine import Execution, act
from hearth.simulation.motion.positions import facing, placed
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.pose import Pose
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


def hand_and_base_poses(execution: Execution, rules: Rules = DEFAULT) -> tuple[tuple[HandAndBasePose, ...], ...]:
    """For each tick done, the hand and the base pose of each acting character, once it has arrived and turned.

    Args:
        execution: of any program; in a home without geometry nobody has a pose.
        rules: of the run.
    """
    here = placed(execution.worlds[0])
    if any(agent.pose is None for agent in here.agents):
        return ()
    found = []
    for steps, after in zip(execution.program.ticks(), execution.worlds[1:], strict=False):
        tick = tuple(_each(here, steps, rules))
        found.append(tick)
        poses = {each.agent: each.pose for each in tick}
        agents = (
            now._replace(pose=poses.get(number, agent.pose))
            for number, (now, agent) in enumerate(zip(after.agents, here.agents, strict=True))
        )
        here = World(after.home, after.states, tuple(agents), after.moved)
    return tuple(found)


def _each(here: World, steps: tuple[Step, ...], rules: Rules) -> Iterator[HandAndBasePose]:
    for step in steps:
        there = act(here, step, rules)
        if isinstance(there, Failure):
            there = here
        hand = hand_of(step, here, there)
        pose = there.agents[step.agent].pose
        assert pose is not None
        target = here.home.index.get(step.objects[-1].node or -1, -1) if step.objects else -1
        if hand is not None and target >= 0:
            pose = facing(here, pose, target)
        yield HandAndBasePose(step.agent, pose, hand)


def hand_of(step: Step, before: World, after: World) -> str | None:
    """Return the hand of a step: the one that takes or gives, else a free one, else the right."""
    old, new = before.agents[step.agent], after.agents[step.agent]
    if asked := value(step, "hand"):
        return asked
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
