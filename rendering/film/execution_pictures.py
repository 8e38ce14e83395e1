"""Pictures of a recorded execution: after each tick, by fixed cameras or by the one that sees the step best."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hearth.kb.knowledge import Knowledge
from hearth.rendering.cameras.camera import Camera, top_view
from hearth.rendering.cameras.recognition import PERSON, recognition
from hearth.rendering.cameras.viewpoints import best_view, home_box, room_views
from hearth.rendering.film.execution_keyframes import (  # noqa: F401 - the module of 0.2 had both
    BESIDE,
    STOOPED,
    TRIED,
    Keyframe,
    Trajectory,
    acting,
    advanced,
    check_geometry,
    keyframes,
    named_nodes,
    people_seed,
    scene_at,
    standing,
    trajectory_of,
)
from hearth.rendering.modalities import check_modalities, pictures_of
from hearth.rendering.rays.camera_shot import Shot, shoot
from hearth.rendering.rays.incremental_pictures import IncrementalFrame, incremental_frame
from hearth.schemas.graph import EnvironmentGraph, to_release
from hearth.schemas.program import Step
from hearth.schemas.vocabulary import ROOM_CATEGORY
from hearth.simulation.engine import Execution

AUTO = "auto"
TOP = "top"


@dataclass(frozen=True, eq=False)
class Snapshot:
    """Pictures of one keyframe by one camera.

    Attributes:
        tick, steps: the keyframe's.
        camera: the camera.
        pictures: modality -> array, as `modalities.render` gives them.
        seen: visible share of the objects that the steps name; None where they name none.
        person: whether the acting character can be recognised: it is large enough, and less than half hidden.
    """

    tick: int
    steps: tuple[Step, ...]
    camera: Camera
    pictures: Mapping[str, Any]
    seen: float | None = None
    person: bool = False


def snapshots(
    execution: Execution,
    home: EnvironmentGraph,
    knowledge: Knowledge,
    cameras: Sequence[Camera | str] = (TOP, AUTO),
    modalities: Iterable[str] = ("rgb", "instance_ids"),
    *,
    size: tuple[int, int] = (320, 240),
    quality: str = "draft",
    seed: int = 0,
    hour: float = 10.0,
) -> Iterator[Snapshot]:
    """Pictures of every keyframe of an execution by every camera.

    Args:
        execution, home, knowledge, seed, hour: as in `keyframes`.
        cameras: fixed cameras; `top` is a bird's-eye view of the home, `auto` the camera of the character's room that
            best shows the step's objects.
        modalities, quality: as in `modalities.render`; `flow` is towards the next tick, by the same camera; `class_ids`
            are those of the table `vocabulary`; `graph` is the scene graph.
        size: width and height for `top` and `auto`.

    Raises:
        HearthError: the home has no geometry, open3d is missing, or a modality is unknown.
    """
    check_geometry(home)
    wanted = tuple(dict.fromkeys(modalities))
    drawn = check_modalities([name for name in wanted if name != "graph"], quality)
    views = room_views(home, *size)
    rooms = {node.id: node.box for node in home.nodes if node.category == ROOM_CATEGORY}
    above = top_view(home_box(home), TOP, *size)
    last_frames: dict[Camera | str, IncrementalFrame] = {}
    found = trajectory_of(execution, home, knowledge, seed=seed, hour=hour).keyframes
    for keyframe, later in zip(found, (*found[1:], found[-1]), strict=True):
        named = named_nodes(keyframe.steps, rooms)
        for choice in cameras:
            camera = choice if isinstance(choice, Camera) else above
            if choice == AUTO:
                actor = keyframe.acting
                camera = best_view(keyframe.scene, views, actor, named, rooms.get(actor.room))
            if quality == "draft":
                last_frames[choice] = incremental_frame(keyframe.scene, camera, last_frames.get(choice))
                shot, known = last_frames[choice].shot, {"rgb": last_frames[choice].picture}
            else:
                shot, known = shoot(keyframe.scene, camera, by_rays=True), {}
            shot = replace(shot, after=later.scene, class_ids=knowledge.class_ids)
            pictures = known | pictures_of(shot, [name for name in drawn if name not in known], quality)
            if "graph" in wanted:
                pictures["graph"] = to_release(keyframe.places.graph)
            row = {name: pictures[name] for name in wanted}
            person = recognition(shot, keyframe.acting.node.id).suffices(PERSON) if keyframe.actors else False
            yield Snapshot(keyframe.tick, keyframe.steps, camera, row, _seen(shot, named), person)


def _seen(shot: Shot, named: tuple[int, ...]) -> float | None:
    """Share of the nodes with a pixel; None of no nodes."""
    if not named:
        return None
    numbers = np.flatnonzero(np.bincount(shot.owner + 1, minlength=1)[1:])
    ids = {shot.geometry.things[number].id for number in numbers.tolist()}
    found = [node_id in ids for node_id in dict.fromkeys(named)]
    return sum(found) / len(found)
