"""Small questions about classes that several parts of grounding ask."""

from __future__ import annotations

from hearth.kb.knowledge import Knowledge


def has(knowledge: Knowledge, name: str, prop: str) -> bool:
    """Whether things of a class have a property; unknown classes have none."""
    thing = knowledge.object_class(name)
    return thing is not None and prop in thing.properties
