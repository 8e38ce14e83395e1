"""Figure 4-4: which actions clips are taken for, as a matrix."""

from collections import Counter
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.datasets.dataset import Dataset
from hearth.models.films.clip_result_tables import HOMES, looked_at


class Confusion(NamedTuple):
    """The predicted actions of test clips, by their true action.

    Attributes:
        actions: that test clips have, the commonest first, then those that are named alone.
        shares: (A, A) of a row's clips, those that are taken for the column's action; of no clips 0.
        clips: of each row.
    """

    actions: tuple[str, ...]
    shares: NDArray[np.float64]
    clips: tuple[int, ...]


def confusion(dataset: Dataset, model: Path | str, homes: str = "all") -> Confusion:
    """Return the confusion of a classifier by true masks.

    Args:
        dataset: with clips.
        model: a checkpoint.
        homes: of `clip_tables.HOMES`.

    Raises:
        HearthError: errors of `clip_tables.looked_at`.
    """
    test, [(_, trained)] = looked_at("4.3", dataset, [model])
    pairs = [(clip.done.action, named.action) for clip, named in zip(test.clips, trained.named(test), strict=True)
             if clip.kind in HOMES[homes]]  # fmt: skip
    return of_pairs(pairs)


def of_pairs(pairs: Sequence[tuple[str, str]]) -> Confusion:
    """Return the confusion of pairs of a true action and the predicted one."""
    rows, columns = (Counter(pair[place] for pair in pairs) for place in (0, 1))
    actions = sorted(rows | columns, key=lambda name: (-rows[name], name))
    table = np.zeros((len(actions), len(actions)))
    for one, other in pairs:
        table[actions.index(one), actions.index(other)] += 1
    counts = tuple(rows[name] for name in actions)
    return Confusion(tuple(actions), table / np.maximum(counts, 1)[:, None], counts)


def drawn(found: Confusion) -> str:
    """Return the matrix as SVG, the true action at the left."""
    cell, left, top = 44, 150, 110
    side = cell * len(found.actions)
    lines = []
    for row, name in enumerate(found.actions):
        y = top + cell * row
        lines.append(f'<text x="{left - 8}" y="{y + 27}" text-anchor="end">{escape(name)} ({found.clips[row]})</text>')
        x = left + cell * row + 26
        lines.append(f'<text x="{x}" y="{top - 8}" transform="rotate(-50 {x} {top - 8})">{escape(name)}</text>')
        for column, share in enumerate(found.shares[row]):
            lines += _cell(left + cell * column, y, cell, float(share))
    lines.append(f'<text x="{left}" y="20" font-size="14">What the actions of test clips are taken for</text>')
    size = f'width="{left + side + 70}" height="{top + side + 20}"'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-family="sans-serif" font-size="12">'
    return "\n".join([head, '<rect width="100%" height="100%" fill="#ffffff"/>', *lines, "</svg>", ""])


def _cell(x: int, y: int, size: int, share: float) -> list[Any]:
    light = [round(255 + (dark - 255) * share) for dark in (27, 79, 114)]
    colour = f"#{light[0]:02x}{light[1]:02x}{light[2]:02x}"
    found = [f'<rect x="{x}" y="{y}" width="{size}" height="{size}" fill="{colour}" stroke="#dddddd"/>']
    if share >= 0.005:
        ink = "#ffffff" if share > 0.5 else "#222222"
        found.append(f'<text x="{x + size / 2}" y="{y + 27}" fill="{ink}" text-anchor="middle">{share:.2f}</text>')
    return found
