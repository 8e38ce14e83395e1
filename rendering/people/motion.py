"""Films of steps: the motion of actors by time; the world changes when the hand arrives."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

from hearth.rendering.film.execution_keyframes import Keyframe, Trajectory
from hearth.rendering.film.film_rate import FILM_RATE
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.bedding import Remade
from hearth.rendering.people.held_objects import held_things
from hearth.rendering.people.motion_tracks import HOLD, Track, motionless, track
from hearth.rendering.people.object_arrivals import Arrivals, arrivals
from hearth.rendering.scene.free_poses import Pose
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.visible_state_effects import at_time
from hearth.schemas.graph import Node
from hearth.schemas.program import Step

OPENING = 0.5
"""Seconds in which doors, lids and drawers open or close."""


class Frame(NamedTuple):
    """The scene of one picture of a film.

    Attributes:
        time: seconds from the film's start.
        tick: the current tick, from 1; 0 before the first.
        steps: of that tick.
        scene: the scene.
        actors: the characters.
        holds: character id -> id of each thing that it holds -> `right` or `left`.
    """

    time: float
    tick: int
    steps: tuple[Step, ...]
    scene: Scene
    actors: tuple[Actor, ...]
    holds: Mapping[int, Mapping[int, str]]


class Span(NamedTuple):
    """Start and end of a tick in a film, seconds."""

    tick: int
    steps: tuple[Step, ...]
    start: float
    end: float


def frames(trajectory: Trajectory, fps: float = FILM_RATE, speed: float = 1.0) -> Iterator[Frame]:
    """Yield the frames of a film of an execution.

    Args:
        trajectory: as `snapshots.trajectory_of` gives it.
        fps: frames per second.
        speed: factor of all motions' speed.
    """
    set_ = _SceneCache(trajectory)
    number = 0
    for span, before, after, tracks, coming in _spans(trajectory, speed):
        change, swings = _change(tracks), swinging(before, after)
        while number / fps < span.end:
            time = number / fps
            past = (time - span.start) * speed
            actors = tuple(track.at(past) for track in tracks)
            keyframe, share = (after, (past - change) / OPENING) if past >= change else (before, 1.0)
            ajar = {node: share if opens else 1 - share for node, opens in swings.items()} if share < 1 else {}
            scene = set_.scene(keyframe, actors, ajar, _bedding(before, after, tracks, past), time)
            if past >= change:
                scene = coming.at(scene, past - change)
            yield Frame(time, span.tick, span.steps, scene, actors, keyframe.places.holds)
            number += 1


def _bedding(before: Keyframe, after: Keyframe, tracks: Sequence[Track], past: float) -> dict[int, Pose]:
    """Poses of the bedding that people move at a moment."""
    found: dict[int, Pose] = {}
    for each, one, other in zip(tracks, before.actors, after.actors, strict=True):
        made, covered = each.done("make", past), each.done("cover", past)
        if made is not None or covered is not None:
            place = other.place or one.place
            found |= Remade.between(before.places, after.places, place).at(made, covered)
    return found


def _arrivals(trajectory: Trajectory, before: Keyframe, after: Keyframe, tracks: Sequence[Track]) -> Arrivals:
    """Objects that still move when all hands have arrived; bedding that people move is not counted."""
    change = _change(tracks)
    actors = tuple(track.at(change) for track in tracks)
    moved = _bedding(before, after, tracks, change).keys()
    return arrivals(trajectory.prepared, before.places, after.places, actors, moved)


def swinging(before: Keyframe, after: Keyframe) -> dict[int, bool]:
    """Things that open (True) or close (False) between two keyframes, by id."""
    one, other = ({n.id for n in m.places.graph.nodes if "OPEN" in n.states} for m in (before, after))
    return {node: node in other for node in sorted(one ^ other)}


def _change(tracks: Sequence[Track]) -> float:
    """Seconds until all hands have arrived."""
    return max((track.change for track in tracks), default=0.0)


def spans(trajectory: Trajectory, speed: float = 1.0) -> list[Span]:
    """Start and end of each tick in the film; the first span is before the program."""
    return [span for span, *_ in _spans(trajectory, speed)]


def _spans(
    trajectory: Trajectory, speed: float
) -> Iterator[tuple[Span, Keyframe, Keyframe, tuple[Track, ...], Arrivals]]:
    first = trajectory.keyframes[0]
    static = tuple(Track((motionless(actor, 1.0),), 0.0) for actor in first.actors)
    yield Span(0, (), 0.0, 1.0 / speed), first, first, static, Arrivals({})
    time = 1.0 / speed
    for before, after in zip(trajectory.keyframes, trajectory.keyframes[1:], strict=False):
        by_agent = {step.agent: step for step in after.steps}
        tracks = tuple(
            track(one, other, before, after, by_agent.get(number))
            for number, (one, other) in enumerate(zip(before.actors, after.actors, strict=True))
        )
        takes = [found.seconds for found in tracks] or [HOLD]
        if swinging(before, after):
            takes.append(_change(tracks) + OPENING)
        coming = _arrivals(trajectory, before, after, tracks)
        takes.append(_change(tracks) + coming.seconds)
        end = time + max(takes) / speed
        yield Span(after.tick, after.steps, time, end), before, after, tracks, coming
        time = end


class _SceneCache:
    """Scenes of a trajectory, with a cache of the things that frames share."""

    def __init__(self, trajectory: Trajectory) -> None:
        self.trajectory = trajectory
        self.known: dict[tuple[int, frozenset[int], frozenset[int]], tuple[tuple[Thing, ...], Scene]] = {}

    def scene(
        self,
        keyframe: Keyframe,
        actors: tuple[Actor, ...],
        ajar: Mapping[int, float],
        moved: Mapping[int, Pose],
        time: float,
    ) -> Scene:
        """Return a keyframe's scene with actors as in a frame, some things partly open or elsewhere, and effects as
        they are at a time.
        """
        prepared, places = self.trajectory.prepared, keyframe.places
        held = held_things(prepared, places, actors)
        things, base = self._rest(keyframe, frozenset(held), frozenset(ajar) | frozenset(moved))
        swung = [
            thing
            for node in (places.nodes() if ajar else ())
            if node.id in ajar and node.id not in held
            for thing in prepared.things(_opened(node), ajar[node.id])
        ]
        swung += [
            thing
            for node in (places.nodes() if moved else ())
            if node.id in moved and node.id not in held
            for thing in prepared.things(replace(node, box=moved[node.id].box, yaw=moved[node.id].yaw))
        ]
        hands = [thing for things in held.values() for thing in things]
        people = [Thing(a.node.id, a.node.class_name, a.figure(), a.position, a.yaw) for a in actors]
        shown = tuple(now for thing in (*things, *hands, *swung) for now in at_time(thing, time))
        return replace(base, things=(*shown, *people), static=self.trajectory.static)

    def _rest(self, keyframe: Keyframe, held: frozenset[int], swung: frozenset[int]) -> tuple[tuple[Thing, ...], Scene]:
        key = (keyframe.tick, held, swung)
        if key not in self.known:
            # Swinging things are removed only afterwards: windows give light while they open.
            nodes = [node for node in keyframe.places.nodes() if node.id not in held]
            base = self.trajectory.prepared.scene(nodes)
            kept = frozenset(self.trajectory.static.things)
            self.known[key] = tuple(t for t in base.things if t not in kept and t.id not in swung), base
        return self.known[key]


def _opened(node: Node) -> Node:
    """Return the node with state OPEN, drawn while it swings."""
    return replace(node, states=tuple(sorted({*node.states, "OPEN"} - {"CLOSED"})))
