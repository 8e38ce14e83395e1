"""The figures of thesis 3.4 for any corpus, as PNG and SVG, and their data as Parquet."""

from __future__ import annotations

from collections import Counter
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from hearth.analysis import corpus_statistics as numbers
from hearth.analysis.corpus_statistics import Corpus, Similarities
from hearth.schemas.optional_libraries import library
from hearth.storage.files import replacing
from hearth.storage.names import inside

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BARS = 50
"""Number of actions and objects in a histogram (figure 3-4)."""

USED_TOGETHER = 30
"""Number of objects in the matrix of common use."""

_BLUE, _GREY = "#31688e", "#b8b8b8"


def write(found: Corpus, alike: Similarities, folder: Path) -> list[Path]:
    """Write every figure and every table of numbers; returns the files, in order."""
    folder.mkdir(parents=True, exist_ok=True)
    actions, objects = numbers.frequencies(found)
    figures = {
        "funnel": _funnel(numbers.funnel(found)),
        "actions": _bars(actions, "Steps with each action"),
        "objects": _bars(objects, "Steps with each object"),
        "similarity": _matrix(alike),
        "together": _together(found, objects),
    }
    files = [file for name, figure in figures.items() for file in saved(figure, folder / name)]
    return [*files, *_tables(found, alike, folder)]


def _tables(found: Corpus, alike: Similarities, folder: Path) -> list[Path]:
    actions, objects = numbers.frequencies(found)
    compared = [alike.activities[number] for number in alike.order]
    rows: dict[str, list[dict[str, Any]]] = {
        "funnel": [
            {"step": step, "ours": count, "thesis": numbers.THESIS_FUNNEL[step]}
            for step, count in numbers.funnel(found).items()
        ],
        "variety": [
            {"what": what, "ours": count, "thesis": numbers.THESIS_VARIETY[what]}
            for what, count in numbers.variety(found).items()
        ],
        "averages": [
            dict(zip(("dataset", "programs", "steps", "sentences", "words"), (name, *row), strict=True))
            for name, row in {"ours": numbers.averages(found), **numbers.THESIS_AVERAGES}.items()
        ],
        "actions": [{"action": name, "steps": count} for name, count in _ranked(actions)],
        "objects": [{"object": name, "steps": count} for name, count in _ranked(objects)],
        "together": [{"object": a, "other": b, "programs": n} for (a, b), n in _ranked(numbers.together(found))],
        "specials": [{"text": text, "times": count} for text, count in _ranked(found.specials)],
        "diversity": [asdict(one) for one in alike.activities],
        "similarity": [
            {"activity": one.activity, "other": other.activity, "similarity": float(alike.matrix[i, j])}
            for i, one in enumerate(compared)
            for j, other in enumerate(compared)
        ],
    }
    files = []
    for name, table in rows.items():
        path = inside(folder, f"{name}.parquet")
        with replacing(path) as temporary:
            pq.write_table(pa.Table.from_pylist(table or [{"empty": None}][:0]), temporary, compression="zstd")
        files.append(path)
    return files


def _ranked(counts: Counter[Any]) -> list[tuple[Any, int]]:
    return sorted(counts.items(), key=lambda pair: (-pair[1], pair[0]))


def blank(width: float, height: float) -> tuple[Figure, Any]:
    """Return a figure of a size in inches, and its axes."""
    figure: Figure = library("matplotlib.figure").Figure(figsize=(width, height), layout="constrained")
    return figure, figure.subplots()


def saved(figure: Figure, path: Path) -> list[Path]:
    """Write a figure as PNG and SVG, deterministically."""
    files = []
    with library("matplotlib").rc_context({"svg.hashsalt": "hearth", "svg.fonttype": "none"}):
        for suffix, metadata in ((".png", {"Software": None}), (".svg", {"Date": None, "Creator": None})):
            file = path.with_suffix(suffix)
            with replacing(file) as temporary:
                figure.savefig(temporary, format=suffix[1:], dpi=150, metadata=metadata)
            files.append(file)
    return files


def _funnel(counts: dict[str, int]) -> Figure:
    figure, axes = blank(8, 3.2)
    names = list(counts)
    for offset, colour, row, label in (
        (-0.2, _BLUE, counts, "this corpus"),
        (0.2, _GREY, numbers.THESIS_FUNNEL, "thesis 3.4"),
    ):
        bars = axes.barh([place + offset for place in range(len(names))], [row[n] for n in names], 0.38, color=colour)
        bars.set_label(label)
        axes.bar_label(bars, fmt="{:,.0f}", padding=3, fontsize=8)
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    axes.margins(x=0.12)
    axes.legend(frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    return figure


def _bars(counts: Counter[str], label: str) -> Figure:
    figure, axes = blank(11, 3.8)
    shown = _ranked(counts)[:BARS]
    axes.bar(range(len(shown)), [count for _, count in shown], color=_BLUE)
    axes.set_xticks(range(len(shown)), [_label(name) for name, _ in shown], rotation=90, fontsize=8)
    axes.set_ylabel(label)
    axes.margins(x=0.01)
    axes.spines[["top", "right"]].set_visible(False)
    return figure


def _together(found: Corpus, objects: Counter[str]) -> Figure:
    """Return numbers of programs that use both of two frequent objects."""
    names = [name for name, _ in _ranked(objects)[:USED_TOGETHER]]
    place = {name: number for number, name in enumerate(names)}
    counts = np.full((len(names), len(names)), np.nan)
    for (one, other), programs in numbers.together(found).items():
        if one in place and other in place:
            counts[place[one], place[other]] = counts[place[other], place[one]] = programs
    return _heat_map(counts, [_label(name) for name in names], "programs that use both", (9, 8), fontsize=8)


def _label(name: str) -> str:
    return name.removeprefix("food_").replace("_", " ")


def _matrix(alike: Similarities) -> Figure:
    names = [alike.activities[number].title for number in alike.order]
    most = max(0.5, float(alike.matrix.max(initial=0)))
    return _heat_map(alike.matrix, names, "mean normalised LCS", (10, 9), fontsize=6, vmin=0, vmax=most)


def _heat_map(
    values: Any, names: list[str], label: str, size: tuple[float, float], fontsize: int, **limits: float
) -> Figure:
    """Return a square matrix with the same names along both sides; empty without names."""
    figure, axes = blank(*size)
    if names:
        figure.colorbar(axes.imshow(values, cmap="viridis", **limits), ax=axes, shrink=0.7, label=label)
    axes.set_xticks(range(len(names)), names, rotation=90, fontsize=fontsize)
    axes.set_yticks(range(len(names)), names, fontsize=fontsize)
    return figure
