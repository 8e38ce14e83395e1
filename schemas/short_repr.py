"""Short reprs: what a notebook prints of a value is one line, whatever it holds."""

from collections.abc import Iterator, Sized
from dataclasses import fields, is_dataclass
from typing import Any

LONGEST = 180
"""Characters of a repr, at most: a few of them fit a page, and one with its name in a dict stays under 200."""

_WITHIN = 60
_TEXT = 40
_SHOWN = 3
_DIGITS = 10**12


def brief(value: Any) -> str:
    """Return `Type(field=value, ...)` in at most `LONGEST` characters: a class has it as its `__repr__`.

    Fields that hold many things say how many, large numbers how many bits, arrays their shape.
    """
    return cut(f"{type(value).__name__}({', '.join(_parts(value))})")


def cut(text: str, most: int = LONGEST) -> str:
    """Return a text, or its beginning and three dots."""
    return text if len(text) <= most else f"{text[: most - 3]}..."


def _parts(value: Any) -> Iterator[str]:
    names = getattr(value, "_fields", None) or [each.name for each in _fields(value) if each.repr]
    if not names and isinstance(value, Sized):
        yield f"<{len(value):,} items>"
    for name in names:
        yield f"{name}={_shown(getattr(value, name))}"


def _fields(value: Any) -> tuple[Any, ...]:
    return fields(value) if is_dataclass(value) else ()


def _shown(value: Any) -> str:
    if isinstance(value, str):
        return cut(repr(value[:_WITHIN]), _TEXT)
    if isinstance(value, int) and not -_DIGITS < value < _DIGITS:
        return f"<{value.bit_length()} bits>"
    if isinstance(value, float):
        return f"{value:g}"
    if hasattr(value, "shape"):
        return f"<{'x'.join(map(str, value.shape))} array>"
    ours = type(value).__module__.startswith("hearth.")
    return _items(value) if isinstance(value, Sized) and not ours else cut(repr(value), _WITHIN)


def _items(value: Any) -> str:
    """Return a collection as it is, where it holds few plain values; else how many."""
    if not len(value):
        return repr(value)
    plain = len(value) <= _SHOWN and all(map(_is_plain, value))
    text = repr(value) if plain and not hasattr(value, "values") else ""
    return text if 0 < len(text) <= _TEXT else f"<{len(value):,} items>"


def _is_plain(value: Any) -> bool:
    return isinstance(value, str) or (isinstance(value, int) and -_DIGITS < value < _DIGITS)
