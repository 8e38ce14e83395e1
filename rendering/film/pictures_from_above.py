"""Demonstrations from above: a picture of the whole home after each tick of an execution, with class masks.

The thesis predicts sketches from such pictures (5.4.3). Homes look the same in all of them, at ten in the morning; only
the person and the act differ. Each home's objects are drawn once, which halves the time.
"""

from collections.abc import Mapping
from dataclasses import replace
from io import BytesIO
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.kb.knowledge import Knowledge
from hearth.rendering.cameras.camera import Camera, top_view
from hearth.rendering.cameras.viewpoints import home_box
from hearth.rendering.film.execution_keyframes import trajectory_of
from hearth.rendering.film.execution_pictures import TOP
from hearth.rendering.modalities import pictures_of
from hearth.rendering.rays.incremental_pictures import IncrementalFrame, incremental_frame
from hearth.schemas.graph import EnvironmentGraph
from hearth.simulation.engine import Execution

SIZE = (320, 240)
"""Width and height, pixels, as in the thesis (table A.1)."""

FILE = "above.npz"
"""Name of a demonstration's arrays in its folder."""

MASKS, CHANGES = "class_ids", "rgb_changes"
"""Names of its arrays."""


class Demonstration(NamedTuple):
    """Pictures from above of an execution of T ticks.

    Attributes:
        rgb: (T + 1, H, W, 3) uint8, at the start and after each tick.
        class_ids: (T + 1, H, W) uint16, the number of the class that a pixel shows; 0 for the background.
        camera: of all pictures.
    """

    rgb: NDArray[np.uint8]
    class_ids: NDArray[np.uint16]
    camera: Camera


def demonstration(
    execution: Execution, home: EnvironmentGraph, knowledge: Knowledge, class_ids: Mapping[str, int], seed: int = 0
) -> Demonstration:
    """Picture an execution from above.

    Args:
        execution: a recorded run.
        home: its home as it was built, with boxes.
        knowledge: of its classes.
        class_ids: class -> number in the masks; others are 0.
        seed: decides bodies, colours and designs.

    Raises:
        HearthError: NOT_RENDERED, the home has no geometry.
    """
    moving = trajectory_of(execution, home, knowledge, seed=seed)
    camera = top_view(home_box(home), TOP, *SIZE)
    last: IncrementalFrame | None = None
    rgb, masks = [], []
    for keyframe in moving.keyframes:
        last = incremental_frame(keyframe.scene, camera, last)
        rgb.append(last.picture.copy())
        masks.append(pictures_of(replace(last.shot, class_ids=class_ids), [MASKS])[MASKS])
    return Demonstration(np.stack(rgb), np.stack(masks).astype(np.uint16), camera)


def stored(found: Demonstration) -> bytes:
    """Return the pictures as the bytes of an .npz file, which NumPy reads; equal pictures are equal bytes.

    Colours are stored as changes from picture to picture, modulo 256: an eighth of the size.
    """
    changes = found.rgb.copy()
    changes[1:] -= found.rgb[:-1]
    buffer = BytesIO()
    arrays: dict[str, Any] = {MASKS: found.class_ids, CHANGES: changes}
    np.savez_compressed(buffer, allow_pickle=False, **arrays)
    return buffer.getvalue()
