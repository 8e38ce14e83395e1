"""The 3D scene of a game, for browsers: a home's fixed part as one glTF, and the present differences from it."""

from collections.abc import Iterator
from functools import lru_cache
from hashlib import blake2b
from pathlib import Path
from typing import Any

from hearth.challenges.challenge_definition import challenge
from hearth.challenges.household_definition import NAME as HOUSEHOLD
from hearth.challenges.household_definition import every_home, home_named
from hearth.challenges.start_worlds import site_of
from hearth.grounding.environments.default_state import prepared
from hearth.kb.knowledge import Knowledge
from hearth.rendering.cameras.camera import Camera
from hearth.rendering.cameras.sensor import CameraSensor
from hearth.rendering.scene.gltf_and_obj import glb, node_names
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.scene_preparation import prepared_scene
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.simulation.observation.visible_nodes import out_of_sight
from hearth.simulation.world.bits import indices
from hearth.simulation.world.edit import edit
from hearth.simulation.world.world import World
from hearth.storage.files import write_bytes
from hearth.storage.names import inside
from hearth.web.play.games import Game
from hearth.web.play.play_trials import SIZE


@lru_cache(maxsize=32)
def base_scene(name: str, home: str, knowledge: Knowledge) -> Scene:
    """Return a home as all games of a challenge have it: its visible parts, without the things of goals and characters.

    Raises:
        HearthError: BAD_ARGUMENT: the challenge is not played there.
    """
    which = challenge(name)
    if home not in (every_home() if name == HOUSEHOLD else (*which.train, *which.test)):
        raise HearthError.of(Code.BAD_ARGUMENT, f"{name} is not played in `{home[:40]}`")
    world = _empty(home, knowledge) if name == HOUSEHOLD else World.start(site_of(name, home, knowledge).home)
    return Scene(tuple(in_sight(prepared_scene(world.graph(), knowledge).scene(), world)))


def _empty(name: str, knowledge: Knowledge) -> World:
    """Return a home of household tasks in its default state, without characters."""
    home = prepared(home_named(name, knowledge)).home
    found = edit(World.start(home), remove=[home.ids[i] for i in home.agents], check=False)
    assert isinstance(found, World)
    return World.start(found.home)


def in_sight(scene: Scene, world: World) -> Iterator[Thing]:
    """Yield the things of a scene, without those inside closed furniture.

    These cost time to draw, and a page must not know them.
    """
    shut = {world.home.ids[i] for i in indices(out_of_sight(world))}
    return (thing for thing in scene.everything if thing.id not in shut)


@lru_cache(maxsize=32)
def base_key(name: str, home: str, knowledge: Knowledge) -> str:
    """Return a digest of the drawn parts, in 32 digits, for its file and address."""
    return _digest(base_scene(name, home, knowledge).everything)


def base_file(name: str, home: str, knowledge: Knowledge, folder: Path) -> bytes:
    """It as glTF in plain colours, from a folder that keeps it once it is made."""
    file = inside(folder, f"{name}-{home}-{base_key(name, home, knowledge)}.glb")
    if not file.is_file():
        folder.mkdir(parents=True, exist_ok=True)
        write_bytes(file, glb(base_scene(name, home, knowledge), textures=False))
    return file.read_bytes()


def _digest(value: object) -> str:
    return blake2b(repr(value).encode(), digest_size=16).hexdigest()


def model_key(thing: Thing) -> str:
    """Return the name of a thing's model in addresses; parts of the building are drawn where they stand."""
    where = (thing.position, thing.yaw) if thing.structural else ()
    return _digest((thing.model, where))


class DrawnGame:
    """The scene of a game, which follows its ticks.

    Args:
        game: the game; hold its lock.
        knowledge: of its home.
        number: whose eyes it is seen with.
    """

    def __init__(self, game: Game, knowledge: Knowledge, number: int) -> None:
        task = game.trial.task
        self.game, self.number = game, number
        self.sensor = CameraSensor(game.start.graph(), knowledge, size=SIZE)
        base = base_scene(task.challenge, task.home, knowledge)
        self._base = node_names(base)
        self._sent: dict[str, Thing] = {}
        self.address = f"/play/home/{task.challenge}/{task.home}.glb?{base_key(task.challenge, task.home, knowledge)}"

    @property
    def scene(self) -> Scene:
        """Return the present scene."""
        return self.sensor.scene(self.game.playing.env)

    @property
    def camera(self) -> Camera:
        """Return the eyes now."""
        return self.sensor.camera(self.game.playing.env, self.number)

    def as_json(self) -> dict[str, Any]:
        """Return the home's file, its nodes that are missing now, the other things, and the eyes.

        Each of `on` is node id, class, key of its model, x, y, z in metres, and yaw in degrees. Axes are the scene's:
        x east, y up, z north.
        """
        now = dict.fromkeys(self._in_sight())
        off = [name for thing, name in self._base.items() if thing not in now]
        others = [thing for thing in now if thing not in self._base]
        self._sent.update((model_key(thing), thing) for thing in others)
        on = [_on(thing) for thing in others]
        camera = self.camera
        eyes = {"eye": _point(camera.eye), "target": _point(camera.target), "fov": camera.fov}
        return {"base": self.address, "off": off, "on": on, "camera": eyes}

    def model(self, key: str) -> bytes:
        """Return a model that is there now, or was sent to a page before, which may ask once the game has gone on.

        Raises:
            HearthError: UNKNOWN_ID: there is none with that key.
        """
        thing = self._sent.get(key) or next((each for each in self.others() if model_key(each) == key), None)
        if thing is None:
            raise HearthError.of(Code.UNKNOWN_ID, f"nothing looks like {key[:40]} now")
        alone = thing if thing.structural else Thing(thing.id, thing.class_name, thing.model)
        return glb(Scene((alone,)), textures=False)

    def others(self) -> Iterator[Thing]:
        """Yield the present things that are not of the home's fixed part."""
        return (thing for thing in self._in_sight() if thing not in self._base)

    def _in_sight(self) -> Iterator[Thing]:
        return in_sight(self.scene, self.game.playing.env.world)

    def jpeg(self) -> bytes:
        """Return the person's view, as our own renderer draws it."""
        import cv2

        rgb = self.sensor(self.game.playing.env, self.number, ("rgb",))["rgb"]
        done, data = cv2.imencode(".jpg", rgb[..., 2::-1], [cv2.IMWRITE_JPEG_QUALITY, 85])
        assert done
        return data.tobytes()

    def pick(self, x: int, y: int) -> int:
        """Return the node id that a pixel of the picture shows; 0 of the background."""
        ids = self.sensor(self.game.playing.env, self.number, ("instance_ids",))["instance_ids"]
        return int(ids[min(max(y, 0), SIZE[1] - 1), min(max(x, 0), SIZE[0] - 1)])


def _on(thing: Thing) -> list[Any]:
    place = ((0.0, 0.0, 0.0), 0.0) if thing.structural else (thing.position, thing.yaw)
    return [thing.id, thing.class_name, model_key(thing), *_point(place[0]), round(float(place[1]), 3)]


def _point(point: tuple[float, float, float]) -> list[float]:
    return [round(float(value), 4) for value in point]
