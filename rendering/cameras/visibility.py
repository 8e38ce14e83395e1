"""How much of what steps name can be seen: by the camera that is chosen for each step, and from above."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from hearth.rendering.cameras.camera import Camera, top_view
from hearth.rendering.cameras.viewpoints import best_view, home_box, room_views
from hearth.rendering.film.snapshots import TOP, Moment, Play, named_nodes
from hearth.rendering.rays.shot import shoot
from hearth.rendering.scene.places import Places
from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.program import Step
from hearth.schemas.vocabulary import ROOM_CATEGORY

SIZE = (320, 240)


class Looked(NamedTuple):
    """What can be seen of a tick.

    Attributes:
        tick, steps: which.
        camera: that was chosen.
        named: ids of what the steps name; rooms are none.
        missed: those of them that its picture does not show.
        unseen: those that the picture from above does not show either.
        shut: those of the unseen that are inside something closed, where no camera could see them.
    """

    tick: int
    steps: tuple[Step, ...]
    camera: str
    named: tuple[int, ...]
    missed: tuple[int, ...]
    unseen: tuple[int, ...]
    shut: tuple[int, ...]


def looks(staged: Play, home: EnvironmentGraph, size: tuple[int, int] = SIZE) -> Iterator[Looked]:
    """What the pictures that `snapshots` takes of an execution show of what each tick names."""
    views = room_views(home, *size)
    rooms = {node.id: node.box for node in home.nodes if node.category == ROOM_CATEGORY}
    above = top_view(home_box(home), TOP, *size)
    last: Camera | None = None
    for moment in staged.moments[1:]:
        named = named_nodes(moment.steps, rooms)
        actor, shown = moment.acting, tuple(dict.fromkeys(_shown_as(node, moment) for node in named))
        last = best_view(moment.scene, views, actor, named, last, rooms.get(actor.room))
        missed = _missed(moment, last, shown)
        unseen = _missed(moment, above, missed)
        shut = tuple(node for node in unseen if _is_shut(node, moment.places))
        yield Looked(moment.tick, moment.steps, last.name, named, missed, unseen, shut)


def _shown_as(node: int, moment: Moment) -> int:
    """What shows a node: parts of the body and what is worn are drawn with the body."""
    spot = moment.places.where.get(node)
    part = next((known.category == "BodyParts" for known in moment.places.graph.nodes if known.id == node), False)
    if part:
        return moment.acting.node.id
    return spot.what if spot is not None and spot.how == "worn" else node


def _missed(moment: Moment, camera: Camera, named: tuple[int, ...]) -> tuple[int, ...]:
    """The nodes without a pixel."""
    if not named:
        return ()
    shot = shoot(moment.scene, camera)
    numbers = np.flatnonzero(np.bincount(shot.owner + 1, minlength=1)[1:])
    seen = {shot.geometry.things[number].id for number in numbers.tolist()}
    return tuple(node for node in named if node not in seen)


def _is_shut(node: int, places: Places) -> bool:
    """Whether something around it is closed."""
    states = {known.id: known.states for known in places.graph.nodes}
    for _ in range(8):
        spot = places.where.get(node)
        if spot is None or spot.how not in ("on", "inside"):
            return False
        node = spot.what
        if spot.how == "inside" and "CLOSED" in states.get(node, ()):
            return True
    return False


class Shares(NamedTuple):
    """Shares of the steps that name something.

    Attributes:
        steps: how many those are.
        chosen: every named object is visible in the chosen camera's picture.
        either: in that or in the one from above.
        open_: likewise, of the steps that name nothing inside something closed.
    """

    steps: int
    chosen: float
    either: float
    open_: float


def shares(found: Iterable[Looked]) -> Shares:
    """Over all ticks that name something; 1 where there are none."""
    known = [look for look in found if look.named]
    free = [look for look in known if not look.shut]
    return Shares(
        len(known),
        _share([not look.missed for look in known]),
        _share([not look.unseen for look in known]),
        _share([not look.unseen for look in free]),
    )


def _share(found: list[bool]) -> float:
    return round(sum(found) / len(found), 4) if found else 1.0
