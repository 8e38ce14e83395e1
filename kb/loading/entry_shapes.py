"""The shapes of values in the YAML files: what the parts of an entry may be, and faults for those of other shapes."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from hearth.kb.loading.source_files import Entry, Faults


class Shape(NamedTuple):
    """A test that a value passes, and the name of such values in words."""

    fits: Callable[[Any], bool]
    meaning: str


def _name(value: Any) -> bool:
    return isinstance(value, str | int | float)


def _list(value: Any) -> bool:
    return value is None or isinstance(value, list)


def _names(value: Any) -> bool:
    return value is None or _name(value) or (isinstance(value, list) and all(map(_name, value)))


def _names_by_name(value: Any) -> bool:
    return isinstance(value, dict) and all(isinstance(each, list) and all(map(_name, each)) for each in value.values())


MOST_THINGS = 50
"""On a seat or bed; planners write out every pair of them."""


def _limits(value: Any) -> bool:
    if not isinstance(value, dict) or "default" not in value:
        return False
    return all(type(limit) is int and 0 <= limit <= MOST_THINGS for limit in value.values())


MAPPING = Shape(lambda value: isinstance(value, dict), "a mapping")
NAMES = Shape(_names, "a name, or a list of names")
NAMES_BY_NAME = Shape(_names_by_name, "a list of names for each name")
LIST = Shape(_list, "a list")
TEXT = Shape(lambda value: value is None or _name(value), "a text")
REASONS = Shape(lambda value: isinstance(value, dict) or _names(value), "a reason for each class")
LIMITS = Shape(_limits, f"whole numbers up to {MOST_THINGS} by class, one of them for `default`")
NAME_LIST = Shape(lambda value: isinstance(value, list) and _names(value), "a list of names")

SHOWN = 60
"""Letters of a wrong value that a fault shows."""


def fits(value: Any, shape: Shape, name: str, at: Entry, faults: Faults) -> bool:
    """Return whether a value has a shape; else that is a fault."""
    if shape.fits(value):
        return True
    text = str(value) if len(str(value)) <= SHOWN else f"{str(value)[:SHOWN]}..."
    faults.at(at, f"`{name}` is `{text}`", f"it is {shape.meaning}")
    return False


def parts(value: Any, shapes: Mapping[str, Shape], name: str, at: Entry, faults: Faults) -> dict[str, Any]:
    """Return the parts of a mapping but those of a wrong shape, which are faults; parts without a shape stay."""
    if not fits(value, MAPPING, name, at, faults):
        return {}
    return {
        key: part
        for key, part in value.items()
        if key not in shapes or fits(part, shapes[key], f"{name}: {key}", at, faults)
    }
