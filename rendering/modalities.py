"""Modalities of a picture: colour, depth, ids, normals, flow, boxes, poses (thesis 2.4, 4.4); `render` makes them."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.annotations import boxes, camera_of, poses
from hearth.rendering.arrays import Image
from hearth.rendering.cameras.camera import Camera
from hearth.rendering.rays import pixel_maps, shading
from hearth.rendering.rays.camera_shot import Shot, draft, everywhere, shoot
from hearth.rendering.rays.fine_pictures import fine
from hearth.rendering.rays.optical_flow import flow_of
from hearth.rendering.rays.threads import each
from hearth.rendering.scene.scene import Scene
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

QUALITIES = ("draft", "fine")


def render(
    scene: Scene,
    camera: Camera,
    modalities: Iterable[str] = ("rgb",),
    *,
    quality: str = "draft",
    class_ids: Mapping[str, int] | None = None,
    after: Scene | None = None,
) -> dict[str, Any]:
    """Render a scene in several modalities (thesis 2.4, 4.4).

    Args:
        scene: the scene.
        camera: pose and size of the picture.
        modalities: names of `MODALITIES`.
        quality: `draft` (one ray a pixel, hard shadows) or `fine` (smooth edges, soft shadows, ambient occlusion).
        class_ids: class -> number, for `class_ids`; by default the scene's classes, sorted, from 1.
        after: the next scene, for `flow`; by default nothing moves.

    Returns:
        For each modality an array of (height, width) or (height, width, n): `rgb` uint8; `depth` uint16 millimetres
        along the camera's axis; `instance_ids` uint16 node ids (int32 if one is larger); `class_ids` uint16; `normals`
        float32 unit vectors of the world; `flow` float32 pixels right and down, NaN for points that the next picture
        does not show. The background is 0. `camera`, `boxes` (2D and 3D, of every object) and `poses` (2D and 3D
        joints of every character; None where a 2D joint is behind the camera) are plain values, see `annotations`.

    Raises:
        HearthError: an unknown modality or quality, or open3d is missing.

    Examples:
        >>> from hearth.rendering.cameras.camera import top_view
        >>> kitchen = next(node for node in graph.nodes if node.class_name == "kitchen")
        >>> scene, camera = hearth.scene_of(graph, known), top_view(kitchen.box, width=32, height=24)
        >>> found = hearth.render(scene, camera, ["rgb", "depth"])
        >>> found["rgb"].shape, found["depth"].dtype.name
        ((24, 32, 3), 'uint16')
    """
    wanted = check_modalities(list(modalities), quality)
    return pictures_of(shoot(scene, camera, class_ids, after, by_rays=quality == "fine"), wanted, quality)


def check_modalities(wanted: list[str], quality: str) -> list[str]:
    """Return the same names.

    Raises:
        HearthError: an unknown modality or quality.
    """
    unknown = [name for name in wanted if name not in MODALITIES] + [q for q in (quality,) if q not in QUALITIES]
    if unknown:
        known = ", ".join((*MODALITIES, *QUALITIES))
        raise HearthError.of(Code.NOT_RENDERED, f"unknown modality or quality: {', '.join(unknown)}", suggestion=known)
    return wanted


def pictures_of(shot: Shot, modalities: Iterable[str], quality: str = "draft") -> dict[str, Any]:
    """Return the pictures of a shot by modality, as `render` gives them."""
    return {name: MODALITIES[name](shot, quality) for name in modalities}


def _rgb(shot: Shot, quality: str) -> Image:
    return shot.image(fine(shot) if quality == "fine" else draft(shot))


def _depth(shot: Shot, quality: str) -> Image:
    out = np.empty(len(shot.rays), np.uint16)
    pixel_maps.depths(shot.hits.distance, shot.hits.triangle, shot.skipped, out)
    return shot.image(out)


def _per_thing(shot: Shot, values: Sequence[int]) -> Image:
    """(H, W) the value of the thing that each pixel shows, 0 for the background."""
    dtype = np.uint16 if max(values, default=0) < 1 << 16 else np.int32
    out = np.empty(len(shot.rays), dtype)
    pixel_maps.labels(shot.hits.triangle, shot.geometry.owners, np.array([*values, 0], dtype), out)
    return shot.image(out)


def _instances(shot: Shot, quality: str) -> Image:
    return _per_thing(shot, [thing.id for thing in shot.geometry.things])


def _classes(shot: Shot, quality: str) -> Image:
    known = shot.class_ids or {
        name: number for number, name in enumerate(sorted({thing.class_name for thing in shot.scene.everything}), 1)
    }
    return _per_thing(shot, [known.get(thing.class_name, 0) for thing in shot.geometry.things])


def _normals(shot: Shot, quality: str) -> Image:
    out = np.empty((len(shot.rays), 3), np.float32)

    _, triangle, u, v = shot.hits
    rows = (shot.geometry.static.rows, shot.geometry.moving.rows)

    def work(chunk: NDArray[np.int32]) -> None:
        part = int(chunk[0]), int(chunk[-1]) + 1
        pixel_maps.facings(shot.rays, triangle, u, v, *rows, *part, out)

    each(work, shading.chunks(everywhere(len(shot.rays))))
    return shot.image(out)


def _flow(shot: Shot, quality: str) -> Image:
    return flow_of(shot.after or shot.scene, shot)


MODALITIES: dict[str, Callable[[Shot, str], Any]] = {
    "rgb": _rgb,
    "depth": _depth,
    "instance_ids": _instances,
    "class_ids": _classes,
    "normals": _normals,
    "flow": _flow,
    "camera": lambda shot, quality: camera_of(shot.camera),
    "boxes": lambda shot, quality: boxes(shot),
    "poses": lambda shot, quality: poses(shot),
}
"""Every modality by name. To add one: a function of a shot, and a row here."""

PICTURES = ("rgb", "depth", "instance_ids", "class_ids", "normals", "flow")
"""Modalities whose values are pictures; the others are plain values."""
