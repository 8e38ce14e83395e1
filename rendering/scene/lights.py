"""Lights: the sun by the time of day, the sky through windows, lamps that are on."""

from dataclasses import dataclass, replace
from math import cos, pi, sin

from hearth.schemas.graph import Point

LinearColor = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Light:
    """A lamp, or a window with the light of the sky.

    Attributes:
        position: of its middle, metres.
        color: linear; a lamp of strength 1 lights white paper fully at a distance of one metre.
        span: half extents along x, y and z, for soft shadows; lamps are small balls, windows flat.
        facing: direction of a window into its room; None for lamps.
        room: (x0, x1, z0, z1) that it lights; by night a lamp's area exceeds its room, for light through doors.
    """

    position: Point
    color: LinearColor
    span: Point = (0.05, 0.05, 0.05)
    facing: Point | None = None
    room: tuple[float, float, float, float] | None = None


@dataclass(frozen=True, slots=True)
class Daylight:
    """Sun and sky at an hour of the day.

    Attributes:
        sun: unit vector towards the sun; None after sunset.
        sunlight: its linear colour.
        zenith, horizon: colours of the sky.
        ambient: ambient light indoors.
        sky: brightness of a square metre of window.
    """

    sun: Point | None
    sunlight: LinearColor
    zenith: LinearColor
    horizon: LinearColor
    ambient: float
    sky: float


SUNRISE, SUNSET = 6.0, 20.0


def daylight(hour: float = 10.0) -> Daylight:
    """Return the light at an hour from 0 to 24; the sun rises in the east (+x) and stands in the south (-z) at noon."""
    if not SUNRISE + 0.5 < hour < SUNSET - 0.5:
        return Daylight(None, (0, 0, 0), (0.01, 0.015, 0.04), (0.03, 0.035, 0.06), 0.17, 0.02)
    share = (hour - SUNRISE) / (SUNSET - SUNRISE)
    height = 0.15 + 0.75 * sin(pi * share)
    around = pi * share
    level = (1 - height * height) ** 0.5
    east, south = cos(around) * level, max(sin(around), 0.25) * level
    norm = (east * east + height * height + south * south) ** 0.5
    warm = max(0.0, 0.55 - height)
    return Daylight(
        (east / norm, height / norm, -south / norm),
        (1.75, 1.62 - 0.9 * warm, 1.4 - 1.8 * warm),
        (0.24, 0.44, 0.86),
        (0.78 + 0.2 * warm, 0.87, 0.96 - 0.5 * warm),
        0.30 + 0.08 * height,
        0.75 + 0.5 * height,
    )


def from_above(day: Daylight) -> Daylight:
    """Return the same hour for views without a ceiling: more of the sky, less sun, and from nearly overhead."""
    if day.sun is None:
        return replace(day, ambient=day.ambient * 1.3)
    red, green, blue = (0.42 * c for c in day.sunlight)
    return replace(day, sun=(0.26, 0.93, -0.26), sunlight=(red, green, blue), ambient=day.ambient * 1.25)


LAMP_COLOR: LinearColor = (1.0, 0.86, 0.64)


SPILL = 2.0
"""Metres that a lamp's light reaches beyond its room by night; by day light through doors is too faint to show."""


def lamp(
    position: Point,
    strength: float = 1.5,
    room: tuple[float, float, float, float] | None = None,
    spill: float = SPILL,
    color: LinearColor = LAMP_COLOR,
) -> Light:
    """Return a lamp that lights its room and `spill` metres around it."""
    red, green, blue = (strength * c for c in color)
    beyond = room and (room[0] - spill, room[1] + spill, room[2] - spill, room[3] + spill)
    return Light(position, (red, green, blue), room=beyond)


def window(center: Point, size: Point, facing: Point, room: tuple[float, float, float, float], day: Daylight) -> Light:
    """Return the light of the sky through a window of full `size` that faces into `room` along `facing`."""
    area = sorted(size)[1] * sorted(size)[2]
    strength = 0.62 * area * day.sky
    color = (0.94 * strength, 0.98 * strength, 1.04 * strength)
    span = (size[0] / 2 * 0.9, size[1] / 2 * 0.9, size[2] / 2 * 0.9)
    inside = tuple(c + 0.1 * f for c, f in zip(center, facing, strict=True))
    return Light((inside[0], inside[1], inside[2]), color, span, facing, room)
