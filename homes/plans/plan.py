"""Floor plans as people write them in YAML (README of data_raw/homes), read into records.

Single entries are checked here: names, keys, numbers. Entries together are checked in `plan_checks`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from hearth.homes.geometry import Rect

OUTSIDE = "outside"


@dataclass(frozen=True, slots=True)
class Window:
    """A window in a room's wall.

    Attributes:
        wall: `north`, `east`, `south` or `west`.
        at: where it begins, from the wall's west or south end; None: in the middle.
        width, height: of the glass, metres.
        sill: the height it begins at.
        curtains: how many curtains hang at it.
        line: in the plan.
    """

    wall: str
    at: float | None
    width: float = 1.2
    height: float = 1.2
    sill: float = 0.9
    curtains: int = 0
    line: int = 0


@dataclass(frozen=True, slots=True)
class Piece:
    """One entry of furniture, or of a thing on or in it.

    Attributes:
        class_name: of the knowledge.
        name: what other entries call it.
        count: how many there are.
        place: how it is placed: key -> value, as `plan_entries.PLACE_KEYS` reads them.
        size: width, height and depth as far as the plan says so.
        on, inside: what stands on it and in it.
        lay: the table setting of each seat.
        line: in the plan.
    """

    class_name: str
    name: str = ""
    count: int = 1
    place: Mapping[str, Any] = field(default_factory=dict)
    size: tuple[float | None, float | None, float | None] = (None, None, None)
    on: tuple[Piece, ...] = ()
    inside: tuple[Piece, ...] = ()
    lay: tuple[Piece, ...] = ()
    line: int = 0

    def with_parts(self, change: Callable[[tuple[Piece, ...]], tuple[Piece, ...]]) -> Piece:
        """Return the same, with its `on`, `inside` and `lay` changed."""
        if not (self.on or self.inside or self.lay):
            return self
        return replace(self, on=change(self.on), inside=change(self.inside), lay=change(self.lay))

    def has(self, key: str) -> bool:
        """Return whether the plan places it by that key."""
        return key in self.place


@dataclass(frozen=True, slots=True)
class Room:
    """A rectangular room.

    Attributes:
        name: unique in the plan; its class unless `class` says otherwise.
        class_name: one of the rooms of the knowledge.
        rect: between the middles of its walls.
        windows: of its walls.
        furniture: in the order of the plan.
        line: in the plan.
    """

    name: str
    class_name: str
    rect: Rect
    windows: tuple[Window, ...] = ()
    furniture: tuple[Piece, ...] = ()
    line: int = 0


@dataclass(frozen=True, slots=True)
class Doorway:
    """A way between two rooms, or out of the home.

    Attributes:
        rooms: the two rooms' names; the second may be `outside`.
        wall: for a door to the outside, which wall of the first room it is in.
        at: where it begins, from the west or south end of the wall both share; None: in the middle.
        width: metres.
        leaf: whether a door hangs in it.
        into: the room it opens into.
        hinge: which end of the opening it hangs at: `low` (west or south) or `high`.
        line: in the plan.
    """

    rooms: tuple[str, str]
    wall: str = ""
    at: float | None = None
    width: float = 0.9
    leaf: bool = True
    into: str = ""
    hinge: str = "low"
    line: int = 0


@dataclass(frozen=True, slots=True)
class Plan:
    """A home as it is planned.

    Attributes:
        name: of the home.
        about: one line about it.
        height: of the rooms, metres.
        rooms, doorways: in the order of the plan.
        character: the room the character stands in at first.
        file: where it stands.
        ids: node ids by the names of things, as far as they are fixed.
    """

    name: str
    rooms: tuple[Room, ...]
    doorways: tuple[Doorway, ...]
    about: str = ""
    height: float = 2.5
    character: str = ""
    file: str = ""
    ids: Mapping[str, int] = field(default_factory=dict)

    def room(self, name: str) -> Room:
        """Return the room of that name.

        Raises:
            KeyError: there is none.
        """
        return {room.name: room for room in reversed(self.rooms)}[name]
