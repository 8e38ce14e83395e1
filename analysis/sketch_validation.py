"""Cross-validation of learned sketches over activities, with rules, majorities, and intervals of the leads."""

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from hearth.analysis.sketch_evaluation import Counts
from hearth.analysis.sketch_model_training import Example, fit, parts
from hearth.repair.sketch import Keep
from hearth.repair.sketch_model import SketchModel
from hearth.schemas.rng import derive

FOLDS, RESAMPLES = 10, 1_000

MAJORITY = "majority of each action"
"""The way that leads are measured against: actions that the training folds keep more often than not."""

Learned = Callable[[Sequence[Example], SketchModel | None, int], Callable[[Example], Keep]]
"""A way of learning: examples of the training folds, a base and a seed give a way to keep steps."""


def _ruled(train: Sequence[Example], base: SketchModel | None, seed: int) -> Callable[[Example], Keep]:
    return lambda one: one.ruled


def _by_base(train: Sequence[Example], base: SketchModel | None, seed: int) -> Callable[[Example], Keep]:
    return lambda one: base.keep(one.steps) if base else one.ruled


def _majority(place: int) -> Learned:
    """Return steps whose name at a place (0.

    The action, 1: with its objects) is kept more often than not, else by action.
    """

    def learned(train: Sequence[Example], base: SketchModel | None, seed: int) -> Callable[[Example], Keep]:
        margins: Counter[str] = Counter()
        for one in train:
            for step, kept in zip(one.steps, one.answer, strict=True):
                for name in dict.fromkeys(step.names[: place + 1]):
                    margins[name] += 1 if kept else -1

        def usual(names: Sequence[str]) -> bool:
            known = next((margins[name] for name in reversed(names) if margins.get(name)), 0)
            return known > 0

        return lambda one: tuple(usual(step.names[: place + 1]) for step in one.steps)

    return learned


def _model(change: Callable[[SketchModel], SketchModel]) -> Learned:
    """Return a fitted model, or one of its parts."""

    def learned(train: Sequence[Example], base: SketchModel | None, seed: int) -> Callable[[Example], Keep]:
        model = change(fit(train, "training folds", base, seed))
        return lambda one: model.keep(one.steps)

    return learned


WAYS: dict[str, Learned] = {
    "repairs": _ruled,
    "base": _by_base,
    MAJORITY: _majority(0),
    "majority of each instruction": _majority(1),
    "linear": _model(lambda model: replace(model, trees=(), forest=())),
    "boosted trees": _model(lambda model: replace(model, linear=False, forest=())),
    "linear and boosted trees": _model(lambda model: replace(model, forest=())),
    "all parts": _model(lambda model: model),
}
"""`repairs` and `base` learn nothing from the folds: the former infers sketches, the latter is another's model. A model
that builds on no other has no forest, so that all its parts are two."""


def cross_validate(
    found: Sequence[Example], base: SketchModel | None = None, folds: int = FOLDS, seed: int = 0
) -> dict[str, Any]:
    """Precision, recall and F1 of every way on activities that it was not fitted on, and its lead in F1.

    Args:
        found: annotated programs.
        base: a model fitted on other annotations; without one `base` is left out.
        folds: number of parts; no activity is in two.
        seed: of parts, models and intervals.

    Returns:
        By way: `precision`, `recall`, `f1`; `lead`, over `MAJORITY`, and `lead_low` and `lead_high`, its 95% interval
        over resampled activities.
    """
    part = parts([one.activity for one in found], folds, seed).tolist()
    kept: dict[str, list[Keep]] = {name: [()] * len(found) for name in WAYS if base or name != "base"}
    for number in sorted(set(part)):
        train = [one for one, mine in zip(found, part, strict=True) if mine != number]
        for name, keeps in kept.items():
            keep = WAYS[name](train, base, seed)
            for place, one in enumerate(found):
                if part[place] == number:
                    keeps[place] = keep(one)
    counted = {name: _by_activity(found, keeps) for name, keeps in kept.items()}
    return {name: {**_total(counts), **_lead(counts, counted[MAJORITY], seed)} for name, counts in counted.items()}


def _by_activity(found: Sequence[Example], keeps: Iterable[Keep]) -> dict[str, Counts]:
    counts: dict[str, Counts] = defaultdict(Counts)
    for one, keep in zip(found, keeps, strict=True):
        counts[one.activity].add(keep, one.answer)
    return dict(sorted(counts.items()))


def _total(counts: dict[str, Counts]) -> dict[str, float]:
    every = counts.values()
    return Counts(*(sum(getattr(one, name) for one in every) for name in ("both", "extra", "missing"))).scores()


def _lead(mine: dict[str, Counts], usual: dict[str, Counts], seed: int) -> dict[str, float]:
    """Return the difference in F1 and its percentile interval; activities are drawn with replacement."""
    table = np.array([[[c.both, c.extra, c.missing] for c in each.values()] for each in (mine, usual)], dtype=float)
    generator = np.random.Generator(np.random.PCG64(derive(seed, "sketch leads")))
    count = table.shape[1]
    drawn = generator.integers(count, size=(RESAMPLES, count))
    both, extra, missing = np.moveaxis(table[:, drawn].sum(axis=2), -1, 0)
    f1 = 2 * both / np.maximum(2 * both + extra + missing, 1)
    low, high = np.quantile(f1[0] - f1[1], [0.025, 0.975])
    lead = _total(mine)["f1"] - _total(usual)["f1"]
    return {"lead": round(lead, 4), "lead_low": round(float(low), 4), "lead_high": round(float(high), 4)}
