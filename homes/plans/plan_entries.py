"""Reading a plan's entries: every key by the function that reads it; every fault named with its line."""

import re
from typing import Any

from hearth.homes.geometry import DIRECTIONS, Rect
from hearth.homes.plans.plan import OUTSIDE, Doorway, Piece, Plan, Room, Window
from hearth.kb.knowledge import Knowledge
from hearth.schemas import located_yaml
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.vocabulary import ROOM_CATEGORY
from hearth.schemas.yaml_fields import Faults, ReadValue, fields, one_of, reads, shown

CORNERS = ("northwest", "northeast", "southwest", "southeast")
MOST = 60
"""Things one entry may count; a larger number is a fault."""
MOST_ROOMS = 60
MOST_ENTRIES = 1_000
"""Rooms and entries of things in a plan: placing and checking takes time by the square of both. Ours have 9 and 250."""
LONGEST = 100
"""Metres that a home may measure: its floor is a grid of cells of 10 cm."""


def or_middle(read: ReadValue) -> ReadValue:
    """Return a reader that reads `middle` as None, and everything else like another reader."""
    return lambda value: None if value == "middle" else read(value)


number = reads("a number of metres", lambda it: isinstance(it, located_yaml.Number) and abs(it) < 1000, then=float)
length = reads("a length greater than 0", lambda metres: metres > 0, first=number)
whole = reads(f"a whole number from 0 to {MOST}", lambda it: it == int(it) and 0 <= it <= MOST, first=number, then=int)
yes_or_no = reads("true or false", lambda value: isinstance(value, bool))
word = reads("a name", lambda value: isinstance(value, str) and value, then=str)
pair = reads(
    "two numbers, [east, north]",
    lambda value: isinstance(value, list) and len(value) == 2,
    then=lambda value: (number(value[0]), number(value[1])),
)
extent = reads("two lengths greater than 0", lambda lengths: min(lengths) > 0, first=pair)
"""[width, depth]."""
along = or_middle(number)
"""A distance from a wall's west or south end."""
spot = or_middle(pair)
"""A point of the room as [east, north] of its south-west corner."""
direction = one_of(*DIRECTIONS)

PLACE_KEYS: dict[str, ReadValue] = {
    "wall": direction, "at": along, "from_end": number, "corner": one_of(*CORNERS), "beside": word, "side": direction,
    "before": word, "opposite": word, "around": word, "above": word, "spot": spot, "facing": direction,
    "gap": number, "up": number,
}  # fmt: skip
"""The placement of a thing."""

ANCHORS = ("wall", "corner", "beside", "before", "opposite", "around", "above", "spot")
"""The keys of which a piece of furniture has one; `corner` may have a `wall` as well."""

ON_TOP = ("spot", "before", "beside")
"""Those that also place what stands on something: `spot` is then [along its back, out from its back]."""

SIZE_KEYS: dict[str, ReadValue] = {"width": length, "height": length, "depth": length}
WINDOW_KEYS: dict[str, ReadValue] = {
    "wall": direction, "at": along, "width": length, "height": length, "sill": number, "curtains": whole,
}  # fmt: skip
DOOR_KEYS: dict[str, ReadValue] = {
    "between": list, "wall": direction, "at": along, "width": length, "leaf": yes_or_no, "into": word,
    "hinge": one_of("low", "high"),
}  # fmt: skip
ROOM_KEYS: dict[str, ReadValue] = {
    "name": word, "class": word, "at": pair, "size": extent, "windows": list, "furniture": list,
}  # fmt: skip
PLAN_KEYS: dict[str, ReadValue] = {
    "home": word, "about": word, "height": length, "character": word, "rooms": list, "doors": list,
}  # fmt: skip


def read_plan(text: str, file: str, knowledge: Knowledge, faults: Faults) -> Plan:
    """Return a plan from YAML text; what cannot be read is left out and noted.

    Raises:
        HearthError: the text is not a YAML mapping, or is of a home too large to be one.
    """
    tree = located_yaml.read(text, file)
    if not isinstance(tree, located_yaml.Mapping):
        raise HearthError.of(Code.SYNTAX, "a plan is a mapping", file=file, suggestion="home, rooms, doors")
    reader = _Reader(knowledge, faults)
    top = reader.fields(tree, PLAN_KEYS, "a plan", need=("home", "rooms"))
    if len(top.get("rooms") or ()) > MOST_ROOMS:
        raise _too_large(f"{len(top['rooms']):,} rooms", file)
    rooms = [room for entry in top.get("rooms") or () if (room := reader.room(entry)) is not None]
    bounds = Rect.over(room.rect for room in rooms) if rooms else Rect(0, 0, 0, 0)
    if max(bounds.width, bounds.depth) > LONGEST:
        raise _too_large(f"a home of over {LONGEST} m", file)
    doors = [door for entry in top.get("doors") or () if (door := reader.door(entry)) is not None]
    return Plan(
        name=top.get("home", ""),
        rooms=tuple(rooms),
        doorways=tuple(doors),
        about=top.get("about", ""),
        height=top.get("height", 2.5),
        character=top.get("character", ""),
        file=file,
    )


def _too_large(found: str, file: str) -> HearthError:
    limits = f"at most {MOST_ROOMS} rooms, {MOST_ENTRIES:,} entries of things, {LONGEST} m"
    return HearthError.of(Code.FILE_TOO_LARGE, f"a plan cannot have {found}", file=file, suggestion=limits)


def read_piece(entry: Any, knowledge: Knowledge) -> Piece:
    """One entry with the things on and in it, wherever it is placed.

    Raises:
        HearthError: its faults.
    """
    faults = Faults("")
    piece = _Reader(knowledge, faults).piece(entry, furniture=False)
    if piece is None or faults:
        raise HearthError(list(faults))
    return piece


class _Reader:
    """Reads entries of one plan."""

    def __init__(self, knowledge: Knowledge, faults: Faults) -> None:
        self.knowledge = knowledge
        self.faults = faults
        self.entries = 0

    def fields(
        self, entry: Any, keys: dict[str, ReadValue], what: str, need: tuple[str, ...] = (), line: int = 0
    ) -> dict[str, Any]:
        """Return the values of a mapping, read by their keys' readers."""
        return fields(entry, keys, what, self.faults, need, line)

    def room(self, entry: Any) -> Room | None:
        """Return a room with its windows and furniture; None when it has no usable name or place."""
        found = self.fields(entry, ROOM_KEYS, "a room", ("name", "at", "size"))
        if not {"name", "at", "size"} <= found.keys():
            return None
        line = located_yaml.line_of(entry)
        name = found["name"]
        class_name = found.get("class", name)
        known = self.knowledge.objects.get(class_name)
        if known is None or known.category != ROOM_CATEGORY:
            rooms = sorted(n for n, o in self.knowledge.objects.items() if o.category == ROOM_CATEGORY)
            self.faults.add(
                Code.UNKNOWN_OBJECT,
                f"`{class_name}` is not a known class of room",
                line,
                f"`class:` one of {', '.join(rooms)}",
            )
        (x, z), (width, depth) = found["at"], found["size"]
        windows = [w for item in found.get("windows", ()) if (w := self.window(item)) is not None]
        return Room(
            name, class_name, Rect(x, z, round(x + width, 6), round(z + depth, 6)), tuple(windows),
            self.pieces(found.get("furniture", ()), furniture=True), line,
        )  # fmt: skip

    def window(self, entry: Any) -> Window | None:
        """Return a window."""
        found = self.fields(entry, WINDOW_KEYS, "a window", ("wall",))
        return Window(**{"at": None, **found}, line=located_yaml.line_of(entry)) if "wall" in found else None

    def door(self, entry: Any) -> Doorway | None:
        """Return a doorway."""
        found = self.fields(entry, DOOR_KEYS, "a door", ("between",))
        line = located_yaml.line_of(entry)
        rooms = found.pop("between", None)
        if rooms is None:
            return None
        if len(rooms) != 2 or not all(isinstance(room, str) for room in rooms) or rooms[0] == rooms[1]:
            self.faults.add(Code.SYNTAX, "a door is between two rooms", line, f"between: [kitchen, {OUTSIDE}]")
            return None
        first, second = rooms if rooms[0] != OUTSIDE else rooms[::-1]
        return Doorway((str(first), str(second)), **found, line=line)

    def pieces(self, entries: Any, furniture: bool = False) -> tuple[Piece, ...]:
        """Entries of a list: `plate*4`, or `- couch: {wall: south}`."""
        if not isinstance(entries, (list, tuple)):
            self.faults.add(Code.SYNTAX, "things are a list", located_yaml.line_of(entries), "[cup, plate*4]")
            return ()
        self.entries += len(entries)
        if self.entries > MOST_ENTRIES:
            raise _too_large(f"over {MOST_ENTRIES:,} entries", self.faults.file)
        return tuple(piece for entry in entries if (piece := self.piece(entry, furniture)) is not None)

    def piece(self, entry: Any, furniture: bool) -> Piece | None:
        """One thing, or several alike."""
        line = located_yaml.line_of(entry)
        if isinstance(entry, located_yaml.Mapping) and len(entry) == 1:
            ((text, fields),) = entry.items()
            fields = located_yaml.Mapping(line) if fields is None else fields
        elif isinstance(entry, str):
            text, fields = entry, located_yaml.Mapping(line)
        else:
            hint = "`plate*4`, or `couch: {wall: south, at: 1.2}`"
            self.faults.add(Code.SYNTAX, f"`{shown(entry)}` is not an entry", line, hint)
            return None
        match = re.fullmatch(r"\s*([^*\s]+)\s*(?:\*\s*(\d{1,4}))?\s*", text)
        count = int(match[2] or 1) if match else 0
        if match is None or not 1 <= count <= MOST:
            self.faults.add(Code.SYNTAX, f"`{text}` is not an entry", line, f"a class, or class*count up to {MOST}")
            return None
        class_name = self._class(match[1], line)
        return self._piece(class_name, count, fields, line, furniture) if class_name else None

    def _piece(self, class_name: str, count: int, fields: Any, line: int, furniture: bool) -> Piece:
        keys = {"name": word, "on": list, "in": list, "lay": list, **SIZE_KEYS, **PLACE_KEYS}
        found = self.fields(fields, keys, f"`{class_name}`", line=line)
        place = {key: found[key] for key in PLACE_KEYS if key in found}
        anchors = [key for key in ANCHORS if key in place]
        if furniture and len(anchors) != 1 and set(anchors) != {"wall", "corner"}:
            message = f"`{class_name}` is placed by {' and '.join(anchors) or 'nothing'}"
            self.faults.add(Code.SYNTAX, message, line, f"give one of {', '.join(ANCHORS)}")
        if not furniture and (len(anchors) > 1 or not set(anchors) <= set(ON_TOP)):
            message = f"`{class_name}` stands on or in something and is placed by {' and '.join(anchors)} too"
            self.faults.add(Code.SYNTAX, message, line, f"leave it out, or give one of {', '.join(ON_TOP)}")
        return Piece(
            class_name,
            found.get("name", ""),
            count,
            place,
            (found.get("width"), found.get("height"), found.get("depth")),
            self.pieces(found.get("on", ())),
            self.pieces(found.get("in", ())),
            self.pieces(found.get("lay", ())),
            line,
        )

    def _class(self, name: str, line: int) -> str | None:
        """Return the class of that name, when the knowledge has it."""
        if name not in self.knowledge.objects:
            near = self.knowledge.suggest(name)
            hint = f"did you mean `{near[0]}`?" if near else "`kb find` lists the classes"
            self.faults.add(Code.UNKNOWN_OBJECT, f"`{name}` is not a known class", line, hint)
            return None
        return name
