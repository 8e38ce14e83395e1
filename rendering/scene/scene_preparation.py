"""From an environment graph to a scene: models, positions and lights."""

from collections.abc import Hashable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import cos, radians, sin

from hearth.homes.object_shapes import form
from hearth.kb.knowledge import Knowledge
from hearth.rendering.models.appearance import Look, Size
from hearth.rendering.models.class_appearance import Model, choice_of, model_of
from hearth.rendering.models.model_recipes import RECIPES
from hearth.rendering.models.paint import linear
from hearth.rendering.people.figure import Figure
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.lights import LAMP_COLOR, SPILL, Daylight, Light, LinearColor, daylight, lamp, window
from hearth.rendering.scene.room_shell import OPENINGS, around_openings, hung_doors, walls_of
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.visible_state_effects import light_point, shining
from hearth.schemas.graph import Box, EnvironmentGraph, Node, Point, Spot
from hearth.schemas.rng import derive
from hearth.schemas.vocabulary import CHARACTER_CATEGORY, ROOM_CATEGORY
from hearth.schemas.yaml_limits import packaged

UNSEEN = (ROOM_CATEGORY, CHARACTER_CATEGORY, "BodyParts")
"""Categories that are not drawn as objects; characters are drawn as figures."""

BUILDING = ("floor", "wall", "ceiling")

LIQUIDS: dict[str, str] = packaged("hearth.rendering.scene", "liquids.yaml")
"""Classes that fill the vessel that they are INSIDE, and their colours."""

SURFACE = 0.004
"""Height of the box of a liquid in a vessel: only its surface is drawn."""


@dataclass(frozen=True, eq=False)
class PreparedScene:
    """A graph, prepared for making many scenes of it.

    Attributes:
        graph: the home, with boxes.
        knowledge: for classes without a recipe of their own.
        seed: decides colours and variants.
        hour: of the day, 0 to 24.
    """

    graph: EnvironmentGraph
    knowledge: Knowledge
    seed: int = 0
    hour: float = 10.0
    _drawn: dict[Hashable, tuple[tuple[Thing, ...], tuple[Light, ...]]] = field(default_factory=dict, repr=False)

    @cached_property
    def day(self) -> Daylight:
        """Sun and sky."""
        return daylight(self.hour)

    @cached_property
    def rooms(self) -> dict[int, Node]:
        """Rooms by id."""
        return {node.id: node for node in self.graph.nodes if node.category == ROOM_CATEGORY}

    @cached_property
    def room_of(self) -> dict[int, int]:
        """Node id -> id of the room it is INSIDE."""
        return {e.source: e.target for e in self.graph.edges if e.relation == "INSIDE" and e.target in self.rooms}

    @cached_property
    def laden(self) -> frozenset[int]:
        """Nodes that something is ON or INSIDE."""
        return frozenset(e.target for e in self.graph.edges if e.relation in ("ON", "INSIDE"))

    @cached_property
    def sunk(self) -> dict[int, Box]:
        """Counter id -> box of the basin that is sunk into it."""
        nodes = {node.id: node for node in self.graph.nodes}
        found = {}
        for edge in self.graph.edges:
            source, target = nodes.get(edge.source), nodes.get(edge.target)
            if edge.relation not in ("ON", "INSIDE") or not (source and target and source.box and target.box):
                continue
            if source.class_name == "sink" and choice_of(target.class_name, self.knowledge).recipe == "counter":
                found[target.id] = source.box
        return found

    @cached_property
    def jambs(self) -> tuple[Node, ...]:
        """The doorways."""
        return tuple(node for node in self.graph.nodes if node.class_name == "doorjamb" and node.box)

    @cached_property
    def hung(self) -> frozenset[int]:
        """The doors that hang in doorways."""
        return hung_doors(self.graph.nodes)

    @cached_property
    def openings(self) -> tuple[Box, ...]:
        """Boxes of doors and windows in walls."""
        return tuple(node.box for node in self.graph.nodes if node.class_name in OPENINGS and node.box)

    def seed_of(self, node: Node) -> int:
        """Return the seed of a node's colours; furniture of one class in one room has the same."""
        if (
            node.category in ("Furniture", "Doors", "Windows", "Walls", "Floor", "Ceiling")
            or "curtain" in node.class_name
        ):
            return derive(self.seed, "look", self.room_of.get(node.id, 0), node.class_name)
        return derive(self.seed, "look", node.id)

    def scene(
        self, nodes: Iterable[Node] | None = None, figures: Iterable[tuple[Node, Figure, Point, float]] = ()
    ) -> Scene:
        """Return the scene of a keyframe.

        Args:
            nodes: the graph's nodes with their current boxes, yaws and states; None takes those of the graph. A node
                without a box is not drawn.
            figures: for each character its node, figure, position on the floor and yaw.
        """
        present = [
            node for node in (self.graph.nodes if nodes is None else nodes) if node.box and node.category not in UNSEEN
        ]
        drawn = [self._remembered(node) for node in present]
        people = tuple(Thing(node.id, node.class_name, pose, place, yaw) for node, pose, place, yaw in figures)
        things = tuple(thing for found, _ in drawn for thing in found)
        lights = tuple(light for _, found in drawn for light in found)
        return Scene(things + self.walls + people, lights, self.day)

    @cached_property
    def walls(self) -> tuple[Thing, ...]:
        """Walls, floors and ceilings that the graph lacks."""
        return tuple(walls_of(self.graph, tuple(self.rooms.values())))

    def _remembered(self, node: Node) -> tuple[tuple[Thing, ...], tuple[Light, ...]]:
        """Return a node's things and lights, cached: most nodes are the same in most scenes."""
        key = (node.id, node.class_name, node.states, node.box, node.yaw)
        found = self._drawn.get(key)
        if found is None:
            found = self._drawn[key] = tuple(self.things(node)), tuple(self.lights(node))
        return found

    def at_origin(self, node: Node, size: Point) -> Iterator[Thing]:
        """Return the things that draw a node of a size that stands at the origin, as it is held or worn."""
        return self.things(replace(node, box=Box((0.0, size[1] / 2, 0.0), size), yaw=0.0))

    def things(self, node: Node, ajar: float = 1.0) -> Iterator[Thing]:
        """Yield the things that draw a node; `ajar` is its opening share if it is OPEN."""
        if node.box is None:
            return
        room = self.rooms.get(self.room_of.get(node.id, -1))
        choice = choice_of(node.class_name, self.knowledge)
        parts = around_openings(node.box, self.openings) if choice.recipe == "wall" else [node.box]
        if parts != [node.box]:
            for part in parts:
                yield from self.things(replace(node, box=part))
            return
        box, yaw = node.box, node.yaw or 0.0
        turned = self._leaf(box, 0.0 if "CLOSED" in node.states else ajar) if node.id in self.hung else None
        if turned:
            box, yaw = turned
        building = choice.recipe in BUILDING
        if building:
            yaw = 0.0
        size = box.size if turned else local_size(box.size, yaw)
        more: dict[str, object] = {"level": self._level(node.class_name, size[1]), "ajar": round(ajar, 4)}
        if building and room:
            more["kind"] = room.class_name
        elif choice.recipe == "bookshelf" and node.id in self.laden:
            more["kind"] = "bare"
        elif choice.recipe == "counter" and node.id in self.sunk:
            more["hole"] = _local_hole(self.sunk[node.id], box, yaw)
        poured = node.class_name in LIQUIDS and size[1] <= SURFACE
        seed = derive(self.seed, "look", room.id, "walls") if building and room else self.seed_of(node)
        model = model_of(node.class_name, size, frozenset(node.states), seed, self.knowledge, **more)
        if poured:
            model = Model("liquid", Look(size, color=LIQUIDS[node.class_name]))
        (x, y, z), h = box.center, box.size[1]
        above = choice.recipe in ("ceiling", "ceiling_lamp", "ceiling_fan")
        shining = RECIPES[choice.recipe].lamp is not None and "ON" in node.states
        yield Thing(node.id, node.class_name, model, (x, y - h / 2, z), yaw, above, building, shining)

    def lights(self, node: Node) -> Iterator[Light]:
        """Yield the lights of a node."""
        if node.box is None:
            return
        choice = choice_of(node.class_name, self.knowledge)
        room, bulb = self.rooms.get(self.room_of.get(node.id, -1)), RECIPES[choice.recipe].lamp
        for shine, up in shining(choice.recipe, frozenset(node.states), bulb):
            bounds = _bounds(room.box) if room and room.box else None
            spill = 0.0 if self.day.sun else SPILL
            color = _linear(shine.color) if shine.color else LAMP_COLOR
            yield lamp(light_point(shine, up, node.box, node.yaw or 0.0), shine.strength, bounds, spill, color)
        if choice.recipe == "window" and room and room.box and node.yaw is not None:
            facing = (sin(radians(node.yaw)), 0.0, cos(radians(node.yaw)))
            yield window(node.box.center, node.box.size, _rounded(facing), _bounds(room.box), self.day)

    def _level(self, class_name: str, height: float) -> float:
        """Height of the supporting surface if the class's form gives one below the top, else 0."""
        known = form(class_name, self.knowledge)
        if known is None or not known.levels or known.levels[0] >= height:
            return 0.0
        return known.levels[0]

    def _leaf(self, leaf: Box, share: float) -> tuple[Box, float] | None:
        """Center, size in its own frame and yaw of a partly open door leaf; None without a doorway.

        Its own +x points away from the hinge.
        """
        closed = self._closed_leaf(leaf)
        if closed is None:
            return None
        width, thick = (f(leaf.size[0], leaf.size[2]) for f in (max, min))
        width = width if share else max(closed.size[0], closed.size[2])
        hung, one, other = _hinge(closed, leaf)
        hinge = [a + (b - a) * share for a, b in zip(*hung, strict=True)]
        angle = one + ((other - one + 180) % 360 - 180) * share
        x, z = cos(radians(angle)) * width / 2, sin(radians(angle)) * width / 2
        center = (hinge[0] + x, leaf.center[1] - 0.025 * (1 - share), hinge[1] + z)
        return Box(center, (width, leaf.size[1], thick)), round(-angle, 4)

    def _closed_leaf(self, leaf: Box) -> Box | None:
        """Return the box of a closed door leaf, in the nearest doorway."""
        if not self.jambs:
            return None
        jamb = min(self.jambs, key=lambda node: _distance(node.box, leaf) if node.box else 1e9)
        if jamb.box is None or _distance(jamb.box, leaf) > 1.0:
            return None
        (w, _, d), (x, _, z) = jamb.box.size, jamb.box.center
        height, thick = leaf.size[1], min(leaf.size[0], leaf.size[2])
        size = (w - 0.1, height - 0.05, thick) if w > d else (thick, height - 0.05, d - 0.1)
        return Box((x, leaf.center[1] - 0.025, z), size)


def prepared_scene(
    graph: EnvironmentGraph, knowledge: Knowledge, *, seed: int = 0, hour: float = 10.0
) -> PreparedScene:
    """Return a graph prepared for rendering."""
    return PreparedScene(graph, knowledge, seed, hour)


def scene_of(graph: EnvironmentGraph, knowledge: Knowledge, *, seed: int = 0, hour: float = 10.0) -> Scene:
    """Return the scene of a graph as it is. Nodes without a box are not drawn.

    Args:
        graph: with boxes, yaws and states.
        knowledge: of the classes.
        seed: decides colours and variants.
        hour: of the day, 0 to 24.
    """
    return prepared_scene(graph, knowledge, seed=seed, hour=hour).scene()


def local_size(size: Size, yaw: float) -> Size:
    """Return the size of a thing in its own frame, from its axis-aligned box in the world and its yaw."""
    w, h, d = size
    c, s = abs(cos(radians(yaw))), abs(sin(radians(yaw)))
    if s < 0.02:
        return size
    if c < 0.02:
        return d, h, w
    # The box of a turned rectangle: X = a c + b s, Z = a s + b c; near 45 degrees a and b can't be solved for.
    det = c * c - s * s
    if abs(det) < 0.2:
        side = min(w, d) / (c + s)
        return side, h, side
    a, b = (w * c - d * s) / det, (d * c - w * s) / det
    return max(a, 0.02), h, max(b, 0.02)


def liquid(node: Node, vessel: Box) -> Node:
    """Return a liquid's node with the box of its surface in a vessel."""
    (x, y, z), (w, h, d) = vessel.center, vessel.size
    side = min(w, d) * 0.72
    return replace(node, box=Box((x, y + h * 0.24, z), (side, SURFACE, side)))


def _hinge(closed: Box, leaf: Box) -> tuple[tuple[Spot, Spot], float, float]:
    """Return the hinge (x, z) of a door, and the leaf's directions from there, degrees: closed and open."""
    ends = []
    for box in (closed, leaf):
        along = 0 if box.size[0] >= box.size[2] else 2
        ends.append([(sign, along, _end(box, along, sign)) for sign in (-1, 1)])
    pairs = [(one, other) for one in ends[0] for other in ends[1]]
    one, other = min(pairs, key=lambda pair: abs(pair[0][2][0] - pair[1][2][0]) + abs(pair[0][2][1] - pair[1][2][1]))
    ways = [(90.0 if along else 0.0) + (180.0 if sign > 0 else 0.0) for sign, along, _ in (one, other)]
    return (one[2], other[2]), ways[0], ways[1]


def _end(box: Box, along: int, sign: int) -> Spot:
    """(x, z) of one end of a door leaf."""
    x, z = box.center[0], box.center[2]
    half = sign * box.size[along] / 2
    return (x + half, z) if along == 0 else (x, z + half)


def _local_hole(basin: Box, counter: Box, yaw: float) -> tuple[float, float, float, float]:
    """Return the basin's outline in the counter's frame, without its rim."""
    dx, dz = basin.center[0] - counter.center[0], basin.center[2] - counter.center[2]
    c, s = cos(radians(yaw)), sin(radians(yaw))
    x, z = dx * c - dz * s, dx * s + dz * c
    w, _, d = local_size(basin.size, yaw)
    return tuple(round(v, 4) for v in (x - w / 2 + 0.01, x + w / 2 - 0.01, z - d / 2 + 0.01, z + d / 2 - 0.01))  # type: ignore[return-value]


def _bounds(box: Box) -> tuple[float, float, float, float]:
    (x, _, z), (w, _, d) = box.center, box.size
    return x - w / 2 - 0.07, x + w / 2 + 0.07, z - d / 2 - 0.07, z + d / 2 + 0.07


def _linear(color: str) -> LinearColor:
    red, green, blue = (float(value) for value in linear(color))
    return red, green, blue


def _rounded(direction: Point) -> Point:
    x, y, z = (round(value, 6) + 0.0 for value in direction)
    return x, y, z


def _distance(a: Box | None, b: Box) -> float:
    if a is None:
        return 1e9
    return max(
        max(abs(p - q) - (s + t) / 2, 0) for p, q, s, t in zip(a.center, b.center, a.size, b.size, strict=True)
    ) + 0.01 * sum(abs(p - q) for p, q in zip(a.center, b.center, strict=True))
