"""Flags, names of values and help of the commands' options and arguments, from `options.yaml`.

A command is a function with plain types and defaults; `described` adds the rest by the names of its parameters. A
parameter whose type is a group of `shared_options` stands for the fields of the group.
"""

import math
import os
from collections.abc import Callable, Iterable, Iterator
from dataclasses import fields, is_dataclass
from functools import cache, wraps
from inspect import Parameter, signature
from typing import Annotated, Any, get_origin

import typer

from hearth.schemas.yaml_limits import packaged

_Entries = dict[str, dict[str, Any]]


@cache
def _table() -> dict[str, _Entries]:
    """Entries by file of commands, and those for all files as `shared`."""
    table: dict[str, _Entries] = packaged("hearth.commands", "options.yaml")
    return table


def described(command: Callable[..., Any]) -> Callable[..., Any]:
    """Return a command whose parameters have their entries; a parameter without one stays as it is."""
    own, shared = _table().get(command.__module__.rpartition(".")[2], {}), _table()["shared"]

    def entered(parameter: Parameter) -> Parameter:
        name = parameter.name
        entry = own.get(f"{command.__name__}.{name}") or own.get(name) or shared.get(name)
        if entry is None or get_origin(parameter.annotation) is Annotated:
            return parameter
        if parameter.annotation in (float, float | None):
            entry = {"callback": _finite, **entry}
        return parameter.replace(annotation=Annotated[parameter.annotation, _parameter(**entry)])

    groups: dict[str, Any] = {each.name: each.annotation for each in _given(command) if is_dataclass(each.annotation)}

    @wraps(command)
    def called(**values: Any) -> Any:
        for name, group in groups.items():
            values[name] = group(**{field.name: values.pop(field.name) for field in fields(group)})
        return command(**values)

    parameters = [entered(parameter) for parameter in parameters_of(command)]
    called.__signature__ = signature(command).replace(parameters=parameters)  # type: ignore[attr-defined]
    return called


def parameters_of(command: Callable[..., Any]) -> Iterator[Parameter]:
    """Yield the parameters of a command, those of a group one by one in its place."""
    for parameter in _given(command):
        group: Any = parameter.annotation
        if is_dataclass(group):
            yield from (each.replace(kind=parameter.kind) for each in _given(group))
        else:
            yield parameter


def _given(function: Any) -> Iterable[Parameter]:
    return signature(function, eval_str=True).parameters.values()


def _parameter(*, flags: list[str] | None = None, processes: bool = False, **more: Any) -> Any:
    """Return an option with these flags, or an argument if there are none."""
    if processes:
        more["callback"] = _processes
    return typer.Option(*flags, **more) if flags else typer.Argument(**more)


def _processes(count: int) -> int:
    """Return the number of processes: 0 means one for each core."""
    return count or os.cpu_count() or 1


def _finite(number: float | None) -> float | None:
    """Return a number that is one; `nan` passes every comparison with a least and a most.

    Raises:
        typer.BadParameter: it is none.
    """
    if number is not None and not math.isfinite(number):
        raise typer.BadParameter(f"{number} is not a number that can be used here")
    return number
