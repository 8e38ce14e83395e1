"""A drawing of two corpora: frequencies of actions and objects, lengths, similarity, and mutual predictions."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.analysis import corpus_realism as numbers
from hearth.analysis.corpus_figures import saved
from hearth.schemas.optional_libraries import library

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SHOWN = 15
_LONGEST = 40
COLOURS = {"ours": "#31688e", "theirs": "#d68910"}


def draw(
    ours: Sequence[numbers.Sample], theirs: Sequence[numbers.Sample], found: Mapping[str, Any], folder: Path
) -> list[Path]:
    """Draw a comparison (`corpus_realism.compare`) as `realism.png` and `realism.svg`; returns the files."""
    folder.mkdir(parents=True, exist_ok=True)
    figure: Figure = library("matplotlib.figure").Figure(figsize=(13, 10), layout="constrained")
    axes = figure.subplots(3, 2)
    corpora = {"ours": ours, "theirs": theirs}
    for place, (name, count) in enumerate({"actions": numbers.actions, "objects": numbers.objects}.items()):
        _frequencies(axes[0, place], {label: count(rows) for label, rows in corpora.items()}, f"Steps with {name}")
    lengths = {label: Counter(len(one.steps) for one in rows) for label, rows in corpora.items()}
    texts = {label: Counter(len(words) for words in {one.words for one in rows}) for label, rows in corpora.items()}
    _lengths(axes[1, 0], lengths, "Steps of a program")
    _lengths(axes[1, 1], texts, "Words of a description")
    _similarities(axes[2, 0], corpora)
    _ratios(axes[2, 1], found)
    return saved(figure, folder / "realism")


def _frequencies(axes: Any, counts: Mapping[str, Counter[str]], title: str) -> None:
    theirs = counts["theirs"]
    names = sorted(theirs, key=lambda name: (-theirs[name], name))[:_SHOWN]
    for offset, (label, found) in zip((-0.2, 0.2), counts.items(), strict=True):
        shares = [found[name] / max(1, found.total()) for name in names]
        axes.bar([place + offset for place in range(len(names))], shares, 0.38, color=COLOURS[label], label=label)
    axes.set_xticks(range(len(names)), [name.replace("_", " ") for name in names], rotation=60, ha="right")
    _finish(axes, title)


def _lengths(axes: Any, counts: Mapping[str, Counter[int]], title: str) -> None:
    places = range(1, _LONGEST + 1)
    for label, found in counts.items():
        total = sum(count for length, count in found.items() if length) or 1
        axes.plot(places, [found[place] / total for place in places], color=COLOURS[label], label=label)
    _finish(axes, title)


def _similarities(axes: Any, corpora: Mapping[str, Sequence[numbers.Sample]]) -> None:
    """Similarity within activities as a cumulative distribution over activities of several programs."""
    for label, rows in corpora.items():
        values = sorted(value for value in numbers.similarities(rows).values() if value is not None)
        heights = [(place + 1) / len(values) for place in range(len(values))]
        axes.step(values, heights, where="post", color=COLOURS[label], label=f"{label}: {len(values)} activities")
    axes.set_xlabel("mean normalised LCS within an activity")
    axes.set_ylabel("share of activities")
    _finish(axes, "Diversity of programs (table 3.1)")
    axes.yaxis.set_major_formatter("{x:.0%}")


def _ratios(axes: Any, found: Mapping[str, Any]) -> None:
    """Draw the ratios of this corpus's scores to those of the other's own half, with their intervals."""
    rows = [(name, kinds["ratio"]) for name, kinds in found.items() if "ratio" in kinds]
    for place, (_, ratio) in enumerate(rows):
        axes.plot([ratio["low"], ratio["high"]], [place, place], color=COLOURS["ours"], linewidth=3)
        axes.plot([ratio["mean"]], [place], "o", color=COLOURS["ours"])
        axes.annotate(f"{ratio['mean']:.2f}", (ratio["mean"], place), (0, 6), textcoords="offset points", ha="center")
    axes.axvline(1, color="#888", linestyle="--", linewidth=1)
    axes.set_xscale("log")
    axes.set_yticks(range(len(rows)), [name for name, _ in rows])
    axes.invert_yaxis()
    axes.margins(0.12)
    axes.set_title("Ours as a multiple of theirs, asked about their second half", fontsize=10)
    axes.spines[["top", "right"]].set_visible(False)


def _finish(axes: Any, title: str) -> None:
    axes.set_title(title, fontsize=10)
    axes.yaxis.set_major_formatter("{x:.0%}")
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, fontsize=8)
