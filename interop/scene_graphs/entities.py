"""The things and relations of a JSON value of any shape, found by the names of their fields."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from hearth.interop.scene_graphs.shape import Shape
from hearth.kb.spelling import key_of

DEEPEST = 12
"""Levels of a file that are looked at."""

DEEPEST_FIELD = 3
"""Levels of an entry in which its own fields stand."""

MENTIONS_EACH = 10
"""Words in lists of things that are read for each thing that may be read."""

LONGEST_LABEL = 80
"""Characters of a label."""


@dataclass(eq=False)
class Entity:
    """A thing or room as a file has it.

    Attributes:
        path: where it stands: `objects[3]`.
        keys: what relations may call it: its id, its name.
        label: the word for its class.
        name: its own name, `kitchen_0`; the label where it has none.
        fields: its own values, by their keys with the keys above them, each as `key_of` writes it.
        owner: the entry that it stands in; None at the top.
        group: the list that it stands in, `rooms`.
    """

    path: str
    keys: tuple[str, ...]
    label: str
    name: str
    fields: Mapping[str, Any]
    owner: Entity | None = None
    group: str = ""


@dataclass(frozen=True)
class Mention:
    """A word in a list of things: the id or name of an entry, or else a thing of its own."""

    path: str
    text: str
    owner: Entity | None
    group: str


@dataclass(frozen=True)
class Link:
    """A relation as a file has it: two references and a word, which may be empty."""

    path: str
    source: str
    word: str
    target: str


@dataclass(eq=False)
class Found:
    """The things and relations of a file, and the words in lists of things that name an entry."""

    entities: list[Entity] = field(default_factory=list)
    links: list[Link] = field(default_factory=list)
    mentions: list[Mention] = field(default_factory=list)
    described: list[Entity] = field(default_factory=list)
    most: int = 0

    @property
    def is_full(self) -> bool:
        """Return whether there are more things than are read."""
        return len(self.entities) > self.most or len(self.mentions) > MENTIONS_EACH * self.most


def entities_of(data: Any, shape: Shape, most: int) -> Found:
    """Return the things and relations in a JSON value, in its order.

    Of a value with more things than `most`, those up to the first one too many.
    """
    found = Found(most=most)
    _Walk(shape, found).visit(data, "", "", None, 0)
    called = {key for entity in found.entities for key in entity.keys}
    found.entities += [entity for entity in found.described if entity.keys[0] not in called]
    called = {key for entity in found.entities for key in entity.keys}
    for mention in found.mentions:
        if mention.text not in called:
            text = mention.text
            found.entities.append(Entity(mention.path, (text,), text, text, {}, mention.owner, mention.group))
    found.mentions = [mention for mention in found.mentions if mention.text in called]
    return found


class _Walk:
    """A walk through a JSON value that notes things and relations."""

    def __init__(self, shape: Shape, found: Found) -> None:
        self.shape = shape
        self.found = found
        self.described: set[str] = set()

    def visit(self, value: Any, path: str, group: str, owner: Entity | None, depth: int) -> None:
        """Note what a value holds.

        Args:
            value: of the file.
            path: where it stands.
            group: the last key on the way to it.
            owner: the entry that it stands in.
            depth: levels above it.
        """
        if depth > DEEPEST or self.found.is_full:
            return
        if isinstance(value, list):
            for number, each in enumerate(value):
                if self.found.is_full:
                    return
                self._element(each, f"{path}[{number}]", group, owner, depth, "")
        elif isinstance(value, dict):
            grouped = group in self.shape.groups or self._is_by_id(value)
            for key, each in value.items():
                if key_of(str(key)) in self.shape.best or self.found.is_full:
                    continue
                below = f"{path}.{key}" if path else str(key)
                if grouped and isinstance(each, dict):
                    self._element(each, below, group, owner, depth, str(key))
                else:
                    self.visit(each, below, key_of(str(key)), owner, depth + 1)

    def _is_by_id(self, value: Mapping[str, Any]) -> bool:
        """Return whether a mapping has an entry of its own for each key, each with a label and a place or size."""
        parts = [each for each in value.values() if isinstance(each, dict)]
        if len(parts) < 2 or len(parts) < len(value):
            return False
        names = (*self.shape.fields["position"], *self.shape.fields["size"], *self.shape.fields["corners"])
        owns = (dict(_fields(each, depth=DEEPEST_FIELD)) for each in parts)
        return all(self._label(own) and any(name in own for name in names) for own in owns)

    def _element(self, each: Any, path: str, group: str, owner: Entity | None, depth: int, key: str) -> None:
        """Note an element of a list, or a value of a mapping by ids."""
        link = self._link(each, path, group)
        if link is not None:
            self.found.links.append(link)
            return
        if isinstance(each, dict):
            entity = self._entity(each, path, group, owner, key)
            if entity is not None:
                self.found.entities.append(entity)
            self.visit(each, path, "", entity or owner, depth + 1)
        elif isinstance(each, str) and group in self.shape.groups and 0 < len(each) <= LONGEST_LABEL:
            self.found.mentions.append(Mention(path, each, owner, group))
        elif isinstance(each, list):
            self.visit(each, path, group, owner, depth + 1)

    def _entity(self, each: dict[str, Any], path: str, group: str, owner: Entity | None, key: str) -> Entity | None:
        own = dict(_fields(_with_best(each, self.shape.best)))
        label = self._label(own) or self.shape.namesakes.get(group, "") or key
        if not label:
            return None
        names = _texts(own, self.shape.fields["name"])
        ids = [str(value) for value in _values(own, self.shape.fields["id"]) if isinstance(value, str | int)][:1]
        keys = tuple(dict.fromkeys(filter(None, (*ids, key, *names))))
        return Entity(path, keys, label, names[0] if names else key or label, own, owner, group)

    def _label(self, own: Mapping[str, Any]) -> str:
        """Return the word for an entry's class; a word for its kind, or a number, where it has no other."""
        texts = _texts(own, self.shape.fields["label"])
        structures = [text for text in texts if self.shape.classes.get(key_of(text), "") is None]
        words = [text for text in texts if key_of(text) not in self.shape.kinds]
        numbers = [str(value) for value in _values(own, self.shape.fields["label"]) if type(value) is int]
        return next(iter((*structures, *words, *numbers, *texts)), "")

    def _link(self, each: Any, path: str, group: str) -> Link | None:
        if isinstance(each, dict):
            low = {key_of(str(key)): value for key, value in each.items()}
            source, target = (_reference(low, self.shape.edges[end]) for end in ("source", "target"))
            word = next(iter(_texts(low, self.shape.edges["relation"])), "")
            if source and target:
                self._ends(low, path)
                return Link(path, source, word, target)
            return None
        if group in self.shape.edges["lists"] and isinstance(each, list) and len(each) >= 3:
            known = [value for value in each[1:] if isinstance(value, str) and key_of(value) in self._words]
            words = known or [value for value in each[2:] if isinstance(value, str)]
            ends = [str(value) for value in each if isinstance(value, str | int) and value not in words]
            if words and len(ends) >= 2:
                return Link(path, ends[0], words[-1], ends[1])
        return None

    def _ends(self, low: Mapping[str, Any], path: str) -> None:
        """Note the things that a relation describes in full, once each."""
        for end in ("source", "target"):
            value = next((low[name] for name in self.shape.edges[end] if isinstance(low.get(name), dict)), None)
            entity = None if value is None else self._entity(value, f"{path}.{end}", "", None, "")
            if entity is not None and entity.keys and entity.keys[0] not in self.described:
                self.described.add(entity.keys[0])
                self.found.described.append(entity)

    @property
    def _words(self) -> frozenset[str]:
        return frozenset(map(key_of, self.shape.relations))


def _with_best(entry: Mapping[str, Any], best: frozenset[str]) -> Mapping[str, Any]:
    """Return an entry with the first of its guesses in place of their list."""
    return {
        key: value[0] if key_of(str(key)) in best and isinstance(value, list) and value else value
        for key, value in entry.items()
    }


def _fields(entry: Mapping[str, Any], above: str = "", depth: int = 0) -> Iterator[tuple[str, Any]]:
    """Yield an entry's own values: those of mappings within it too, each by all keys above it."""
    for key, value in entry.items():
        name = above + key_of(str(key))
        yield name, value
        if isinstance(value, dict) and depth < DEEPEST_FIELD:
            yield from _fields(value, name, depth + 1)


def _values(own: Mapping[str, Any], names: Sequence[str]) -> Iterator[Any]:
    """Yield the values of the fields of some names, the likeliest first; of one name, the outermost first."""
    for name in names:
        if name in own:
            yield own[name]
        yield from (
            value for key, value in own.items() if key != name and key.endswith(name) and _nested(own, key, name)
        )


def _nested(own: Mapping[str, Any], key: str, name: str) -> bool:
    """Return whether a field is of that name and stands in another field: `attributesname`, and not `classname`."""
    return key != name and key.endswith(name) and isinstance(own.get(key[: -len(name)]), dict)


def _texts(own: Mapping[str, Any], names: Sequence[str]) -> list[str]:
    return [
        value for value in _values(own, names) if isinstance(value, str) and 0 < len(value.strip()) <= LONGEST_LABEL
    ]


def _reference(low: Mapping[str, Any], names: Sequence[str]) -> str:
    """Return what an end of a relation refers to: an id, a name, or the id of an entry that stands there."""
    for name in names:
        value = low.get(name)
        if isinstance(value, dict):
            inner = {key_of(str(key)): each for key, each in value.items()}
            value = next((inner[key] for key in ("id", "uid", "name", "label") if key in inner), None)
        if isinstance(value, str | int) and not isinstance(value, bool):
            return str(value)
    return ""


def values_of(entity: Entity, names: Sequence[str]) -> list[Any]:
    """Return the values of an entry's fields of some names, the likeliest first."""
    return list(_values(entity.fields, names))
