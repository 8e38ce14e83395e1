"""The pictures and texts of `render`: a floor plan with the agents on it, a camera's picture, lines of text."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hearth.envs.action_codes import str_step
from hearth.envs.session import Session
from hearth.homes import floor_plan_drawing
from hearth.homes.from_graph.layout_from_boxes import measured
from hearth.homes.geometry import Rect
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.simulation.motion import positions
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.motion.navigation import BODY_RADIUS
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

Picture = NDArray[np.uint8]
"""(height, width, 3)."""

MODES = ("rgb_array", "ansi")
"""The render modes of `ParallelHome` and `HomeEnv`."""

PLAN = "plan"

CAMERAS = ("first", "third", "top")
"""Views of `rendering.cameras.sensor.CameraSensor`, which needs the extra `pictures`."""

SCALE = 40
"""Pixels a metre."""

AGENTS = ("#3f6fd1", "#d1493f", "#3fa85f", "#a03fd1")
"""Colours of agents, by number."""

THING = "#111111"
"""Colour of things that have been moved, or are held."""


class Pictures:
    """Pictures and texts of a session.

    Args:
        mode: of rendering: `rgb_array`, `ansi`, or None.
        camera: `plan`, or a view of agent 0 (`first`, `third`, `top`).

    Raises:
        HearthError: BAD_ARGUMENT, where there is no such mode or camera.
    """

    def __init__(self, mode: str | None = None, camera: str = PLAN) -> None:
        if mode is not None and mode not in MODES:
            raise HearthError.of(Code.BAD_ARGUMENT, f"there is no render mode `{mode}`", suggestion=", ".join(MODES))
        if camera not in (PLAN, *CAMERAS):
            raise HearthError.of(Code.BAD_ARGUMENT, f"there is no camera `{camera}`",
                                 suggestion=", ".join((PLAN, *CAMERAS)))  # fmt: skip
        self.mode, self.camera = mode, camera
        self._ground: tuple[Home, tuple[Picture, Rect]] | None = None
        self._start: World | None = None

    def take(self, session: Session) -> Picture | str | None:
        """Return the picture or text of now; None without a mode.

        Raises:
            HearthError: NOT_RENDERED, where the home has no geometry; MISSING_FILE, where a library is not installed.
        """
        if self.mode != "rgb_array":
            return None if self.mode is None else lines(session)
        if ground_of(session.env.world.home) is None:
            raise HearthError.of(Code.NOT_RENDERED, "a home without geometry has no pictures", suggestion="ansi")
        return self._plan(session.env.world) if self.camera == PLAN else self._seen(session)

    def _seen(self, session: Session) -> Picture:
        from hearth.rendering.cameras.sensor import CameraSensor

        env = session.env
        start = env.ticks[0].before if env.ticks else env.world
        if self._start is not start:
            env.camera_sensor = CameraSensor(start.graph(), start.home.knowledge, view=self.camera)
            self._start = start
        found: Picture = np.ascontiguousarray(env.observe(0, "rgb")["rgb"][..., :3], np.uint8)
        return found

    def _plan(self, world: World) -> Picture:
        here = ground_of(world.home)
        assert here is not None
        base = here.ground.home
        if self._ground is None or self._ground[0] is not base:
            self._ground = base, _drawn(base)
        picture, area = self._ground[1]
        picture = picture.copy()
        for i in indices(here.displaced(world) & ~world.home.rooms & ~world.home.characters):
            _disc(picture, area, positions.spot(world, i), 0.06, THING)
        for number, agent in enumerate(world.agents):
            if agent.pose is not None:
                angle = math.radians(agent.pose.yaw)
                x, z = agent.pose.point
                colour = AGENTS[number % len(AGENTS)]
                _disc(picture, area, (x, z), BODY_RADIUS, colour)
                nose = (x + math.sin(angle) * BODY_RADIUS, z + math.cos(angle) * BODY_RADIUS)
                _disc(picture, area, nose, BODY_RADIUS / 3, colour)
                if agent.held:
                    _disc(picture, area, (x, z), 0.1, THING)
        return picture


def _drawn(home: Home) -> tuple[Picture, Rect]:
    """Return the floor plan without letters, and its area in meters."""
    layout = measured(World.start(home).graph(), home.name, home.knowledge)
    area = floor_plan_drawing.bounds(layout)
    picture = np.full((round(area.depth * SCALE), round(area.width * SCALE), 3), 255, np.uint8)
    for shape in floor_plan_drawing.shapes(layout):
        if shape.kind != "text" and shape.fill not in AGENTS:
            left, right = round((shape.rect.x0 - area.x0) * SCALE), round((shape.rect.x1 - area.x0) * SCALE)
            top, low = round((area.z1 - shape.rect.z1) * SCALE), round((area.z1 - shape.rect.z0) * SCALE)
            part = picture[max(0, top) : max(low, top + 1), max(0, left) : max(right, left + 1)]
            part[...] = _colour(shape.fill)
            if shape.edge and min(part.shape[:2]) > 2:
                part[[0, -1]] = part[:, [0, -1]] = _colour(shape.edge)
    return picture, area


def _disc(picture: Picture, area: Rect, point: tuple[float, float] | None, radius: float, colour: str) -> None:
    if point is not None:
        x, y = (point[0] - area.x0) * SCALE, (area.z1 - point[1]) * SCALE
        rows, columns = np.ogrid[: picture.shape[0], : picture.shape[1]]
        picture[(columns + 0.5 - x) ** 2 + (rows + 0.5 - y) ** 2 <= (radius * SCALE) ** 2] = _colour(colour)


def _colour(text: str) -> tuple[int, ...]:
    return tuple(bytes.fromhex(text[1:7]))


def lines(session: Session) -> str:
    """Return the state as text: the tick, each agent's last attempt, place and things in hand, and the goal."""
    env = session.env
    goal = f"{session.progress.goal}  [{session.progress.fraction:.0%}]"
    found = [f"tick {len(env.ticks)} of {session.setting.limit}: {goal}"]
    tried = env.ticks[-1].instructions if env.ticks else {}
    for number in range(session.agents):
        pose = env.observe(number).me
        home = env.world.home
        room = "no room" if pose.room is None else home.classes[home.index[pose.room]]
        held = ", ".join(f"{home.classes[home.index[node]]} ({node})" for node in pose.holding) or "nothing"
        failure = session.failures.get(number)
        refused = f": {failure.code}" if failure else ""
        found.append(f"  agent {number}, {pose.posture} in {room} with {held}; {str_step(tried.get(number))}{refused}")
    return "\n".join(found)
