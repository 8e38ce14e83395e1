"""Holders of each entry of a file, found from relations, fields and lists within lists."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

from hearth.interop.scene_graphs.entities import Entity, Found, Link
from hearth.interop.scene_graphs.entries import wanted
from hearth.interop.scene_graphs.shape import Shape
from hearth.kb.spelling import key_of

HOLDERS = ("ON", "INSIDE", "")
"""Relations to the holder of a thing; "" where the file does not say which of the two."""


class Tie(NamedTuple):
    """A relation between two entries of a file; `relation` is "" where it only says that the second holds the first."""

    source: Entity
    relation: str
    target: Entity


class Ties(NamedTuple):
    """The relations of a file, and its unusable references, each with its path."""

    ties: tuple[Tie, ...]
    rooms: tuple[tuple[Entity, str], ...]
    unknown_words: tuple[tuple[str, str], ...]
    dangling: tuple[tuple[str, str], ...]
    ambiguous: tuple[tuple[str, str], ...] = ()
    selves: tuple[tuple[str, str], ...] = ()


def ties_of(found: Found, shape: Shape) -> Ties:
    """Return the relations of a file.

    Returns: those between entries; rooms that are only named, each with the entry in it; words that are no relation of
        ours; references to no entry; references to one of several entries; references of an entry to itself.
    """
    by_key: dict[str, Entity] = {}
    twice: set[str] = set()
    for entity in found.entities:
        for key in entity.keys:
            if by_key.setdefault(key, entity) is not entity:
                twice.add(key)
    own = frozenset(by_key)  # a label says which thing is meant where nothing has it as its id or name
    for entity in found.entities:
        if entity.label not in own and by_key.setdefault(entity.label, entity) is not entity:
            twice.add(entity.label)
    reader = _Reader(shape, by_key, frozenset(twice))
    for link in found.links:
        reader.link(link)
    for entity in found.entities:
        reader.fields(entity)
    for mention in found.mentions:
        if mention.owner is not None and by_key[mention.text] is not mention.owner:
            reader.ties.append(Tie(by_key[mention.text], "", mention.owner))
    faults = (reader.words, reader.dangling, reader.ambiguous, reader.selves)
    return Ties(tuple(dict.fromkeys(reader.ties)), tuple(reader.rooms), *map(tuple, faults))


_ENDS = re.compile(r"^(?:(a|b)\s+)?(.*?)(?:\s+(a|b))?$")


class _Reader:
    """A reader of references that knows all entries by their ids, names and labels."""

    def __init__(self, shape: Shape, by_key: Mapping[str, Entity], twice: frozenset[str]) -> None:
        self.shape = shape
        self.by_key = by_key
        self.twice = twice
        self.words_known = {key_of(word): name for word, name in shape.relations.items()}
        self.ties: list[Tie] = []
        self.rooms: list[tuple[Entity, str]] = []
        self.words: list[tuple[str, str]] = []
        self.dangling: list[tuple[str, str]] = []
        self.ambiguous: list[tuple[str, str]] = []
        self.selves: list[tuple[str, str]] = []

    def link(self, link: Link) -> None:
        """Note a relation of a list of relations."""
        if self._is_ambiguous(link.path, link.source) or self._is_ambiguous(link.path, link.target):
            return
        source, target = self.by_key.get(link.source), self.by_key.get(link.target)
        if source is None or target is None:
            self.dangling.append((link.path, link.source if source is None else link.target))
            return
        relation, reversed_ = self._relation(link.word)
        if relation is None:
            self.words.append((link.path, link.word))
            return
        if relation == "" and not link.word and _level(source) is not None and _level(source) == _level(target):
            return  # neighbors of one layer: places, rooms; neither holds the other
        if relation == "" and not link.word:  # the upper layer of a hierarchy comes first: a room and its things
            source, target = target, source
        self._tie(target if reversed_ else source, relation, source if reversed_ else target)

    def _relation(self, word: str) -> tuple[str | None, bool]:
        """Return the relation that a word means, and whether the second thing stands in it to the first.

        None: the word is not known. "" is what holds something.
        """
        if not word:
            return "", False
        given = _ENDS.match(word.strip().lower())
        first, text = (given[1], given[2]) if given else (None, word)
        name = self.words_known.get(key_of(text)) or self.words_known.get(key_of(text.removeprefix("is ")))
        if name is None:
            return None, False
        return name.removeprefix("^"), name.startswith("^") != (first == "b")

    def fields(self, entity: Entity) -> None:
        """Note what an entry's own fields and its place in the file say."""
        names = self.shape.fields
        for field, relation in (("on", "ON"), ("inside", "INSIDE"), ("parent", "")):
            for text in wanted(entity, names[field]):
                self._held(entity, relation, text)
        for text in wanted(entity, names["room"]):
            self._room(entity, text)
        ends = [self.by_key.get(text) for text in wanted(entity, names["between"])]
        if len(ends) == 2:
            self.ties += [Tie(entity, "BETWEEN", end) for end in ends if end is not None and end is not entity]
        for text in wanted(entity, names["children"]):
            child = None if self._is_ambiguous(entity.path, text) else self.by_key.get(text)
            if child is not None:
                self._tie(child, "", entity)
        if entity.owner is not None:
            self._tie(entity, "", entity.owner)

    def _held(self, entity: Entity, relation: str, text: str) -> None:
        """Note a holder by its id, its name or a phrase; what is no entry may be a room."""
        if text not in self.by_key:
            relation, text = self._phrase(relation, text)
        if self._is_ambiguous(entity.path, text):
            return
        holder = self.by_key.get(text)
        if holder is None:
            self._room(entity, text)
        else:
            self._tie(entity, relation, holder)

    def _phrase(self, relation: str, text: str) -> tuple[str, str]:
        """Return the relation and the name of `on the table`."""
        words = text.lower().split()
        for length in range(len(words) - 1, 0, -1):
            name = self.words_known.get(key_of(" ".join(words[:length])), "")
            if name in ("ON", "INSIDE"):
                rest = words[length:]
                return name, " ".join(rest[1:] if rest[0] in ("the", "a", "an", "my") else rest)
        return relation, text

    def _is_ambiguous(self, path: str, text: str) -> bool:
        """Return whether several entries are called so, which is then noted."""
        if text in self.twice:
            self.ambiguous.append((path, text))
        return text in self.twice

    def _room(self, entity: Entity, text: str) -> None:
        """Note the room of an entry, by its id or name; one that is no entry is noted by its name."""
        if self._is_ambiguous(entity.path, text):
            return
        room = self.by_key.get(text)
        if room is not None:
            self._tie(entity, "INSIDE", room)
        else:
            self.rooms.append((entity, text))

    def _tie(self, source: Entity, relation: str, target: Entity) -> None:
        if source is target:
            self.selves.append((source.path, source.name))
        else:
            self.ties.append(Tie(source, relation, target))

    def __repr__(self) -> str:
        return f"_Reader({len(self.ties)} ties)"


def _level(entity: Entity) -> object:
    """Return the layer of an entry of a hierarchy, or the kind of its attributes; None where the file has neither."""
    return entity.fields.get("layer", entity.fields.get("attributestype"))


def holders(ties: Sequence[Tie], kept: Callable[[Entity], bool]) -> dict[int, list[tuple[str, Entity]]]:
    """Return for each entry, by its `id()`, what holds it: of holders that are left out, what holds those."""
    direct: dict[int, list[tuple[str, Entity]]] = {}
    for tie in ties:
        if tie.relation in HOLDERS:
            direct.setdefault(id(tie.source), []).append((tie.relation, tie.target))
    return {key: list(_kept(key, direct, kept)) for key in direct}


def _kept(
    key: int, direct: Mapping[int, list[tuple[str, Entity]]], kept: Callable[[Entity], bool]
) -> Iterator[tuple[str, Entity]]:
    waiting, seen = list(direct[key]), {key}
    while waiting:
        relation, holder = waiting.pop(0)
        if id(holder) in seen:
            continue
        seen.add(id(holder))
        if kept(holder):
            yield relation, holder
        else:
            waiting += [("", above) for _, above in direct.get(id(holder), [])]
