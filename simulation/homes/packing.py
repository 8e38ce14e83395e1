"""Where things stand on and in furniture: found automatically; tidy in containers, spread on tops, no overlaps."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Code
from hearth.schemas.graph import Box
from hearth.simulation.homes.entries import ON_TOP
from hearth.simulation.homes.forms import Form, form
from hearth.simulation.homes.geometry import Rect, bottom, box_over, footprint, top, wall_of
from hearth.simulation.homes.placing import NoPlaceError, shape
from hearth.simulation.homes.plan import Faults, Piece
from hearth.simulation.homes.shell import Thing

if TYPE_CHECKING:
    import numpy as np

MARGIN = 0.015
"""Free rim of a top, and half the least distance between two things on it."""
SHELL = 0.03
"""Thickness of a container's sides."""
SINK = 0.18
"""How deep a sink is let into what it is on."""
STEP = 0.02
FLAT = 0.07
"""Things no higher than this are piled on their like."""
FAR = 0.12
"""On a top, things need not stand further apart than this."""

Local = tuple[float, float, float, float]
"""A rectangle in a support's own axes: along its back from the west or south end, and outwards from its back."""


@dataclass(slots=True)
class Level:
    """A height of a support on which things stand.

    Attributes:
        y: the height above the floor.
        clear: the free height above it.
        taken: what stands there, with the name it is called by.
        piles: how high things are piled where they are, by the place of the pile.
    """

    y: float
    clear: float
    taken: list[tuple[str, Local]]
    piles: dict[Local, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Support:
    """A thing with its levels, in axes of its own.

    Attributes:
        thing: what it is.
        width, depth: of a level.
        rim: the distance from the thing's edges.
        levels: from the lowest.
        tidy: whether things stand in rows from the back, as in containers and on shelves.
    """

    thing: Thing
    width: float
    depth: float
    rim: float
    levels: tuple[Level, ...]
    tidy: bool


def contents(thing: Thing, piece: Piece, shaped: Form, knowledge: Knowledge, faults: Faults) -> Iterator[Thing]:
    """What stands on and in a thing, and on and in that, as the plan's entry says.

    What finds no room is noted as NO_PLACE and left out.
    """
    numbers: dict[str, int] = {}
    for relation, pieces in (("on", piece.on), ("inside", piece.inside)):
        if not pieces:
            continue
        support = _support(thing, shaped, relation, knowledge)
        # Sinks and what is placed by hand come first, then the large; names still follow the plan's order.
        named = [(entry, _names(entry, numbers)) for entry in pieces]
        for entry, names in sorted(named, key=lambda pair: _rank(pair[0], knowledge)):
            yield from _stand(support, entry, names, relation=relation, knowledge=knowledge, faults=faults)


def _names(piece: Piece, numbers: dict[str, int]) -> list[str]:
    base = piece.name or piece.class_name
    names = []
    for _ in range(piece.count):
        numbers[base] = numbers.get(base, 0) + 1
        names.append(base if piece.name and piece.count == 1 else f"{base}.{numbers[base]}")
    return names


def _rank(piece: Piece, knowledge: Knowledge) -> tuple[bool, bool, float]:
    known = form(piece.class_name, knowledge)
    area = known.size[0] * known.size[2] if known else 0.0
    sunk = known is not None and known.mount == "sunk"
    by_hand = any(piece.has(key) for key in ON_TOP)
    return (not sunk, not by_hand, 0.0 if by_hand else -area)


def _support(thing: Thing, shaped: Form, relation: str, knowledge: Knowledge) -> Support:
    width, _, depth = thing.box.size if _along_x(thing) else thing.box.size[::-1]
    low, high = bottom(thing.box), top(thing.box)
    if relation == "on":
        heights = [low + level for level in shaped.levels] or [high]
        ceilings = [*heights[1:], heights[-1] + 10.0]
        if len(heights) > 1:
            ceilings[-1] = high
        levels = tuple(Level(y, above - y - 0.02, []) for y, above in zip(heights, ceilings, strict=True))
        return Support(thing, width - 2 * MARGIN, depth - 2 * MARGIN, MARGIN, levels, len(levels) > 1)
    rim = min(SHELL, 0.1 * min(width, depth))
    base = min(SHELL, 0.1 * (high - low))
    pitch = (high - low - 2 * base) / shaped.shelves
    closed = "CAN_OPEN" in knowledge.objects[thing.class_name].properties or shaped.shelves > 1
    levels = tuple(Level(low + base + k * pitch, pitch - 0.01 if closed else 10.0, []) for k in range(shaped.shelves))
    return Support(thing, width - 2 * rim, depth - 2 * rim, rim, levels, tidy=True)


def _along_x(thing: Thing) -> bool:
    return (thing.yaw or 0.0) % 180 == 0


def _stand(
    support: Support, piece: Piece, names: Sequence[str], *, relation: str, knowledge: Knowledge, faults: Faults
) -> Iterator[Thing]:
    """Find a place for each of an entry's things."""
    shaped = shape(piece, knowledge)
    for name in names:
        try:
            level, local, height, turned = _find(support, piece, shaped)
        except NoPlaceError as why:
            owner = support.thing
            where = f"{'on' if relation == 'on' else 'in'} `{owner.name}`"
            faults.add(Code.NO_PLACE, f"`{piece.class_name}` {where}: {why}", piece.line,
                       "take something away, or make it larger")  # fmt: skip
            return
        level.taken.append((name, local))
        under = level.piles.get(local, 0.0)
        level.piles[local] = under + height
        box = _box(support, level, local, (under - SINK if shaped.mount == "sunk" else under), height)
        yaw = ((support.thing.yaw or 0.0) + (90 if turned else 0)) % 360
        owner_name = support.thing.name
        thing = Thing(
            f"{owner_name}/{name}", piece.class_name, support.thing.room, box, yaw, "item",
            on=owner_name if relation == "on" else "", inside=owner_name if relation == "inside" else "",
            line=piece.line,
        )  # fmt: skip
        yield thing
        yield from contents(thing, piece, shaped, knowledge, faults)


def _find(support: Support, piece: Piece, shaped: Form) -> tuple[Level, Local, float, bool]:
    """A level, a rectangle on it, the height of the thing as it lies there, and whether it is turned sideways.

    Raises:
        NoPlaceError: there is none.
    """
    if any(piece.has(key) for key in ON_TOP):
        width, height, depth = shaped.size
        level, local = _by_hand(support, piece, width, depth)
        _check(support, level, local)
        return level, local, height, False
    pile = _pile(support, piece.class_name, shaped) if support.tidy else None
    if pile is not None:
        return pile
    for (width, height, depth), turned in _ways(shaped.size, support.tidy):
        for level in _level_order(support, piece.class_name):
            place = _best(support, level, width, depth) if height <= level.clear else None
            if place is not None:
                return level, place, height, turned
    pile = _pile(support, piece.class_name, shaped)
    if pile is not None:
        return pile
    raise NoPlaceError("there is no room left")


def _pile(support: Support, class_name: str, shaped: Form) -> tuple[Level, Local, float, bool] | None:
    """The top of a pile of its like, for a flat thing; None where there is none or it would grow too high."""
    height = shaped.size[1]
    if height > FLAT:
        return None
    for level in support.levels:
        for name, local in level.taken:
            under = level.piles[local]
            if name.split(".")[0] == class_name and under + height <= min(level.clear, 4 * FLAT):
                return level, local, height, abs((local[2] - local[0]) - shaped.size[0]) > 1e-6
    return None


def _ways(size: tuple[float, float, float], tidy: bool) -> Iterator[tuple[tuple[float, float, float], bool]]:
    """As it is, turned sideways, laid on its back, set upright; what is thin lies down first unless on a shelf."""
    width, height, depth = size
    if not tidy and min(width, depth) < 0.2 * height:
        yield ((height, width, depth) if width < depth else (width, depth, height)), False
    yield (width, height, depth), False
    yield (depth, height, width), True
    yield (width, depth, height), False
    yield (height, width, depth), False
    yield (depth, width, height), True


def _level_order(support: Support, class_name: str) -> list[Level]:
    """The levels from the emptiest; a tidy support keeps like with like where it can."""

    def rank(pair: tuple[int, Level]) -> tuple[bool, float, int]:
        number, level = pair
        alike = support.tidy and any(name.split(".")[0] == class_name for name, _ in level.taken)
        return (not alike, sum((u1 - u0) * (v1 - v0) for _, (u0, v0, u1, v1) in level.taken), number)

    return [level for _, level in sorted(enumerate(support.levels), key=rank)]


def _by_hand(support: Support, piece: Piece, width: float, depth: float) -> tuple[Level, Local]:
    if piece.has("spot"):
        level = support.levels[-1]
        point = piece.place["spot"] or (support.width / 2 + support.rim, support.depth / 2 + support.rim)
        u, v = point[0] - support.rim, point[1] - support.rim
        u0, v0 = u - width / 2, v - depth / 2
        return level, (u0, v0, u0 + width, v0 + depth)
    key = "before" if piece.has("before") else "beside"
    level, (u0, v0, u1, v1) = _sibling(support, piece.place[key])
    gap = piece.place.get("gap", 2 * MARGIN)
    if key == "before":
        start = (u0 + u1 - width) / 2
        return level, (start, v1 + gap, start + width, v1 + gap + depth)
    if piece.place.get("side") in ("west", "south"):
        return level, (u0 - gap - width, v0, u0 - gap, v0 + depth)
    return level, (u1 + gap, v0, u1 + gap + width, v0 + depth)


def _sibling(support: Support, wanted: str) -> tuple[Level, Local]:
    for level in support.levels:
        for name, local in level.taken:
            if wanted in (name, name.rpartition(".")[0]):
                return level, local
    raise NoPlaceError(f"`{wanted}` does not stand there")


def _check(support: Support, level: Level, local: Local) -> None:
    u0, v0, u1, v1 = local
    slack = support.rim + 1e-6
    if u0 < -slack or v0 < -slack or u1 > support.width + slack or v1 > support.depth + slack:
        raise NoPlaceError("it would stand over the edge")
    for name, (a0, b0, a1, b1) in level.taken:
        if min(a1 - u0, u1 - a0, b1 - v0, v1 - b0) > 1e-6:
            raise NoPlaceError(f"it would stand in `{name}`")


def _candidates(support: Support, width: float, depth: float) -> tuple[np.ndarray, np.ndarray] | None:
    """Lower corners of all places of a size: arrays of shape (places,), along the back first, then outwards."""
    import numpy as np

    across, out = support.width - width, support.depth - depth
    if across < -1e-9 or out < -1e-9:
        return None
    u = np.linspace(0.0, max(across, 0.0), max(1, round(across / STEP)) + 1)
    v = np.linspace(0.0, max(out, 0.0), max(1, round(out / STEP)) + 1)
    grid_v, grid_u = np.meshgrid(v, u, indexing="ij")
    return grid_u.ravel(), grid_v.ravel()


def _distances(level: Level, u: np.ndarray, v: np.ndarray, width: float, depth: float) -> np.ndarray:
    """For each place, the least free distance to what stands there already; at most 0 where they touch."""
    import numpy as np

    best = np.full(u.shape, np.inf)
    for _, (u0, v0, u1, v1) in level.taken:
        gap = np.maximum(np.maximum(u0 - (u + width), u - u1), np.maximum(v0 - (v + depth), v - v1))
        best = np.minimum(best, gap)
    return best


def _best(support: Support, level: Level, width: float, depth: float) -> Local | None:
    """Where a thing of that size stands best: the first free place from the back on tidy supports, else well apart."""
    import numpy as np

    places = _candidates(support, width, depth)
    if places is None:
        return None
    u, v = places
    free = _distances(level, u, v, width, depth)
    far = 0.0 if support.tidy else FAR
    edges = np.minimum(np.minimum(u, support.width - width - u), np.minimum(v, support.depth - depth - v))
    score = np.minimum(free, far) + (0.5 * np.minimum(edges, far) if far else 0.0)
    # Rounded, so that the last digit of a distance does not choose between equal places.
    score = np.where(free >= MARGIN - 1e-9, np.round(score, 4), -np.inf)
    index = int(np.argmax(score))
    if score[index] == -np.inf:
        return None
    u0, v0 = float(u[index]), float(v[index])
    return u0, v0, u0 + width, v0 + depth


def _box(support: Support, level: Level, local: Local, under: float, height: float) -> Box:
    u0, v0, u1, v1 = (value + support.rim for value in local)
    rect = footprint(support.thing.box)
    wall = wall_of(support.thing.yaw or 0.0)
    if wall == "north":
        over = Rect(rect.x0 + u0, rect.z1 - v1, rect.x0 + u1, rect.z1 - v0)
    elif wall == "south":
        over = Rect(rect.x0 + u0, rect.z0 + v0, rect.x0 + u1, rect.z0 + v1)
    elif wall == "east":
        over = Rect(rect.x1 - v1, rect.z0 + u0, rect.x1 - v0, rect.z0 + u1)
    else:
        over = Rect(rect.x0 + v0, rect.z0 + u0, rect.x0 + v1, rect.z0 + u1)
    return box_over(over, level.y + under, level.y + under + height)
