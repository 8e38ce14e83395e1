"""Where networks are computed: on a GPU if there is one."""

from __future__ import annotations

from typing import Any

from hearth.schemas.libraries import library


def device() -> Any:
    """The torch device of this machine: its first GPU, else one thread of its processor.

    The networks are small: two threads wait for each other longer than they save, and sums by one thread are the same
    on any number of cores.

    Raises:
        HearthError: MISSING_FILE, if torch is not installed.
    """
    torch = library("torch")
    torch.set_num_threads(1)
    return torch.device("cuda" if torch.cuda.is_available() else "cpu")
