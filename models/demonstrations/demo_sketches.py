"""Sketches of demonstrations for a table: those of models, and of two yardsticks that learn nothing."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.models.demonstrations.demonstration_data import Demonstrations, shown
from hearth.models.interface import Steps
from hearth.models.model_registry import MODELS, restore
from hearth.models.text_examples import examples
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import rng

BEYOND = 32
"""Half the width of the area around the person over which masks are pooled, pixels."""


def demonstrated(
    models: Sequence[Path | str],
    beam: int,
    there: Demonstrations,
    split: str,
    names: Sequence[str],
    seed: int,
    sketches: str,
) -> Iterator[tuple[str, Mapping[str, Steps]]]:
    """Yield the sketches of some executions by each model that reads demonstrations, and by the yardsticks.

    The yardsticks take a sketch of training, of the kind that is asked (`annotated` or `inferred`): a random one, and
    that of the demonstration whose masks are most alike.

    Raises:
        HearthError: BAD_ARGUMENT, if none of the models reads demonstrations.
    """
    readers = list(_readers(models))
    if not readers:
        message = "table 5.5 needs a model that writes sketches of demonstrations"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="name a trained `demo2sketch` with --model")
    known = shown(there, examples(there.dataset, split, "train", originals=True, sketches=sketches))
    train = [(each.sketch, name) for each, name in known if each.sketch]
    if train:
        known_sketches = [sketch for sketch, _ in train]
        yield "random sketch", {name: rng(seed, "random sketch", name).choice(known_sketches) for name in names}
        yield "nearest masks", dict(zip(names, _nearest(there, train, names), strict=True))
    for name, trained in readers:
        seen = [trained.see(there.pictures(each)) for each in names]
        yield name, dict(zip(names, trained.sketches(seen, beam), strict=True))


def _readers(models: Sequence[Path | str]) -> Iterator[tuple[str, Any]]:
    for model in models:
        name, trained = restore(model)
        if MODELS[name].output == "sketch" and MODELS[name].input == "film":
            yield name, trained


def _nearest(there: Demonstrations, train: Sequence[tuple[Steps, str]], names: Sequence[str]) -> Iterator[Steps]:
    known = np.stack([pooled(there, name) for _, name in train])
    for name in names:
        alike = (known @ pooled(there, name)).round(9)
        yield train[int(alike.argmax())][0]


def pooled(there: Demonstrations, execution: str) -> NDArray[np.float64]:
    """Return the share of each class in the masks around the person, over all pictures: roots, of length 1."""
    total = np.zeros(1 << 16)
    for mask in there.pictures(execution).masks:
        ys, xs = np.nonzero(mask == there.person)
        if len(xs):
            y, x = int(ys.mean()), int(xs.mean())
            near = mask[max(0, y - BEYOND) : y + BEYOND, max(0, x - BEYOND) : x + BEYOND]
            total += np.bincount(near.ravel(), minlength=1 << 16)
    total[[0, there.person]] = 0
    classes = np.sqrt(total[: 1 << 12])
    return classes / max(float(np.linalg.norm(classes)), 1e-9)
