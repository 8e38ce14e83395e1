"""The scene that clients of the Unity protocol share: a home, its characters, its cameras, the hour."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from hearth.homes import library
from hearth.homes.procedural.home_generator import generate
from hearth.homes.scene_graph import scene as scene_of_layout
from hearth.interop.virtualhome.graph_exchange import GraphChange, change_between, read_graph, unity_graph
from hearth.interop.virtualhome.scene_cameras import (
    OWN_MOUNTS,
    Mount,
    Surroundings,
    check_indices,
    fixed_cameras,
    of_size,
    on_person,
)
from hearth.interop.virtualhome.unity_class_names import means
from hearth.kb.knowledge import Knowledge
from hearth.rendering.cameras.camera import Camera
from hearth.rendering.film.followed_scene import FollowedScene
from hearth.rendering.scene.free_poses import Pose as LyingPose
from hearth.rendering.scene.home_geometry import with_geometry
from hearth.rendering.scene.scene import Scene
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failure_words import sentence
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge, EnvironmentGraph, Node, Point
from hearth.schemas.program import Step
from hearth.schemas.rng import rng
from hearth.schemas.vocabulary import CHARACTER_CATEGORY, CHARACTER_CLASS, ROOM_CATEGORY
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.motion.positions import placed
from hearth.simulation.rules import EVOLVING_GRAPH, Rules
from hearth.simulation.world.edit import edit, free_id
from hearth.simulation.world.home import Home
from hearth.simulation.world.pose import Pose
from hearth.simulation.world.world import World

RULES: Rules = EVOLVING_GRAPH._replace(leaves_seat=True)
"""The rules of VirtualHome 2.x; a character that stands up leaves its seat, as in Unity's pictures."""

MOST_CHARACTERS = 10
"""Characters of a scene."""

GENERATED_ROOMS = 5
"""Rooms of a generated home."""


@dataclass(frozen=True)
class Homes:
    """The homes that clients reset to, by number: the library's in the order of their names.

    Attributes:
        names: by number.
        knowledge: of their classes.
        folder: of the user's own homes, or None.
    """

    names: tuple[str, ...]
    knowledge: Knowledge
    folder: Any = None

    @classmethod
    def of_library(cls, knowledge: Knowledge, folder: Any = None) -> Homes:
        """Return our homes, and those of a folder."""
        return cls(library.names(folder), knowledge, folder)

    def graph(self, number: int) -> tuple[str, EnvironmentGraph]:
        """Return the name and the graph of a home, with boxes.

        Raises:
            HearthError: UNKNOWN_HOME: none has that number.
        """
        if not 0 <= number < len(self.names):
            listed = ", ".join(f"{n} {name}" for n, name in enumerate(self.names))
            raise HearthError.of(Code.UNKNOWN_HOME, f"there is no environment {number}", suggestion=listed)
        name = self.names[number]
        found = library.load_graph(name, self.knowledge, self.folder)
        return name, with_geometry(found, name, self.knowledge).graph


class UnityScene:
    """One scene, which requests change in turn.

    Args:
        homes: that clients reset to.
        seed: decides bodies, colours and where characters begin.

    Attributes:
        world: now.
        followed: where characters and things are seen.
        before: what was seen before the last tick, for pictures of flow.
        mounts: the cameras that go with each character, by name.
        added: the cameras that clients added.
        ticks: how many were done since the reset.
    """

    def __init__(self, homes: Homes, seed: int = 0) -> None:
        self.homes, self.seed, self.hour = homes, seed, 10.0
        self.mounts: dict[str, Mount] = dict(OWN_MOUNTS)
        self.added: list[Camera] = []
        self.reset(0)

    @property
    def knowledge(self) -> Knowledge:
        """The knowledge of the homes."""
        return self.homes.knowledge

    def reset(self, number: int | None = None) -> None:
        """Take a home as it is built, without characters; None takes the home of now anew.

        Raises:
            HearthError: UNKNOWN_HOME.
        """
        name, graph = (self.name, self.built) if number is None else self.homes.graph(number)
        self._begin(name, graph)

    def generate(self, seed: int) -> None:
        """Take a generated home."""
        layout = generate(GENERATED_ROOMS, seed, self.knowledge)
        self._begin(layout.plan.name, scene_of_layout(layout, self.knowledge))

    def _begin(self, name: str, graph: EnvironmentGraph) -> None:
        nobody = {node.id for node in graph.nodes if node.category != CHARACTER_CATEGORY}
        edges = tuple(edge for edge in graph.edges if edge.source in nobody and edge.target in nobody)
        self.name = name
        self.built = replace(graph, nodes=tuple(n for n in graph.nodes if n.id in nobody), edges=edges)
        self.world = World.start(Home.from_graph(self.built, name, self.knowledge))
        self.added, self.ticks = [], 0
        for name_of_cached in ("fixed", "around"):
            self.__dict__.pop(name_of_cached, None)
        self._follow()
        self.followed.begin(self.world)

    def _follow(self) -> None:
        self.followed = FollowedScene(self.built, self.knowledge, seed=self.seed, hour=self.hour)
        self.before: Scene | None = None

    def set_hour(self, hour: float) -> None:
        """Let it be another hour of the day; people and things stay."""
        self.hour = hour
        places, actors = self.followed.places, self.followed.actors
        self._follow()
        self.followed.places = replace(places, prepared=self.followed.prepared)
        self.followed.actors = actors

    @cached_property
    def fixed(self) -> tuple[Camera, ...]:
        """The cameras of the home."""
        return fixed_cameras(self.built)

    @cached_property
    def around(self) -> Surroundings:
        """The boxes that cameras of characters stay in and out of."""
        return Surroundings.of(self.built)

    @property
    def rooms(self) -> dict[int, Node]:
        """The rooms by id."""
        return {node.id: node for node in self.built.nodes if node.category == ROOM_CATEGORY}

    def camera_count(self) -> int:
        """Return the number of cameras: of the home, of clients, of characters."""
        return len(self.fixed) + len(self.added) + len(self.mounts) * len(self.world.agents)

    def cameras(self, indices: Sequence[int], size: tuple[int, int]) -> list[Camera]:
        """Return cameras by their numbers.

        Raises:
            HearthError: UNKNOWN_ID.
        """
        check_indices(indices, self.camera_count())
        standing = (*self.fixed, *self.added)
        found = []
        for index in indices:
            if index < len(standing):
                found.append(of_size(standing[index], size, self.built))
                continue
            agent, number = divmod(index - len(standing), len(self.mounts))
            actor = self.followed.actors[agent]
            found.append(
                on_person(tuple(self.mounts)[number], self.mounts, actor, self.followed.scene, self.around, size)
            )
        return found

    def graph(self) -> dict[str, Any]:
        """Return the graph of now, as Unity writes it."""
        return unity_graph(self.world.graph(), self.followed.places, self.followed.actors)

    def add_character(self, room: str = "", point: Point | None = None) -> tuple[int, str]:
        """Add a character, and return its node and its room's name.

        Args:
            room: the name of a room; "" for any.
            point: where on the floor; the nearest free floor is taken. None for anywhere in the room.

        Raises:
            HearthError: NO_ROOM: no such room, or a point outside of all; BAD_ARGUMENT: there are too many characters.
        """
        if len(self.world.agents) >= MOST_CHARACTERS:
            raise HearthError.of(Code.BAD_ARGUMENT, f"the scene has {MOST_CHARACTERS} characters, the most it takes")
        chosen = self._room_at(point) if point is not None else self._room_called(room)
        first = free_id(self.world.home, 1)
        node = Node(first, CHARACTER_CLASS, CHARACTER_CATEGORY, ("PERSON",), ("STANDING",))
        world = edit(self.world, add=[node], link=[Edge(first, "INSIDE", chosen.id)])
        assert isinstance(world, World)
        self.world = placed(world, rng(self.seed, "unity character", self.name, first))
        if point is not None:
            self._stand(len(self.world.agents) - 1, point)
        self._show()
        return first, chosen.class_name

    def move_character(self, number: int, point: Point) -> None:
        """Let a character stand elsewhere, with the things that it holds.

        Raises:
            HearthError: UNKNOWN_AGENT; NO_ROOM: the point is outside of all rooms.
        """
        agent = self.world.agent(number)
        room = self._room_at(point)
        world = edit(self.world, place={self.world.home.ids[agent.index]: ("INSIDE", room.id)}, check=False)
        assert isinstance(world, World)
        self.world = placed(world)
        self._stand(number, point)
        self._show()

    def _stand(self, number: int, point: Point) -> None:
        """Set the pose of a character on the free floor nearest to a point."""
        here = ground_of(self.world.home)
        if here is None:
            return
        ways = here.ground.ways
        others = [a.pose.point for n, a in enumerate(self.world.agents) if n != number and a.pose is not None]
        cell = ways.nearest((point[0], point[2]), ~ways.main | ways.blocked(others))
        agents = list(self.world.agents)
        x, z = (float(value) for value in ways.points[cell])
        yaw = agents[number].pose.yaw if agents[number].pose is not None else 0.0  # type: ignore[union-attr]
        agents[number] = agents[number]._replace(pose=Pose(x, z, yaw))
        self.world = World(self.world.home, self.world.states, tuple(agents), self.world.moved)

    def _room_at(self, point: Point) -> Node:
        for node in self.rooms.values():
            box = node.box
            if box and all(abs(point[k] - box.center[k]) <= box.size[k] / 2 for k in (0, 2)):
                return node
        raise HearthError.of(Code.NO_ROOM, f"the point ({point[0]:g}, {point[2]:g}) is in no room")

    def _room_called(self, name: str) -> Node:
        found = [node for node in self.rooms.values() if not name or means(name, node.class_name, self.knowledge)]
        if not found:
            there = ", ".join(node.class_name for node in self.rooms.values())
            raise HearthError.of(Code.NO_ROOM, f"there is no room `{name[:40]}`", suggestion=f"one of {there}")
        chooser = rng(self.seed, "unity room", self.name, len(self.world.agents))
        return found[0] if name else chooser.choice(found)

    def expand(self, data: Mapping[str, Any], *, transforms: bool = True) -> GraphChange:
        """Change the scene into that of a client's graph.

        Args:
            data: the graph.
            transforms: whether boxes of the graph count; else things get a free place where their relations say.

        Raises:
            HearthError: every contradiction of the graph, by name; the scene then stays as it is.
        """
        now = self.world.graph()
        wanted = read_graph(data, now, self.knowledge)
        seen = {node.id: node.box for node in self.followed.places.nodes() if node.box is not None}
        change = change_between(now, wanted, seen)
        boxes = {**change.boxes, **{node.id: node.box for node in change.add if node.box}} if transforms else {}
        bare = [replace(node, box=None) for node in change.add]
        world = _edited(self.world, change, bare)
        self.world = placed(world)
        self._show(boxes)
        return change

    def _show(self, boxes: Mapping[int, Any] | None = None) -> None:
        """Show the world of now; things lie where they lay, or in given boxes."""
        self.followed.begin(self.world, self.followed.places)
        if boxes:
            places = self.followed.places
            poses = dict(places.poses)
            for number, box in boxes.items():
                old = poses.get(number)
                poses[number] = LyingPose(box, old.yaw if old else 0.0)
            self.followed.begin(self.world, replace(places, poses=poses))
        self.before = None

    def seen_before(self) -> Scene:
        """Return what was seen before the last tick; the scene of now before the first."""
        return self.before or self.followed.scene

    def advance(self, steps: Sequence[Step], world: World) -> None:
        """Go on by a tick that was done."""
        self.before = self.followed.scene
        self.followed.advance(steps, world)
        self.world, self.ticks = world, self.ticks + 1

    def points(self, most: int) -> tuple[np.ndarray[Any, Any], list[int]]:
        """Return points of surfaces as the rooms' cameras see them, (N, 3) metres, and the node of each."""
        from hearth.rendering.rays.camera_shot import shoot

        cameras = self.cameras(range(len(self.fixed) - 1), (24, 18))
        found, owners = [], []
        for camera in cameras:
            shot = shoot(self.followed.scene, camera)
            seen = shot.hits.triangle >= 0
            found.append((shot.rays[:, :3] + shot.rays[:, 3:] * shot.distance[:, None])[seen])
            owners += [shot.geometry.things[number].id for number in shot.owner[seen].tolist()]
        step = max(1, -(-len(owners) // most))
        return np.concatenate(found)[::step], owners[::step]


def _edited(world: World, change: GraphChange, add: Sequence[Node]) -> World:
    """Return the world after a change.

    Raises:
        HearthError: NOT_AFFORDED: a thing is in no such state.
    """
    there = edit(world, add=add, remove=change.remove, place=change.place, clear=change.clear, check=False)
    assert isinstance(there, World)
    found = edit(there, set=change.set)
    if isinstance(found, Failure):
        raise HearthError.of(found.code, sentence(found, remedy=None, code=False))
    return found
