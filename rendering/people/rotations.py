"""Rotations of bodies and bones."""

from math import cos, radians, sin, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.floating[Any]]


def leaning(degrees: float) -> Vector:
    """Return the rotation by which a body leans forward."""
    c, s = cos(radians(degrees)), sin(radians(degrees))
    return np.array(((1, 0, 0), (0, c, -s), (0, s, c)))


def yawed(degrees: float) -> Vector:
    """Return the rotation about y from +z towards +x."""
    c, s = cos(radians(degrees)), sin(radians(degrees))
    return np.array(((c, 0, s), (0, 1, 0), (-s, 0, c)))


def about(axis: Vector, degrees: float) -> Vector:
    """Return the right-handed rotation about a unit vector (Rodrigues)."""
    c, s = cos(radians(degrees)), sin(radians(degrees))
    x, y, z = axis
    cross = np.array(((0, -z, y), (z, 0, -x), (-y, x, 0)))
    found: Vector = np.eye(3) * c + np.outer(axis, axis) * (1 - c) + cross * s
    return found


def unit(vector: Vector) -> Vector:
    """Return the vector with length 1."""
    return vector / max(sqrt(float(vector @ vector)), 1e-9)
