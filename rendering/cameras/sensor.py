"""A camera sensor for agents: the pictures of `Env.observe`."""

from typing import Any

from numpy.typing import NDArray

from hearth.kb.knowledge import Knowledge
from hearth.rendering.cameras.camera import Camera, follow, top_view
from hearth.rendering.cameras.viewpoints import home_box
from hearth.rendering.film.execution_keyframes import advanced, check_geometry, scene_at, standing
from hearth.rendering.film.video import FIRST, THIRD, first_person
from hearth.rendering.modalities import render
from hearth.rendering.people.action_poses import Actor, initial_actors
from hearth.rendering.people.bedding import turned_back
from hearth.rendering.people.step_hands_and_gaze import posed
from hearth.rendering.scene.added_furniture import furnished
from hearth.rendering.scene.door_sweep import Floors
from hearth.rendering.scene.object_boxes import Places
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.scene_preparation import prepared_scene
from hearth.schemas.graph import EnvironmentGraph
from hearth.simulation.env import Env
from hearth.simulation.world.world import World


class CameraSensor:
    """Pictures of an episode, for an environment: `env.camera_sensor = CameraSensor(home, knowledge)`.

    From the first picture on, the sensor follows the episode: characters stand where their steps brought them, and
    objects lie where they were put. `class_ids` are those of the table `vocabulary`.

    Args:
        home: the home's graph as it was built, with boxes.
        seed: decides bodies, colours and designs.
        hour: of the day.
        size: width and height of the pictures.
        view: `first` person, `third` person, or `top`.
        quality: as in `modalities.render`.
        knowledge: of the home's classes.

    Raises:
        HearthError: the home has no geometry.
    """

    def __init__(
        self,
        home: EnvironmentGraph,
        knowledge: Knowledge,
        *,
        seed: int = 0,
        hour: float = 10.0,
        size: tuple[int, int] = (320, 240),
        view: str = FIRST,
        quality: str = "draft",
    ) -> None:
        check_geometry(home)
        self.home, self.seed, self.size, self.view, self.quality = home, seed, size, view, quality
        self.prepared = prepared_scene(home, knowledge, seed=seed, hour=hour)
        self.floors = Floors(self.prepared)
        self.places = Places.start(home, self.prepared.knowledge, self.prepared)
        self.actors: tuple[Actor, ...] = ()
        self._scene: Scene | None = None
        self._ticks = 0
        self._world: World | None = None

    def __call__(self, env: Env, agent: int, modalities: tuple[str, ...]) -> dict[str, NDArray[Any]]:
        """Return the current pictures of an agent, by modality."""
        how: dict[str, Any] = {"quality": self.quality, "class_ids": self.prepared.knowledge.class_ids}
        return render(self.scene(env), self.camera(env, agent), modalities, **how)

    def scene(self, env: Env) -> Scene:
        """Return the current content of a picture: the scene and its moving parts."""
        self._follow(env)
        if self._scene is None:
            self._scene = scene_at(self.prepared, self.places, self.actors)
        return self._scene

    def camera(self, env: Env, agent: int) -> Camera:
        """Return the camera of an agent now."""
        self._follow(env)
        actor = self.actors[agent]
        if self.view == FIRST:
            return first_person(actor, self.size)
        if self.view == THIRD:
            return follow(THIRD, actor.position, actor.yaw, *self.size)
        return top_view(home_box(self.home), self.view, *self.size)

    def _follow(self, env: Env) -> None:
        """Apply the ticks since the last picture."""
        if self._world is None or self._world is not self._world_after(env, self._ticks):
            self._begin(env)
        for tick in env.ticks[self._ticks :]:
            steps = tuple(step for number, step in tick.instructions.items() if number not in tick.failures)
            floor = self.floors.at(self.places.nodes())
            self.actors, self.places = advanced(self.actors, self.places, tick.world.graph(), floor, steps, tick.world)
            self._ticks, self._world, self._scene = self._ticks + 1, tick.world, None

    @staticmethod
    def _world_after(env: Env, ticks: int) -> World | None:
        """Return the episode's world after that many ticks; None where it has had fewer."""
        if ticks < len(env.ticks):
            return env.ticks[ticks].before
        return env.world if ticks == len(env.ticks) else None

    def _begin(self, env: Env) -> None:
        graph = env.world.graph()
        start = Places.start(self.home, self.prepared.knowledge, self.prepared)
        self.places = furnished(start, graph, self.floors).settled(graph)
        actors = initial_actors(graph, self.floors.at(self.places.nodes()), self.places, self.seed)
        self.actors = standing((posed(actor, graph, self.places, None) for actor in actors), env.world)
        self.places = turned_back(self.places, self.actors)
        self._ticks, self._world, self._scene = len(env.ticks), env.world, None
