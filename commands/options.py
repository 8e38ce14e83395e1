"""Flags, names of values and help of the commands' options and arguments, from `options.yaml`.

A command is a function with plain types and defaults; `described` adds the rest by the names of its parameters.
"""

import os
from collections.abc import Callable
from functools import cache
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


def described(command: Callable[..., Any]) -> None:
    """Give the parameters of a command their entries; a parameter without one stays as it is."""
    own, shared = _table().get(command.__module__.rpartition(".")[2], {}), _table()["shared"]

    def entered(parameter: Parameter) -> Parameter:
        name = parameter.name
        entry = own.get(f"{command.__name__}.{name}") or own.get(name) or shared.get(name)
        if entry is None or get_origin(parameter.annotation) is Annotated:
            return parameter
        return parameter.replace(annotation=Annotated[parameter.annotation, _parameter(**entry)])

    given = signature(command, eval_str=True)
    command.__signature__ = given.replace(  # type: ignore[attr-defined]
        parameters=[entered(parameter) for parameter in given.parameters.values()]
    )


def _parameter(*, flags: list[str] | None = None, processes: bool = False, **fields: Any) -> Any:
    """Return an option with these flags, or an argument if there are none."""
    if processes:
        fields["callback"] = _processes
    return typer.Option(*flags, **fields) if flags else typer.Argument(**fields)


def _processes(count: int) -> int:
    """Return the number of processes: 0 means one for each core."""
    return count or os.cpu_count() or 1
