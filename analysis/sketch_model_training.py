"""Fitting models of sketches on annotations, and judging them by cross-validation over activities."""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.analysis.sketch_evaluation import Annotated
from hearth.datasets.format.ids import activity_id
from hearth.kb.knowledge import Knowledge
from hearth.repair.sketch import Keep, sketch
from hearth.repair.sketch_features import RATED, StepFeatures, features
from hearth.repair.sketch_model import BASE, SketchModel, Tree, inputs, logit, shares
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import derive
from hearth.simulation.world.home import Home

LEAST = 0.45
"""Probability from which a step is kept: below one half, since F1 asks for recall as much as for precision."""

RAREST, SHARE = 3, 4_000
"""A name is a feature if at least `RAREST` steps have it, and one of `SHARE` steps."""

_STRENGTH, _RUNS = 0.3, 2
_BOOSTED = {"n_estimators": 150, "learning_rate": 0.06, "max_leaf_nodes": 6, "max_depth": None,
            "min_samples_leaf": 10, "subsample": 0.7, "max_features": 0.3}  # fmt: skip
_FOREST = {"n_estimators": 200, "min_samples_leaf": 4, "max_features": 0.3}
_DIGITS = 3


class Example(NamedTuple):
    """An annotated program as models see it."""

    activity: str
    actions: tuple[str, ...]
    ruled: Keep
    answer: Keep
    steps: list[StepFeatures]


def examples(
    found: Iterable[Annotated | None], homes: Sequence[Home], knowledge: Knowledge, seed: int = 0
) -> list[Example]:
    """Features and answers of annotated programs; annotations without a program are left out."""
    return [_example(one, homes, knowledge, seed) for one in found if one is not None]


def _example(one: Annotated, homes: Sequence[Home], knowledge: Knowledge, seed: int) -> Example:
    program = one.script.program
    ruled = sketch(program, homes, knowledge, seed, one.script.program_id)
    actions = tuple(step.action for step in program.steps)
    return Example(activity_id(program.title), actions, ruled, one.answer, features(program, ruled, knowledge))


@dataclass(slots=True)
class _Rows:
    """The steps of examples as rows."""

    names: list[tuple[str, ...]]
    numbers: NDArray[Any]
    base: NDArray[Any]
    answers: NDArray[Any]
    counts: dict[str, tuple[int, int]]


def _rows(found: Sequence[Example], base: SketchModel | None) -> _Rows:
    counts = _counts(found)
    own = {name: _counts([one for one in found if one.activity == name]) for name in {one.activity for one in found}}
    names = inputs(base is not None)
    numbers = []
    below = []
    for one in found:
        for step in one.steps:
            below.append(logit(base.probability(step)) if base else 0.0)
            values = dict(step.numbers, **{BASE: below[-1]})
            values |= _labelled("share", shares(step, counts, own[one.activity]))
            values |= _labelled("base share", shares(step, base.counts)) if base else {}
            numbers.append([values[name] for name in names])
    return _Rows(
        [step.names for one in found for step in one.steps],
        np.array(numbers).reshape(len(numbers), len(names)),
        np.array(below),
        np.array([kept for one in found for kept in one.answer], dtype=bool),
        counts,
    )


def _labelled(label: str, values: Iterable[float]) -> dict[str, float]:
    return {f"{label} {name}": value for name, value in zip(RATED, values, strict=True)}


def _counts(found: Iterable[Example]) -> dict[str, tuple[int, int]]:
    """Return by rated name the numbers of steps and of kept steps; of all steps under the empty name."""
    steps: Counter[str] = Counter()
    kept: Counter[str] = Counter()
    for one in found:
        for step, keep in zip(one.steps, one.answer, strict=True):
            names = {"", *step.names[: len(RATED)]}
            steps.update(names)
            kept.update(names if keep else ())
    return {name: (count, kept[name]) for name, count in sorted(steps.items())}


def fit(found: Sequence[Example], fitted_on: str, base: SketchModel | None = None, seed: int = 0) -> SketchModel:
    """Fit a model: the linear part on names, the trees on numbers; on top of another model a forest, too.

    Args:
        found: annotated programs, of two activities at least.
        fitted_on: the kind of the programs, in words; stored in the model.
        base: a model of other annotations that this one builds on.
        seed: of the trees.

    Raises:
        HearthError: EMPTY: all steps are kept, or none.
    """
    if len({kept for one in found for kept in one.answer}) < 2:
        remedy = "give more sketches, which keep some steps and not others"
        raise HearthError.of(Code.EMPTY, "nothing to learn: all steps are kept, or none", suggestion=remedy)
    rows = _rows(found, base)
    rarest = max(RAREST, len(rows.answers) // SHARE)
    vocabulary = _vocabulary(rows.names, rarest)
    bias, weights = _linear(_matrix(rows, vocabulary), rows.answers)
    start, trees = _boosted(rows, seed)
    return SketchModel(
        {"source": fitted_on, "programs": len(found), "steps": len(rows.answers)},
        bias,
        {name: weight for name, weight in zip(vocabulary, weights[:-1], strict=True) if weight},
        weights[-1],
        {name: pair for name, pair in rows.counts.items() if pair[0] >= rarest},
        inputs(base is not None),
        start,
        trees,
        LEAST,
        base,
        forest=_grown(rows, seed) if base else (),
    )


def _vocabulary(names: Iterable[tuple[str, ...]], rarest: int) -> list[str]:
    counts = Counter(name for row in names for name in set(row))
    return sorted(name for name, count in counts.items() if count >= rarest)


def _matrix(rows: _Rows, vocabulary: Sequence[str]) -> Any:
    """Sparse: a column a name, and the base's logit last."""
    from scipy.sparse import csr_matrix

    place = {name: column for column, name in enumerate(vocabulary)}
    cells = [
        (row, place[name], 1.0) for row, names in enumerate(rows.names) for name in sorted(set(names) & place.keys())
    ]
    cells += [(row, len(place), value) for row, value in enumerate(rows.base.tolist())]
    lines, columns, values = zip(*cells, strict=True)
    at = (np.array(lines, np.int32), np.array(columns, np.int32))
    return csr_matrix((np.array(values), at), shape=(len(rows.names), len(place) + 1))


def _linear(matrix: Any, answers: NDArray[Any]) -> tuple[float, list[float]]:
    from sklearn.linear_model import LogisticRegression

    fitted = LogisticRegression(C=_STRENGTH, max_iter=300).fit(matrix, answers)
    return round(float(fitted.intercept_[0]), _DIGITS), fitted.coef_[0].round(_DIGITS).tolist()


def parts(activities: Sequence[str], count: int, seed: int) -> NDArray[Any]:
    """Return a part, from 0, for each row, whole activities in one part, parts of nearly equal size."""
    sizes = Counter(activities)
    loads, part_of = [0] * count, {}
    for name in sorted(sizes, key=lambda each: (-sizes[each], derive(seed, "sketch parts", each))):
        part_of[name] = loads.index(min(loads))
        loads[part_of[name]] += sizes[name]
    return np.array([part_of[name] for name in activities])


def _boosted(rows: _Rows, seed: int) -> tuple[float, tuple[Tree, ...]]:
    """Return the logit before the trees, and the trees of several runs, each weighing its share."""
    from sklearn.ensemble import GradientBoostingClassifier

    trees: list[Tree] = []
    for run in range(_RUNS):
        fitted = GradientBoostingClassifier(**_BOOSTED, random_state=derive(seed, "sketch trees", run) % 2**32)
        fitted.fit(rows.numbers, rows.answers)
        trees += [_tree(each.tree_, fitted.learning_rate / _RUNS) for each in fitted.estimators_[:, 0]]
    share = rows.answers.mean()
    return round(float(np.log(share / (1 - share))), _DIGITS), tuple(trees)


def _grown(rows: _Rows, seed: int) -> tuple[Tree, ...]:
    """Trees of a forest; their leaves have probabilities."""
    from sklearn.ensemble import ExtraTreesClassifier

    random = derive(seed, "sketch forest") % 2**32
    fitted = ExtraTreesClassifier(**_FOREST, random_state=random).fit(rows.numbers, rows.answers)
    kept = fitted.classes_.tolist().index(True)
    return tuple(_tree(each.tree_, 1.0, kept) for each in fitted.estimators_)


def _tree(tree: Any, rate: float, output: int = 0) -> Tree:
    leaf = tree.children_left < 0
    return Tree(
        tuple(-1 if end else int(number) for end, number in zip(leaf, tree.feature, strict=True)),
        tuple(0.0 if end else round(float(value), 6) for end, value in zip(leaf, tree.threshold, strict=True)),
        tuple(map(int, tree.children_left)),
        tuple(map(int, tree.children_right)),
        tuple((tree.value[:, 0, output] * rate).round(_DIGITS).tolist()),
    )
