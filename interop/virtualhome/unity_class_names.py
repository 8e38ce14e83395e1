"""Names that Unity's graphs give to classes, where ours are called otherwise."""

from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from types import MappingProxyType

from hearth.kb.knowledge import Knowledge


@cache
def unity_names() -> Mapping[str, str]:
    """Return the Unity name of each class of ours that has another there."""
    text = (files("hearth.interop.virtualhome") / "unity_class_names.csv").read_text(encoding="utf-8")
    rows = (line.partition(",") for line in text.split("\n")[1:] if line)
    return MappingProxyType({row[0]: row[2] for row in rows})


def to_unity(class_name: str) -> str:
    """Return the name that Unity's graphs give a class: `television` is `tv`."""
    return unity_names().get(class_name, class_name)


def means(name: str, class_name: str, knowledge: Knowledge) -> bool:
    """Return whether a name of a script or a graph means a class of ours."""
    plain = name.strip().lower()
    return (
        plain in (class_name, to_unity(class_name))
        or class_name in knowledge.found_as(plain)
        or plain.replace("_", "") == class_name.replace("_", "")
    )
