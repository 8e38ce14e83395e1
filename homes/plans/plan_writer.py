"""Plans as the YAML that people write: the inverse of reading one."""

import re
from collections.abc import Iterator, Mapping
from typing import Any

import orjson

from hearth.homes.plans.plan import Doorway, Piece, Plan, Room, Window


def plan_text(plan: Plan) -> str:
    """Return a plan as YAML that reads back as the same plan, but for the lines its entries stand on."""
    lines = [f"home: {_text(plan.name)}"]
    if plan.about:
        lines.append(f"about: {_quoted(plan.about)}")
    lines.append(f"height: {plan.height:g}")
    if plan.character:
        lines.append(f"character: {_text(plan.character)}")
    lines += ["", "rooms:"]
    for room in plan.rooms:
        lines += [*_room(room), ""]
    lines.append("doors:")
    lines.extend(f"  - {_flow(_door(door))}" for door in plan.doorways)
    return "\n".join(lines) + "\n"


def _room(room: Room) -> Iterator[str]:
    yield f"  - name: {_text(room.name)}"
    if room.class_name != room.name:
        yield f"    class: {_text(room.class_name)}"
    yield f"    at: {_flow([room.rect.x0, room.rect.z0])}"
    yield f"    size: {_flow([_metres(room.rect.width), _metres(room.rect.depth)])}"
    if room.windows:
        yield "    windows:"
        yield from (f"      - {_flow(_window(window))}" for window in room.windows)
    if room.furniture:
        yield "    furniture:"
        yield from (f"      - {_piece(piece)}" for piece in room.furniture)


def _piece(piece: Piece) -> str:
    what = _text(f"{piece.class_name}*{piece.count}" if piece.count > 1 else piece.class_name)
    fields: dict[str, Any] = {"name": piece.name} if piece.name else {}
    fields |= {key: _place(value) for key, value in piece.place.items()}
    fields |= {key: size for key, size in zip(("width", "height", "depth"), piece.size, strict=True) if size}
    fields |= {key: list(own) for key, own in (("on", piece.on), ("in", piece.inside), ("lay", piece.lay)) if own}
    return f"{what}: {_flow(fields)}" if fields else what


def _place(value: Any) -> Any:
    if value is None:
        return "middle"
    return list(value) if isinstance(value, tuple) else value


def _window(window: Window) -> dict[str, Any]:
    place = {} if window.at is None else {"at": window.at}
    sizes = {"width": window.width, "height": window.height, "sill": window.sill}
    return {"wall": window.wall, **place, **sizes, **({"curtains": window.curtains} if window.curtains else {})}


def _door(door: Doorway) -> dict[str, Any]:
    fields: dict[str, Any] = {"between": list(door.rooms)}
    if door.wall:
        fields["wall"] = door.wall
    if door.at is not None:
        fields["at"] = door.at
    fields["width"] = door.width
    if not door.leaf:
        return {**fields, "leaf": False}
    return {**fields, **({"into": door.into} if door.into else {}), "hinge": door.hinge}


def _metres(length: float) -> float:
    """Return a difference of coordinates without the last digits' noise."""
    return round(length, 6)


def _flow(value: Any) -> str:
    """Return a value in YAML's flow style."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key}: {_flow(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_flow, value)) + "]"
    if isinstance(value, Piece):
        return _piece(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text(value)
    return f"{value:.6g}" if isinstance(value, float) else str(value)


_PLAIN = re.compile(r"(?!(?:true|false|yes|no|on|off|null|y|n)\b)[A-Za-z_][\w.]*(?:\*\d+)?", re.ASCII | re.IGNORECASE)
"""Texts that YAML reads as themselves without quotes."""


def _text(value: str) -> str:
    return value if _PLAIN.fullmatch(value) else _quoted(value)


def _quoted(value: str) -> str:
    """Return a text in double quotes.

    As in JSON, which is YAML, with YAML's own escapes for the characters that YAML forbids.
    """
    written = orjson.dumps(value).decode()
    return "".join(letter if letter.isprintable() else f"\\U{ord(letter):08x}" for letter in written)
