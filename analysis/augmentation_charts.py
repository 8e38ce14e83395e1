"""Charts of figure 5-4 and of program lengths, before and after augmentation."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.analysis.corpus_figures import blank, saved
from hearth.schemas.optional_libraries import library

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = {"before": "#9aa5b1", "after": "#b5651d"}


def draw(found: Mapping[str, Any], folder: Path) -> list[Path]:
    """Draw the result of `augmentation_results.figures`, each chart as PNG and SVG; returns the files."""
    folder.mkdir(parents=True, exist_ok=True)
    files = saved(conditions(found["conditions"]), folder / "conditions")
    return files + saved(lengths(found["lengths"]), folder / "lengths")


def conditions(shares: Mapping[str, Mapping[str, Mapping[str, float]]]) -> Figure:
    """Shares of the conditions of a class, before and after, one panel per class (figure 5-4)."""
    figure: Figure = library("matplotlib.figure").Figure(figsize=(5.2 * len(shares), 4), layout="constrained")
    for axes, (name, rows) in zip(figure.subplots(1, len(shares), squeeze=False)[0], shares.items(), strict=True):
        _pairs(axes, list(rows), {label: [row[label] for row in rows.values()] for label in COLOURS})
        axes.set_title(name.replace("_", " "))
        axes.yaxis.set_major_formatter("{x:.0%}")
    return figure


def lengths(counts: Mapping[str, Mapping[str, int]]) -> Figure:
    """Shares of programs by length, of originals and of augmented ones."""
    figure, axes = blank(7, 4)
    names = list(counts["executable"])
    shares = {}
    for label, group in (("before", "executable"), ("after", "augmented")):
        total = sum(counts[group].values()) or 1
        shares[label] = [counts[group][name] / total for name in names]
    _pairs(axes, names, shares)
    axes.set_xlabel("steps")
    axes.yaxis.set_major_formatter("{x:.0%}")
    return figure


def _pairs(axes: Any, names: list[str], shares: Mapping[str, list[float]]) -> None:
    """Two bars side by side for each name."""
    for offset, (label, values) in zip((-0.2, 0.2), shares.items(), strict=True):
        axes.bar([place + offset for place in range(len(names))], values, 0.38, color=COLOURS[label], label=label)
    axes.set_xticks(range(len(names)), [name.replace("_", " ") for name in names], rotation=35, ha="right")
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False)
