"""Near sequences: the index finds what comparing each with each finds."""

from __future__ import annotations

import random

from hearth.pipelines.alike import near_sequences


def plainly(rows, columns, least):
    """Each with each, by a plain table of longest common subsequences."""

    def common(one, other):
        before = [0] * (len(other) + 1)
        for a in one:
            now = [0]
            for place, b in enumerate(other):
                now.append(before[place] + 1 if a == b else max(now[-1], before[place + 1]))
            before = now
        return before[-1]

    return [
        (i, j)
        for i, one in enumerate(rows)
        for j, other in enumerate(columns)
        if common(one, other) >= least * max(len(one), len(other)) - 1e-6
    ]


def test_the_index_misses_nothing():
    draw = random.Random(0)
    families = [[draw.randrange(9) for _ in range(draw.randint(0, 14))] for _ in range(12)]
    rows = [tuple(number for number in draw.choice(families) if draw.random() > 0.08) for _ in range(70)]
    for least in (0.5, 0.9, 1.0):
        found = list(near_sequences(rows, rows, least))
        assert found == plainly(rows, rows, least)
        assert len(found) > len(rows)
    assert list(near_sequences(rows[:20], rows[20:], 0.9)) == plainly(rows[:20], rows[20:], 0.9)
