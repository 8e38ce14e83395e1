"""Animation of steps: relax, rise, walk, turn, sit down, reach; the world changes when the hand arrives."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import atan2, ceil, cos, degrees, hypot, pi, sin
from typing import NamedTuple

from hearth.kb.modifiers import SPEEDS, value
from hearth.rendering.film.snapshots import Keyframe, Trajectory
from hearth.rendering.people.acting import Actor, carried, posed, reach_for
from hearth.rendering.people.figure import Figure
from hearth.rendering.people.skeleton import HIP, PELVIS_ON_SEAT, BodyPose
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.routes import WalkableFloor, path
from hearth.rendering.scene.scene import Scene
from hearth.schemas.graph import Node, Point, Spot
from hearth.schemas.program import Step

WALKING, RUNNING = 1.15, 2.6
"""Metres per second."""

TURNING = 200.0
"""Degrees per second."""

RELAX, RISE, REACH, BACK, HOLD = 0.25, 0.8, 0.55, 0.3, 0.3
"""Seconds."""

OPENING = 0.5
"""Seconds in which doors, lids and drawers open or close."""

STEP_LENGTH = 0.16
"""Distance from hips to planted foot at full stride, as a share of the body's height (see `skeleton`)."""


class Frame(NamedTuple):
    """The scene of one picture of a film.

    Attributes:
        time: seconds from the film's start.
        tick: the current tick, from 1; 0 before the first.
        steps: of that tick.
        scene: the scene.
        actors: the characters.
    """

    time: float
    tick: int
    steps: tuple[Step, ...]
    scene: Scene
    actors: tuple[Actor, ...]


class Span(NamedTuple):
    """Start and end of a tick in a film, seconds."""

    tick: int
    steps: tuple[Step, ...]
    start: float
    end: float


class Segment(NamedTuple):
    """A part of an actor's motion: its length in seconds, and the actor at a share of it."""

    seconds: float
    at: Callable[[float], Actor]


@dataclass(frozen=True, eq=False)
class Track:
    """An actor's motion in a tick.

    Attributes:
        segments: its parts, in order.
        change: seconds until the hand arrives and the world changes.
    """

    segments: tuple[Segment, ...]
    change: float

    @property
    def seconds(self) -> float:
        """Its length."""
        return sum(segment.seconds for segment in self.segments)

    def at(self, time: float) -> Actor:
        """The actor `time` seconds after the start of the tick."""
        for segment in self.segments:
            if time < segment.seconds:
                return segment.at(time / segment.seconds)
            time -= segment.seconds
        return self.segments[-1].at(1.0)


def frames(trajectory: Trajectory, fps: float = 15.0, speed: float = 1.0) -> Iterator[Frame]:
    """The frames of a film of an execution.

    Args:
        trajectory: as `snapshots.trajectory_of` gives it.
        fps: frames per second.
        speed: factor of all motions' speed.
    """
    set_ = _SceneCache(trajectory)
    number = 0
    for span, before, after, tracks in _spans(trajectory, speed):
        change, swings = _change(tracks), swinging(before, after)
        while number / fps < span.end:
            time = number / fps
            past = (time - span.start) * speed
            actors = tuple(track.at(past) for track in tracks)
            keyframe, share = (after, (past - change) / OPENING) if past >= change else (before, 1.0)
            ajar = {node: share if opens else 1 - share for node, opens in swings.items()} if share < 1 else {}
            yield Frame(time, span.tick, span.steps, set_.scene(keyframe, actors, ajar), actors)
            number += 1


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


def _spans(trajectory: Trajectory, speed: float) -> Iterator[tuple[Span, Keyframe, Keyframe, tuple[Track, ...]]]:
    first = trajectory.keyframes[0]
    static = tuple(Track((_motionless(actor, 1.0),), 0.0) for actor in first.actors)
    yield Span(0, (), 0.0, 1.0 / speed), first, first, static
    time = 1.0 / speed
    for before, after in zip(trajectory.keyframes, trajectory.keyframes[1:], strict=False):
        by_agent = {step.agent: step for step in after.steps}
        tracks = tuple(
            track(one, other, before, by_agent.get(number))
            for number, (one, other) in enumerate(zip(before.actors, after.actors, strict=True))
        )
        takes = [found.seconds for found in tracks] or [HOLD]
        if swinging(before, after):
            takes.append(_change(tracks) + OPENING)
        end = time + max(takes) / speed
        yield Span(after.tick, after.steps, time, end), before, after, tracks
        time = end


class _SceneCache:
    """Scenes of a trajectory, with a cache of the things that frames share."""

    def __init__(self, trajectory: Trajectory) -> None:
        self.trajectory = trajectory
        self.known: dict[tuple[int, frozenset[int], frozenset[int]], tuple[tuple[Thing, ...], Scene]] = {}

    def scene(self, keyframe: Keyframe, actors: tuple[Actor, ...], ajar: Mapping[int, float]) -> Scene:
        """A keyframe's scene with actors as in a frame, and some things partly open."""
        prepared, places = self.trajectory.prepared, keyframe.places
        held = carried(actors, places)
        things, base = self._rest(keyframe, frozenset(held), frozenset(ajar))
        nodes = {node.id: node for node in places.graph.nodes if node.id in held}
        swung = [
            thing
            for node in (places.nodes() if ajar else ())
            if node.id in ajar and node.id not in held
            for thing in prepared.things(_opened(node), ajar[node.id])
        ]
        hands = [
            thing
            for number, pose in held.items()
            for thing in prepared.things(replace(nodes[number], box=pose.box, yaw=pose.yaw))
        ]
        people = [Thing(a.node.id, a.node.class_name, a.figure(), a.position, a.yaw) for a in actors]
        return replace(base, things=(*things, *hands, *swung, *people), static=self.trajectory.static)

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
    """The node with state OPEN, drawn while it swings."""
    return replace(node, states=tuple(sorted({*node.states, "OPEN"} - {"CLOSED"})))


def track(one: Actor, other: Actor, before: Keyframe, step: Step | None) -> Track:
    """An actor's motion from one keyframe to the next."""
    segments: list[Segment] = []
    rest = _resting(one, before)
    if rest.body_pose != one.body_pose:
        segments.append(_blended(one, rest, RELAX))
    here = _approach(segments, rest, other, step, before.floor.walkable)
    if step is not None:
        reach = reach_for(here, other, before.places, step)
        if reach.body_pose != here.body_pose:
            segments.append(_blended(here, reach, REACH))
        here = reach
    change = sum(segment.seconds for segment in segments)
    if here != other:
        segments.append(_blended(here, other, BACK))
    segments.append(_motionless(other, HOLD))
    rate = SPEEDS.get(value(step, "speed"), 1.0) if step is not None else 1.0
    if rate != 1.0:
        segments = [segment._replace(seconds=segment.seconds / rate) for segment in segments]
    return Track(tuple(segments), change / rate)


def _motionless(actor: Actor, seconds: float) -> Segment:
    return Segment(seconds, lambda share: actor)


def _approach(
    segments: list[Segment], one: Actor, other: Actor, step: Step | None, ways: WalkableFloor | None
) -> Actor:
    """Append the segments up to the acting position; returns the actor there, hands in default pose."""
    seated, sits = one.body_pose.posture != "standing", other.body_pose.posture != "standing"
    if seated and sits and one.place == other.place:
        return replace(other, body_pose=replace(other.body_pose, right=one.body_pose.right, left=one.body_pose.left))
    route = path(ways, one.spot, other.spot)
    if seated:
        up = replace(one, spot=_edge(route, one.spot), body_pose=_hands(BodyPose(), one.body_pose), place=0)
        segments.append(_risen(one, up))
        one, route = up, path(ways, up.spot, other.spot)
    stop = _edge(route[::-1], other.spot) if sits else other.spot
    if sits:
        route = path(ways, one.spot, stop)
    speed = RUNNING if step is not None and step.action == "Run" else WALKING
    one = _walked(segments, one, route, speed)
    turned = replace(one, yaw=other.yaw, room=other.room, spot=stop)
    angle = abs(_angle(one.yaw, other.yaw))
    if angle > 1:
        segments.append(_blended(one, turned, angle / TURNING))
    if sits:
        down = replace(other, body_pose=_hands(BodyPose("sitting", other.body_pose.seat), turned.body_pose))
        rising = _risen(down, turned)
        segments.append(Segment(rising.seconds, lambda share: rising.at(1 - share)))
        return replace(other, body_pose=_hands(other.body_pose, turned.body_pose))
    return turned


def _hands(body_pose: BodyPose, other: BodyPose) -> BodyPose:
    """A body pose with the hands of another; unchanged when lying."""
    return body_pose if body_pose.posture == "lying" else replace(body_pose, right=other.right, left=other.left)


def _edge(route: Sequence[Spot], spot: Spot, far: float = 0.55) -> Spot:
    """The point of a route at which an actor stands after rising from the route's start."""
    for a, b in pairwise(route):
        length = hypot(b[0] - a[0], b[1] - a[1])
        if length >= far:
            share = far / length
            return a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share
    return route[-1]


def _resting(actor: Actor, keyframe: Keyframe) -> Actor:
    """The actor with arms hanging, or carrying what it holds."""
    return posed(actor, keyframe.places.graph, keyframe.places, None)


def _risen(seated: Actor, up: Actor) -> Segment:
    """Standing up: hips rise while the feet stay in front of the seat."""
    high = HIP * up.body.height - PELVIS_ON_SEAT
    low = seated.body_pose.seat

    def at(share: float) -> Actor:
        if share >= 1:
            return up
        eased = _eased(share)
        body_pose = replace(_hands(BodyPose("sitting"), seated.body_pose), seat=low + (high - low) * eased)
        spot = _between(seated.spot, up.spot, eased)
        yaw = seated.yaw + _angle(seated.yaw, up.yaw) * eased
        return replace(up, spot=spot, yaw=yaw, body_pose=body_pose, level=up.level)

    return Segment(RISE, at)


def _walked(segments: list[Segment], actor: Actor, route: Sequence[Spot], speed: float) -> Actor:
    """Append a walk along a route: a turn, then steps, during which the planted foot does not slide."""
    for a, b in pairwise(route):
        length = hypot(b[0] - a[0], b[1] - a[1])
        if length < 0.05:
            continue
        yaw = degrees(atan2(b[0] - a[0], b[1] - a[1]))
        turned = replace(actor, yaw=yaw)
        if abs(_angle(actor.yaw, yaw)) > 1:
            segments.append(_blended(actor, turned, abs(_angle(actor.yaw, yaw)) / TURNING))
        segments.append(_leg(turned, a, b, length, speed))
        actor = replace(turned, spot=b)
    return actor


def _leg(actor: Actor, a: Spot, b: Spot, length: float, speed: float) -> Segment:
    """A straight walk from a to b in whole steps; feet are side by side at both ends."""
    pace = 2 * STEP_LENGTH * actor.body.height * (0.75 if speed < 2 else 1.0)
    steps = max(1, ceil(length / pace))
    stride = length / steps / (2 * STEP_LENGTH * actor.body.height)

    def at(share: float) -> Actor:
        phase = share * steps + 0.5
        number = int(phase)
        side, part = (1.0 if number % 2 == 0 else -1.0), phase - number
        # Relative to the body the planted foot moves backwards at walking speed.
        lift = sin(pi * part) * min(1.0, 3 * share * steps, 3 * (1 - share) * steps)
        body_pose = replace(actor.body_pose, stride=stride * side * (1 - 2 * part), swing=-side * max(lift, 1e-6))
        return replace(actor, spot=_between(a, b, share), body_pose=body_pose)

    return Segment(length / speed, at)


def _blended(one: Actor, other: Actor, seconds: float) -> Segment:
    """A transition between two actors' poses."""

    def at(share: float) -> Actor:
        return other if share >= 1 else blend(one, other, _eased(share))

    return Segment(max(seconds, 1e-3), at)


def blend(one: Actor, other: Actor, share: float) -> Actor:
    """Interpolation between two poses; if postures differ, the second's."""
    if one.body_pose.posture != other.body_pose.posture:
        return one if share < 0.5 else other
    a, b = one.body_pose, other.body_pose
    body_pose = replace(
        b,
        seat=a.seat + (b.seat - a.seat) * share,
        stride=a.stride + (b.stride - a.stride) * share,
        swing=0.0,
        right=_hand(one, other, "r", share),
        left=_hand(one, other, "l", share),
        gaze=_gaze(one, other, share),
    )
    yaw = one.yaw + _angle(one.yaw, other.yaw) * share
    level = one.level + (other.level - one.level) * share
    return replace(other, spot=_between(one.spot, other.spot, share), level=level, yaw=yaw, body_pose=body_pose)


def _hand(one: Actor, other: Actor, side: str, share: float) -> Point | None:
    a, b = ((actor.body_pose.right if side == "r" else actor.body_pose.left) for actor in (one, other))
    if (a is None and b is None) or one.body_pose.posture == "lying":
        return b
    start, end = (at or _hanging(actor, side) for at, actor in ((a, one), (b, other)))
    x, y, z = (p + (q - p) * share for p, q in zip(start, end, strict=True))
    return x, y, z


def _hanging(actor: Actor, side: str) -> Point:
    """Position of the hand of a hanging arm, in the figure's frame."""
    body_pose = replace(actor.body_pose, right=None, left=None)
    x, y, z = Figure(actor.body, body_pose).joints()[f"hand_{side}"]
    return float(x), float(y), float(z)


def _gaze(one: Actor, other: Actor, share: float) -> Point | None:
    a, b = one.body_pose.gaze, other.body_pose.gaze
    if a is None and b is None:
        return None
    ahead = (0.0, 0.88 * other.body.height, 2.0)
    x, y, z = (p + (q - p) * share for p, q in zip(a or ahead, b or ahead, strict=True))
    return x, y, z


def _between(a: Spot, b: Spot, share: float) -> Spot:
    return a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share


def _angle(start: float, end: float) -> float:
    """The smaller angle from one direction to another, degrees."""
    return (end - start + 180) % 360 - 180


def _eased(share: float) -> float:
    return (1 - cos(pi * share)) / 2
