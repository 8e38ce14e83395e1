"""Holding things: at which point and with which grip, and where held things are."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import lru_cache
from math import cos, radians, sin
from typing import Any, NamedTuple

import numpy as np

from hearth.rendering.models.appearance import Look
from hearth.rendering.models.class_appearance import Model, choice_of
from hearth.rendering.models.mesh import rotation
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.body_pose import Held
from hearth.rendering.people.headwear import WORN, on_head
from hearth.rendering.people.rotations import Vector
from hearth.rendering.scene.instances import Thing, own_mesh, tilted
from hearth.rendering.scene.object_boxes import Places
from hearth.rendering.scene.scene_preparation import PreparedScene
from hearth.schemas.graph import Box, Node, Point
from hearth.schemas.yaml_limits import packaged

HOLDS: Mapping[str, Mapping[str, Any]] = packaged("hearth.rendering.people", "holding.yaml")
"""Ways of holding models, by recipe. To add one: a row of `holding.yaml`."""

BROAD, SMALL, THIN = 0.25, 0.06, 0.035
"""Metres: widths from which things are held with both hands, up to which between fingers; height of sheets."""

PALMS: Mapping[str, Point] = {
    "handle": (-1.0, 0.0, 0.1), "body": (-1.0, 0.0, 0.15), "rim": (-0.5, 0.85, 0.0), "pinch": (-0.75, -0.6, 0.2),
    "sheet": (-0.5, 0.85, 0.0), "two hands": (-1.0, 0.1, 0.15),
}  # fmt: skip
"""Direction of the right palm by grip."""

CARRIED: Mapping[str, Point] = {
    "handle": (0.12, 0.665, 0.235), "body": (0.11, 0.67, 0.235), "rim": (0.12, 0.64, 0.23),
    "pinch": (0.11, 0.67, 0.235), "sheet": (0.12, 0.655, 0.225), "two hands": (0.0, 0.6, 0.15),
}  # fmt: skip
"""Positions of the right palm while a thing is carried, by grip, as shares of the person's height."""


class Hold(NamedTuple):
    """A hand's grip of a thing.

    Attributes:
        grip: form of the fingers.
        point: its grip point in its own frame, foot in the origin, metres.
        turn: its direction in the hand, degrees from the person's own.
        palm: direction in which the palm looks, in the person's frame.
        carry: where the palm is while it is carried, as shares of the person's height.
        fixed: whether it is held at this point only, such as a handle.
    """

    grip: str
    point: Point
    turn: float
    palm: Point
    carry: Point
    fixed: bool

    @property
    def both(self) -> bool:
        """Return whether both hands hold it, if they are free."""
        return self.grip == "two hands"


@lru_cache(maxsize=4096)
def hold_of(recipe: str, size: Point, side: str) -> Hold:
    """Return how a thing of a recipe and a size in metres is held by the `right` or `left` hand."""
    row = HOLDS.get(recipe) or _by_size(size)
    left, grip = side == "left", row["grip"]
    x, y, z = row["at"]
    x = 1 - x if left and row.get("mirror") == "at" else x
    turn = row.get("turn", 0) + (180.0 if left and row.get("mirror") == "turn" else 0.0)
    palm, carry = row.get("palm", PALMS[grip]), row.get("carry", CARRIED[grip])
    sign = -1.0 if left else 1.0
    w, h, d = size
    if grip == "two hands":
        carry = (0.0, carry[1], carry[2])
    return Hold(
        grip, ((x - 0.5) * w, y * h, (z - 0.5) * d), turn, (sign * palm[0], palm[1], palm[2]),
        (sign * carry[0], carry[1], carry[2]), row.get("mirror") != "at",
    )  # fmt: skip


def _by_size(size: Point) -> Mapping[str, Any]:
    w, h, d = size
    if h > 1.0 and max(w, d) < 0.5:
        return {"grip": "handle", "at": (0.5, 0.7, 0.5)}
    if max(w, d) > BROAD:
        return {"grip": "two hands", "at": (1.0, 0.45, 0.5), "mirror": "at"}
    if h < THIN:
        return {"grip": "sheet", "at": (0.98, 0.5, 0.4), "mirror": "at"}
    if max(size) < SMALL:
        return {"grip": "pinch", "at": (0.95, 0.6, 0.5), "mirror": "at"}
    return {"grip": "body", "at": (1.0, 0.5, 0.5), "mirror": "at"}


def hold_of_node(node: Node, places: Places, side: str) -> Hold:
    """Return how a node of the graph is held."""
    return hold_of(choice_of(node.class_name, places.knowledge).recipe, places.size_of(node), side)


def grip_point(hold: Hold, box: Box, yaw: float) -> Point:
    """Return the grip point in the world of a thing that stands somewhere."""
    c, s = cos(radians(yaw)), sin(radians(yaw))
    (x, y, z), (px, py, pz) = box.center, hold.point
    return x + px * c + pz * s, y - box.size[1] / 2 + py, z - px * s + pz * c


def held_things(prepared: PreparedScene, places: Places, actors: tuple[Actor, ...]) -> dict[int, tuple[Thing, ...]]:
    """Return the drawn things that hands hold and heads wear, their contents, and the liquid that pours out of them, by
    id.
    """
    nodes = {node.id: node for node in places.graph.nodes}
    found: dict[int, tuple[Thing, ...]] = {}
    for actor in actors:
        for node, side in places.holds.get(actor.node.id, {}).items():
            found[node] = tuple(_in_hand(prepared, places, actor, nodes[node], side))
            found |= _contents(prepared, places, nodes[node], found[node][0], nodes) if found[node] else {}
        for edge in places.graph.edges:
            if edge.target == actor.node.id and edge.relation == "ON" and nodes[edge.source].class_name in WORN:
                found[edge.source] = tuple(on_head(prepared, places, actor, nodes[edge.source]))
    return found


def _contents(
    prepared: PreparedScene, places: Places, vessel: Node, drawn: Thing, nodes: Mapping[int, Node]
) -> dict[int, tuple[Thing, ...]]:
    """Return the drawn things that are in and on one, by id."""
    found: dict[int, tuple[Thing, ...]] = {}
    turn = rotation("y", drawn.yaw) @ tilted(drawn.tilt)
    for number, pose in places.packed.get(vessel.id, {}).items():
        still = prepared.things(replace(nodes[number], box=pose.box, yaw=pose.yaw))
        things: list[Thing] = []
        for thing in still:
            x, y, z = (np.array(drawn.position) + turn @ np.array(thing.position)).tolist()
            things.append(replace(thing, position=(x, y, z), yaw=drawn.yaw, tilt=drawn.tilt))
        found[number] = tuple(things)
        found |= _contents(prepared, places, nodes[number], things[0], nodes) if things else {}
    return found


def _in_hand(prepared: PreparedScene, places: Places, actor: Actor, node: Node, side: str) -> Iterator[Thing]:
    hold, held = hold_of_node(node, places, side), actor.body_pose.hand(side[0]).held
    tilt = (held.pitch, held.roll, hold.turn + held.turn)
    turn = tilted(tilt)
    palm = actor.figure().joints()[f"palm_{side[0]}"] + np.array(held.gap)
    opened = tuple(sorted({*node.states, "OPEN"} - {"CLOSED"})) if held.opens else node.states
    for thing in prepared.at_origin(replace(node, states=opened), places.size_of(node)):
        assert isinstance(thing.model, Model)
        point = nearest_surface(thing.model, hold.point)
        x, y, z = (palm - turn @ (np.array(point) - thing.position)).tolist()
        yield replace(thing, position=actor.world((x, y, z)), yaw=actor.yaw, tilt=tilt)
    if held.stream is not None:
        yield from _stream(prepared, actor, node, hold, held, palm, places.size_of(node))


@lru_cache(maxsize=1024)
def nearest_surface(model: Model, point: Point) -> Point:
    """Return the point of a model's surface nearest to a point of its frame."""
    corners = own_mesh(Thing(0, "", model)).corners.astype(np.float64)
    a, b, c = (corners[:, k] for k in range(3))
    best, least = point, np.inf
    for u in np.linspace(0, 1, 7):
        for v in np.linspace(0, 1 - u, 7):
            at = a + (b - a) * u + (c - a) * v
            far = np.linalg.norm(at - point, axis=1)
            k = int(far.argmin())
            if far[k] < least:
                best, least = (float(at[k, 0]), float(at[k, 1]), float(at[k, 2])), float(far[k])
    return best


POURED = {"water": "#bcd8ea", "milk": "#f4f1ea", "juice": "#e8a13a", "wine": "#6a1f2e", "coffee": "#4a3020",
          "tea": "#9a5a2a", "oil": "#d8b84a", "cereal": "#c89a58", "rice": "#efe9da", "sugar": "#f4f2ee",
          "salt": "#f4f2ee", "soap": "#7ab0d8", "detergent": "#5a8ac8", "shampoo": "#8ac0a8"}  # fmt: skip
"""Colours of poured liquids, by parts of the names of classes; water for others."""


def _stream(
    prepared: PreparedScene, actor: Actor, node: Node, hold: Hold, held: Held, palm: Vector, size: Point
) -> Iterator[Thing]:
    """Yield the stream that pours from the lip of a tilted thing."""
    lip = palm + tilted((held.pitch, held.roll, 0.0)) @ _lip(hold, held, size)
    assert held.stream is not None
    high = float(lip[1] - held.stream[1])
    if high > 0.01:
        color = next((c for part, c in POURED.items() if part in node.class_name), POURED["water"])
        model = Model("liquid", Look((0.014, high, 0.014), color=color))
        x, y, z = float(lip[0]), float(lip[1]) - high, float(lip[2])
        yield Thing(node.id, node.class_name, model, actor.world((x, y, z)), actor.yaw)


def _lip(hold: Hold, held: Held, size: Point) -> Vector:
    """From the grip point to the lip from which is poured, before the thing is tilted."""
    turn = tilted((0.0, 0.0, hold.turn + held.turn))
    side = np.array((np.sign(held.roll) * 0.42 * min(size[0], size[2]), size[1] * 0.97, 0.0))
    found: Vector = side - turn @ np.array(hold.point)
    return found
