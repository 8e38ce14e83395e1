"""A camera sensor for agents: the pictures of `Env.observe`."""

from typing import Any

from numpy.typing import NDArray

from hearth.kb.knowledge import Knowledge
from hearth.rendering.cameras.camera import Camera, top_view
from hearth.rendering.cameras.viewpoints import behind, bulky, home_box
from hearth.rendering.film.followed_scene import FollowedScene
from hearth.rendering.film.video import FIRST, THIRD, first_person
from hearth.rendering.modalities import render
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.scene.scene import Scene
from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.vocabulary import ROOM_CATEGORY
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
        self.followed = FollowedScene(home, knowledge, seed=seed, hour=hour)
        self.home, self.seed, self.size, self.view, self.quality = home, seed, size, view, quality
        self._rooms = {node.id: node.box for node in home.nodes if node.category == ROOM_CATEGORY}
        self._furniture = bulky(home)
        self._ticks = 0
        self._world: World | None = None

    def __call__(self, env: Env, agent: int, modalities: tuple[str, ...]) -> dict[str, NDArray[Any]]:
        """Return the current pictures of an agent, by modality."""
        how: dict[str, Any] = {"quality": self.quality, "class_ids": self.followed.prepared.knowledge.class_ids}
        return render(self.scene(env), self.camera(env, agent), modalities, **how)

    @property
    def actors(self) -> tuple[Actor, ...]:
        """The characters as of the last picture."""
        return self.followed.actors

    def scene(self, env: Env) -> Scene:
        """Return the current content of a picture: the scene and its moving parts."""
        self._follow(env)
        return self.followed.scene

    def camera(self, env: Env, agent: int) -> Camera:
        """Return the camera of an agent now."""
        self._follow(env)
        actor = self.followed.actors[agent]
        if self.view == FIRST:
            return first_person(actor, self.size)
        if self.view == THIRD:
            return behind(THIRD, actor, self.followed.scene, self.size, self._rooms.get(actor.room), self._furniture)
        return top_view(home_box(self.home), self.view, *self.size)

    def _follow(self, env: Env) -> None:
        """Apply the ticks since the last picture."""
        if self._world is None or self._world is not self._world_after(env, self._ticks):
            self._begin(env)
        for tick in env.ticks[self._ticks :]:
            steps = tuple(step for number, step in tick.instructions.items() if number not in tick.failures)
            self.followed.advance(steps, tick.world)
            self._ticks, self._world = self._ticks + 1, tick.world

    @staticmethod
    def _world_after(env: Env, ticks: int) -> World | None:
        """Return the episode's world after that many ticks; None where it has had fewer."""
        if ticks < len(env.ticks):
            return env.ticks[ticks].before
        return env.world if ticks == len(env.ticks) else None

    def _begin(self, env: Env) -> None:
        self.followed.begin(env.world)
        self._ticks, self._world = len(env.ticks), env.world
