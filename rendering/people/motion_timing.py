"""Pacing: motions that take so long that heads, hands and held things are as slow as people's all along the way.

The straight way between two poses is a poor measure: a stooping person moves the hands further, and a long object that
turns in the hand moves its far end.
"""

import numpy as np

from hearth.rendering.arrays import Floats
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.held_objects import Hold, hold_of_node
from hearth.rendering.people.pose_blends import Segment
from hearth.rendering.scene.instances import tilted
from hearth.rendering.scene.object_boxes import Places

FASTEST, THINGS = 2.6, 1.5
"""Metres per second at most of heads and hands, and of held things, which may be on a way of their own besides."""

LOOKED = 16
"""Moments of a motion at which it is looked where everything is."""

BODY = 3
"""Points of the body that are looked at: the head and the hands."""

Holds = dict[str, Hold]
"""The grips of the `r` and `l` hands."""


def holds_of(actor: Actor, places: Places) -> Holds:
    """Return how an actor holds what it holds."""
    nodes = {node.id: node for node in places.graph.nodes}
    held = places.holds.get(actor.node.id, {})
    return {side[0]: hold_of_node(nodes[node], places, side) for node, side in held.items()}


def paced(segment: Segment, holds: Holds) -> Segment:
    """Return the same motion, slower if anything would be too fast."""
    points = np.stack([_points(segment.at(number / LOOKED), holds) for number in range(LOOKED + 1)])
    steps = np.diff(points, axis=0)
    most = np.array([FASTEST] * BODY + [THINGS] * (points.shape[1] - BODY))
    longest = float((np.linalg.norm(steps, axis=2) / most).max()) * LOOKED
    return segment._replace(seconds=max(segment.seconds, longest))


def _points(actor: Actor, holds: Holds) -> Floats:
    """(3 + held things, 3) the head, the hands, and the feet of held things in the world."""
    joints = actor.figure().joints()
    found = [joints["head"], joints["hand_r"], joints["hand_l"]]
    for side, hold in sorted(holds.items()):
        held = actor.body_pose.hand(side).held
        turn = tilted((held.pitch, held.roll, hold.turn + held.turn))
        found.append(joints[f"palm_{side}"] + np.array(held.gap) - turn @ np.array(hold.point))
    return np.array([actor.world((float(x), float(y), float(z))) for x, y, z in found])
