"""Hearth turns what people say they do at home into datasets that machines can run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hearth.version import VERSION as __version__

if TYPE_CHECKING:
    from hearth.pipelines.dataset import Dataset

__all__ = ["__version__", "load"]


def load(path: str) -> Dataset:
    """Open a published dataset folder for reading.

    Raises:
        HearthError: the folder is not a dataset, or was written by a newer version.
    """
    from hearth.pipelines.dataset import Dataset

    return Dataset.open(path)
