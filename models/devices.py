"""Where networks are computed: on a GPU if there is one."""

from __future__ import annotations

from typing import Any

from hearth.schemas.libraries import library


def device() -> Any:
    """The torch device of this machine: its first GPU, else its processor.

    Raises:
        HearthError: MISSING_FILE, if torch is not installed.
    """
    torch = library("torch")
    return torch.device("cuda" if torch.cuda.is_available() else "cpu")
