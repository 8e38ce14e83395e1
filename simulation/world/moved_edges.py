"""Movements since the start: edges of the home that no longer count, and new ones, shared between worlds.

Nothing is deleted row by row: a thing that was grabbed is *removed* from a relation, which voids all its old edges of
that relation in both directions at once; what it stands in now is *extra*.
"""

from typing import NamedTuple

from hearth.schemas.short_repr import brief
from hearth.simulation.world.bits import indices

ON, BEARS, INSIDE, CONTENTS, CLOSE, FACING, FACED = range(7)
"""Kinds of extra rows; row (i, kind) has the key 8 * i + kind."""

_INVERSE = (BEARS, ON, CONTENTS, INSIDE, CLOSE, FACED, FACING)


class Moved(NamedTuple):
    """Removed nodes by relation, and extra rows by key. Values: never changed after they are made."""

    on: int = 0
    inside: int = 0
    close: int = 0
    facing: int = 0
    extra: dict[int, int] = {}  # noqa: RUF012 - shared and never written to

    def __repr__(self) -> str:
        return brief(self)


NOTHING = Moved()


def link(extra: dict[int, int], i: int, kind: int, j: int) -> None:
    """Add the edge and its inverse to a dict that nobody else holds yet."""
    key = 8 * i + kind
    extra[key] = extra.get(key, 0) | 1 << j
    key = 8 * j + _INVERSE[kind]
    extra[key] = extra.get(key, 0) | 1 << i


def unlink_all(extra: dict[int, int], i: int, kinds: tuple[int, ...]) -> None:
    """Drop every extra edge of node i of these kinds, in both directions, from a dict that nobody else holds yet."""
    bit = 1 << i
    for kind in kinds:
        row = extra.pop(8 * i + kind, 0)
        inverse = _INVERSE[kind]
        for j in indices(row & ~bit):
            key = 8 * j + inverse
            rest = extra[key] & ~bit
            if rest:
                extra[key] = rest
            else:
                del extra[key]


def unlink(extra: dict[int, int], i: int, kind: int, j: int) -> None:
    """Drop an extra edge and its inverse, if there is one, from a dict that nobody else holds yet."""
    for key, bit in ((8 * i + kind, 1 << j), (8 * j + _INVERSE[kind], 1 << i)):
        rest = extra.get(key, 0) & ~bit
        if rest:
            extra[key] = rest
        else:
            extra.pop(key, None)


def lift(moved: Moved, i: int, room: int) -> Moved:
    """Take node i out of all it is ON, INSIDE and CLOSE to, both ways, and put it INSIDE a room (or nowhere)."""
    bit = 1 << i
    extra = dict(moved.extra)
    unlink_all(extra, i, (ON, BEARS, INSIDE, CONTENTS, CLOSE))
    if room >= 0:
        link(extra, i, INSIDE, room)
    return Moved(moved.on | bit, moved.inside | bit, moved.close | bit, moved.facing, extra)


def carry(moved: Moved, i: int, room: int) -> Moved:
    """Take node i along to a room (or nowhere): it loses INSIDE, CLOSE and FACING both ways and is INSIDE the room."""
    bit = 1 << i
    there = 1 << room if room >= 0 else 0
    extra = moved.extra
    settled = moved.inside & moved.close & moved.facing & bit
    movable = (8 * i + CONTENTS, 8 * i + CLOSE, 8 * i + FACING, 8 * i + FACED)
    if settled and extra.get(8 * i + INSIDE, 0) == there and not any(key in extra for key in movable):
        return moved
    extra = dict(extra)
    unlink_all(extra, i, (INSIDE, CONTENTS, CLOSE, FACING, FACED))
    if there:
        link(extra, i, INSIDE, room)
    return Moved(moved.on, moved.inside | bit, moved.close | bit, moved.facing | bit, extra)


def add(moved: Moved, *edges: tuple[int, int, int]) -> Moved:
    """With more edges, each (i, kind, j)."""
    extra = dict(moved.extra)
    for i, kind, j in edges:
        link(extra, i, kind, j)
    return Moved(moved.on, moved.inside, moved.close, moved.facing, extra)
