"""Pictures of a recorded execution: one moment a tick, from cameras that stay or that are chosen by what they see."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hearth.kb.knowledge import Knowledge
from hearth.rendering.cameras.camera import Camera, top_view
from hearth.rendering.cameras.viewpoints import best_view, home_box, room_views
from hearth.rendering.modalities import check_modalities, pictures_of
from hearth.rendering.people.acting import Actor, carried, cast, moved, posed
from hearth.rendering.rays.incremental import Take, take
from hearth.rendering.rays.shot import Shot, shoot
from hearth.rendering.scene.history import graphs
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.places import Places
from hearth.rendering.scene.prepared import Stage, stage
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.standing_places import Ground
from hearth.rendering.scene.swept import ground_of
from hearth.rendering.scene.triangles import Still
from hearth.rendering.scene.variation import PLAIN, Variation, scattered
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import EnvironmentGraph, to_release
from hearth.schemas.program import Step
from hearth.schemas.vocabulary import ROOM_CATEGORY
from hearth.simulation.engine import Execution

AUTO = "auto"
TOP = "top"


@dataclass(frozen=True, eq=False)
class Moment:
    """One tick of an execution, ready to be pictured.

    Attributes:
        tick: 0 before the first step, then 1 after it, ...
        steps: what was done in this tick; none at the start.
        scene: what there is.
        actors: the characters.
        places: where everything is.
    """

    tick: int
    steps: tuple[Step, ...]
    scene: Scene
    actors: tuple[Actor, ...]
    places: Places

    @property
    def acting(self) -> Actor:
        """Who is looked at: the first who does something, else the first."""
        return self.actors[acting(self.steps, len(self.actors))]


def acting(steps: Sequence[Step], count: int) -> int:
    """The number of the agent that is looked at in a tick, of `count`: the first who does something, else 0."""
    found = min((step.agent for step in steps), default=0)
    return found if found < count else 0


def named_nodes(steps: Sequence[Step], rooms: Container[int]) -> tuple[int, ...]:
    """The things that steps name, in their order; rooms are none."""
    return tuple(
        dict.fromkeys(ref.node for step in steps for ref in step.objects if ref.node and ref.node not in rooms)
    )


@dataclass(frozen=True, eq=False)
class Snapshot:
    """Pictures of one moment by one camera.

    Attributes:
        tick, steps: as of the moment.
        camera: it was taken with.
        pictures: modality -> array, as `modalities.render` gives them.
        seen: share of the objects the steps name, and the character, that are visible.
    """

    tick: int
    steps: tuple[Step, ...]
    camera: Camera
    pictures: Mapping[str, Any]
    seen: float = 1.0


def moments(
    execution: Execution,
    home: EnvironmentGraph,
    knowledge: Knowledge,
    *,
    seed: int = 0,
    hour: float = 10.0,
) -> Iterator[Moment]:
    """The scene at the start and after each tick of an execution.

    Args:
        execution: a recorded run; what its environment adds to the home, or has moved, is placed by its relations.
        home: the home's graph as it was built, with boxes.
        knowledge: what is known of its classes.
        seed: decides bodies, colours and designs.
        hour: of the day.

    Raises:
        HearthError: the home has no geometry.
    """
    yield from play(execution, home, knowledge, seed=seed, hour=hour).moments


@dataclass(frozen=True, eq=False)
class Play:
    """An execution, staged.

    Attributes:
        prepared: the home, for making further scenes of it.
        moments: at the start and after each tick.
        still: the things that never change; every moment's scene shares them.
        variation: what was drawn by chance.
    """

    prepared: Stage
    moments: tuple[Moment, ...]
    still: Still
    variation: Variation = PLAIN


def play(
    execution: Execution,
    home: EnvironmentGraph,
    knowledge: Knowledge,
    *,
    seed: int = 0,
    hour: float = 10.0,
    variation: Variation | None = None,
) -> Play:
    """All moments of an execution at once; see `moments`. A `variation` comes in place of seed and hour."""
    check_geometry(home)
    how = variation or replace(PLAIN, seed=seed, hour=hour)
    placed = scattered(home, how)
    prepared = stage(placed, knowledge, seed=how.seed, hour=how.hour)
    found = list(_played(execution, placed, prepared, how))
    still = Still(_still([moment.scene for moment in found]))
    kept = frozenset(still.things)
    return Play(prepared, tuple(_parted(moment, still, kept) for moment in found), still, how)


def _parted(moment: Moment, still: Still, kept: frozenset[Thing]) -> Moment:
    moving = tuple(thing for thing in moment.scene.things if thing not in kept)
    return replace(moment, scene=replace(moment.scene, things=moving, still=still))


def check_geometry(home: EnvironmentGraph) -> None:
    """Refuse a home that can't be pictured.

    Raises:
        HearthError: no room has a box.
    """
    if not any(node.box and node.category == ROOM_CATEGORY for node in home.nodes):
        raise HearthError.of(
            Code.NOT_RENDERED, "the home has no geometry: no room has a box", suggestion="a designed home"
        )


def _still(scenes: Sequence[Scene]) -> tuple[Thing, ...]:
    """The things that are the same in all scenes."""
    common = set(scenes[0].things)
    for scene in scenes[1:]:
        common &= set(scene.things)
    return tuple(thing for thing in scenes[0].things if thing in common)


def _played(execution: Execution, home: EnvironmentGraph, prepared: Stage, how: Variation) -> Iterator[Moment]:
    """The moments of an execution, their scenes made of moving things only."""
    ground = ground_of(prepared)
    ticks: list[tuple[Step, ...]] = [(), *execution.program.ticks()]
    places = Places.start(home, prepared.knowledge)
    actors: tuple[Actor, ...] = ()
    for tick, (graph, steps) in enumerate(zip(graphs(execution), ticks, strict=False)):
        if tick == 0:
            places = places.settled(graph)
            actors = cast(graph, ground, places, how.seed)
            actors = _wandered(actors, ground, how) if how.wander else actors
            actors = tuple(posed(actor, graph, places, None) for actor in actors)
        else:
            actors, places = advanced(actors, places, graph, ground, steps)
        yield Moment(tick, steps, scene_at(prepared, places, actors), actors, places)


def _wandered(actors: tuple[Actor, ...], ground: Ground, how: Variation) -> tuple[Actor, ...]:
    """Everyone who stands, anywhere on the free floor of the same room, looking anywhere."""
    found: list[Actor] = []
    for actor in actors:
        taken = [other.spot for other in (*found, *actors[len(found) + 1 :])]
        numbers = how.random("start", actor.node.id)
        spot = ground.any_in(actor.room, numbers, taken) if actor.stance.posture == "standing" else None
        found.append(replace(actor, spot=spot, yaw=numbers.uniform(-180, 180)) if spot else actor)
    return tuple(found)


def advanced(
    actors: tuple[Actor, ...], places: Places, graph: EnvironmentGraph, ground: Ground, steps: tuple[Step, ...]
) -> tuple[tuple[Actor, ...], Places]:
    """Everyone and everything after a tick."""
    by_agent = {step.agent: step for step in steps}
    after: list[Actor] = []
    # People first go where they act, then things are put down near them, then hands go to where the things are.
    for number, actor in enumerate(actors):
        others = [a.spot for a in (*after, *actors[number + 1 :])]
        known = replace(places, graph=graph)
        after.append(moved(actor, graph, known, ground, by_agent.get(number), others))
    near = {actor.node.id: actor.position for actor in after}
    settled = places.settled(graph, near)
    return tuple(posed(actor, graph, settled, by_agent.get(n)) for n, actor in enumerate(after)), settled


def scene_at(prepared: Stage, places: Places, actors: tuple[Actor, ...]) -> Scene:
    """The scene of a moment, with what hands hold in the hands."""
    held = carried(actors, places)
    nodes = [replace(n, box=held[n.id].box, yaw=held[n.id].yaw) if n.id in held else n for n in places.nodes()]
    figures = [(actor.node, actor.figure(), actor.position, actor.yaw) for actor in actors]
    return prepared.scene(nodes, figures)


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
    """Pictures of every moment of an execution by every camera.

    Args:
        execution, home, knowledge, seed, hour: as of `moments`.
        cameras: cameras that stay; `top` is a bird's eye over the home, `auto` the camera of the character's room
            that sees best what the step names.
        modalities, quality: as of `modalities.render`; `flow` leads to the next tick, and `graph` is the scene graph.
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
    last: dict[Camera | str, Camera] = {}
    takes: dict[Camera | str, Take] = {}
    found = play(execution, home, knowledge, seed=seed, hour=hour).moments
    for moment, later in zip(found, (*found[1:], found[-1]), strict=True):
        named = named_nodes(moment.steps, rooms)
        for choice in cameras:
            camera = choice if isinstance(choice, Camera) else above
            if choice == AUTO:
                actor = moment.acting
                camera = best_view(moment.scene, views, actor, named, last.get(choice), rooms.get(actor.room))
            last[choice] = camera
            if quality == "draft":
                takes[choice] = take(moment.scene, camera, takes.get(choice))
                shot, known = replace(takes[choice].shot, after=later.scene), {"rgb": takes[choice].picture}
            else:
                shot, known = shoot(moment.scene, camera, after=later.scene), {}
            pictures = known | pictures_of(shot, [name for name in drawn if name not in known], quality)
            if "graph" in wanted:
                pictures["graph"] = to_release(moment.places.graph)
            told = {name: pictures[name] for name in wanted}
            yield Snapshot(moment.tick, moment.steps, camera, told, _seen(shot, named))


def _seen(shot: Shot, named: tuple[int, ...]) -> float:
    """Share of the nodes that have a pixel."""
    numbers = np.flatnonzero(np.bincount(shot.owner + 1, minlength=1)[1:])
    ids = {shot.geometry.things[number].id for number in numbers.tolist()}
    found = [node_id in ids for node_id in dict.fromkeys(named)]
    return sum(found) / len(found) if found else 1.0
