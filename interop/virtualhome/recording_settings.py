"""Settings of `render_script`, each within limits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from hearth.interop.virtualhome.camera_images import check_modes
from hearth.interop.virtualhome.protocol_messages import flag, number, words, wrong

MOST_WIDTH, MOST_HEIGHT = 1_920, 1_200
"""Pixels of a picture."""

MOST_RATE = 60.0
"""Frames a second."""

OTHER_SETTINGS = ("randomize_execution", "random_seed", "processing_time_limit", "save_scene_states")
"""Settings of Unity that change nothing here: programs are bound and run the same way each time."""


@dataclass(frozen=True, slots=True)
class ScriptSettings:
    """The settings that a client gives with a script.

    Attributes:
        search: whether things are found for the script; else its numbers are nodes.
        skip: whether it is only checked.
        recording: whether pictures are written.
        teleports: whether only the end of each tick is pictured.
        prefix: the name of the recording.
        rate: frames a second.
        speed: factor of all motions.
        modes: of the pictures.
        cameras: modes of cameras, or numbers of cameras.
        size: width and height.
        poses: whether joints are written.
    """

    search: bool = False
    skip: bool = False
    recording: bool = False
    teleports: bool = False
    prefix: str = "script"
    rate: float = 5.0
    speed: float = 1.0
    modes: tuple[str, ...] = ("normal",)
    cameras: tuple[str, ...] = ("AUTO",)
    size: tuple[int, int] = (640, 480)
    poses: bool = False


def read_settings(given: Mapping[str, Any]) -> ScriptSettings:
    """Return the settings that a client sent; `output_folder` is never a path, and is not read.

    Raises:
        HearthError: BAD_ARGUMENT: one is of another kind or out of its limits; NOT_RENDERED: a mode is not drawn.
    """
    modes = words(given, "image_synthesis", ("normal",))
    check_modes(modes)
    prefix = given.get("file_name_prefix", "script")
    if not isinstance(prefix, str) or not prefix.strip():
        raise wrong("file_name_prefix", "a name", prefix)
    return ScriptSettings(
        flag(given, "find_solution"),
        flag(given, "skip_execution"),
        flag(given, "recording"),
        flag(given, "skip_animation"),
        prefix,
        number(given, "frame_rate", 5, 0.1, MOST_RATE),
        number(given, "time_scale", 1.0, 0.1, 10.0),
        modes,
        words(given, "camera_mode", ("AUTO",)),
        read_size(given, 640, 480),
        flag(given, "save_pose_data"),
    )


def read_size(given: Mapping[str, Any], width: int, height: int) -> tuple[int, int]:
    """Return `image_width` and `image_height`.

    Raises:
        HearthError: BAD_ARGUMENT.
    """
    return (
        int(number(given, "image_width", width, 16, MOST_WIDTH)),
        int(number(given, "image_height", height, 16, MOST_HEIGHT)),
    )
