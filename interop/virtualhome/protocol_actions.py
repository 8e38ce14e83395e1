"""Every action of the Unity protocol: what a request does to a scene, and the reply."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import orjson

from hearth.interop.virtualhome.camera_images import MODES, base64_of, check_modes, colour_of, png_of
from hearth.interop.virtualhome.protocol_messages import (
    Reply,
    Request,
    flag,
    in_words,
    json_of,
    number,
    point,
    refusal,
    wrong,
)
from hearth.interop.virtualhome.recording_settings import read_settings, read_size
from hearth.interop.virtualhome.scene_cameras import MOST_ADDED, OWN_MOUNTS, Mount, check_indices, data_of, mounted
from hearth.interop.virtualhome.script_lines import (
    bound_by_node,
    bound_by_search,
    failed,
    read_script,
    ticks_done,
)
from hearth.interop.virtualhome.script_recordings import Recordings, record
from hearth.interop.virtualhome.unity_scene import RULES, UnityScene
from hearth.rendering.modalities import render
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import Program
from hearth.simulation.env import with_agents
from hearth.simulation.world.world import World

MOST_PICTURES = 64
"""Pictures of one request."""

MOST_POINTS = 20_000
"""Points of a point cloud."""


class Simulator:
    """A simulator that answers requests of the Unity protocol.

    Args:
        scene: what requests look at and change.
        recordings: where scripts are recorded.
    """

    def __init__(self, scene: UnityScene, recordings: Recordings) -> None:
        self.scene, self.recordings = scene, recordings

    def answer(self, request: Request) -> Reply:
        """Return the reply to a request; one that can't be done says why, and changes nothing."""
        action = ACTIONS.get(request.action)
        if action is None:
            known = ", ".join(ACTIONS)
            return Reply(False, f"there is no action `{request.action}`; actions are {known} ({Code.UNKNOWN_ACTION})")
        try:
            return action(self, request)
        except HearthError as error:
            return refusal(error)


def _idle(simulator: Simulator, request: Request) -> Reply:
    return Reply(True, "Hearth")


def _reset(simulator: Simulator, request: Request) -> Reply:
    simulator.scene.reset(request.numbers[0] if request.numbers else None)
    return Reply(True, simulator.scene.name)


def _generate(simulator: Simulator, request: Request) -> Reply:
    seed = request.numbers[0] if request.numbers else 0
    simulator.scene.generate(seed)
    return Reply(True, str(seed), seed)


def _graph(simulator: Simulator, request: Request) -> Reply:
    return Reply(True, _json(simulator.scene.graph()))


def _expand(simulator: Simulator, request: Request) -> Reply:
    if len(request.texts) < 2:
        raise wrong("stringParams", "settings and a graph", list(request.texts))
    settings = request.settings()
    change = simulator.scene.expand(
        json_of(request.texts[1], "the graph"), transforms=flag(settings, "transfer_transform", True)
    )
    return Reply(True, _json(change.as_json()))


def _add_character(simulator: Simulator, request: Request) -> Reply:
    settings = request.settings()
    mode, room = settings.get("mode", "random"), settings.get("initial_room") or ""
    if mode not in ("random", "fix_position", "fix_room") or not isinstance(room, str):
        raise wrong("mode", "random, fix_position or fix_room, with the name of a room", mode)
    where = point(settings, "character_position") if mode == "fix_position" else None
    node, there = simulator.scene.add_character(room if mode == "fix_room" else "", where)
    return Reply(True, f"character {len(simulator.scene.world.agents) - 1} is node {node}, in the {there}", node)


def _move_character(simulator: Simulator, request: Request) -> Reply:
    settings = request.settings()
    index = int(number(settings, "char_index", 0, 0, 1_000))
    simulator.scene.move_character(index, point(settings, "character_position"))
    return Reply(True)


def _script(lines: tuple[str, ...], world: World, *, search: bool) -> Program:
    """Return the lines of a script, bound to nodes."""
    program = read_script(lines, world.home)
    return bound_by_search(program, world, RULES) if search else bound_by_node(program, world.home)


def _check_script(simulator: Simulator, request: Request) -> Reply:
    """Return whether a script can be done; nothing of it is done. Without characters, one is imagined."""
    scene = simulator.scene
    world = with_agents(scene.world, 1, scene.seed)
    try:
        program = _script(request.texts, world, search=False)
    except HearthError:
        program = _script(request.texts, world, search=True)
    _, failure = ticks_done(world, program, RULES)
    return Reply(failure is None, failed(failure, program) if failure else "")


STOPPED = "Not done from line {line} on: another character's act failed there, and nobody acts in such a line"
"""The message of a character whose own acts did not fail."""


def _render_script(simulator: Simulator, request: Request) -> Reply:
    settings = read_settings(request.settings())
    scene, lines = simulator.scene, request.texts[1:]
    if not scene.world.agents:
        raise HearthError.of(Code.UNKNOWN_AGENT, "the scene has no characters", suggestion="`add_character` first")
    if settings.recording:
        simulator.recordings.check()
    program = _script(lines, scene.world, search=settings.search)
    done, failure = ticks_done(scene.world, program, RULES)
    messages: dict[str, Any] = {str(agent): {"message": "Success"} for agent in range(len(scene.world.agents))}
    if failure is not None:
        left = {step.agent for tick in list(program.ticks())[len(done) :] for step in tick}
        messages |= {str(agent): {"message": STOPPED.format(line=len(done) + 1)} for agent in left}
        messages[str(failure.agent)] = {"message": failed(failure, program)}
    if settings.skip:
        return Reply(failure is None, _json(messages))
    keyframes = [scene.followed.keyframe(0)]
    for tick, (steps, world) in enumerate(done, 1):
        scene.advance(steps, world)
        if settings.recording:
            keyframes.append(scene.followed.keyframe(tick, steps))
    if settings.recording:
        messages["recording"] = _recorded(simulator, keyframes, settings)
    return Reply(failure is None and "error" not in messages.get("recording", {}), _json(messages))


def _recorded(simulator: Simulator, keyframes: Any, settings: Any) -> dict[str, Any]:
    """Return what was recorded, or why it was not; the script is done in either case."""
    try:
        found = record(simulator.scene, keyframes, settings, simulator.recordings)
    except HearthError as error:
        return {"error": in_words(error)}
    steps = [{"step": step, "first": first, "last": last} for step, first, last in found.spans]
    return {"folder": found.folder, "frames": found.frames, "steps": steps}


def _camera_count(simulator: Simulator, request: Request) -> Reply:
    return Reply(True, "", simulator.scene.camera_count())


def _character_cameras(simulator: Simulator, request: Request) -> Reply:
    return Reply(True, _json(list(simulator.scene.mounts)))


def _camera_data(simulator: Simulator, request: Request) -> Reply:
    cameras = simulator.scene.cameras(request.numbers, (640, 480))
    return Reply(True, _json([data_of(k, camera) for k, camera in zip(request.numbers, cameras, strict=True)]))


def _camera_image(simulator: Simulator, request: Request) -> Reply:
    settings, scene = request.settings(), simulator.scene
    mode = settings.get("mode", "normal")
    check_modes([mode if isinstance(mode, str) else ""])
    if len(request.numbers) > MOST_PICTURES:
        raise wrong("intParams", f"at most {MOST_PICTURES} cameras", len(request.numbers))
    found = []
    for camera in scene.cameras(request.numbers, read_size(settings, 640, 480)):
        if mode == "flow":
            pictures = render(scene.seen_before(), camera, ["flow"], after=scene.followed.scene)
        else:
            ids = scene.knowledge.class_ids
            pictures = render(scene.followed.scene, camera, [MODES[mode][0]], class_ids=ids)
        found.append(base64_of(png_of(mode, pictures)))
    return Reply(True, "", len(found), tuple(found))


def _mount(settings: Mapping[str, Any], field: float) -> Mount:
    return Mount(
        point(settings, "position"), point(settings, "rotation"), number(settings, "field_view", field, 1, 170)
    )


def _add_camera(simulator: Simulator, request: Request) -> Reply:
    scene = simulator.scene
    if len(scene.added) >= MOST_ADDED:
        raise HearthError.of(Code.BAD_ARGUMENT, f"the scene has {MOST_ADDED} added cameras", suggestion="`reset`")
    index = len(scene.fixed) + len(scene.added)
    scene.added.append(mounted(f"added.{index}", _mount(request.settings(), 40.0), (640, 480)))
    return Reply(True, f"New camera created. Id:{index}", index)


def _update_camera(simulator: Simulator, request: Request) -> Reply:
    scene = simulator.scene
    if not request.numbers:
        raise wrong("intParams", "the number of a camera", [])
    check_indices(request.numbers[:1], len(scene.fixed) + len(scene.added))
    index = request.numbers[0] - len(scene.fixed)
    if index < 0:
        raise HearthError.of(Code.NOT_ALLOWED, f"camera {request.numbers[0]} is one of the home's, which stay",
                             suggestion="`add_camera` makes one of your own")  # fmt: skip
    scene.added[index] = mounted(f"added.{request.numbers[0]}", _mount(request.settings(), 40.0), (640, 480))
    return Reply(True, f"Camera updated. Id:{request.numbers[0]}", request.numbers[0])


def _camera_name(settings: Mapping[str, Any]) -> str:
    name = settings.get("camera_name")
    if not isinstance(name, str) or not 0 < len(name) <= 60 or not name.isprintable():
        raise wrong("camera_name", "a name of at most 60 characters", name)
    return name


def _add_character_camera(simulator: Simulator, request: Request) -> Reply:
    settings, scene = request.settings(), simulator.scene
    name = _camera_name(settings)
    if len(scene.mounts) >= len(OWN_MOUNTS) + 20 and name not in scene.mounts:
        raise HearthError.of(Code.BAD_ARGUMENT, "characters have 20 added cameras, the most they take")
    if name in ("AUTO", "FIRST_PERSON") or name.isdecimal():
        raise wrong("camera_name", "a name that no other camera has", name)
    scene.mounts[name] = _mount(settings, 60.0)
    return Reply(True, name)


def _update_character_camera(simulator: Simulator, request: Request) -> Reply:
    settings, scene = request.settings(), simulator.scene
    name = _camera_name(settings)
    if name not in scene.mounts:
        raise HearthError.of(Code.UNKNOWN_ID, f"characters have no camera `{name}`",
                             suggestion=f"one of {', '.join(scene.mounts)}")  # fmt: skip
    scene.mounts[name] = _mount(settings, 60.0)
    return Reply(True, name)


def _observation(simulator: Simulator, request: Request) -> Reply:
    """Return the nodes that cameras see, with their classes."""
    scene = simulator.scene
    found: dict[str, str] = {}
    names = {node["id"]: node["class_name"] for node in scene.graph()["nodes"]}
    for camera in scene.cameras(request.numbers[:MOST_PICTURES], (160, 120)):
        ids = render(scene.followed.scene, camera, ["instance_ids"])["instance_ids"]
        found |= {str(node): names[node] for node in sorted(set(ids.ravel().tolist())) if node in names}
    return Reply(True, _json(found), len(found))


def _instance_colours(simulator: Simulator, request: Request) -> Reply:
    ids = [node.id for node in simulator.scene.world.graph().nodes]
    return Reply(True, _json({str(node): [round(v / 255, 4) for v in colour_of(node)] for node in ids}))


def _set_time(simulator: Simulator, request: Request) -> Reply:
    settings = request.settings()
    hours, minutes = number(settings, "hours", 0, 0, 24), number(settings, "minutes", 0, 0, 60)
    simulator.scene.set_hour((hours + minutes / 60 + number(settings, "seconds", 0, 0, 60) / 3600) % 24)
    return Reply(True, f"{simulator.scene.hour:g}")


def _physics(simulator: Simulator, request: Request) -> Reply:
    said = "activate_physics does not work: Hearth has no physics; things are where their relations put them"
    return Reply(False, f"{said} ({Code.NOT_SIMULATED})")


def _terrain(simulator: Simulator, request: Request) -> Reply:
    return Reply(True, "there is no terrain around homes of Hearth")


def _points(simulator: Simulator, request: Request) -> Reply:
    points, owners = simulator.scene.points(MOST_POINTS)
    return Reply(True, _json({"points": points.round(3).tolist(), "ids": owners}), len(owners))


ACTIONS: Mapping[str, Callable[[Simulator, Request], Reply]] = {
    "idle": _idle,
    "environment": _reset,
    "clear": _reset,
    "fast_reset": _reset,
    "clear_procedural": _idle,
    "procedural_generation": _generate,
    "environment_graph": _graph,
    "expand_scene": _expand,
    "add_character": _add_character,
    "move_character": _move_character,
    "check_script": _check_script,
    "render_script": _render_script,
    "camera_count": _camera_count,
    "character_cameras": _character_cameras,
    "camera_data": _camera_data,
    "camera_image": _camera_image,
    "add_camera": _add_camera,
    "update_camera": _update_camera,
    "add_character_camera": _add_character_camera,
    "update_character_camera": _update_character_camera,
    "observation": _observation,
    "instance_colors": _instance_colours,
    "set_time": _set_time,
    "activate_physics": _physics,
    "remove_terrain": _terrain,
    "point_cloud": _points,
}
"""Every action by its name."""


def _json(value: Any) -> str:
    return orjson.dumps(value, option=orjson.OPT_SERIALIZE_NUMPY).decode()
