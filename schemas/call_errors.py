"""Public functions whose wrong arguments become errors of ours; what finds the fault is imported only then."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")


def explained(function: Callable[P, T]) -> Callable[P, T]:
    """Return the function; where it fails and an argument is not of its type, it raises an error of ours.

    What is raised though all arguments fit stays what it is: a documented KeyError, or a fault of ours.

    Raises:
        HearthError: BAD_ARGUMENT, naming the argument, its value and the value that it should have.
    """

    @wraps(function)
    def call(*args: P.args, **kwargs: P.kwargs) -> T:
        try:
            return function(*args, **kwargs)
        except Exception as error:
            from hearth.schemas.argument_faults import explain

            explain(function, args, kwargs, error)
            raise

    return call
