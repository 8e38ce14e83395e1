"""The course of policies' trainings, as a picture: imitation, then practice, a line for each checkpoint."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

from hearth.models.checkpoint import load

COLOURS = ("#1b4f72", "#d1495b", "#2e8b57", "#d68910", "#6c3483", "#555555")

PHASES = ("imitation", "practice")
TITLES = {"imitation": "imitation: minus the loss on held-out tasks", "practice": "practice: return on held-out tasks"}


@dataclass(frozen=True)
class Run:
    """A training.

    Attributes:
        name: of its model.
        seed: of it.
        scores: by phase, of each epoch; those of practice begin with the last score of imitation.
    """

    name: str
    seed: int
    scores: dict[str, list[float]]

    def row(self) -> dict[str, Any]:
        """Return where each phase began and ended."""
        found: dict[str, Any] = {"model": self.name, "seed": self.seed}
        for phase, scores in self.scores.items():
            found |= {f"{phase}_first": scores[0], f"{phase}_best": max(scores), f"{phase}_last": scores[-1]}
        return found


def runs(folders: Iterable[Path]) -> list[Run]:
    """Return the trainings of checkpoints.

    Raises:
        HearthError: MISSING_FILE, DAMAGED_FILE.
    """
    found = []
    for folder in folders:
        checkpoint = load(folder)
        trained: Any = checkpoint.trained
        practice = list(trained.get("curves", {}).get("score", ()))
        scores = {"practice": [trained["return_imitated"], *practice] if "return_imitated" in trained else practice}
        if "imitation" in trained:
            scores = {"imitation": list(trained["imitation"].get("curves", {}).get("score", ())), **scores}
        found.append(Run(checkpoint.model, trained.get("seed", 0), {k: v for k, v in scores.items() if v}))
    return found


def drawn(found: Sequence[Run]) -> str:
    """Return the picture, as SVG."""
    lines: list[str] = []
    for number, phase in enumerate(PHASES):
        there = [(run, run.scores[phase]) for run in found if phase in run.scores]
        if there:
            lines += _panel(60 + 430 * number, TITLES[phase], [scores for _, scores in there])
    for number, run in enumerate(found):
        y = 330 + 18 * number
        lines.append(f'<path d="M60 {y}h24" stroke="{_colour(number)}" stroke-width="2"/>')
        lines.append(f'<text x="90" y="{y + 4}">{escape(run.name)}, seed {run.seed}</text>')
    size = f'width="920" height="{340 + 18 * len(found)}"'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-family="sans-serif" font-size="12">'
    return "\n".join([head, '<rect width="100%" height="100%" fill="#ffffff"/>', *lines, "</svg>", ""])


def _panel(left: int, title: str, every: Sequence[Sequence[float]]) -> list[str]:
    low, high = min(map(min, every)), max(map(max, every))
    span, most = (high - low) or 1.0, max(max(map(len, every)) - 1, 1)
    lines = [f'<text x="{left}" y="24">{title}</text>']
    lines.append(f'<rect x="{left}" y="36" width="360" height="250" fill="none" stroke="#888888"/>')
    for k in range(5):
        y = 286 - 250 * k / 4
        lines.append(f'<text x="{left - 4}" y="{y + 4:.0f}" text-anchor="end">{low + span * k / 4:.2f}</text>')
    lines.append(f'<text x="{left}" y="302">0</text><text x="{left + 360}" y="302" text-anchor="end">{most}</text>')
    lines.append(f'<text x="{left + 180}" y="302" text-anchor="middle">epochs</text>')
    for number, scores in enumerate(every):
        points = [
            f"{left + 360 * i / most:.1f},{286 - 250 * (score - low) / span:.1f}" for i, score in enumerate(scores)
        ]
        lines.append(f'<polyline points="{" ".join(points)}" fill="none" stroke="{_colour(number)}" stroke-width="2"/>')
    return lines


def _colour(number: int) -> str:
    return COLOURS[number % len(COLOURS)]
