"""The visible state of an episode that goes on tick by tick: where characters stand and things lie."""

from __future__ import annotations

from collections.abc import Sequence

from hearth.kb.knowledge import Knowledge
from hearth.rendering.film.execution_keyframes import Keyframe, advanced, check_geometry, scene_at, standing
from hearth.rendering.people.action_poses import Actor, initial_actors
from hearth.rendering.people.bedding import turned_back
from hearth.rendering.people.step_hands_and_gaze import posed
from hearth.rendering.scene.added_furniture import furnished
from hearth.rendering.scene.door_sweep import Floors
from hearth.rendering.scene.object_boxes import Places
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.scene_preparation import PreparedScene, prepared_scene
from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.program import Step
from hearth.simulation.world.world import World


class FollowedScene:
    """Characters and things of an episode, where its steps brought them.

    Args:
        home: the home's graph as it was built, with boxes.
        knowledge: of the home's classes.
        seed: decides bodies, colours and designs.
        hour: of the day.

    Attributes:
        prepared: the home's prepared scene.
        floors: the floors on which characters stand.
        places: of all things, now.
        actors: the characters, now.

    Raises:
        HearthError: the home has no geometry.
    """

    def __init__(self, home: EnvironmentGraph, knowledge: Knowledge, *, seed: int = 0, hour: float = 10.0) -> None:
        check_geometry(home)
        self.home, self.seed = home, seed
        self.prepared: PreparedScene = prepared_scene(home, knowledge, seed=seed, hour=hour)
        self.floors = Floors(self.prepared)
        self.places = Places.start(home, self.prepared.knowledge, self.prepared)
        self.actors: tuple[Actor, ...] = ()
        self._scene: Scene | None = None

    def begin(self, world: World, places: Places | None = None) -> None:
        """Show a world without regard to how it came about.

        Args:
            world: at any moment.
            places: where things lay before; else where the home was built with them.
        """
        graph = world.graph()
        start = places or Places.start(self.home, self.prepared.knowledge, self.prepared)
        self.places = furnished(start, graph, self.floors).settled(graph)
        actors = initial_actors(graph, self.floors.at(self.places.nodes()), self.places, self.seed)
        self.actors = standing((posed(actor, graph, self.places, None) for actor in actors), world)
        self.places = turned_back(self.places, self.actors)
        self._scene = None

    def advance(self, steps: Sequence[Step], world: World) -> None:
        """Go on by a tick: the steps that were done in it, and the world after it."""
        floor = self.floors.at(self.places.nodes())
        self.actors, self.places = advanced(self.actors, self.places, world.graph(), floor, tuple(steps), world)
        self._scene = None

    @property
    def scene(self) -> Scene:
        """The scene now."""
        if self._scene is None:
            self._scene = scene_at(self.prepared, self.places, self.actors)
        return self._scene

    def keyframe(self, tick: int, steps: Sequence[Step] = ()) -> Keyframe:
        """Return the scene now as the keyframe after a tick."""
        floor = self.floors.at(self.places.nodes())
        return Keyframe(tick, tuple(steps), self.scene, self.actors, self.places, floor)
