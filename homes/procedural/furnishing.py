"""Procedural furnishing of a room: data_raw/furnishing.yaml lists its contents, places are tried at random."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from importlib.resources import files
from itertools import compress
from random import Random
from typing import Any

from hearth.homes.geometry import DIRECTIONS, Rect, along_x, bottom, facing_from, footprint, front_of, wall_of
from hearth.homes.plans.furniture import GAP, Furnishing, NoPlaceError, Placed, shape, stand, underside
from hearth.homes.plans.home_shell import Opening, Shell, Thing, interior, span, strip
from hearth.homes.plans.obstacles import Obstacles
from hearth.homes.plans.plan import Piece, Room
from hearth.homes.plans.plan_entries import PLACE_KEYS, SIZE_KEYS, read_piece
from hearth.homes.procedural.furniture_contents import stock
from hearth.kb.knowledge import Knowledge
from hearth.schemas import located_yaml
from hearth.schemas.yaml_fields import Faults

TRIES = 8
"""Places tried along each wall, and twice as many out in the room."""
RUN = frozenset({"dishwasher", "freezer", "fridge", "kitchen_counter", "oven", "stove"})
"""Classes that stand side by side in a kitchen."""
EDGE = 0.03
"""Distance between a room's corner and the furniture in it, metres."""
OWN_KEYS = frozenset({"chance", "needed", "run", "with", "then", "more_on", "more_in", "within"})
"""Keys of furnishing.yaml that a plan's entry has not."""
BED = "bed"
"""A bed is got into from its sides: the floor before it is not kept free."""


class UnfurnishableError(Exception):
    """A room has no place for a thing that it needs."""


@dataclass(frozen=True, slots=True)
class Recipe:
    """One entry of furnishing.yaml, whose head explains the keys.

    Attributes:
        text: a class, or several of which one is drawn, with a number.
        fields: the keys of a plan's entry, not yet drawn.
        place: how it is placed; empty: along a wall.
        fill: how many things more stand `on` and `in` it, [least, most].
        together, then, either: of entries placed with it, after it, and instead of it.
    """

    text: str
    fields: Mapping[str, Any]
    place: Mapping[str, Any]
    fill: Mapping[str, Sequence[float]]
    chance: float = 1.0
    needed: bool = False
    run: bool = False
    together: tuple["Recipe", ...] = ()
    then: tuple["Recipe", ...] = ()
    either: tuple["Recipe", ...] = ()


@dataclass(slots=True)
class Suite:
    """A partially furnished room: what has its place, its openings, the floor before its doors, and the generator."""

    furnishing: Furnishing
    openings: list[Opening]
    doors: list[Rect]
    rng: Random
    obstacles: Obstacles | None = None

    def in_the_way(self, user: Thing | None) -> Obstacles:
        """Return the standing things; the place of the user is free: a chair stands in front of its desk."""
        if self.obstacles is None or user is not None:
            solids = [replace(t, front=0.0) if t is user else t for _, t in self.furnishing.placed if t.mount != "flat"]
            found = Obstacles(self.furnishing.room, solids, self.doors, self.openings)
            self.obstacles = found if user is None else None
            return found
        return self.obstacles


def furnish(room: Room, height: float, shell: Shell, knowledge: Knowledge, rng: Random) -> tuple[Piece, ...]:
    """Return a room's furniture with the things on and in it, as entries of a plan.

    Raises:
        UnfurnishableError: something that such a room needs found no place.
    """
    furnishing = Furnishing(room, interior(room), height, knowledge, Faults(""))
    openings = [opening for opening in shell.openings if opening.room == room.name]
    doors = [zone for name, zone, _ in shell.kept_free if name == room.name]
    suite = Suite(furnishing, openings, doors, rng)
    for recipe in recipes()[room.class_name]:
        if rng.random() < recipe.chance and not _done(suite, recipe) and recipe.needed:
            raise UnfurnishableError(f"{room.name}: {recipe.text}")
    return tuple({id(piece): piece for piece, _ in furnishing.placed}.values())


@lru_cache(maxsize=1)
def recipes() -> Mapping[str, Sequence[Recipe]]:
    """Furniture of each class of room."""
    text = (files("hearth.data_raw") / "furnishing.yaml").read_text(encoding="utf-8")
    # Not by yaml.load: to it, the key `on` is the truth value.
    found: Mapping[str, Sequence[Any]] = located_yaml.read(text, "furnishing.yaml")
    return {room: [_recipe(entry) for entry in entries] for room, entries in found.items()}


def _recipe(entry: Any) -> Recipe:
    text, keys = next(iter(entry.items())) if isinstance(entry, Mapping) else (entry, {})
    if text == "either":
        first, *_ = either = tuple(map(_recipe, keys))
        return replace(first, chance=1.0, either=either)
    together, then = (tuple(map(_recipe, keys.get(word, ()))) for word in ("with", "then"))
    return Recipe(
        text,
        {key: value for key, value in keys.items() if key not in OWN_KEYS and key not in PLACE_KEYS},
        {key: value for key, value in keys.items() if key in PLACE_KEYS or key == "within"},
        {key: keys[f"more_{key}"] for key in ("on", "in") if f"more_{key}" in keys},
        **{key: keys[key] for key in ("chance", "needed", "run") if key in keys},
        together=together,
        then=then,
    )


# What is placed


def _done(suite: Suite, recipe: Recipe) -> bool:
    """Place what a recipe says; False when it found no place."""
    if recipe.either:
        return any(suite.rng.random() < each.chance and _done(suite, each) for each in recipe.either)
    piece = _piece(suite, recipe)
    beside = [(other, _piece(suite, other)) for other in recipe.together if suite.rng.random() < other.chance]
    least = max((number for number, (other, _) in enumerate(beside, 1) if other.needed), default=0)
    for count in range(len(beside), least - 1, -1):
        partners = [other for _, other in beside[:count]]
        if any(_put(suite, [each, *partners]) for each in _anywhere(suite, piece, recipe.run)):
            for other in recipe.then:
                if suite.rng.random() < other.chance:
                    _done(suite, other)
            return True
    return False


def _piece(suite: Suite, recipe: Recipe) -> Piece:
    """Return a recipe's entry with everything drawn, stocked by the knowledge."""
    keys = {key: _drawn(value, suite.rng, key in SIZE_KEYS) for key, value in recipe.fields.items()}
    entry = located_yaml.Mapping(0)
    entry[_drawn(recipe.text, suite.rng)] = located_yaml.Mapping(0)
    next(iter(entry.values())).update(keys)
    piece = read_piece(entry, suite.furnishing.knowledge)
    place = {key: _drawn(value, suite.rng, True) if key == "gap" else value for key, value in recipe.place.items()}
    room = suite.furnishing.room.class_name
    return replace(stock(piece, recipe.fill, room, suite.furnishing.knowledge, suite.rng), place=place)


def _drawn(value: Any, rng: Random, metres: bool = False) -> Any:
    """Return a value as in a plan.

    One of `a|b`, a number of `cup*1-3`, metres between two; what is drawn 0 times is gone.
    """
    if isinstance(value, list):
        if metres:
            return located_yaml.Number(round(rng.uniform(*value), 2))
        drawn = (_drawn(item, rng) for item in value)
        return located_yaml.Sequence(item for item in drawn if not str(item).endswith("*0"))
    if isinstance(value, Mapping):
        found = located_yaml.Mapping(0)
        found.update((_drawn(key, rng), _drawn(item, rng, key in SIZE_KEYS)) for key, item in value.items())
        return found
    if not isinstance(value, str):
        return value
    one = rng.choice(value.split("|"))
    if metres:
        return located_yaml.Number(one)
    text, _, amount = one.partition("*")
    least, _, most = amount.partition("-")
    return f"{text}*{rng.randint(int(least), int(most))}" if most else one


# Where it is placed


def _anywhere(suite: Suite, piece: Piece, run: bool) -> Iterator[Piece]:
    """Yield the piece at its candidate places: its own, else next to others of a run, else along the walls."""
    rng, inner = suite.rng, suite.furnishing.inner
    if piece.place.get("spot") == "free":
        for _ in range(2 * TRIES):
            x, z = shape(piece, suite.furnishing.knowledge).size[::2]
            spot = tuple(round(rng.uniform(side, side + max(0.0, room - 2 * side)), 2)
                         for side, room in ((x, inner.width), (z, inner.depth)))  # fmt: skip
            yield replace(piece, place={"spot": spot, "facing": rng.choice(("north", "east"))})
    elif piece.place:
        yield piece
    else:
        if run:
            yield from (replace(piece, place=place) for place in _in_a_run(suite, piece))
        yield from (replace(piece, place=place) for place in _along_walls(suite, piece))


def _in_a_run(suite: Suite, piece: Piece) -> Iterator[Mapping[str, Any]]:
    """Yield places directly next to the things at a wall, on both their sides."""
    width = shape(piece, suite.furnishing.knowledge).size[0]
    for other, thing in reversed(suite.furnishing.placed):
        if other.class_name in RUN:
            wall = wall_of(thing.yaw or 0.0)
            (low, high), origin = span(footprint(thing.box), wall), span(suite.furnishing.inner, wall)[0]
            yield from ({"wall": wall, "at": round(start - origin, 3)} for start in (high, low - width))


def _along_walls(suite: Suite, piece: Piece) -> Iterator[Mapping[str, Any]]:
    """Yield the free ends of each wall first, as people furnish rooms, then the places between."""
    rng, room = suite.rng, suite.furnishing
    form = shape(piece, room.knowledge)
    low, (width, _, depth) = underside(piece, form, room), form.size
    inner, front = room.inner.inset(GAP), 0.0 if piece.class_name == BED else form.front
    for wall in rng.sample(list(DIRECTIONS), 4):
        start, end = span(room.inner, wall)
        most = end - start - width - EDGE
        if most >= EDGE:
            places = [*rng.sample([EDGE, most], 2), *(rng.uniform(EDGE, most) for _ in range(TRIES - 2))]
            places = [round(at, 2) for at in places]
            rects = (strip(inner, wall, start + at, start + at + width, depth) for at in places)
            free = suite.in_the_way(None).free([(rect, facing_from(wall), low) for rect in rects], form, front)
            yield from ({"wall": wall, "at": at} for at in compress(places, free))


def _put(suite: Suite, pieces: Sequence[Piece]) -> bool:
    """Place pieces that belong together, each after the other, or leave everything as it was."""
    placed = suite.furnishing.placed
    before = len(placed)
    for piece in pieces:
        found = next((found for each in _ways(suite, piece) if (found := _stand(suite, each))), None)
        if found is None:
            if len(placed) > before:
                del placed[before:]
                suite.obstacles = None
            return False
        placed += found
        suite.obstacles = None
    return True


def _ways(suite: Suite, piece: Piece) -> Iterator[Piece]:
    """Yield the piece on either side, where any will do; in front of its target, where the wall opposite is too far."""
    place = dict(piece.place)
    if place.get("side") == "any" and (other := suite.furnishing.find(place["beside"])):
        along = along_x(wall_of(other.yaw or 0.0))
        yield from (replace(piece, place={**place, "side": side}) for side in DIRECTIONS if along_x(side) != along)
    elif "within" in place and (shown := suite.furnishing.find(place["opposite"])):
        front = front_of(shown.yaw or 0.0)
        far = suite.furnishing.inner.reach(front) - footprint(shown.box).reach(front)
        if far > place.pop("within"):
            place["before"] = place.pop("opposite")
        yield replace(piece, place=place)
    else:
        yield piece


def _stand(suite: Suite, piece: Piece) -> list[Placed] | None:
    """Return the things of a piece at its place, if that is free."""
    room = suite.furnishing
    try:
        found = stand(piece, [f"{piece.class_name}.{number}" for number in range(piece.count)], room)
    except NoPlaceError:
        return None
    if piece.class_name == BED:
        found = [Placed(piece, replace(thing, front=0.0)) for _, thing in found]
    form, first = shape(piece, room.knowledge), found[0].thing
    low = bottom(first.box)
    if low + form.size[1] > room.height:
        return None
    spots = [(footprint(thing.box), thing.yaw or 0.0, low) for _, thing in found]
    user = room.find(piece.place["before"]) if piece.has("before") else None
    return found if suite.in_the_way(user).free(spots, form, first.front).all() else None
