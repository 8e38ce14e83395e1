"""Procedural furnishing of a room: data_raw/furnishing.yaml lists its contents, places are tried at random."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from importlib.resources import files
from random import Random
from typing import Any

from hearth.homes.geometry import DIRECTIONS, Rect, box_over, footprint, front_of, wall_of
from hearth.homes.plans import located
from hearth.homes.plans.furniture import PLACERS, Furnishing, NoPlaceError, Placed, shape, underside
from hearth.homes.plans.plan import Faults, Piece, Room
from hearth.homes.plans.shell import Opening, Shell, Thing, before, interior, span, strip
from hearth.homes.procedural.partial_room import Suite
from hearth.homes.procedural.stocking import stock
from hearth.kb.knowledge import Knowledge

TRIES = 8
"""Places tried along each wall."""
LOW = 1.0
"""What begins higher does not stand in the way of what is used from the floor."""
FRONT_OF_WINDOW = 0.9
"""What is higher is not put before a window."""


TABLES = {2: 1.1, 4: 1.4, 6: 1.8}
"""Metres of table by number of people."""
RUN = frozenset({"dishwasher", "freezer", "fridge", "kitchen_counter", "oven", "stove"})
"""Classes that stand side by side in a kitchen."""


class UnfurnishableError(Exception):
    """A room has no place for what it needs."""


def furnish(room: Room, height: float, shell: Shell, knowledge: Knowledge, rng: Random) -> tuple[Piece, ...]:
    """A room's furniture with what stands on and in it, as entries of a plan.

    Raises:
        UnfurnishableError: something that such a room needs found no place.
    """
    furnishing = Furnishing(room, interior(room), height, knowledge, Faults(""))
    openings = [opening for opening in shell.openings if opening.room == room.name]
    kept = [zone for name, zone, _ in shell.kept_free if name == room.name]
    suite = Suite(furnishing, openings, kept, rng)
    for entry in recipes()[room.class_name]:
        if rng.random() >= entry.get("chance", 1.0):
            continue
        done = GROUPS[entry["group"]](suite) if "group" in entry else _single(suite, entry)
        if not done and entry.get("needed"):
            raise UnfurnishableError(f"{room.name}: {entry.get('thing') or entry.get('group')}")
    return tuple(suite.pieces)


@lru_cache(maxsize=1)
def recipes() -> Mapping[str, Sequence[Mapping[str, Any]]]:
    """What each class of room holds."""
    text = (files("hearth.data_raw") / "furnishing.yaml").read_text(encoding="utf-8")
    # Not by yaml.load: to it, the key `on` is the truth value.
    found: Mapping[str, Sequence[Mapping[str, Any]]] = located.read(text, "furnishing.yaml")
    return found


# Where things go


def _single(suite: Suite, entry: Mapping[str, Any]) -> bool:
    piece = Piece(entry["thing"])
    if "width" in entry:
        piece = replace(piece, size=(round(suite.rng.uniform(*entry["width"]), 1), None, None))
    also = (Piece(name, count=int(suite.rng.uniform(*amount))) for name, amount in entry.get("also", {}).items())
    piece = replace(piece, on=tuple(item for item in also if item.count))
    piece = stock(piece, entry, suite.furnishing.room.class_name, suite.knowledge, suite.rng)
    if "above" in entry:
        return _put(suite, [replace(piece, place={"above": str(entry["above"])})])
    return (entry.get("run", False) and _in_a_run(suite, piece)) or _along_walls(suite, piece)


def _in_a_run(suite: Suite, piece: Piece) -> bool:
    """Put a piece directly beside one that stands at a wall already."""
    for placed in reversed(suite.furnishing.placed):
        if placed.piece.class_name in RUN:
            sides = ["east", "west"] if wall_of(placed.thing.yaw or 0.0) in ("north", "south") else ["north", "south"]
            for side in sides:
                start, rect = {"east": 1, "west": -1, "north": 1, "south": -1}[side], footprint(placed.thing.box)
                at = _beside(suite, placed.thing, rect, start, shape(piece, suite.knowledge).size[0])
                if _put(suite, [replace(piece, place=at)]):
                    return True
    return False


def _beside(suite: Suite, thing: Thing, rect: Rect, way: int, width: float) -> dict[str, Any]:
    """The place at the same wall, directly after (1) or before (-1) a thing."""
    wall = wall_of(thing.yaw or 0.0)
    low, high = span(rect, wall)
    origin = span(suite.furnishing.inner, wall)[0]
    return {"wall": wall, "at": round((high if way > 0 else low - width) - origin, 3)}


Wanted = Piece | Callable[[], Piece]
"""A piece, or what makes it once those before it have their places."""


def _along_walls(suite: Suite, piece: Piece, *after: Wanted) -> bool:
    """Put a piece somewhere along a wall, with the pieces that go with it; all of them or none."""
    shaped = shape(piece, suite.knowledge)
    walls = list(DIRECTIONS)
    suite.rng.shuffle(walls)
    for wall in walls:
        low, high = span(suite.furnishing.inner, wall)
        room = high - low - shaped.size[0]
        if room < 0.06:
            continue
        for at in _positions(suite, room):
            place = {"wall": wall, "at": round(at, 2)}
            if _put(suite, [replace(piece, place=place), *after]):
                return True
    return False


def _positions(suite: Suite, room: float) -> list[float]:
    """Both ends first, as people do, then places between."""
    ends = [0.03, room - 0.03]
    suite.rng.shuffle(ends)
    return ends + [suite.rng.uniform(0.03, room - 0.03) for _ in range(TRIES - 2)]


def _put(suite: Suite, pieces: Sequence[Wanted]) -> bool:
    """Place pieces that belong together, each after the other, or leave everything as it was."""
    known = suite.furnishing
    before = (len(known.placed), len(suite.solids), len(suite.kept), len(suite.pieces), dict(known.named))
    for piece in pieces:
        if not _try(suite, piece if isinstance(piece, Piece) else piece()):
            del known.placed[before[0] :], suite.solids[before[1] :], suite.kept[before[2] :], suite.pieces[before[3] :]
            known.named = before[4]
            return False
    return True


def _try(suite: Suite, piece: Piece) -> bool:
    known = suite.furnishing
    key = next((key for key in PLACERS if key in piece.place), "")
    reference = piece.place.get(key)
    if key in ("above", "before", "beside", "opposite", "around") and reference not in known.named:
        return False
    try:
        shaped = shape(piece, suite.knowledge)
        spots = PLACERS[key](piece, shaped, known)
    except NoPlaceError:
        return False
    low = underside(piece, shaped, known)
    front = 0.0 if piece.class_name == "bed" else shaped.front
    for number, (rect, yaw) in enumerate(spots):
        if not _fits(suite, rect, low, low + shaped.size[1], shaped.mount, yaw):
            return False
        zone = before(rect, yaw, front)
        if front and any(y0 < LOW and _meet(zone, other) for other, y0, _ in suite.solids):
            return False
        if shaped.mount != "flat":
            suite.solids.append((rect, low, low + shaped.size[1]))
        if front:
            suite.kept.append(zone)
        thing = _stand_in(suite, piece, number, rect, yaw, (low, low + shaped.size[1]))
        placed = Placed(piece, thing)
        known.placed.append(placed)
        # A copy, so that what `_put` kept aside stays as it was.
        known.named = {**known.named, piece.name or piece.class_name: [placed]}
    suite.pieces.append(piece)
    return True


def _stand_in(suite: Suite, piece: Piece, number: int, rect: Rect, yaw: float, heights: tuple[float, float]) -> Thing:
    name = f"{suite.furnishing.room.name}/{piece.class_name}.{number}"
    return Thing(name, piece.class_name, suite.furnishing.room.name, box_over(rect, *heights), yaw)


def _meet(a: Rect, b: Rect) -> bool:
    return a.x0 < b.x1 - 0.005 and b.x0 < a.x1 - 0.005 and a.z0 < b.z1 - 0.005 and b.z0 < a.z1 - 0.005


def _fits(suite: Suite, rect: Rect, y0: float, y1: float, mount: str, yaw: float) -> bool:
    if not suite.furnishing.inner.contains(rect) or y1 > suite.furnishing.height:
        return False
    if mount != "flat" and any(y0 < top and low < y1 and _meet(rect, other) for other, low, top in suite.solids):
        return False
    if y0 < LOW and mount != "flat" and any(_meet(rect, zone) for zone in suite.kept):
        return False
    deep = min(rect.width, rect.depth) > 0.1
    if LOW <= y0 < 1.8 and deep and any(_meet(rect, zone) for zone in suite.kept[: _doors(suite)]):
        return False
    return not any(_hides(suite, opening, rect, y0, y1, mount, yaw) for opening in suite.openings)


def _doors(suite: Suite) -> int:
    """How many of the kept zones are doors' (they come first)."""
    return sum(opening.door is not None for opening in suite.openings)


def _hides(suite: Suite, opening: Opening, rect: Rect, y0: float, y1: float, mount: str, yaw: float) -> bool:
    """Whether a thing hangs where a hole in the wall is, or stands high before a window."""
    hole = strip(suite.furnishing.inner, opening.wall, opening.start - 0.03, opening.end + 0.03, 0.3)
    if not _meet(rect, hole):
        return False
    if mount == "wall":
        return wall_of(yaw) == opening.wall and y0 < opening.y1 and opening.y0 < y1
    return opening.window is not None and y1 > FRONT_OF_WINDOW


# What belongs together


def _sleeping(suite: Suite) -> bool:
    """A bed with a nightstand or two, a rug, a picture."""
    rng, child = suite.rng, suite.furnishing.room.class_name == "kids_bedroom"
    pillows = 1 if child else 2
    bed = Piece("bed", count=1, size=(1.0 if child else rng.choice((1.4, 1.6, 1.8)), None, None),
                on=(Piece("pillow", count=pillows), Piece(rng.choice(("blanket", "comforter")))))  # fmt: skip

    def stand(side: str = "") -> Piece:
        piece = Piece("nightstand", on=(Piece(rng.choice(("tablelamp", "lamp"))),))
        place = {"beside": "bed", "gap": 0.05} | ({"side": side} if side else {})
        stocked = stock(piece, {"on": [0, 1], "in": [0, 2]}, "bedroom", suite.knowledge, rng)
        return replace(stocked, place=place)

    def other() -> Piece:
        return stand(_other_side(suite))

    done = (not child and _along_walls(suite, bed, stand, other)) or _along_walls(suite, bed, stand)
    done = done or _along_walls(suite, bed, other) or _along_walls(suite, bed)
    if done:
        _put(suite, [Piece("drawing", place={"above": "bed", "up": 1.5})])
        _put(suite, [Piece("mat", place={"before": "bed", "gap": 0.05}, size=(1.2, None, 0.7))])
    return done


def _other_side(suite: Suite) -> str:
    wall = wall_of(suite.furnishing.named["bed"][-1].thing.yaw or 0.0)
    return "west" if wall in ("north", "south") else "south"


def _watching(suite: Suite) -> bool:
    """A television, and what one watches it from."""
    rng = suite.rng
    stand = stock(
        Piece("tvstand", on=(Piece("television"),)), {"on": [0, 1], "in": [1, 4]}, "living_room", suite.knowledge, rng
    )
    table = stock(Piece("coffee_table"), {"on": [2, 5]}, "living_room", suite.knowledge, rng)

    rug = Piece("mat", place={"before": "couch", "gap": 0.2}, size=(1.8, None, 1.2))
    low = replace(table, place={"before": "couch", "gap": 0.4})

    def couch() -> Piece:
        return _couch(suite, suite.furnishing.named["tvstand"][-1].thing)

    done = _along_walls(suite, stand, couch, rug, low) or _along_walls(suite, stand, couch)
    if done:
        _put(suite, [Piece("drawing", place={"above": "couch", "up": 1.5})])
    return done


def _couch(suite: Suite, shown: Thing) -> Piece:
    """A couch that looks at it: from the wall across, or out in the room where that is far."""
    inner = suite.furnishing.inner
    yaw = shown.yaw or 0.0
    front = front_of(yaw)
    x, _, z = shown.box.center
    far = inner.reach(front) - Rect(x, z, x, z).reach(front)
    couch = Piece("couch", on=(Piece("pillow", count=suite.rng.choice((1, 2, 3))),))
    if far <= 4.0:
        return replace(couch, place={"opposite": "tvstand"})
    step = suite.rng.uniform(2.6, 3.0)
    dx, dz = {"north": (0.0, step), "south": (0.0, -step), "east": (step, 0.0), "west": (-step, 0.0)}[front]
    point = (round(x + dx - inner.x0, 2), round(z + dz - inner.z0, 2))
    return replace(couch, place={"spot": point, "facing": wall_of(yaw)})


def _eating(suite: Suite) -> bool:
    """A table with chairs around it, and a setting for each."""
    rng, inner = suite.rng, suite.furnishing.inner
    large = suite.furnishing.room.class_name == "dining_room"
    name = rng.choice(("dining_table", "table")) if large else rng.choice(("kitchen_table", "table"))
    lay = tuple(
        Piece(item) for item in ("plate", "fork", rng.choice(("knife", "spoon")), rng.choice(("glass", "wine_glass")))
    )
    table = Piece(name, lay=lay, on=(Piece(rng.choice(("vase", "centerpiece", "candle"))),))
    for count in (rng.choice((4, 6)), 4, 2) if large else (2,):
        sized = replace(table, size=(TABLES[count], None, 0.8))
        for _ in range(2 * TRIES):
            spotted = _spotted(sized, inner, rng.choice(("north", "east")), 0.9 + 0.1 * count, rng)
            if _put(suite, [spotted, Piece("chair", count=count, place={"around": name})]):
                return True
    small = replace(table, size=(TABLES[2], None, 0.7))
    return not large and _along_walls(suite, small, Piece("chair", place={"before": name, "gap": 0.06}))


def _spotted(piece: Piece, inner: Rect, facing: str, margin: float, rng: Random) -> Piece:
    east, north = rng.uniform(margin, inner.width - margin), rng.uniform(margin, inner.depth - margin)
    return replace(piece, place={"spot": (round(east, 2), round(north, 2)), "facing": facing})


def _working(suite: Suite) -> bool:
    """A desk with a computer, and a chair before it."""
    kit = (
        Piece("computer", place={"spot": (0.18, 0.27)}),
        Piece("cpuscreen", place={"spot": (0.7, 0.16)}),
        Piece("keyboard", place={"before": "cpuscreen", "gap": 0.12}),
        Piece("mousepad", place={"beside": "keyboard"}, on=(Piece("mouse"),)),
        Piece("tablelamp", place={"spot": (1.22, 0.16)}),
    )
    desk = stock(Piece("desk", on=kit), {"on": [0, 2], "in": [2, 5]}, "home_office", suite.knowledge, suite.rng)
    return _with_chair(suite, desk)


def _homework(suite: Suite) -> bool:
    """A child's desk and chair."""
    desk = Piece("desk", size=(1.1, None, 0.6), on=(Piece("lamp"),))
    return _with_chair(suite, stock(desk, {"on": [3, 6], "in": [1, 4]}, "kids_bedroom", suite.knowledge, suite.rng))


def _with_chair(suite: Suite, desk: Piece) -> bool:
    done = _along_walls(suite, desk)
    if done:
        # The chair may stand where the desk is used from.
        zone = suite.kept.pop()
        _put(suite, [Piece("chair", place={"before": "desk", "gap": 0.1})])
        suite.kept.append(zone)
        _put(suite, [Piece("drawing", place={"above": "desk", "up": 1.5})])
    return done


def _cooking(suite: Suite) -> bool:
    """A counter with a sink."""
    rest = Piece("dish_soap"), Piece("sponge")
    return _sink(suite, "kitchen_counter", 0.9, rest, {"on": [0, 1], "in": [2, 4]})


def _washbasin(suite: Suite) -> bool:
    """A basin on its counter, and a cabinet over it."""
    brushes = Piece("toothbrush_holder", inside=(Piece("toothbrush", count=suite.rng.choice((1, 2, 3))),))
    done = _sink(suite, "bathroom_counter", 1.0, (brushes, Piece("soap")), {"on": [0, 2], "in": [3, 7]})
    if done:
        cabinet = Piece("bathroom_cabinet", place={"above": "bathroom_counter"})
        _put(suite, [stock(cabinet, {"in": [4, 8]}, "bathroom", suite.knowledge, suite.rng)])
    return done


def _sink(suite: Suite, counter: str, width: float, rest: Sequence[Piece], amounts: Mapping[str, Any]) -> bool:
    kit = (Piece("sink", place={"spot": (width / 2, 0.33)}), Piece("faucet", place={"spot": (width / 2, 0.09)}))
    room = suite.furnishing.room.class_name
    piece = Piece(counter, size=(width, None, None), on=(*kit, *rest))
    return _along_walls(suite, stock(piece, amounts, room, suite.knowledge, suite.rng))


GROUPS: dict[str, Callable[[Suite], bool]] = {
    "cooking": _cooking,
    "eating": _eating,
    "homework": _homework,
    "sleeping": _sleeping,
    "washbasin": _washbasin,
    "watching": _watching,
    "working": _working,
}
"""What belongs together, by the name data_raw/furnishing.yaml gives it."""
