"""The words of BDDL as ours: predicates, synsets, substances and rooms, from `words.yaml`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

from hearth.kb.knowledge import Knowledge
from hearth.schemas.yaml_limits import packaged


@dataclass(frozen=True)
class Words:
    """The table of words; see `words.yaml` for its parts."""

    relations: Mapping[str, str]
    states: Mapping[str, tuple[str, str]]
    substances: Mapping[str, Mapping[str, tuple[str, str]]]
    silent: frozenset[str]
    kinds: Mapping[str, str]
    rooms: Mapping[str, str]
    classes: Mapping[str, str]

    def class_of(self, synset: str, knowledge: Knowledge) -> str:
        """Return the class of a synset: by its word, or by the table; "" without one."""
        word = synset.partition(".")[0]
        known = knowledge.object_class(self.classes.get(word, word))
        return "" if known is None else known.name

    def is_of_table(self, synset: str) -> bool:
        """Return whether the class of a synset stands for it by the table."""
        return synset.partition(".")[0] in self.classes

    def kind_of(self, synset: str) -> str:
        """Return the kind of a substance: `dirt`, `water` or `other`."""
        return self.kinds.get(synset.partition(".")[0], "other")

    def room_of(self, name: str, knowledge: Knowledge) -> str:
        """Return the room of ours for a room of BEHAVIOR; "" without one."""
        room = self.rooms.get(name, name)
        return room if knowledge.is_room(room) else ""


@cache
def words() -> Words:
    """Return the table of words."""
    data = packaged("hearth.interop.bddl", "words.yaml")
    return Words(
        data["relations"],
        {name: (true, false) for name, (true, false) in data["states"].items()},
        {name: {kind: (a, b) for kind, (a, b) in kinds.items()} for name, kinds in data["substances"].items()},
        frozenset(data["silent"]),
        {word: kind for kind, listed in data["kinds"].items() for word in listed},
        data["rooms"],
        data["classes"],
    )
