"""Places of things on and in furniture, found automatically: tidy in containers, spread on tops, no overlaps."""

from collections.abc import Iterator, Sequence

from hearth.homes.geometry import Rect, box_over
from hearth.homes.object_shapes import Form, form
from hearth.homes.plans.furniture import NoPlaceError, names_of, shape
from hearth.homes.plans.home_shell import Thing
from hearth.homes.plans.plan import Piece
from hearth.homes.plans.plan_entries import ON_TOP
from hearth.homes.plans.support_surfaces import (  # noqa: F401 - some were here in 0.2
    FAR,
    MARGIN,
    MOST_STEPS,
    SHELL,
    STEP,
    Level,
    Local,
    Support,
    best_place,
    box_of,
    check_free,
    local_of,
    support_of,
)
from hearth.homes.plans.table_setting import places, setting
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Code
from hearth.schemas.graph import Box
from hearth.schemas.yaml_fields import Faults

SINK = 0.18
"""Depth of a sink in its counter."""
FLAT = 0.07
"""Things no higher than this are piled on their like."""
HAND = 1.2
"""Height of a hand, metres: levels near it are filled first."""

NamedPiece = tuple[Piece, list[str], str]
"""An entry, the names of its things, and whether they are `on` or `inside` the support."""


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
        box = box_of(support, level, local, (under - SINK if shaped.mount == "sunk" else under), height)
        yield _item(support.thing, piece, name, box, relation=relation, turned=turned)


def _lay(support: Support, piece: Piece, name: str, rect: Rect, knowledge: Knowledge) -> Thing:
    """Put a thing at a given place on the top.

    Raises:
        NoPlaceError: something else lies there, or it would stick out.
    """
    level, height = support.levels[-1], shape(piece, knowledge).size[1]
    local = local_of(support, rect)
    check_free(support, level, local)
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
        check_free(support, level, local)
        return level, local, height, False
    pile = _pile(support, piece.class_name, shaped) if support.tidy else None
    if pile is not None:
        return pile
    for (width, height, depth), turned in _ways(shaped.size, support.tidy):
        for level in _level_order(support, piece.class_name):
            place = best_place(support, level, width, depth) if height <= level.clear else None
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
