"""Optical flow between two pictures (thesis 2.4)."""

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats
from hearth.rendering.cameras.camera import Camera
from hearth.rendering.models.class_appearance import Model
from hearth.rendering.models.mesh import rotation
from hearth.rendering.rays.camera_shot import Shot, everywhere, shoot, shoot_after
from hearth.rendering.rays.pixel_maps import HORIZON, motion
from hearth.rendering.rays.shading import chunks
from hearth.rendering.rays.threads import each
from hearth.rendering.scene.instances import Thing, placed
from hearth.rendering.scene.scene import Scene


def flow(shot: Shot, after: Shot) -> Floats:
    """(H, W, 2) pixels by which each point moves right and down until the next picture; NaN if it is not visible there.

    Points move with their triangles, so limbs and carried things have flow; things whose mesh changes (an opening door)
    move as a whole. The sky moves with the camera only.

    Args:
        shot: a picture.
        after: the next one, by any camera of the same size.
    """
    ids, later = each(_ids, (shot, after))
    far = np.where(after.hits.triangle >= 0, after.distance, np.float32(HORIZON))
    out = np.empty((len(shot.rays), 2), np.float32)
    size = (shot.camera.width, shot.camera.height)
    shifts, first, frame = _shifts(shot, after), shot.geometry.first, _frame(after.camera)
    distance, triangle, u, v = shot.hits

    def work(chunk: NDArray[np.int32]) -> None:
        part = int(chunk[0]), int(chunk[-1]) + 1
        motion(shot.rays, distance, triangle, u, v, shifts, first, frame, *size, *part, ids, later, far, out)

    each(work, chunks(everywhere(len(out))))
    return shot.image(out)


def flow_of(scene: Scene, shot: Shot) -> Floats:
    """Flow from a shot to the shot of `scene` by the shot's next camera; unknown everywhere across a cut."""
    if shot.cut:
        return np.full((shot.camera.height, shot.camera.width, 2), np.nan, np.float32)
    camera = shot.after_camera or shot.camera
    still = camera == shot.camera
    return flow(shot, shoot_after(scene, shot) if still else shoot(scene, camera, by_rays=shot.by_rays))


def _ids(shot: Shot) -> NDArray[np.int32]:
    """(N,) node ids of the visible things, -1 for the background."""
    return np.array([*(thing.id for thing in shot.geometry.things), -1], np.int32).take(shot.owner, mode="wrap")


def _frame(camera: Camera) -> Floats:
    pose = camera.pose
    return np.array([*camera.eye, *pose[:3, 0], *pose[:3, 1], *pose[:3, 2], camera.intrinsics[0, 0]], np.float32)


def _shifts(shot: Shot, after: Shot) -> Floats:
    """(M, 3, 3) displacements of the moving triangles' corners until the later shot."""
    part = shot.geometry.moving
    shifts = np.zeros_like(part.mesh.corners)
    later: dict[tuple[int, str], Thing] = {}
    for thing in after.geometry.moving.things:
        later.setdefault(_part(thing), thing)
    there = set(after.geometry.moving.things)
    for thing, start in zip(part.things, part.starts.tolist(), strict=True):
        other = later.get(_part(thing))
        if thing not in there and other is not None:
            before = placed(thing).corners
            shifts[start : start + len(before)] = _displaced(before, thing, other)
    return np.ascontiguousarray(shifts, np.float32)


def _part(thing: Thing) -> tuple[int, str]:
    """Return the identity of a part of a node: a machine's steam is not the machine."""
    return thing.id, thing.model.recipe if isinstance(thing.model, Model) else ""


def _displaced(before: Floats, thing: Thing, other: Thing) -> Floats:
    """(T, 3, 3) displacements of a thing's corners to its later state."""
    now = placed(other).corners
    if len(before) == len(now):
        return now - before
    # The mesh changed: it moves as a whole.
    turn = rotation("y", other.yaw - thing.yaw).T
    moved: Floats = (before - np.array(thing.position, np.float32)) @ turn + np.array(other.position, np.float32)
    return moved - before
