"""Retrieval of training programs by words, by vectors, and by both: table 4.5's similarity of the nearest program."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hearth.datasets.dataset import Dataset
from hearth.models.text.mixed_similarity import WEIGHTS, Vectors, by_weight, mean_score
from hearth.models.text_examples import corpus, examples
from hearth.scoring.bootstrap import intervals
from hearth.scoring.metrics.lcs import LEVELS


def compared(folder: Path, split: str, vectors: Vectors, limit: int | None = None) -> list[dict[str, Any]]:
    """Return a row for words, for vectors, and for both with the weight that is best on validation.

    Args:
        folder: of a dataset.
        split: by which examples are parted.
        vectors: gives vectors of texts.
        limit: the first test programs only.

    Raises:
        HearthError: UNKNOWN_ID: no such split; BAD_ARGUMENT: it has no validation examples; those of `vectors`.
    """
    dataset = Dataset.open(folder)
    given = corpus(dataset, split)
    on_validation = {weight: mean_score(found) for weight, found in _by_weight(given, vectors).items()}
    best = max(WEIGHTS, key=lambda weight: (on_validation[weight], -weight))
    test = examples(dataset, split, "test", originals=True)[:limit]
    on_test = by_weight(given.train, test, vectors)
    rows = []
    for name, weight in (("words", 0.0), ("vectors", 1.0), ("both", best)):
        columns = {level: [getattr(each, level) for each in on_test[weight]] for level in (*LEVELS, "mean")}
        scores = intervals(columns, 0)
        low, high = scores["mean"].low, scores["mean"].high
        rows.append({
            "by": name, "weight_of_vectors": weight, "validation_mean": round(on_validation[weight], 3),
            "tests": len(test), **{level: round(scores[level].mean, 3) for level in (*LEVELS, "mean")},
            "from": round(low, 3), "to": round(high, 3),
        })  # fmt: skip
    return rows


def _by_weight(given: Any, vectors: Vectors) -> Any:
    return by_weight(given.train, given.checked(), vectors)
