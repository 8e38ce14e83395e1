"""The shape of a scene graph of another project: the names of its fields, its words, its units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import Any

from hearth.kb.spelling import key_of
from hearth.schemas.yaml_limits import packaged

UPWARDS = ("auto", "y", "z")
"""Axes that may point upwards; `auto`: as the file suggests."""

QUATERNIONS = ("xyzw", "wxyz")
"""Orders of the four numbers of a rotation."""

Names = tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Shape:
    """Meaning of the fields and words of a scene graph.

    Attributes:
        fields: field of ours -> names that others have for it, the likeliest first.
        groups: names of lists of things.
        kinds: labels that say what kind of entry it is.
        best: names of lists of guesses about an entry, the best one first.
        namesakes: name of a list -> class of its entries that have no label.
        edges: `source`, `target`, `relation` -> names; `lists` -> names of lists of relations.
        relations: word -> relation of ours; with `^` before it where the second thing stands in it to the first.
        flags: name of a flag -> the states of true and of false.
        states: word -> state of ours.
        classes: label -> class of ours; None: left out.
        units: word -> metres of that unit of length.
        up: the axis that points upwards, or `auto`.
        quaternion: the order of the numbers of a rotation.
        scale: metres of a unit; 0: as the file suggests.
    """

    fields: Mapping[str, Names]
    groups: frozenset[str]
    kinds: frozenset[str]
    best: frozenset[str]
    namesakes: Mapping[str, str]
    edges: Mapping[str, Names]
    relations: Mapping[str, str]
    flags: Mapping[str, tuple[str, str]]
    states: Mapping[str, str]
    classes: Mapping[str, str | None]
    units: Mapping[str, float]
    up: str = "auto"
    quaternion: str = "xyzw"
    scale: float = 0.0


@cache
def usual() -> Shape:
    """Return the shape that tells the names of all projects we know apart; from `shapes.yaml`."""
    data: dict[str, Any] = packaged("hearth.interop.scene_graphs", "shapes.yaml")
    return Shape(
        fields=MappingProxyType({key: tuple(names) for key, names in data["fields"].items()}),
        groups=frozenset(data["groups"]),
        kinds=frozenset(data["kinds"]),
        best=frozenset(data["best"]),
        namesakes=MappingProxyType(data["namesakes"]),
        edges=MappingProxyType({key: tuple(names) for key, names in data["edges"].items()}),
        relations=MappingProxyType(by_word(data["relations"])),
        flags=MappingProxyType({name: (true, false) for name, (true, false) in data["flags"].items()}),
        states=MappingProxyType(by_word(data["states"])),
        units=MappingProxyType({word: float(metres) for metres, words in data["units"].items() for word in words}),
        classes=MappingProxyType({key_of(label): name for label, name in data["classes"].items()}),
    )


def by_word(table: Mapping[str, list[str]]) -> dict[str, str]:
    """Return a table of words the other way round: word -> the name it is listed under."""
    return {str(word): name for name, words in table.items() for word in words}
