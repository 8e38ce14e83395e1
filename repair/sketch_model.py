"""Learned sketches: a linear model and trees, stored as JSON and evaluated without a library.

The linear model sees the names of a step; the trees see its numbers and, for some names, the share of steps kept. The
probability is the mean of theirs. A model fitted on few annotations builds on another (`base`), whose logit and shares
it sees, too, and has a forest besides the boosted trees: the trees of a forest err each in its own way.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from math import exp, log
from pathlib import Path
from typing import Any, NamedTuple

import orjson

from hearth.kb.knowledge import Knowledge
from hearth.repair.sketch import Keep
from hearth.repair.sketch_features import NUMBERS, RATED, StepFeatures, features
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import Program
from hearth.storage.input_files import LARGEST_TABLE, read_input

FILE = Path(__file__).parent / "sketch_model.json"
"""The model fitted on our own annotations."""

FORM = 1
"""Version of the stored form."""

BASE = "base"
"""The number that is the logit of the base."""

SMOOTHING = 3.0
"""Steps at the share of its action that a rarer name is counted with."""


LARGEST_NUMBER = 1e12
"""Of a stored model, at most: no weight, threshold or count is near it."""


class Tree(NamedTuple):
    """A regression tree: node i goes to `left[i]` if `numbers[number[i]] <= threshold[i]`; a leaf has number -1."""

    number: tuple[int, ...]
    threshold: tuple[float, ...]
    left: tuple[int, ...]
    right: tuple[int, ...]
    value: tuple[float, ...]

    def score(self, values: Sequence[float]) -> float:
        """Return the value of the leaf that these numbers reach."""
        node = 0
        while self.number[node] >= 0:
            below = values[self.number[node]] <= self.threshold[node]
            node = self.left[node] if below else self.right[node]
        return self.value[node]


@dataclass(frozen=True, slots=True)
class SketchModel:
    """A model of which steps people keep.

    Attributes:
        fitted_on: in words, and numbers of programs and steps.
        bias, weights: of the linear model; unknown names weigh nothing.
        base_weight: of the base's logit in the linear model.
        counts: by name, numbers of steps and of those kept.
        numbers: names of the trees' inputs, in order.
        start: logit before the first tree.
        trees: their values are added.
        least: probability from which a step is kept.
        base: the model that this one builds on.
        linear: whether the linear model counts; without it the trees decide alone.
        forest: trees of probabilities, of which the mean counts as much as the other two parts.
    """

    fitted_on: Mapping[str, Any]
    bias: float
    weights: Mapping[str, float]
    base_weight: float
    counts: Mapping[str, tuple[int, int]]
    numbers: tuple[str, ...]
    start: float
    trees: tuple[Tree, ...]
    least: float
    base: SketchModel | None = None
    linear: bool = True
    forest: tuple[Tree, ...] = ()

    def probability(self, step: StepFeatures) -> float:
        """Return the probability that people keep a step."""
        below = logit(self.base.probability(step)) if self.base else 0.0
        linear = self.bias + self.base_weight * below + sum(self.weights.get(name, 0.0) for name in step.names)
        values = self.values(step, below)
        row = [values[name] for name in self.numbers]
        boosted = self.start + sum(tree.score(row) for tree in self.trees)
        found = [_logistic(each) for each in [linear] * self.linear + [boosted] * bool(self.trees)]
        if self.forest:
            found.append(sum(tree.score(row) for tree in self.forest) / len(self.forest))
        return sum(found) / len(found)

    def values(self, step: StepFeatures, below: float) -> dict[str, float]:
        """Return the numbers that the trees may see of a step; `below`: the base's logit."""
        return {
            **step.numbers,
            BASE: below,
            **{f"share {name}": share for name, share in zip(RATED, shares(step, self.counts), strict=True)},
            **(
                {f"base share {n}": s for n, s in zip(RATED, shares(step, self.base.counts), strict=True)}
                if self.base
                else {}
            ),
        }

    def keep(self, steps: Sequence[StepFeatures]) -> Keep:
        """Return the steps kept: those that are probable enough, and always the most probable one."""
        found = [self.probability(step) for step in steps]
        best = max(range(len(found)), key=found.__getitem__, default=0)
        return tuple(each >= self.least or number == best for number, each in enumerate(found))

    def to_json(self) -> dict[str, Any]:
        """Return the stored form; the base is not stored, since it is the shipped model."""
        return {
            "form": FORM,
            "fitted_on": dict(self.fitted_on),
            "least": self.least,
            "base": self.base is not None,
            "bias": self.bias,
            "base_weight": self.base_weight,
            "weights": dict(sorted(self.weights.items())),
            "counts": {name: list(pair) for name, pair in sorted(self.counts.items())},
            "numbers": list(self.numbers),
            "start": self.start,
            "trees": [tree._asdict() for tree in self.trees],
            **({"forest": [tree._asdict() for tree in self.forest]} if self.forest else {}),
        }


def shares(
    step: StepFeatures, counts: Mapping[str, tuple[int, int]], without: Mapping[str, tuple[int, int]] | None = None
) -> list[float]:
    """Return the share of steps kept among those with each of the `RATED` names, smoothed towards that of the action.

    Args:
        step: the step.
        counts: by name, numbers of steps and of those kept; of all steps under the empty name.
        without: counts that are left out, as those of the step's own activity in training.
    """

    def share(name: str, usual: float) -> float:
        steps, kept = counts.get(name, (0, 0))
        own_steps, own_kept = without.get(name, (0, 0)) if without else (0, 0)
        return (kept - own_kept + SMOOTHING * usual) / (steps - own_steps + SMOOTHING)

    usual = share("", 0.2)
    action = share(step.names[0], usual)
    places = zip(RATED[1:], step.names[1:], strict=False)
    return [action, *(share(name, usual if place == "object" else action) for place, name in places)]


def logit(probability: float) -> float:
    """Return the log-odds of a probability, cut at 1e-6 from 0 and 1 and rounded, so that stored trees agree."""
    cut = min(max(probability, 1e-6), 1 - 1e-6)
    return round(log(cut / (1 - cut)), 6)


def _logistic(value: float) -> float:
    return 1 / (1 + exp(-min(max(value, -30.0), 30.0)))


def learned_sketch(program: Program, ruled: Keep, knowledge: Knowledge, model: SketchModel) -> Keep:
    """Return the steps that a model keeps, given those that repairs can't do without.

    Args:
        program: with instances as counters.
        ruled: the sketch inferred by repairs (`sketch`).
        knowledge: of its actions and objects.
        model: as `load_model` reads it.
    """
    return model.keep(features(program, ruled, knowledge)) if program.steps else ()


def model_of(name: str) -> SketchModel:
    """Return the model of a name: `ours` for the shipped one, else a file."""
    return shipped() if name == "ours" else load_model(Path(name))


@cache
def shipped() -> SketchModel:
    """Return the model fitted on our own annotations."""
    return load_model(FILE)


def load_model(path: Path) -> SketchModel:
    """Read a stored model, which may be a stranger's.

    Raises:
        HearthError: BAD_JSON, it is not a model of sketches; those of `read_input`.
    """
    stored = read_input(path, LARGEST_TABLE)
    try:
        data = orjson.loads(stored)
        if data["form"] != FORM:
            raise ValueError(f"form {str(data['form'])[:20]}")
        numbers = tuple(map(str, data["numbers"]))
        trees = tuple(_tree(each, len(numbers)) for each in data["trees"])
        forest = tuple(_tree(each, len(numbers)) for each in data.get("forest", ()))
        if any(not 0 <= value <= 1 for tree in forest for value in tree.value):
            raise ValueError("a tree of a forest whose leaves have no probabilities")
        weights = {str(name): _number(weight) for name, weight in data["weights"].items()}
        start, bias, base_weight = _number(data["start"]), _number(data["bias"]), _number(data["base_weight"])
        counts = {str(name): _share(*pair) for name, pair in data["counts"].items()}
        base = shipped() if data["base"] else None
        return SketchModel(
            dict(data["fitted_on"]), bias, weights, base_weight, counts, _known(numbers, base), start, trees,
            _number(data["least"]), base, forest=forest,
        )  # fmt: skip
    except (orjson.JSONDecodeError, KeyError, TypeError, ValueError, AttributeError, OverflowError) as error:
        message = f"not a model of sketches: {type(error).__name__} {str(error)[:200]}"
        suggestion = "`sketch --fit` writes one"
        raise HearthError.of(Code.BAD_JSON, message, file=str(path), suggestion=suggestion) from error


def _number(given: Any) -> float:
    """Return a number that sums and products of the model's stay finite with."""
    number = float(given)
    if not abs(number) <= LARGEST_NUMBER:
        raise ValueError(f"the number {str(given)[:20]}")
    return number


def _share(steps: Any, kept: Any) -> tuple[int, int]:
    """Numbers of steps and of those kept."""
    if not 0 <= int(kept) <= int(steps) <= LARGEST_NUMBER:
        raise ValueError(f"{str(kept)[:20]} steps kept of {str(steps)[:20]}")
    return int(steps), int(kept)


def _known(numbers: tuple[str, ...], base: SketchModel | None) -> tuple[str, ...]:
    unknown = set(numbers) - set(inputs(base is not None))
    if unknown:
        raise ValueError(f"unknown number {min(unknown)}")
    return numbers


def inputs(based: bool) -> tuple[str, ...]:
    """Return the names of all numbers that trees may see, in order."""
    own = (*sorted(NUMBERS), BASE, *(f"share {name}" for name in RATED))
    return (*own, *(f"base share {name}" for name in RATED)) if based else own


def _tree(data: Mapping[str, Any], count: int) -> Tree:
    """Return a tree whose children come after their parents, so that every walk ends."""
    tree = Tree(
        tuple(int(each) for each in data["number"]),
        tuple(map(_number, data["threshold"])),
        tuple(int(each) for each in data["left"]),
        tuple(int(each) for each in data["right"]),
        tuple(map(_number, data["value"])),
    )
    if len({len(column) for column in tree}) != 1 or not tree.number:
        raise ValueError("columns of a tree differ in length")
    for node, number in enumerate(tree.number):
        children = (tree.left[node], tree.right[node])
        if number >= count or (number >= 0 and not all(node < child < len(tree.number) for child in children)):
            raise ValueError(f"node {node} of a tree")
    return tree
