"""The devices that compute networks: a GPU if there is one."""

from typing import Any, TypeVar

from hearth.schemas.optional_libraries import library

Batch = TypeVar("Batch")


def device() -> Any:
    """Return the torch device of this machine: its first GPU, else one thread of its processor.

    The networks are small: two threads wait for each other longer than they save, and sums by one thread are the same
    on any number of cores.

    Raises:
        HearthError: MISSING_FILE, if torch is not installed.
    """
    torch = library("torch")
    torch.set_num_threads(1)
    return torch.device("cuda" if torch.cuda.is_available() else "cpu")


def place_of(network: Any) -> Any:
    """Return the torch device that has a network's weights."""
    return next(network.parameters()).device


def moved(batch: Batch, place: Any) -> Batch:
    """Move a batch to a torch device: a tensor, or a tuple, list or named tuple of batches."""
    if not isinstance(batch, tuple | list):
        return batch.to(place)  # type: ignore[attr-defined,no-any-return]
    parts = [moved(part, place) for part in batch]
    return type(batch)(*parts) if hasattr(batch, "_fields") else type(batch)(parts)
