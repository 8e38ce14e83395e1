"""Room for arms and bodies among solid things: arms are drawn in, and people stand where they need not enter any."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace
from math import ceil

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.body_pose import drawn_in
from hearth.rendering.people.gait import SAMPLED
from hearth.rendering.people.motion_along_routes import Place, eased
from hearth.rendering.people.rotations import yawed
from hearth.rendering.scene.solids import Solids

SIDES = "rl"
ARM = ("elbow", "wrist", "hand")
TRUNK = ("pelvis", "spine", "chest", "neck", "head", "hip_r", "hip_l", "knee_r", "knee_l")

ROOM = 0.04
"""Metres that are kept between an arm's joints and solid things."""

AHEAD = 0.7
"""Seconds for which arms are drawn in earlier, and let out later, than they need be."""

SWINGS = (0.0, 1.0, -1.0)
"""Strides at which swinging arms are looked at."""

ELBOWS = (25.0, 50.0, -20.0)
"""Degrees by which elbows are turned to find room."""

NEAR = 1.3
"""Metres about a person within which things are looked at."""


def in_world(actor: Actor, points: Iterable[Floats]) -> Floats:
    """(n, 3) points of an actor's frame in the world."""
    found: Floats = np.array(list(points)) @ yawed(actor.yaw).T + np.array(actor.position)
    return found


def at_rest(actor: Actor, solids: Solids, acting: Sequence[str] = ()) -> Actor:
    """Return the actor with arms drawn in, or elbows turned, where they would be in something solid.

    Args:
        actor: in a pose.
        solids: around it.
        acting: `r` and `l` for hands that must be where they are.
    """
    if actor.body_pose.posture == "lying":
        return actor
    near = solids.near(actor.spot, NEAR, (actor.place,))
    inside = _arms_inside(actor, near)
    if not any(inside):
        return actor
    free = [inside[k] and side not in acting for k, side in enumerate(SIDES)]
    if any(free) and actor.body_pose.posture == "standing":
        actor = replace(actor, body_pose=drawn_in(actor.body_pose, (float(free[0]), float(free[1]))))
    for side in acting:
        actor = _elbow_turned(actor, side, near) if inside[side == "l"] else actor
    return actor


def _arms_inside(actor: Actor, solids: Solids) -> list[bool]:
    joints = actor.figure().joints()
    points = in_world(actor, [joints[f"{name}_{side}"] for side in SIDES for name in ARM])
    inside = solids.contain(points, ROOM)
    return [bool(part.any()) for part in (inside[: len(ARM)], inside[len(ARM) :])]


def _elbow_turned(actor: Actor, side: str, solids: Solids) -> Actor:
    """Return the actor with the least turn of an elbow that keeps it out of solid things; unchanged if none does."""
    hand = actor.body_pose.hand(side)
    for swivel in (0.0, *ELBOWS):
        turned = hand._replace(swivel=hand.swivel + swivel)
        pose = actor.body_pose
        pose = replace(pose, right_hand=turned) if side == "r" else replace(pose, left_hand=turned)
        other = replace(actor, body_pose=pose)
        elbow = in_world(other, [other.figure().joints()[f"elbow_{side}"]])
        if not solids.contain(elbow).any():
            return other
    return actor


def arms_on_the_way(actor: Actor, places: Sequence[Place], solids: Solids) -> NDArray[np.float64]:
    """(n, 2) how far the right and the left arm are drawn in at places that a walk passes every `SAMPLED` seconds."""
    spots = np.array([(place.x, place.z) for place in places])
    middle = (spots.min(axis=0) + spots.max(axis=0)) / 2
    near = solids.near((float(middle[0]), float(middle[1])), float(np.ptp(spots, axis=0).max()) / 2 + 0.6)
    own = np.concatenate([_hanging(actor, swing) for swing in SWINGS])
    turns = np.stack([yawed(place.yaw) for place in places])
    at = np.einsum("pij,kj->pki", turns, own)
    at += np.column_stack((spots[:, 0], np.full(len(spots), actor.level), spots[:, 1]))[:, None]
    inside = near.contain(at.reshape(-1, 3), ROOM).reshape(len(places), len(SWINGS), 2, len(ARM))
    return _soft(np.asarray(inside.any(axis=(1, 3))))


def _hanging(actor: Actor, swing: float) -> Floats:
    """(6, 3) joints of the arms at a stride, in the actor's frame."""
    pose = replace(actor.body_pose, stride=swing, feet=None, effort=0.0, tucked=(0.0, 0.0))
    joints = replace(actor, body_pose=pose).figure().joints()
    return np.array([joints[f"{name}_{side}"] for side in SIDES for name in ARM])


def _soft(inside: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Booleans (n, 2) by moment, each extended by `AHEAD` seconds, with soft starts and ends and no brief gaps."""
    wide = ceil(AHEAD / SAMPLED)
    window = np.array([eased((k + 1) / (wide + 1)) for k in range(wide)])
    window = np.concatenate((window, [1.0], window[::-1]))
    padded = np.pad(inside.astype(float), ((wide, wide), (0, 0)))
    moments = np.stack([padded[k : k + len(inside)] * window[k] for k in range(2 * wide + 1)])
    found: NDArray[np.float64] = moments.max(axis=0)
    # Arms that would soon be drawn in again stay so: they would swing out and back at once.
    for reach in (np.max, np.min):
        around = np.pad(found, ((wide, wide), (0, 0)), mode="edge")
        found = reach(sliding_window_view(around, 2 * wide + 1, axis=0), axis=2)
    return found


def faults(actor: Actor, solids: Solids, reached: Collection[int] = ()) -> int:
    """Return the number of an actor's joints that are inside solid things.

    Joints of the trunk count twice, and so do hands out of reach of their targets.

    Args:
        actor: in a pose.
        solids: around it.
        reached: things that hands may be in.
    """
    near, joints = solids.near(actor.spot, NEAR, (actor.place,)), actor.figure().joints()
    trunk = near.contain(in_world(actor, [joints[name] for name in TRUNK]), 0.02)
    elbows = near.contain(in_world(actor, [joints[f"elbow_{side}"] for side in SIDES]), 0.02)
    hands = [joints[f"{name}_{side}"] for side in SIDES for name in ("wrist", "hand")]
    inside = near.near(actor.spot, NEAR, reached).contain(in_world(actor, hands))
    short = [side for side in SIDES if _missed(actor, side) > 0.05]
    return 2 * int(trunk.sum()) + int(elbows.sum()) + int(inside.sum()) + 2 * len(short)


def _missed(actor: Actor, side: str) -> float:
    """Metres from a palm to its target."""
    target = actor.body_pose.target(side)
    return 0.0 if target is None else float(np.linalg.norm(actor.figure().joints()[f"palm_{side}"] - target))
