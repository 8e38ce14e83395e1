"""Values that the texts of a home's worlds share: names and sets of nodes, the places and states of seen things.

Worlds share all that did not change between ticks, so that these values recur; each is worked out once and kept by all
that it depends on.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import lru_cache

from hearth.envs.text_agent import USUAL
from hearth.envs.text_protocol_settings import Protocol
from hearth.schemas.vocabulary import CHARACTER_CATEGORY, EVERY_STATE_ID, FURTHER_STATES, STATE_ID
from hearth.simulation.motion.ground import UNTOUCHED
from hearth.simulation.world import edge_rows
from hearth.simulation.world.action_set_3_states import is_wide
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.home import Home
from hearth.simulation.world.moved_edges import BEARS, CONTENTS
from hearth.simulation.world.values_by_movement import ValuesByMovement
from hearth.simulation.world.world import World

FURNISHING = frozenset({"Furniture", "Appliances"})
"""Categories of things that others are put on or in, and that nobody carries."""

SAID_STATES = tuple(
    (number, name.lower().replace("_", " "), name == "CLOSED")
    for name, number in STATE_ID.items()
    if name not in USUAL and name != "OFF"
)
"""States that texts say: number, words, and whether only doors and containers have it said."""

SAID_FURTHER = tuple((EVERY_STATE_ID[name], name.lower().replace("_", " "), False) for name in FURTHER_STATES)
"""Those of worlds of action set 3, besides: what is hot, dirty, cut or empty."""


@dataclass(frozen=True, eq=False)
class Placement:
    """The places of some seen things.

    Attributes:
        top: those that are on and in nothing seen.
        places: those that others are on or in.
        on, inside: by place, the things on it and in it.
        texts: what was written about it, by all that it depends on besides.
    """

    top: int
    places: int
    on: dict[int, int]
    inside: dict[int, int]
    texts: dict[object, str] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Stated:
    """The states of some seen things, in words.

    Attributes:
        words: by node.
        nodes: that have any.
    """

    words: dict[int, str]
    nodes: int


def printable(text: str) -> str:
    """Return a text on one line, with `?` for characters that a terminal would obey."""
    line = " ".join(text.split())
    return line if line.isprintable() else "".join(each if each.isprintable() else "?" for each in line)


@lru_cache(maxsize=16_384)
def class_words(name: str) -> str:
    """Return a class as texts have it; classes are short, and few."""
    return printable(name)


@dataclass(frozen=True, eq=False)
class Layout:
    """Sets of a home's nodes that never change.

    Attributes:
        home: the home.
        names: of each node, as texts have it.
        built: rooms, walls, floors, characters.
        fixtures: nodes that are left out unless they are wanted.
        large: furniture and appliances.
        not_targets: nodes that are not offered to put things on.
        hollow: nodes that things are put in.
        opened: nodes that can be opened.
        placements: of seen things; `placement` fills it.
        texts: of places with the things on and in them, by all that they depend on; `compact_text` fills it.
    """

    home: Home
    names: tuple[str, ...]
    built: int
    fixtures: int
    large: int
    not_targets: int
    hollow: int
    opened: int
    placements: ValuesByMovement[Placement] = field(default_factory=ValuesByMovement)
    texts: dict[object, str] = field(default_factory=dict)


@lru_cache(maxsize=256)
def layout(home: Home, protocol: Protocol) -> Layout:
    """Return the sets of a home; made once."""
    known = home.knowledge
    found = dict.fromkeys(("built", "fixtures", "large", "not_targets", "hollow", "opened"), 0)
    for i, name in enumerate(home.classes):
        category, bit = home.node(i).category, 1 << i
        found["built"] |= bit * (category in UNTOUCHED or category == CHARACTER_CATEGORY)
        found["fixtures"] |= bit * (name in protocol.fixtures)
        found["large"] |= bit * (category in FURNISHING)
        found["not_targets"] |= bit * (name in protocol.not_targets)
        found["hollow"] |= bit * known.affords("PutIn", 1, name)
        found["opened"] |= bit * known.affords("Open", 0, name)
    names = tuple(f"{class_words(name)} {home.ids[i]}" for i, name in enumerate(home.classes))
    return Layout(home, names, **found, placements=ValuesByMovement(), texts={})


def placement(world: World, shown: int, place: Layout) -> Placement:
    """Return where the shown things of a world are: each in the first container that is shown, else on the first."""
    found = place.placements.find(world.moved, shown)
    if found is None:
        top, on, inside = _places(world, shown, place.opened)
        found = _placed(place, top, tuple(on.items()), tuple(inside.items()))
        place.placements.keep(world.moved, shown, found)
    return found


@lru_cache(maxsize=4096)
def _placed(place: Layout, top: int, on: tuple[tuple[int, int], ...], inside: tuple[tuple[int, int], ...]) -> Placement:
    """Return the placement of a home, the same one wherever things stand the same."""
    return Placement(top, mask_of(at for at, _ in (*on, *inside)), dict(on), dict(inside))


def _places(world: World, shown: int, opened: int) -> tuple[int, dict[int, int], dict[int, int]]:
    """Return the things that are on and in nothing shown, and by place those that are on it and in it."""
    moved = world.moved
    bearing, containing = world.home.bearing, world.home.containing
    for key in moved.extra:
        if key & 7 == CONTENTS:
            containing |= 1 << (key >> 3)
        elif key & 7 == BEARS:
            bearing |= 1 << (key >> 3)
    on: dict[int, int] = {}
    inside: dict[int, int] = {}
    left = shown
    for at in indices(containing & shown):
        if found := edge_rows.contents(world, at) & left:
            left ^= found
            (inside if opened >> at & 1 else on)[at] = found
    for at in indices(bearing & shown):
        if found := edge_rows.bears(world, at) & left:
            left ^= found
            on[at] = on.get(at, 0) | found
    return left, on, inside


@lru_cache(maxsize=4096)
def stated(place: Layout, rows: tuple[int, ...], doors: int, room: int | None) -> Stated:
    """Return the unusual states of nodes, and where doors lead.

    Args:
        place: of the home.
        rows: the nodes in each of `SAID_STATES`, and of `SAID_FURTHER` in a world of action set 3.
        doors: those that are shown.
        room: id of the agent's, to which doors are not said to lead.
    """
    home = place.home
    found: dict[int, list[str]] = {}
    for (_, words, _), row in zip((*SAID_STATES, *SAID_FURTHER), rows, strict=False):
        for i in indices(row):
            found.setdefault(i, []).append(words)
    for i in indices(doors):
        rooms = indices(home.between[i] & home.rooms)
        found.setdefault(i, []).extend(f"to {class_words(home.classes[to])}" for to in rooms if home.ids[to] != room)
    said = {i: f" ({', '.join(facts)})" for i, facts in found.items() if facts}
    return Stated(said, mask_of(said))


def said_rows(world: World, kept: int, place: Layout) -> tuple[int, ...]:
    """Return the shown nodes in each of the states that texts say."""
    shut, states = kept & (place.hollow | place.home.doors), world.states
    said = (*SAID_STATES, *SAID_FURTHER) if is_wide(world) else SAID_STATES
    return tuple([states[number] & (shut if closed else kept) for number, _, closed in said])


def runs(ids: Iterable[int]) -> str:
    """Return ascending numbers, three and more in a row as the first and the last: `66-69 74`."""
    found: list[list[int]] = []
    for number in ids:
        if found and number == found[-1][-1] + 1:
            found[-1].append(number)
        else:
            found.append([number])
    return " ".join(f"{run[0]}-{run[-1]}" if len(run) > 2 else " ".join(map(str, run)) for run in found)
