"""Near duplicates: what is passed over for speed is what comparing each with each finds, too."""

from __future__ import annotations

import random

from hypothesis import given
from hypothesis import strategies as st

from hearth.datasets.format.near_duplicates import near_sequences, near_texts

LEAST = (0.5, 0.9, 1.0)


def common(one, other):
    """Length of the longest common subsequence, by the plain table."""
    before = [0] * (len(other) + 1)
    for a in one:
        now = [0]
        for place, b in enumerate(other):
            now.append(before[place] + 1 if a == b else max(now[-1], before[place + 1]))
        before = now
    return before[-1]


def plainly(rows, similarity, least):
    """Each with each."""
    pairs = ((i, j) for j in range(len(rows)) for i in range(j))
    return sorted((i, j) for i, j in pairs if similarity(rows[i], rows[j]) >= least - 1e-6)


def of_the_longer(one, other):
    return common(one, other) / max(len(one), len(other)) if one or other else 1.0


def of_both(one, other):
    return 2 * common(one, other) / (len(one) + len(other)) if one or other else 1.0


def families(elements, longest, count, dropped):
    """Rows that are parts of few others, in no order."""
    draw = random.Random(0)
    wholes = [[draw.choice(elements) for _ in range(draw.randint(0, longest))] for _ in range(12)]
    return [tuple(each for each in draw.choice(wholes) if draw.random() > dropped) for _ in range(count)]


def test_the_index_of_sequences_misses_nothing():
    rows = families(range(9), 14, 70, 0.08)
    for least in LEAST:
        found = sorted(near_sequences(rows, least))
        assert found == plainly(rows, of_the_longer, least)
        assert len(found) > len(rows)


@given(st.lists(st.lists(st.integers(0, 70) | st.integers(0, 4), max_size=12), max_size=12), st.sampled_from(LEAST))
def test_any_sequences_are_compared_as_each_with_each(rows, least):
    rows += [row[1:] for row in rows] + [[*row, 1] for row in rows]
    assert sorted(near_sequences(rows, least)) == plainly(rows, of_the_longer, least)
    texts = ["".join(map(chr, row)) for row in rows]
    assert sorted(near_texts(texts, least)) == plainly(texts, of_both, least)


def test_lengths_and_counted_characters_keep_no_near_texts_apart():
    rows = ["".join(row) for row in families("abcdef \u00e9\U0001f600", 40, 90, 0.04)]
    for least in LEAST:
        found = sorted(near_texts(rows, least))
        assert found == plainly(rows, of_both, least)
        assert len(found) > len(rows) / 4


def test_nothing_is_near_nothing():
    assert list(near_texts([], 0.9)) == list(near_sequences([], 0.9)) == []
