"""Places at the feet of things, as some files give them, turned into places of their centres."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from hearth.homes.object_shapes import form
from hearth.interop.scene_graphs.entries import Entry
from hearth.kb.knowledge import Knowledge

LEVEL = 0.05
"""Metres between the places of things that stand on one level."""

UNLIKE = 0.2
"""Metres by which the heights of such things differ at least, so that their centres can't be on one level."""


def raised_from_feet(entries: Sequence[Entry], knowledge: Knowledge) -> tuple[list[Entry], list[str]]:
    """Return entries with places of their centres, and the classes of those that were raised.

    Furniture of different heights whose places are on one level has its places at its feet; all entries then have.
    """
    standing = [entry for entry in entries if entry.place is not None and _stands(entry, knowledge)]
    levels = [entry.place[1] for entry in standing if entry.place is not None]
    heights = [_height(entry, knowledge) for entry in standing]
    if len(levels) < 2 or max(levels) - min(levels) > LEVEL or max(heights) - min(heights) < UNLIKE:
        return list(entries), []
    raised = [_raised(entry, knowledge) for entry in entries]
    return raised, [new.class_name for new, old in zip(raised, entries, strict=True) if new is not old]


def _stands(entry: Entry, knowledge: Knowledge) -> bool:
    shaped = form(entry.class_name, knowledge)
    return shaped is not None and shaped.mount == "floor"


def _height(entry: Entry, knowledge: Knowledge) -> float:
    shaped = form(entry.class_name, knowledge)
    return entry.size[1] if entry.size is not None else shaped.size[1] if shaped is not None else 0.0


def _raised(entry: Entry, knowledge: Knowledge) -> Entry:
    height = _height(entry, knowledge)
    if entry.place is None or not height or knowledge.is_room(entry.class_name):
        return entry
    x, y, z = entry.place
    return replace(entry, place=(x, round(y + height / 2, 4), z))
