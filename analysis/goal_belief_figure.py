"""A helper's beliefs in an episode, as in the thesis's figure 7-4: probabilities over time, key actions below."""

from collections.abc import Sequence
from xml.sax.saxutils import escape

from hearth.analysis.episode_figure import COLOURS
from hearth.challenges.helper_beliefs import Beliefs

LINES = ("#1b4f72", "#d68910", "#196f3d", "#922b21", "#6c3483", "#117a65", "#7b7d7d", "#a04000")

WIDE, HIGH, LEFT, TOP = 560, 240, 50, 30

Action = tuple[int, int, str, str]
"""Tick from 1, agent, instruction in words, code of its failure (see `episode_drawing.narrated`)."""


def drawn(found: Beliefs, actions: Sequence[Action]) -> str:
    """Return SVG: a line for each of the likeliest predicates, those of the goal thick, and actions below."""
    ticks = max(1, len(found.moments))
    most = [max((moment.wanted[n] for moment in found.moments), default=0.0) for n in range(len(found.predicates))]
    order = sorted(range(len(most)), key=lambda n: (found.goal[n] == 0, -most[n], n))[: len(LINES)]
    lines = [f'<rect x="{LEFT}" y="{TOP}" width="{WIDE}" height="{HIGH}" fill="none" stroke="#888888"/>']
    lines += [_label(LEFT - 6, TOP + HIGH * (1 - share) + 4, f"{share:.1f}", "end") for share in (0.0, 0.5, 1.0)]
    lines.append(_label(LEFT, TOP - 10, "probability that the goal has a predicate (thick: it has), by tick"))
    for colour, number in zip(LINES, order, strict=False):
        points = " ".join(
            f"{LEFT + WIDE * tick / ticks:.1f},{TOP + HIGH * (1 - moment.wanted[number]):.1f}"
            for tick, moment in enumerate(found.moments)
        )
        thick = 2.5 if found.goal[number] else 1
        lines.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="{thick}"/>')
        y = TOP + 14 + 18 * LINES.index(colour)
        lines.append(f'<rect x="{LEFT + WIDE + 12}" y="{y - 8}" width="12" height="{3 + 2 * thick}" fill="{colour}"/>')
        wanted = f", wanted {found.goal[number]}" if found.goal[number] else ""
        lines.append(_label(LEFT + WIDE + 30, y, f"{found.predicates[number]}{wanted}"))
    below, rows = TOP + HIGH + 20, [each for each in actions if not each[3]]
    for number, (tick, agent, words, _) in enumerate(rows):
        x, y = LEFT + WIDE * (tick - 1) / ticks, below + 14 * number
        colour = COLOURS[agent % len(COLOURS)]
        lines.append(f'<path d="M{x:.1f} {TOP + HIGH}V{y:.1f}" stroke="{colour}" stroke-width="0.5" fill="none"/>')
        lines.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>')
        who = "helper" if agent else "main agent"
        right = x > LEFT + WIDE * 0.6
        text = f"{tick}: {who}: {words}"
        lines.append(_label(x + (-7 if right else 7), y + 4, text, "end" if right else "start"))
    size = f'width="{LEFT + WIDE + 260}" height="{below + 14 * len(rows) + 10}"'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-family="sans-serif" font-size="11">'
    return "\n".join([head, '<rect width="100%" height="100%" fill="#ffffff"/>', *lines, "</svg>", ""])


def _label(x: float, y: float, text: str, anchor: str = "start") -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(text)}</text>'
