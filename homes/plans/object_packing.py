"""Places of things on and in furniture, found automatically: tidy in containers, spread on tops, no overlaps."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from hearth.homes.geometry import OPPOSITE_WALL, Rect, bottom, box_over, footprint, top, wall_of
from hearth.homes.object_shapes import Form, form
from hearth.homes.plans.furniture import NoPlaceError, names_of, shape
from hearth.homes.plans.home_shell import Thing, band, span
from hearth.homes.plans.plan import Piece
from hearth.homes.plans.plan_entries import ON_TOP
from hearth.homes.plans.table_setting import places, setting
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Code
from hearth.schemas.graph import Box
from hearth.schemas.yaml_fields import Faults

MARGIN = 0.015
"""Free rim of a top, and half the least distance between two things on it."""
SHELL = 0.03
"""Thickness of a container's sides."""
SINK = 0.18
"""Depth of a sink in its counter."""
STEP = 0.02
"""Metres between the places that are tried, where they are not more than `MOST_STEPS` along a side."""
MOST_STEPS = 40
FLAT = 0.07
"""Things no higher than this are piled on their like."""
HAND = 1.2
FAR = 0.12
"""On a top, things need not stand further apart than this."""

Local = tuple[float, float, float, float]
"""A rectangle in a support's own axes: along its back from the west or south end, and outwards from its back."""

NamedPiece = tuple[Piece, list[str], str]
"""An entry, the names of its things, and whether they are `on` or `inside` the support."""


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
        apart: how far things should stand apart; 0: in rows from the back, as in containers and on shelves.
    """

    thing: Thing
    width: float
    depth: float
    rim: float
    levels: tuple[Level, ...]
    apart: float

    @property
    def tidy(self) -> bool:
        """Return whether things stand in rows from the back."""
        return self.apart == 0


def contents(
    thing: Thing, piece: Piece, knowledge: Knowledge, faults: Faults, seats: Sequence[Thing] = ()
) -> Iterator[Thing]:
    """All things on and in a thing, and on and in those, by the plan's entry; `seats` are those of its room.

    What finds no room is noted as NO_PLACE and left out.
    """
    opened = [_direct(thing, piece, knowledge, faults, seats)]
    while opened:
        found = next(opened[-1], None)
        if found is None:
            opened.pop()
        else:
            entry, stood = found
            yield stood
            opened.append(_direct(stood, entry, knowledge, faults))


def _direct(
    thing: Thing, piece: Piece, knowledge: Knowledge, faults: Faults, seats: Sequence[Thing] = ()
) -> Iterator[tuple[Piece, Thing]]:
    """Yield the things on and in a thing itself, with their entries."""
    numbers: dict[str, int] = {}
    shaped = shape(piece, knowledge)
    settings = list(_settings(thing, piece.lay, seats, numbers, knowledge))
    named = [(entry, names_of(entry, numbers), "on") for entry in piece.on]
    named += [(entry, names_of(entry, numbers), "inside") for entry in piece.inside]
    # Sinks and things placed by hand come first, then the large ones; names still follow the plan's order.
    named.sort(key=lambda item: _rank(item[0], knowledge))
    for level in ("on", "inside"):
        here = [item for item in named if _level_of(item[0], item[2], shaped, knowledge) == level]
        fixed = settings if level == "on" else []
        if here or fixed:
            standing, missed = _arranged(thing, shaped, level, (here, fixed), knowledge)
            yield from standing
            for entry, why in missed:
                where = f"{'on' if level == 'on' else 'in'} `{thing.name}`"
                faults.add(Code.NO_PLACE, f"`{entry.class_name}` {where}: {why}", entry.line,
                           "take something away, or make it larger")  # fmt: skip


def _level_of(piece: Piece, relation: str, holder: Form, knowledge: Knowledge) -> str:
    """Return whether a thing stands where things are `on` its support or in its hollow.

    A sink is INSIDE a counter and let into its top. Things INSIDE a bookcase stand on its open shelves.
    """
    known = form(piece.class_name, knowledge)
    on_top = (known is not None and known.mount == "sunk") or len(holder.levels) > 1
    return "on" if on_top else relation


def _settings(
    table: Thing, lay: Sequence[Piece], seats: Sequence[Thing], numbers: dict[str, int], knowledge: Knowledge
) -> Iterator[tuple[Piece, str, Rect]]:
    """Yield the table setting of each seat: the entry, its name and its rectangle."""
    sizes = [shape(entry, knowledge).size for entry in lay]
    for place in places(table, seats) if lay else ():
        rects = setting(place, [(width, depth) for width, _, depth in sizes])
        for entry, rect in zip(lay, rects, strict=True):
            yield entry, names_of(entry, numbers)[0], rect


def _arranged(
    thing: Thing,
    shaped: Form,
    relation: str,
    wanted: tuple[Sequence[NamedPiece], Sequence[tuple[Piece, str, Rect]]],
    knowledge: Knowledge,
) -> tuple[list[tuple[Piece, Thing]], list[tuple[Piece, str]]]:
    """Places for all things, widely spaced if possible, closer if necessary; and the things without one, with why."""
    named, settings = wanted
    for apart in (FAR, FAR / 3, 0.0):
        support = support_of(thing, shaped, relation, knowledge, apart)
        found: list[tuple[Piece, Thing]] = []
        missed: list[tuple[Piece, str]] = []
        for entry, name, rect in settings:
            try:
                found.append((entry, _lay(support, entry, name, rect, knowledge)))
            except NoPlaceError as why:
                missed.append((entry, str(why)))
        for entry, names, word in named:
            try:
                found.extend((entry, stood) for stood in stand(support, entry, names, word, knowledge))
            except NoPlaceError as why:
                missed.append((entry, str(why)))
        if not missed or support.tidy:
            break
    return found, missed


def _rank(piece: Piece, knowledge: Knowledge) -> tuple[bool, bool, float]:
    known = form(piece.class_name, knowledge)
    area = known.size[0] * known.size[2] if known else 0.0
    sunk = known is not None and known.mount == "sunk"
    by_hand = any(piece.has(key) for key in ON_TOP)
    return (not sunk, not by_hand, 0.0 if by_hand else -area)


def support_of(thing: Thing, shaped: Form, relation: str, knowledge: Knowledge, apart: float) -> Support:
    """Return a thing with the levels on (or in) it, still empty."""
    width, _, depth = thing.box.size if _along_x(thing) else thing.box.size[::-1]
    low, high = bottom(thing.box), top(thing.box)
    if relation == "on":
        heights = [low + level for level in shaped.levels] or [high]
        ceilings = [*heights[1:], heights[-1] + 10.0]
        if len(heights) > 1:
            ceilings[-1] = high
        levels = tuple(Level(y, above - y - 0.02, []) for y, above in zip(heights, ceilings, strict=True))
        apart = 0.0 if len(levels) > 1 else apart
        return Support(thing, width - 2 * MARGIN, depth - 2 * MARGIN, MARGIN, levels, apart)
    rim = min(SHELL, 0.1 * min(width, depth))
    base = min(SHELL, 0.1 * (high - low))
    pitch = (high - low - 2 * base) / shaped.shelves
    closed = "CAN_OPEN" in knowledge.objects[thing.class_name].properties or shaped.shelves > 1
    levels = tuple(Level(low + base + k * pitch, pitch - 0.01 if closed else 10.0, []) for k in range(shaped.shelves))
    return Support(thing, width - 2 * rim, depth - 2 * rim, rim, levels, apart=0.0)


def _along_x(thing: Thing) -> bool:
    return (thing.yaw or 0.0) % 180 == 0


def stand(support: Support, piece: Piece, names: Sequence[str], relation: str, knowledge: Knowledge) -> Iterator[Thing]:
    """Find a place for each of an entry's things.

    Raises:
        NoPlaceError: there is none for one of them.
    """
    shaped = shape(piece, knowledge)
    for name in names:
        level, local, height, turned = _find(support, piece, shaped)
        level.taken.append((name, local))
        under = level.piles.get(local, 0.0)
        level.piles[local] = under + height
        box = _box(support, level, local, (under - SINK if shaped.mount == "sunk" else under), height)
        yield _item(support.thing, piece, name, box, relation=relation, turned=turned)


def _lay(support: Support, piece: Piece, name: str, rect: Rect, knowledge: Knowledge) -> Thing:
    """Put a thing at a given place on the top.

    Raises:
        NoPlaceError: something else lies there, or it would stick out.
    """
    level, height = support.levels[-1], shape(piece, knowledge).size[1]
    local = local_of(support, rect)
    _check(support, level, local)
    level.taken.append((name, local))
    level.piles[local] = height
    return _item(support.thing, piece, name, box_over(rect, level.y, level.y + height), relation="on")


def _item(owner: Thing, piece: Piece, name: str, box: Box, *, relation: str, turned: bool = False) -> Thing:
    yaw = ((owner.yaw or 0.0) + (90 if turned else 0)) % 360
    on, inside = (owner.name, "") if relation == "on" else ("", owner.name)
    full = f"{owner.name}/{name}"
    return Thing(full, piece.class_name, owner.room, box, yaw, "item", on=on, inside=inside, line=piece.line)


def _find(support: Support, piece: Piece, shaped: Form) -> tuple[Level, Local, float, bool]:
    """Return a level, a rectangle on it, the height of the thing as it lies there, and whether it is turned sideways.

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
    """Return the top of a pile of its like, for a flat thing; None where there is none or it would grow too high."""
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
    """As it is, turned sideways, on its back, upright; what is thin lies down first unless on a shelf."""
    width, height, depth = size
    if not tidy and min(width, depth) < 0.2 * height:
        yield ((height, width, depth) if width < depth else (width, depth, height)), False
    yield (width, height, depth), False
    yield (depth, height, width), True
    yield (width, depth, height), False
    yield (height, width, depth), False
    yield (depth, width, height), True


def _level_order(support: Support, class_name: str) -> list[Level]:
    """Return the levels from the emptiest, those at hand's height first.

    A tidy support keeps like with like where it can.
    """

    def rank(level: Level) -> tuple[bool, float, float]:
        alike = support.tidy and any(name.split(".")[0] == class_name for name, _ in level.taken)
        taken = sum((u1 - u0) * (v1 - v0) for _, (u0, v0, u1, v1) in level.taken)
        return (not alike, taken, abs(level.y - HAND))

    return sorted(support.levels, key=rank)


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


def _best(support: Support, level: Level, width: float, depth: float) -> Local | None:
    """Return where a thing of that size stands best.

    The first free place from the back on tidy supports, else well apart.
    """
    across, out = support.width - width, support.depth - depth
    if across < -1e-9 or out < -1e-9:
        return None
    u, v = _steps(across), _steps(out)
    free = _free(level, u, v, width, depth)
    allowed = free >= MARGIN - 1e-9
    if not support.tidy:
        edge_u, edge_v = np.minimum(u, across - u), np.minimum(v, out - v)
        edges = np.minimum(edge_v[:, None], edge_u[None])
        score = np.minimum(free, support.apart) + 0.5 * np.minimum(edges, support.apart)
        # Rounded, so that the last digit of a distance does not choose between equal places.
        free = np.where(allowed, np.round(score, 4), -1.0)
    index = int(np.argmax(allowed if support.tidy else free))
    row, column = divmod(index, len(u))
    if not allowed[row, column]:
        return None
    u0, v0 = float(u[column]), float(v[row])
    return u0, v0, u0 + width, v0 + depth


def _steps(length: float) -> np.ndarray:
    """Places along a length, both ends among them."""
    count = min(MOST_STEPS, max(1, round(length / STEP)))
    return np.arange(count + 1) * (max(length, 0.0) / count)


def _free(level: Level, u: np.ndarray, v: np.ndarray, width: float, depth: float) -> np.ndarray:
    """Return, for a thing with its corner at each (v, u), the least distance to the things that stand there.

    Negative where they meet.
    """
    taken = np.array([local for _, local in level.taken], float).reshape(-1, 4)
    gap_u = np.maximum(taken[:, 0, None] - (u + width), u - taken[:, 2, None])
    gap_v = np.maximum(taken[:, 1, None] - (v + depth), v - taken[:, 3, None])
    least: np.ndarray = np.maximum(gap_v[:, :, None], gap_u[:, None, :]).min(axis=0, initial=FAR)
    return least


def _box(support: Support, level: Level, local: Local, under: float, height: float) -> Box:
    u0, v0, u1, v1 = (value + support.rim for value in local)
    rect = footprint(support.thing.box)
    wall = wall_of(support.thing.yaw or 0.0)
    low = span(rect, wall)[0]
    return box_over(band(rect, wall, low + u0, low + u1, v0, v1), level.y + under, level.y + under + height)


def local_of(support: Support, rect: Rect) -> Local:
    """Return a rectangle of the room in the support's own axes: the inverse of `_box`."""
    over = footprint(support.thing.box)
    wall = wall_of(support.thing.yaw or 0.0)
    low = span(over, wall)[0]
    u0, u1 = (along - low for along in span(rect, wall))
    v0, v1 = over.reach(wall) - rect.reach(wall), over.reach(wall) + rect.reach(OPPOSITE_WALL[wall])
    return u0 - support.rim, v0 - support.rim, u1 - support.rim, v1 - support.rim
