"""Hearth turns what people say they do at home into datasets that machines can run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hearth.version import VERSION as __version__

if TYPE_CHECKING:
    from hearth.datasets.dataset import Dataset
    from hearth.kb.knowledge import Knowledge

__all__ = ["__version__", "knowledge", "load"]


def load(path: str) -> Dataset:
    """Open a published dataset folder for reading.

    Raises:
        HearthError: the folder is not a dataset, or was written by a newer version.
    """
    from hearth.datasets.dataset import Dataset

    return Dataset.open(path)


def knowledge(overlay: str | None = None) -> Knowledge:
    """What Hearth knows of actions, objects and places, with the files of the folder `overlay` laid over it, if given.

    A dataset's own is `load(path).knowledge`.

    Raises:
        HearthError: every fault of the overlay's files.
    """
    from pathlib import Path

    from hearth.kb.loading.load import overlaid

    return overlaid(Path(overlay) if overlay else None)
