"""Units of length of a file: as it says, as its sizes show, or as far as its places lie apart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import exp, log, prod
from statistics import median
from typing import Any, NamedTuple

from hearth.interop.scene_graphs.shape import Shape
from hearth.interop.scene_graphs.vectors import Vector
from hearth.kb.spelling import key_of

LONGEST_ROOM = 60.0
"""Metres: things farther apart than this are written in another unit."""

FEWEST_SIZES = 3
"""Things of a known size from which sizes show the unit."""

METRIC = {1.0: log(1.8), 0.01: log(2.5), 0.001: log(2.5)}
"""Metres of a unit, and how far sizes in it may be from the usual ones."""

OTHERS = {0.3048: log(1.35), 0.0254: log(1.35)}
"""The same of feet and inches: sizes must fit them better, as 1 m and 1 ft are less far apart."""

STRANGE = log(6.0)
"""Sizes so far from the usual ones are in no unit that is known."""


class Length(NamedTuple):
    """A unit of length.

    Attributes:
        metres: of a unit.
        reason: why it is assumed; "" for metres.
        fault: why it is in doubt; "" where it is not.
    """

    metres: float
    reason: str = ""
    fault: str = ""


def length_unit(
    places: Sequence[Vector], sizes: Sequence[tuple[Vector, Vector]], shape: Shape, word: str = ""
) -> Length:
    """Return the unit of length of a file.

    Args:
        places: of its things.
        sizes: of its things, each with the usual size of the class.
        shape: whose scale comes first.
        word: the file's own word for its unit.
    """
    if shape.scale:
        return Length(shape.scale, "the mapping says so")
    if key_of(word) in shape.units:
        metres = shape.units[key_of(word)]
        return Length(metres, "" if metres == 1.0 else f"the file says `{word}`")
    found = _by_sizes(sizes) or _by_span(places)
    if word:
        return found._replace(fault=f"`{word[:40]}` is no unit of length that is known")
    off = _off(sizes) + log(found.metres) if len(sizes) >= FEWEST_SIZES else 0.0
    if abs(off) > STRANGE:
        return found._replace(fault=f"its things are {exp(off):.3g} times as large as things of their classes")
    return found


def unit_word(data: Any, shape: Shape) -> str:
    """Return the word that a file has for its unit of length, at its top or in its metadata; "" where it has none."""
    tops = [data] if isinstance(data, Mapping) else []
    tops += [each for top in tops for each in top.values() if isinstance(each, Mapping)]
    for top in tops:
        for key, value in top.items():
            if isinstance(value, str) and key_of(str(key)) in shape.fields["unit"] and value.strip():
                return value.strip()
    return ""


def _off(sizes: Sequence[tuple[Vector, Vector]]) -> float:
    """Return the logarithm of how many times larger things are than usual, whatever axis points upwards."""
    return median(log(prod(given) / prod(known)) / 3 for given, known in sizes)


def _by_sizes(sizes: Sequence[tuple[Vector, Vector]]) -> Length | None:
    if len(sizes) < FEWEST_SIZES:
        return None
    off = _off(sizes)
    for units in (METRIC, OTHERS):
        metres, most = min(units.items(), key=lambda unit: abs(off + log(unit[0])))
        if abs(off + log(metres)) <= most:
            return Length(metres, "" if metres == 1.0 else "so the sizes fit those of the classes")
    return None


def _by_span(places: Sequence[Vector]) -> Length:
    """Return metres, or centimetres or millimetres where the places are far apart."""
    if len(places) < 2:
        return Length(1.0)
    span = max(max(column) - min(column) for column in zip(*places, strict=True))
    metres = next((metres for metres in METRIC if span * metres <= LONGEST_ROOM), 1.0)
    return Length(metres, "" if metres == 1.0 else "as they are so far apart")
