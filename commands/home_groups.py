"""Groups of homes that `home stats` compares."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from hearth.commands.inputs import read_knowledge

if TYPE_CHECKING:
    from hearth.schemas.graph import EnvironmentGraph


def homes_in(folder: Path | None) -> list[EnvironmentGraph]:
    """Return the homes of a folder, by name; [] without a folder."""
    from hearth.homes import library

    known = read_knowledge(None)
    return [library.named_graph(name, known, folder)[1] for name in library.names(folder, alone=True)] if folder else []


def among(homes: Sequence[EnvironmentGraph]) -> float | None:
    """Return the mean placement distance of each home to all others."""
    from statistics import fmean

    from hearth.homes.home_statistics import placement_distance, places

    known = read_knowledge(None)
    apart = [
        placement_distance(places([home], known), places([other for other in homes if other is not home], known))
        for home in homes
    ]
    return round(fmean(distance or 0.0 for distance in apart), 3) if len(homes) > 1 else None
