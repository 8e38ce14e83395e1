"""Characters through a program: position, posture and body pose after each tick."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import atan2, cos, degrees, radians, sin

from hearth.homes.object_shapes import form
from hearth.rendering.models.appearance import Look
from hearth.rendering.models.class_appearance import choice_of, recipe_of
from hearth.rendering.people.body_pose import BodyPose
from hearth.rendering.people.figure import Figure
from hearth.rendering.people.gestures import gesture_of
from hearth.rendering.people.person_appearance import Body
from hearth.rendering.people.random_people import person
from hearth.rendering.scene.free_poses import Pose
from hearth.rendering.scene.object_boxes import Places
from hearth.rendering.scene.scene_preparation import local_size
from hearth.rendering.scene.standing_places import FreeFloor
from hearth.schemas.graph import Box, EnvironmentGraph, Node, Point, Spot
from hearth.schemas.program import Step
from hearth.schemas.rng import derive
from hearth.schemas.vocabulary import CHARACTER_CATEGORY, ROOM_CATEGORY

ARM = 0.85
"""Greatest distance in metres at which hands are used without a step nearer."""

INTO = 0.6
"""Greatest distance in metres from an open container at which hands are used in it without a step nearer."""

LEANING = 1.2
"""Greatest distance in metres at which who sits uses hands without getting up."""

LONG = 1.5
"""Metres of depth from which on one lies along a thing, as in a bed; on less one lies across it, as on a couch."""

WEARABLE_TOP = ("shirt", "jacket", "dress", "pajamas")


@dataclass(frozen=True, slots=True)
class Actor:
    """One character in one frame.

    Attributes:
        node: the character's.
        body: its appearance.
        spot: (x, z) of its feet (sitting: of its hips; lying: of its middle).
        level: height of the floor there.
        yaw: its direction, degrees from +z towards +x.
        body_pose: posture, hands and gaze.
        room: id of its room.
        place: id of the seat or bed that it uses, or 0.
    """

    node: Node
    body: Body
    spot: Spot
    level: float
    yaw: float
    body_pose: BodyPose
    room: int
    place: int = 0

    @property
    def position(self) -> Point:
        """Its position on the floor, in the world."""
        return self.spot[0], self.level, self.spot[1]

    def local(self, point: Point) -> Point:
        """Return a world point in the figure's frame."""
        x, z = point[0] - self.spot[0], point[2] - self.spot[1]
        c, s = cos(radians(self.yaw)), sin(radians(self.yaw))
        return x * c - z * s, point[1] - self.level, x * s + z * c

    def world(self, point: Point) -> Point:
        """Return a point of the figure's frame in the world."""
        c, s = cos(radians(self.yaw)), sin(radians(self.yaw))
        return (
            self.spot[0] + point[0] * c + point[2] * s,
            self.level + point[1],
            self.spot[1] - point[0] * s + point[2] * c,
        )

    def figure(self) -> Figure:
        """Body and body pose, for drawing."""
        return Figure(self.body, self.body_pose)

    def hand(self, side: str) -> Point:
        """Position of its `right` or `left` palm, in the world."""
        joint = self.figure().joints()[f"palm_{side[0]}"]
        return self.world((float(joint[0]), float(joint[1]), float(joint[2])))


def initial_actors(graph: EnvironmentGraph, floor: FreeFloor, places: Places, seed: int) -> tuple[Actor, ...]:
    """Return the characters of a graph before the first tick, sorted by id."""
    actors: list[Actor] = []
    for number, node in enumerate(n for n in graph.nodes if n.category == CHARACTER_CATEGORY):
        body = person(derive(seed, "body", number))
        room = room_of(graph, node.id)
        spot = _initial(node, room, floor, [a.spot for a in actors])
        actors.append(Actor(node, body, spot, floor.level, node.yaw or 0.0, BodyPose(), room))
    return tuple(_seated(actor, graph, places, None) for actor in actors)


def _initial(node: Node, room: int, floor: FreeFloor, taken: list[Spot]) -> Spot:
    """Return the free spot nearest to the character's box if that is in its room.

    Else the middle of the room's free floor.
    """
    if node.box:
        x, z = node.box.center[0], node.box.center[2]
        near = next(floor.spots_for(node.box, None, room, (x, z), taken), None)
        if near is not None and abs(near[0] - x) + abs(near[1] - z) < 1.2:
            return (x, z) if not taken else near
    return floor.spot_in(room, taken) or ((node.box.center[0], node.box.center[2]) if node.box else (0.0, 0.0))


def room_of(graph: EnvironmentGraph, node_id: int) -> int:
    """Return the id of the room a node is INSIDE, or 0."""
    rooms = {node.id for node in graph.nodes if node.category == ROOM_CATEGORY}
    return next(
        (e.target for e in graph.edges if e.source == node_id and e.relation == "INSIDE" and e.target in rooms), 0
    )


def moved(
    actor: Actor, graph: EnvironmentGraph, places: Places, floor: FreeFloor, step: Step | None, others: list[Spot]
) -> Actor:
    """Return the character at the position where it performs a step, hands in default pose.

    The actor is seated if the graph says so, and gets up only for objects that its hands cannot reach from there.
    """
    room = room_of(graph, actor.node.id) or actor.room
    if _states(graph, actor.node.id) & {"SITTING", "LYING"}:
        actor = _seated(replace(actor, room=room), graph, places, step)
        if not _out_of_reach(actor, places, step):
            return actor
    if actor.place:
        actor = _risen(actor, places, floor, others)
    actor = replace(actor, body_pose=BodyPose(), place=0)
    goes = room != actor.room or gesture_of(step).stride > 0
    target = _goal(step)
    pose, front = reachable(target, places) if target and target != room else (None, None)
    if pose is None:
        stays = (floor.spot_in(room, others) if goes else None) or actor.spot
        yaw = floor.outlook(stays, actor.yaw) if gesture_of(step).hand == "read" else actor.yaw
        return replace(actor, spot=stays, yaw=yaw, room=room)
    acts = step is not None and (gesture_of(step).near or step.action == "Find")
    top, within = outermost(target, places)[0], _within(target, step, places)
    moves = acts and (_gap(actor.spot, pose.box) > (INTO if within else ARM) or _hinders(actor, step, floor, top))
    if goes or moves:
        there = room_of(graph, target) or room
        now = actor.spot if there == actor.room else None
        spot = next(floor.spots_for(pose.box, front, there, now, others, top, still=_still(step)), None)
        actor = replace(actor, spot=spot or actor.spot, room=there)
        if gesture_of(step).enters:
            return replace(actor, spot=(pose.box.center[0], pose.box.center[2]))
    return replace(actor, yaw=_towards(actor.spot, pose.box.center, actor.yaw))


def elsewhere(
    actor: Actor, graph: EnvironmentGraph, places: Places, floor: FreeFloor, step: Step, others: list[Spot]
) -> Iterator[Actor]:
    """Yield the character at other spots from which it can act, best first."""
    target = _goal(step)
    pose, front = reachable(target, places) if target else (None, None)
    if pose is None:
        return
    room, top = room_of(graph, target) or actor.room, outermost(target, places)[0]
    for spot in floor.spots_for(pose.box, front, room, actor.spot, others, top, still=_still(step)):
        if _gap(spot, pose.box) < ARM:
            yield replace(actor, spot=spot, yaw=_towards(spot, pose.box.center, actor.yaw), room=room)


def _within(target: int, step: Step | None, places: Places) -> bool:
    """Return whether hands go into a container that stands open."""
    gesture = gesture_of(step)
    top, inside = outermost(target, places)
    return gesture.into and (inside or gesture.about > 0) and "OPEN" in _states(places.graph, top)


def _hinders(actor: Actor, step: Step | None, floor: FreeFloor, top: int) -> bool:
    """Return whether somebody stands where the doors swing that it opens or closes."""
    return gesture_of(step).swings and floor.in_the_way(actor.spot, top)


def _still(step: Step | None) -> bool:
    """Return whether doors stay as they are: a person that only walks to a thing may open it next."""
    return gesture_of(step).near and not gesture_of(step).swings


def _out_of_reach(seated: Actor, places: Places, step: Step | None) -> bool:
    """Return whether a step needs hands at something that is not at a seat."""
    target = _goal(step)
    pose, _ = reachable(target, places) if target and gesture_of(step).near else (None, None)
    return pose is not None and _gap(seated.spot, pose.box) > LEANING


def _goal(step: Step | None) -> int:
    """Return the object that hands or gaze go to in a step; 0 for none."""
    if step is None or not step.objects:
        return 0
    return step.objects[min(gesture_of(step).about, len(step.objects) - 1)].node or 0


def _risen(actor: Actor, places: Places, floor: FreeFloor, others: list[Spot]) -> Actor:
    """Return the actor standing in front of the seat that it used, or next to the bed, with the back to it."""
    pose, lay = places.poses.get(actor.place), actor.body_pose.posture == "lying"
    front = (open_side(pose) if lay else pose.yaw) if pose else None
    spot = next(floor.spots_for(pose.box, front, actor.room, actor.spot, others), None) if pose else None
    if lay and spot is not None:
        actor = replace(actor, yaw=_towards(actor.spot, (spot[0], 0.0, spot[1]), actor.yaw))
    return replace(actor, spot=spot or actor.spot)


def open_side(pose: Pose) -> float | None:
    """Return the direction of the front of a couch, the only side from which one lies down there; None for beds."""
    yaw = pose.yaw or 0.0
    return None if local_size(pose.box.size, yaw)[2] >= LONG else yaw


def reachable(node_id: int, places: Places) -> tuple[Pose | None, float | None]:
    """Return the pose of a thing, and the direction of its front, or of its container's front."""
    pose = places.poses.get(node_id)
    top, inside = outermost(node_id, places)
    outer = places.poses.get(top)
    if pose is None:
        return outer, outer.yaw if outer else None
    return (outer if inside and outer else pose), (outer.yaw if outer else pose.yaw)


def outermost(node_id: int, places: Places) -> tuple[int, bool]:
    """Return the outermost support or container of a thing (itself if it has none), and whether it is inside any."""
    top, inside = node_id, False
    for _ in range(6):
        location = places.locations.get(top)
        if location is None or location.kind not in ("on", "inside"):
            break
        if location.holder not in places.poses or location.holder in places.building:
            break
        inside |= location.kind == "inside"
        top = location.holder
    return top, inside


def _seated(actor: Actor, graph: EnvironmentGraph, places: Places, step: Step | None) -> Actor:
    """Return the actor on the seat or bed that the graph gives; unchanged if it gives none."""
    states = _states(graph, actor.node.id)
    seat = _seat(actor, graph, step)
    pose = places.poses.get(seat)
    if not states & {"SITTING", "LYING"}:
        return actor
    if pose is None:
        return replace(actor, body_pose=BodyPose("sitting", 0.45))
    node = next(n for n in graph.nodes if n.id == seat)
    yaw, size = pose.yaw or 0.0, local_size(pose.box.size, pose.yaw or 0.0)
    foot = pose.box.center[1] - pose.box.size[1] / 2
    known = form(node.class_name, places.knowledge)
    level = known.levels[0] if known and known.levels and known.levels[0] < size[1] else 0.0
    region = recipe_of(node.class_name, places.knowledge).on(Look(size, level=level))[0]
    frame = replace(actor, spot=(pose.box.center[0], pose.box.center[2]), level=foot, yaw=yaw, place=seat)
    seat_height = foot - actor.level + region.y
    if choice_of(node.class_name, places.knowledge).recipe == "bathtub":
        # In a bathtub one sits, with the back at the end without the tap and the knees drawn up.
        turn, rests = (-90.0 if size[0] >= size[2] else 0.0), BodyPose("sitting", seat_height)
        at = (size[0] / 2 - BACK, 0.0, 0.0) if turn else (0.0, 0.0, BACK - size[2] / 2)
    elif "LYING" in states:
        turn = 0.0 if size[2] >= LONG else 90.0
        side = size[0] * -0.22 if size[0] > 1.25 and size[2] >= LONG else 0.0
        at, rests = (side, 0.0, 0.0), BodyPose("lying", seat_height)
    elif size[2] >= LONG and size[0] > 0.85:
        # Sitting on the side of a bed, feet on the floor.
        at, turn, rests = (size[0] / 2 - 0.2, 0.0, 0.15), 90.0, BodyPose("sitting", seat_height)
    else:
        middle = (region.x0 + region.x1) / 2
        free = [middle, region.x0 + 0.35, region.x1 - 0.35] if region.x1 - region.x0 > 1.0 else [middle]
        across = min(free, key=lambda x: _crowd(frame.world((x, 0, 0)), places, seat))
        at, turn, rests = (across, 0.0, _depth(region.z0, region.z1)), 0.0, BodyPose("sitting", seat_height)
    x, _, z = frame.world(at)
    return replace(actor, spot=(x, z), yaw=yaw + turn, place=seat, body_pose=rests)


BACK = 0.42
"""Distance from the end of a bathtub to the hips of a person sitting in it, metres."""


def _depth(z0: float, z1: float) -> float:
    return min((z0 + z1) / 2, z1 - 0.22) if z1 - z0 > 0.5 else (z0 + z1) / 2 - 0.02


def _crowd(at: Point, places: Places, seat: int) -> float:
    """Return the number of things on a seat near a point."""
    on = [
        places.poses[i].box.center
        for i, location in places.locations.items()
        if location.holder == seat and location.kind == "on" and i in places.poses
    ]
    return sum(1.0 for center in on if abs(center[0] - at[0]) + abs(center[2] - at[2]) < 0.5)


def _states(graph: EnvironmentGraph, node_id: int) -> frozenset[str]:
    return frozenset(next((node.states for node in graph.nodes if node.id == node_id), ()))


def _seat(actor: Actor, graph: EnvironmentGraph, step: Step | None) -> int:
    """Return the seat or bed in use. A character stays ON a seat after it stands up, so step and posture decide."""
    on = sorted(e.target for e in graph.edges if e.source == actor.node.id and e.relation == "ON")
    named = _goal(step) if gesture_of(step).rests else actor.place
    return named if named in on else next(iter(on), 0)


def _gap(spot: Spot, box: Box) -> float:
    """Metres from a spot to a box's footprint."""
    dx = max(abs(spot[0] - box.center[0]) - box.size[0] / 2, 0)
    dz = max(abs(spot[1] - box.center[2]) - box.size[2] / 2, 0)
    return float((dx * dx + dz * dz) ** 0.5)


def _towards(spot: Spot, point: Point, usual: float) -> float:
    dx, dz = point[0] - spot[0], point[2] - spot[1]
    return degrees(atan2(dx, dz)) if abs(dx) + abs(dz) > 1e-3 else usual


def dressed_for(body: Body, graph: EnvironmentGraph, me: int) -> Body:
    """Return the body in the colours of its worn clothes."""
    classes = {node.id: node.class_name for node in graph.nodes}
    for edge in sorted(e for e in graph.edges if e.target == me and e.relation == "ON"):
        name = classes.get(edge.source, "")
        color = ("#4a6f9a", "#b5564a", "#5f8a5a", "#d8b04a")[derive(edge.source, "worn") % 4]
        if any(part in name for part in WEARABLE_TOP):
            body = replace(body, top=color, weave="stripes" if "pajamas" in name else "fabric")
        elif "pants" in name:
            body = replace(body, bottom=color, skirt=False)
        elif "shoes" in name or "slippers" in name:
            body = replace(body, shoes=color)
    return body
