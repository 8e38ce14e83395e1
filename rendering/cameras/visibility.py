"""Visibility of the objects that steps name: by the camera chosen for each step, and from above."""

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

import numpy as np

from hearth.rendering.cameras.camera import Camera, top_view
from hearth.rendering.cameras.recognition import shows
from hearth.rendering.cameras.viewpoints import best_view, home_box, room_views
from hearth.rendering.film.execution_keyframes import Keyframe, Trajectory, named_nodes
from hearth.rendering.film.execution_pictures import TOP
from hearth.rendering.rays.camera_shot import shoot
from hearth.rendering.scene.object_boxes import Places
from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.program import Step
from hearth.schemas.vocabulary import ROOM_CATEGORY

SIZE = (320, 240)


class TickVisibility(NamedTuple):
    """Visibility of one tick's objects.

    Attributes:
        tick, steps: the tick and its steps.
        camera: name of the chosen camera.
        named: ids of the objects that the steps name, without rooms.
        missed: those of `named` that the chosen camera's picture does not show.
        unseen: those of `missed` that the picture from above does not show either.
        in_closed: those of `unseen` in a closed container, where no camera could see them.
        shown: whether the person and the nodes that show the objects (see `seen_as`) can be recognised in the chosen
            camera's picture: 1.5 % and 0.1 % of it, and less than half hidden.
    """

    tick: int
    steps: tuple[Step, ...]
    camera: str
    named: tuple[int, ...]
    missed: tuple[int, ...]
    unseen: tuple[int, ...]
    in_closed: tuple[int, ...]
    shown: bool = False


def tick_visibilities(
    trajectory: Trajectory, home: EnvironmentGraph, size: tuple[int, int] = SIZE
) -> Iterator[TickVisibility]:
    """Yield the visibility of each tick's objects in the pictures that `snapshots` takes."""
    views = room_views(home, *size)
    rooms = {node.id: node.box for node in home.nodes if node.category == ROOM_CATEGORY}
    above = top_view(home_box(home), TOP, *size)
    for keyframe in trajectory.keyframes[1:]:
        named = named_nodes(keyframe.steps, rooms)
        actor, shown = keyframe.acting, tuple(dict.fromkeys(_shown_as(node, keyframe) for node in named))
        objects = tuple(dict.fromkeys(seen_as(node, keyframe.places) for node in named))
        camera = best_view(keyframe.scene, views, actor, objects, rooms.get(actor.room))
        missed = _missed(keyframe, camera, shown)
        unseen = _missed(keyframe, above, missed)
        in_closed = tuple(node for node in unseen if _is_in_closed(node, keyframe.places))
        seen = shows(shoot(keyframe.scene, camera), actor.node.id, objects)
        yield TickVisibility(keyframe.tick, keyframe.steps, camera.name, named, missed, unseen, in_closed, seen)


def _shown_as(node: int, keyframe: Keyframe) -> int:
    """Return the node that is drawn for a node: body parts and worn clothes are drawn with the body."""
    location = keyframe.places.locations.get(node)
    part = next((known.category == "BodyParts" for known in keyframe.places.graph.nodes if known.id == node), False)
    if part:
        return keyframe.acting.node.id
    return location.holder if location is not None and location.kind == "worn" else node


def seen_as(node: int, places: Places) -> int:
    """Return the node by which an onlooker sees a node.

    Body parts and worn clothes are drawn with their wearer; a closed container shows the objects inside it.
    """
    states: Mapping[int, tuple[str, ...]] = {known.id: known.states for known in places.graph.nodes}
    if any(known.id == node and known.category == "BodyParts" for known in places.graph.nodes):
        return next((known.id for known in places.graph.nodes if known.category == "Characters"), node)
    found = node
    for _ in range(8):
        location = places.locations.get(node)
        if location is None or location.kind not in ("on", "inside", "worn"):
            break
        node = location.holder
        if location.kind == "worn" or (location.kind == "inside" and "CLOSED" in states.get(node, ())):
            found = node
    return found


def objects_of(step: Step, trajectory: Trajectory, keyframe: Keyframe) -> tuple[int, ...]:
    """Return the nodes by which a step's objects are seen, without rooms and the person itself."""
    named = named_nodes([step], trajectory.prepared.rooms)
    person = keyframe.actors[step.agent].node.id
    return tuple(dict.fromkeys(node for node in (seen_as(one, keyframe.places) for one in named) if node != person))


def _missed(keyframe: Keyframe, camera: Camera, named: tuple[int, ...]) -> tuple[int, ...]:
    """Return the nodes without a pixel in a camera's picture."""
    if not named:
        return ()
    shot = shoot(keyframe.scene, camera)
    numbers = np.flatnonzero(np.bincount(shot.owner + 1, minlength=1)[1:])
    seen = {shot.geometry.things[number].id for number in numbers.tolist()}
    return tuple(node for node in named if node not in seen)


def _is_in_closed(node: int, places: Places) -> bool:
    """Return whether a closed container holds the node."""
    states = {known.id: known.states for known in places.graph.nodes}
    for _ in range(8):
        location = places.locations.get(node)
        if location is None or location.kind not in ("on", "inside"):
            return False
        node = location.holder
        if location.kind == "inside" and "CLOSED" in states.get(node, ()):
            return True
    return False


class Shares(NamedTuple):
    """Shares of the steps whose named objects are all visible.

    Attributes:
        steps: number of steps that name an object.
        chosen: share with all objects in the chosen camera's picture.
        either: share with all objects in that picture or in the one from above.
        open_: as `either`, over the steps whose objects are outside closed containers.
        shown: share of all ticks that show the person and the objects recognisably.
    """

    steps: int
    chosen: float
    either: float
    open_: float
    shown: float


def shares(found: Iterable[TickVisibility]) -> Shares:
    """Shares over all ticks that name an object; 1 where there are none."""
    every = list(found)
    known = [look for look in every if look.named]
    free = [look for look in known if not look.in_closed]
    return Shares(
        len(known),
        _share([not look.missed for look in known]),
        _share([not look.unseen for look in known]),
        _share([not look.unseen for look in free]),
        _share([look.shown for look in every]),
    )


def _share(found: list[bool]) -> float:
    return round(sum(found) / len(found), 4) if found else 1.0
