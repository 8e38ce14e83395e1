"""Every step in motion: relax, rise, walk, turn, sit down, reach; things change when the hand arrives."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import atan2, ceil, cos, degrees, hypot, pi, sin
from typing import NamedTuple

from hearth.rendering.film.snapshots import Moment, Play
from hearth.rendering.people.acting import Actor, carried, posed, reach_for
from hearth.rendering.people.figure import Figure
from hearth.rendering.people.skeleton import HIP, PELVIS_ON_SEAT, Stance
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.routes import path, ways_of
from hearth.rendering.scene.scene import Scene
from hearth.schemas.graph import Node, Point, Spot
from hearth.schemas.program import Step
from hearth.simulation.motion.navigation import Ways

WALKING, RUNNING = 1.15, 2.6
"""Metres a second."""

TURNING = 200.0
"""Degrees a second."""

RELAX, RISE, REACH, BACK, HOLD = 0.25, 0.8, 0.55, 0.3, 0.3
"""Seconds."""

OPENING = 0.5
"""Seconds that doors, lids and drawers take to open or close."""

STEP_LENGTH = 0.16
"""How far before the hips a foot is set down at full stride, as a share of the body's height (see `skeleton`)."""


class Frame(NamedTuple):
    """One picture of a film.

    Attributes:
        time: seconds from its start.
        tick: the tick that is going on, from 1; 0 before the first.
        steps: of that tick.
        scene: what there is.
        actors: the characters.
    """

    time: float
    tick: int
    steps: tuple[Step, ...]
    scene: Scene
    actors: tuple[Actor, ...]


class Span(NamedTuple):
    """When a tick goes on, in seconds."""

    tick: int
    steps: tuple[Step, ...]
    start: float
    end: float


class Segment(NamedTuple):
    """A part of what someone does: seconds, and the actor at a share of it."""

    seconds: float
    at: Callable[[float], Actor]


@dataclass(frozen=True, eq=False)
class Track:
    """What someone does in a tick.

    Attributes:
        segments: one after another.
        change: seconds after which the hand arrives, and things change.
    """

    segments: tuple[Segment, ...]
    change: float

    @property
    def seconds(self) -> float:
        """How long it takes."""
        return sum(segment.seconds for segment in self.segments)

    def at(self, time: float) -> Actor:
        """The actor so many seconds after the tick began."""
        for segment in self.segments:
            if time < segment.seconds:
                return segment.at(time / segment.seconds)
            time -= segment.seconds
        return self.segments[-1].at(1.0)


def frames(staged: Play, fps: float = 15.0, speed: float = 1.0) -> Iterator[Frame]:
    """The film of an execution.

    Args:
        staged: what `snapshots.play` makes of it.
        fps: pictures a second.
        speed: 2 has everyone move twice as fast.
    """
    ways = _ways(staged)
    set_ = _Set(staged)
    number = 0
    for span, before, after, tracks in _spans(staged, ways, speed):
        change, swings = _change(tracks), swinging(before, after)
        while number / fps < span.end:
            time = number / fps
            past = (time - span.start) * speed
            actors = tuple(track.at(past) for track in tracks)
            moment, share = (after, (past - change) / OPENING) if past >= change else (before, 1.0)
            ajar = {node: share if opens else 1 - share for node, opens in swings.items()} if share < 1 else {}
            yield Frame(time, span.tick, span.steps, set_.scene(moment, actors, ajar), actors)
            number += 1


def swinging(before: Moment, after: Moment) -> dict[int, bool]:
    """The things that are opened (True) or closed from one moment to the next, by id."""
    one, other = ({n.id for n in m.places.graph.nodes if "OPEN" in n.states} for m in (before, after))
    return {node: node in other for node in sorted(one ^ other)}


def _change(tracks: Sequence[Track]) -> float:
    """Seconds after which all hands have arrived."""
    return max((track.change for track in tracks), default=0.0)


def spans(staged: Play, speed: float = 1.0) -> list[Span]:
    """When each tick begins and ends in the film; the first is the moment before the program."""
    return [span for span, *_ in _spans(staged, _ways(staged), speed)]


def _ways(staged: Play) -> Ways | None:
    first = staged.moments[0]
    return ways_of(staged.prepared.rooms.values(), first.places.nodes())


def _spans(staged: Play, ways: Ways | None, speed: float) -> Iterator[tuple[Span, Moment, Moment, tuple[Track, ...]]]:
    first = staged.moments[0]
    still = tuple(Track((_held_still(actor, 1.0),), 0.0) for actor in first.actors)
    yield Span(0, (), 0.0, 1.0 / speed), first, first, still
    time = 1.0 / speed
    for before, after in zip(staged.moments, staged.moments[1:], strict=False):
        by_agent = {step.agent: step for step in after.steps}
        tracks = tuple(
            track(one, other, before, by_agent.get(number), ways)
            for number, (one, other) in enumerate(zip(before.actors, after.actors, strict=True))
        )
        takes = [found.seconds for found in tracks] or [HOLD]
        if swinging(before, after):
            takes.append(_change(tracks) + OPENING)
        end = time + max(takes) / speed
        yield Span(after.tick, after.steps, time, end), before, after, tracks
        time = end


class _Set:
    """Scenes of one play: all that stays between frames is kept."""

    def __init__(self, staged: Play) -> None:
        self.staged = staged
        self.known: dict[tuple[int, frozenset[int], frozenset[int]], tuple[tuple[Thing, ...], Scene]] = {}

    def scene(self, moment: Moment, actors: tuple[Actor, ...], ajar: Mapping[int, float]) -> Scene:
        """The scene of a moment with the actors as they are in a frame, and some things open by a share."""
        prepared, places = self.staged.prepared, moment.places
        held = carried(actors, places)
        things, base = self._rest(moment, frozenset(held), frozenset(ajar))
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
        return replace(base, things=(*things, *hands, *swung, *people), still=self.staged.still)

    def _rest(self, moment: Moment, held: frozenset[int], swung: frozenset[int]) -> tuple[tuple[Thing, ...], Scene]:
        key = (moment.tick, held, swung)
        if key not in self.known:
            # What swings is left out afterwards: windows give light while they are opened.
            nodes = [node for node in moment.places.nodes() if node.id not in held]
            base = self.staged.prepared.scene(nodes)
            kept = frozenset(self.staged.still.things)
            self.known[key] = tuple(t for t in base.things if t not in kept and t.id not in swung), base
        return self.known[key]


def _opened(node: Node) -> Node:
    """A node as it is while it swings: neither closed nor quite open."""
    return replace(node, states=tuple(sorted({*node.states, "OPEN"} - {"CLOSED"})))


def track(one: Actor, other: Actor, before: Moment, step: Step | None, ways: Ways | None) -> Track:
    """What an actor does to get from one moment to the next."""
    segments: list[Segment] = []
    rest = _resting(one, before)
    if rest.stance != one.stance:
        segments.append(_blended(one, rest, RELAX))
    here = _gone(segments, rest, other, step, ways)
    if step is not None:
        reach = reach_for(here, other, before.places, step)
        if reach.stance != here.stance:
            segments.append(_blended(here, reach, REACH))
        here = reach
    change = sum(segment.seconds for segment in segments)
    if here != other:
        segments.append(_blended(here, other, BACK))
    segments.append(_held_still(other, HOLD))
    return Track(tuple(segments), change)


def _held_still(actor: Actor, seconds: float) -> Segment:
    return Segment(seconds, lambda share: actor)


def _gone(segments: list[Segment], one: Actor, other: Actor, step: Step | None, ways: Ways | None) -> Actor:
    """Add what brings an actor where it acts; gives it as it then is, hands at rest."""
    seated, sits = one.stance.posture != "standing", other.stance.posture != "standing"
    if seated and sits and one.place == other.place:
        return replace(other, stance=replace(other.stance, right=one.stance.right, left=one.stance.left))
    route = path(ways, one.spot, other.spot)
    if seated:
        up = replace(one, spot=_edge(route, one.spot), stance=_hands(Stance(), one.stance), place=0)
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
        down = replace(other, stance=_hands(Stance("sitting", other.stance.seat), turned.stance))
        rising = _risen(down, turned)
        segments.append(Segment(rising.seconds, lambda share: rising.at(1 - share)))
        return replace(other, stance=_hands(other.stance, turned.stance))
    return turned


def _hands(stance: Stance, other: Stance) -> Stance:
    """A stance with the hands of another, if it has hands to hold out."""
    return stance if stance.posture == "lying" else replace(stance, right=other.right, left=other.left)


def _edge(route: Sequence[Spot], spot: Spot, far: float = 0.55) -> Spot:
    """Where on a way one stands when one has just got up from its beginning."""
    for a, b in pairwise(route):
        length = hypot(b[0] - a[0], b[1] - a[1])
        if length >= far:
            share = far / length
            return a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share
    return route[-1]


def _resting(actor: Actor, moment: Moment) -> Actor:
    """With the hands down, or holding before it what they hold."""
    return posed(actor, moment.places.graph, moment.places, None)


def _risen(seated: Actor, up: Actor) -> Segment:
    """From a seat to one's feet: hips rise while the feet stay before the seat."""
    high = HIP * up.body.height - PELVIS_ON_SEAT
    low = seated.stance.seat

    def at(share: float) -> Actor:
        if share >= 1:
            return up
        eased = _eased(share)
        stance = replace(_hands(Stance("sitting"), seated.stance), seat=low + (high - low) * eased)
        spot = _between(seated.spot, up.spot, eased)
        yaw = seated.yaw + _angle(seated.yaw, up.yaw) * eased
        return replace(up, spot=spot, yaw=yaw, stance=stance, level=up.level)

    return Segment(RISE, at)


def _walked(segments: list[Segment], actor: Actor, route: Sequence[Spot], speed: float) -> Actor:
    """Add the way along a route: a turn, then steps; the planted foot stays where it is."""
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
    """Straight from a to b in whole steps, from where the feet are side by side to where they are again."""
    pace = 2 * STEP_LENGTH * actor.body.height * (0.75 if speed < 2 else 1.0)
    steps = max(1, ceil(length / pace))
    stride = length / steps / (2 * STEP_LENGTH * actor.body.height)

    def at(share: float) -> Actor:
        phase = share * steps + 0.5
        number = int(phase)
        side, part = (1.0 if number % 2 == 0 else -1.0), phase - number
        # The planted foot goes back under the body as fast as the body goes on.
        lift = sin(pi * part) * min(1.0, 3 * share * steps, 3 * (1 - share) * steps)
        stance = replace(actor.stance, stride=stride * side * (1 - 2 * part), swing=-side * max(lift, 1e-6))
        return replace(actor, spot=_between(a, b, share), stance=stance)

    return Segment(length / speed, at)


def _blended(one: Actor, other: Actor, seconds: float) -> Segment:
    """From one pose to another."""

    def at(share: float) -> Actor:
        return other if share >= 1 else blend(one, other, _eased(share))

    return Segment(max(seconds, 1e-3), at)


def blend(one: Actor, other: Actor, share: float) -> Actor:
    """Between two poses; from the second's posture on as soon as they differ in that."""
    if one.stance.posture != other.stance.posture:
        return one if share < 0.5 else other
    a, b = one.stance, other.stance
    stance = replace(
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
    return replace(other, spot=_between(one.spot, other.spot, share), level=level, yaw=yaw, stance=stance)


def _hand(one: Actor, other: Actor, side: str, share: float) -> Point | None:
    a, b = ((actor.stance.right if side == "r" else actor.stance.left) for actor in (one, other))
    if (a is None and b is None) or one.stance.posture == "lying":
        return b
    start, end = (at or _hanging(actor, side) for at, actor in ((a, one), (b, other)))
    x, y, z = (p + (q - p) * share for p, q in zip(start, end, strict=True))
    return x, y, z


def _hanging(actor: Actor, side: str) -> Point:
    """Where the hand of an arm at rest is."""
    stance = replace(actor.stance, right=None, left=None)
    x, y, z = Figure(actor.body, stance).joints()[f"hand_{side}"]
    return float(x), float(y), float(z)


def _gaze(one: Actor, other: Actor, share: float) -> Point | None:
    a, b = one.stance.gaze, other.stance.gaze
    if a is None and b is None:
        return None
    ahead = (0.0, 0.88 * other.body.height, 2.0)
    x, y, z = (p + (q - p) * share for p, q in zip(a or ahead, b or ahead, strict=True))
    return x, y, z


def _between(a: Spot, b: Spot, share: float) -> Spot:
    return a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share


def _angle(start: float, end: float) -> float:
    """The shorter way from one direction to another, degrees."""
    return (end - start + 180) % 360 - 180


def _eased(share: float) -> float:
    return (1 - cos(pi * share)) / 2
