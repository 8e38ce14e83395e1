"""Wrong arguments of the public functions, as errors of ours; looked for only once a call has failed."""

import inspect
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import fields, is_dataclass
from itertools import chain
from os import PathLike
from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

_KINDS: dict[str, Any] = {
    "Callable": Callable, "Iterable": Iterable, "Mapping": Mapping, "Sequence": Sequence, "Set": AbstractSet,
    "PathLike": PathLike, "None": type(None), "float": int,
}  # fmt: skip
"""Types that values are of without naming them among their classes; a whole number may stand for any."""


def explain(function: Callable[..., Any], args: tuple[Any, ...], kwargs: Mapping[str, Any], error: Exception) -> None:
    """Raise the error of ours for a failed call with an argument that is not of its type."""
    found = None if isinstance(error, HearthError) else next(_misfits(function, args, kwargs), None)
    if found is not None:
        message = f"{function.__qualname__}: {found}"
        raise HearthError.of(Code.BAD_ARGUMENT, message[:500], suggestion=_form(function)) from error


def _misfits(function: Callable[..., Any], args: tuple[Any, ...], kwargs: Mapping[str, Any]) -> Iterator[str]:
    """Faults in the arguments of a call."""
    signature = inspect.signature(function)
    try:
        given = signature.bind(*args, **kwargs).arguments
    except TypeError as error:
        yield str(error)
        return
    for name, value in given.items():
        parameter = signature.parameters[name]
        if parameter.kind is parameter.VAR_KEYWORD or parameter.annotation is parameter.empty:
            continue
        values = value if parameter.kind is parameter.VAR_POSITIONAL else (value,)
        expected = _text(parameter.annotation)
        yield from chain.from_iterable(_unlike(each, expected, name) for each in values)


def _form(function: Callable[..., Any]) -> str:
    parameters = inspect.signature(function).parameters.values()
    said = (f"{one.name}: {_short(one.annotation)}" for one in parameters if one.annotation is not one.empty)
    return f"call {function.__qualname__}({', '.join(said)})"


def _short(annotation: object) -> str:
    """Without the modules of its names."""
    return re.sub(r"\b[a-z_][\w.]*\.(?=\w)", "", _text(annotation))


def _text(annotation: object) -> str:
    return annotation if isinstance(annotation, str) else inspect.formatannotation(annotation)


def _unlike(value: Any, expected: str, where: str) -> Iterator[str]:
    """Yield where a value, or a part of it, is not of the type that is written."""
    types = [_split(one) for one in _parts(expected, " | ")]
    fitting = [inner for name, inner in types if _is(value, name)]
    if not fitting:
        yield f"`{where}` is {type(value).__name__}, not {_short(expected)}"
    elif is_dataclass(value) and type(value).__module__.startswith("hearth.schemas."):
        for field in fields(value):
            yield from _unlike(getattr(value, field.name), _text(field.type), f"{where}.{field.name}")
    elif isinstance(value, tuple | list | str | bytes | AbstractSet) and (inner := fitting[0].removesuffix(", ...")):
        kinds = list(_parts(inner, ", "))
        for number, each in enumerate(value):
            yield from _unlike(each, kinds[min(number, len(kinds) - 1)], f"{where}[{number}]")


def _is(value: Any, name: str) -> bool:
    names = {kind.__name__ for kind in type(value).__mro__[:-1]}
    kind = _KINDS.get(name)
    return name in names or name in ("Any", "object", "T", "Self") or (kind is not None and isinstance(value, kind))


def _split(expected: str) -> tuple[str, str]:
    """Return the last name of a type, and the content of its brackets."""
    name, _, inner = expected.partition("[")
    return name.rpartition(".")[2].strip("'\""), inner.removesuffix("]")


def _parts(text: str, between: str) -> Iterator[str]:
    """Yield a text at the separators that stand outside of brackets."""
    depth = start = 0
    for at, letter in enumerate(text):
        depth += (letter == "[") - (letter == "]")
        if not depth and text.startswith(between, at):
            yield text[start:at]
            start = at + len(between)
    yield text[start:]
