"""Figure 4-9 with automatic scores in the place of judges: results of running programs of each band of LCS.

In the thesis people rated films of programs, and their ratings rose with LCS. No person was asked here: the engine says
whether a program runs, how much of the reference's goal it reaches, and how much of its change of the home it makes.
"""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

from hearth.analysis.corpus_figures import blank, saved
from hearth.schemas.optional_libraries import library
from hearth.scoring.prediction_scores import METRICS, Scored

BANDS = (0.25, 0.5, 0.65, 0.8, 0.95)
"""Lower bounds of bands of LCS, after 0; from .5 on as in figure 4-9."""

JUDGES = {"executable": "runs", "goal_fraction": "share of the goal", "f1": "F1 of the change"}
"""The scores that stand for judges, and the figure's names for them."""


class BandRow(NamedTuple):
    """The programs of a band of LCS, of steps by class.

    Attributes:
        low, high: the band; only the last band includes its upper end.
        programs: in it.
        scores: the mean of each of `JUDGES`; None where no program has the score.
    """

    low: float
    high: float
    programs: int
    scores: dict[str, float | None]


class Agreement(NamedTuple):
    """The bands, and for each of `JUDGES` Spearman's rank correlation with LCS; None where either is constant."""

    bands: list[BandRow]
    correlations: dict[str, float | None]


def by_lcs(found: Sequence[Scored]) -> Agreement:
    """Scored programs by bands of their LCS; bands without programs are left out."""
    ends = [0.0, *BANDS, 1.0]
    rows = []
    for low, high in pairwise(ends):
        inside = [each for each in found if low <= each.lcs.step < high or each.lcs.step == high == 1]
        if inside:
            rows.append(BandRow(low, high, len(inside), {name: _mean(inside, name) for name in JUDGES}))
    return Agreement(rows, {name: _correlation(found, name) for name in JUDGES})


def _mean(found: Sequence[Scored], name: str) -> float | None:
    values = [value for each in found if (value := METRICS[name](each)) is not None]
    return round(sum(values) / len(values), 4) if values else None


def _correlation(found: Sequence[Scored], name: str) -> float | None:
    pairs = [(each.lcs.step, value) for each in found if (value := METRICS[name](each)) is not None]
    if len({lcs for lcs, _ in pairs}) < 2 or len({value for _, value in pairs}) < 2:
        return None
    return round(float(library("scipy.stats").spearmanr(*zip(*pairs, strict=True)).statistic), 4)


def draw_by_lcs(found: Agreement, title: str, path: Path) -> list[Path]:
    """Draw the bands as PNG and SVG; returns the files."""
    figure, axes = blank(7.2, 4)
    width = 0.8 / len(JUDGES)
    for turn, (name, label) in enumerate(JUDGES.items()):
        places = [place + (turn - (len(JUDGES) - 1) / 2) * width for place in range(len(found.bands))]
        shown = [(place, score) for place, row in zip(places, found.bands, strict=True)
                 if (score := row.scores[name]) is not None]  # fmt: skip
        rho = found.correlations[name]
        note = "" if rho is None else f" (rank correlation {rho:.2f})"
        color = ("#b8b8b8", "#31688e", "#1b9e77")[turn]
        heights = [score for _, score in shown]
        bars = axes.bar([place for place, _ in shown], heights, width * 0.94, label=label + note, color=color)
        axes.bar_label(bars, fmt="%.2f", padding=2, fontsize=7)
        for place in sorted({*places} - {place for place, _ in shown}):
            axes.annotate("none", (place, 0), (0, 2), textcoords="offset points", ha="center", fontsize=7)
    names = [f"{row.low:.2f} to {row.high:.2f}\n{row.programs} programs" for row in found.bands]
    axes.set_xticks(range(len(found.bands)), names, fontsize=8)
    axes.set_xlabel("normalised LCS of the program's steps")
    axes.set_ylabel("mean score")
    axes.set_ylim(0, 1.28)
    axes.set_yticks([0, 0.25, 0.5, 0.75, 1])
    axes.legend(frameon=False, fontsize=8, ncols=2, loc="upper left")
    axes.set_title(f"{title}: the engine's scores, not people's", fontsize=10)
    axes.spines[["top", "right"]].set_visible(False)
    return saved(figure, path)
