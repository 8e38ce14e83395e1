"""An execution in 3D for pages: the home's shapes, and the shapes removed and added after each tick."""

from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.rendering.film.execution_keyframes import Keyframe, check_geometry, trajectory_of
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.packed_shapes import PackedShapes
from hearth.rendering.scene.scene_preparation import prepared_scene
from hearth.schemas.graph import EnvironmentGraph
from hearth.simulation.engine import Execution


def home_shapes(home: EnvironmentGraph, knowledge: Knowledge) -> dict[str, Any]:
    """Return a home as it was built, without characters, and without ceilings, which would hide it from above.

    Returns:
        `shapes` as `PackedShapes.as_json`, and `things`: for each thing the number of its shape, x, y, z in metres, yaw
        in degrees, and 1 for parts of the building, whose shapes stand where they are.

    Raises:
        HearthError: the home has no geometry.
    """
    shapes = PackedShapes()
    things = [[*_placed(thing, shapes), int(thing.structural)] for thing in _things(home, knowledge)]
    return {"shapes": shapes.as_json(), "things": things}


def run_shapes(execution: Execution, home: EnvironmentGraph, knowledge: Knowledge) -> dict[str, Any]:
    """Return an execution as its differences from `home_shapes` of its home, at the start and after each tick.

    Args:
        execution: a recorded run.
        home: as it was built, with boxes.
        knowledge: of its classes.

    Returns:
        `shapes` of things that the home lacks, and `ticks`: `off`, places of the home's `things` that are not there;
        `on`, rows of number of the shape, x, y, z, yaw and node id; `at`, x, y, z of the acting character's feet.

    Raises:
        HearthError: the home has no geometry.
    """
    places = {thing: number for number, thing in enumerate(_things(home, knowledge))}
    shapes = PackedShapes()
    ticks = [_tick(keyframe, places, shapes) for keyframe in trajectory_of(execution, home, knowledge).keyframes]
    return {"shapes": shapes.as_json(), "ticks": ticks}


def _things(home: EnvironmentGraph, knowledge: Knowledge) -> list[Thing]:
    check_geometry(home)
    return [thing for thing in prepared_scene(home, knowledge).scene().everything if not thing.above]


def _tick(keyframe: Keyframe, places: dict[Thing, int], shapes: PackedShapes) -> dict[str, Any]:
    now = dict.fromkeys(thing for thing in keyframe.scene.everything if not thing.above)
    on = [[*_placed(thing, shapes), thing.id] for thing in now if thing not in places]
    off = [number for thing, number in places.items() if thing not in now]
    return {"off": off, "on": on, "at": [round(float(value), 2) for value in keyframe.acting.position]}


def _placed(thing: Thing, shapes: PackedShapes) -> list[float]:
    where = (0.0, 0.0, 0.0, 0.0) if thing.structural else (*thing.position, thing.yaw)
    return [shapes.add(thing), *(round(float(value), 3) for value in where)]
