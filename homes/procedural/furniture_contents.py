"""Stocks furniture: things on and in it, drawn at random by the weights of the knowledge's placements."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from random import Random
from typing import Any

from hearth.homes.object_shapes import form
from hearth.homes.plans.plan import Piece
from hearth.kb.knowledge import Knowledge

SHARPNESS = 3
"""Weights are raised to this power, so that rare placements stay rare."""
MOVABLE = ("Props", "Food", "Clothes", "Decor", "Electronics", "Lamps", "Appliances")
"""Categories of things that stand on and in other things."""
SHARE = 0.45
"""Largest filled share of a top or of a container's floors."""

Candidates = tuple[tuple[str, ...], tuple[float, ...], tuple[float, ...]]
"""Classes, their weights, and the floor each takes in square metres."""


def stock(piece: Piece, amounts: Mapping[str, Any], room: str, knowledge: Knowledge, rng: Random) -> Piece:
    """Return the piece with things on and in it besides what it has.

    `amounts` gives the least and most of `on` and `in`.
    """
    on, inside = piece.on, piece.inside
    if "on" in amounts:
        on += _drawn(piece, "ON", amounts["on"], room, knowledge=knowledge, rng=rng)
    if "in" in amounts:
        inside += _drawn(piece, "IN", amounts["in"], room, knowledge=knowledge, rng=rng)
    return replace(piece, on=on, inside=inside)


def _drawn(
    piece: Piece, relation: str, amount: Sequence[float], room: str, *, knowledge: Knowledge, rng: Random
) -> tuple[Piece, ...]:
    names, weights, areas = _candidates(piece.class_name, relation, room, knowledge)
    if not names:
        return ()
    shaped = form(piece.class_name, knowledge)
    width, _, depth = (
        (own or usual for own, usual in zip(piece.size, shaped.size, strict=True)) if shaped else (0, 0, 0)
    )
    floors = (shaped.shelves if relation == "IN" else max(1, len(shaped.levels))) if shaped else 1
    left = SHARE * width * depth * floors - sum(_area(item, knowledge) for item in piece.on if relation == "ON")
    counts: dict[str, int] = {}
    for name in rng.choices(range(len(names)), weights, k=rng.randint(*map(int, amount))):
        if areas[name] <= left and counts.get(names[name], 0) < 6:
            counts[names[name]] = counts.get(names[name], 0) + 1
            left -= areas[name]
    return tuple(Piece(name, count=count) for name, count in counts.items())


def _area(piece: Piece, knowledge: Knowledge) -> float:
    shaped = form(piece.class_name, knowledge)
    return piece.count * shaped.size[0] * shaped.size[2] if shaped else 0.0


@lru_cache(maxsize=512)
def _candidates(class_name: str, relation: str, room: str, knowledge: Knowledge) -> Candidates:
    """Return the classes that the knowledge allows there, small enough to be carried there; sorted by name."""
    holder = form(class_name, knowledge)
    found: dict[str, float] = {}
    for placement in knowledge.holds(class_name):
        known = knowledge.objects.get(placement.object)
        shaped = form(placement.object, knowledge)
        if known is None or shaped is None or holder is None or placement.relation != relation:
            continue
        if placement.room not in ("", room) or known.category not in MOVABLE or known.same_as:
            continue
        if shaped.mount != "item" or not _goes_in(shaped.size, holder.size, holder.shelves, relation):
            continue
        found[placement.object] = max(found.get(placement.object, 0.0), float(placement.weight) ** SHARPNESS)
    names = tuple(sorted(found))
    areas = tuple(_area(Piece(name), knowledge) for name in names)
    return names, tuple(found[name] for name in names), areas


def _goes_in(size: tuple[float, float, float], holder: tuple[float, float, float], shelves: int, relation: str) -> bool:
    """Return whether it is small compared with its holder."""
    flat, middle, long = sorted(size)
    room = min(holder[0], holder[2]), max(holder[0], holder[2])
    high = holder[1] / shelves - 0.08 if relation == "IN" else 0.6
    return middle < 0.9 * room[0] and long < 0.8 * room[1] and flat < high and size[1] < max(high, 0.01)
