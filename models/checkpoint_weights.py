"""A network with the weights of a checkpoint, which may be a stranger's: nothing is allocated that does not fit."""

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import numpy as np
import torch
from torch.overrides import TorchFunctionMode

Network = TypeVar("Network", bound=torch.nn.Module)


def filled(make: Callable[[], Network], weights: Mapping[str, np.ndarray]) -> Network:
    """Return the network that is made, with these weights, for prediction.

    It is first made without memory: settings that ask for a network larger than its weights cost nothing.

    Raises:
        ValueError: its weights have other names or shapes, or are not numbers.
    """
    with torch.device("meta"), _Uninitialised():
        wanted = {name: _shape(value) for name, value in make().state_dict().items()}
    given = {name: _shape(value) for name, value in weights.items()}
    if wanted != given:
        differ = sorted({name for name, _ in wanted.items() ^ given.items()})
        raise ValueError(f"weights differ from those of the network in {', '.join(differ[:3])}")
    if wrong := next((name for name, value in sorted(weights.items()) if not np.isfinite(value).all()), None):
        raise ValueError(f"the weights {wrong} are not all numbers")
    network = make()
    network.load_state_dict({name: torch.tensor(value) for name, value in weights.items()})
    network.eval()
    return network


class _Uninitialised(TorchFunctionMode):
    """Leaves weights as they are where a network would draw them.

    Without memory there is nothing to draw, and PyTorch would import its compiler for it, which takes seconds.
    """

    def __torch_function__(self, function: Any, types: Any, args: Any = (), kwargs: Any = None) -> Any:
        given = kwargs or {}
        if getattr(function, "__module__", "") == "torch.nn.init":
            return args[0] if args else given["tensor"]
        return function(*args, **given)


def _shape(array: np.ndarray | torch.Tensor) -> tuple[int, ...]:
    """Return the shape of an array, and for a single number that of a list of one, which is how it is stored."""
    return tuple(array.shape) or (1,)
