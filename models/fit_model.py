"""Training a model of the registry on a dataset, into a checkpoint."""

import shutil
from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from hearth.datasets.dataset import Dataset
from hearth.datasets.format.sketch_choice import ANNOTATED
from hearth.models.checkpoint import save
from hearth.models.interface import Settings, Training
from hearth.models.model_registry import MODELS, settings_of
from hearth.models.text_examples import corpus, facts_of
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.parallel import Seen, unseen

STATE = ".training"
"""The folder in a checkpoint's where the state of an unfinished training is kept."""


def fit(
    name: str,
    folder: Path,
    out: Path,
    split: str,
    changed: Sequence[str] = (),
    *,
    originals: bool = True,
    sketches: str = ANNOTATED,
    how: Mapping[str, Any],
    seen: Seen = unseen,
) -> dict[str, Any]:
    """Train a model and write its checkpoint, and return the checkpoint's record of the training.

    Args:
        name: in the registry.
        folder: of the dataset.
        out: of the checkpoint; an unfinished training in it is continued.
        split: of the dataset; clips have parts of their own.
        changed: settings of the model, as `NAME=VALUE`.
        originals: leave out augmented programs; models of sketches learn from them, too.
        sketches: `annotated` or `inferred`: which go before the others.
        how: fields of `Training`.
        seen: reports progress.

    Raises:
        HearthError: an unknown model, setting or split; not a dataset; the extra is not installed.
    """
    model = settings_of(name, **_changed(name, changed))
    dataset, training = Dataset.open(folder), Training(**how, folder=out / STATE)
    of_films, of_sketches = MODELS[name].input == "film", MODELS[name].output == "sketch"
    if of_films and not of_sketches:
        checkpoint = model.fit(dataset, training, seen).checkpoint()  # type: ignore[arg-type]
        facts = {**facts_of(dataset), **checkpoint.trained}
    else:
        originals = originals and MODELS[name].input != "sketch"
        found = corpus(dataset, split, originals=originals, seed=training.seed, sketches=sketches)
        found = found.of_sketches() if of_sketches and not of_films else found
        checkpoint = model.fit(found, training, seen).checkpoint()
        own = {**found.facts, "sketches": sketches, "seed": training.seed}
        facts = {**own, **checkpoint.trained, **own}  # a model that reads a trained one has the facts of that, too
    save(replace(checkpoint, model=name, trained=facts), out)
    shutil.rmtree(out / STATE, ignore_errors=True)
    return facts


BOOLEANS = {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}
"""Spellings of a true or false setting."""


def _changed(name: str, changed: Sequence[str]) -> dict[str, Any]:
    """Return settings as `NAME=VALUE`, the values of the types of their defaults."""
    defaults = settings_of(name)
    own = {each.name: getattr(defaults, each.name) for each in fields(defaults)}  # type: ignore[arg-type]
    kinds = {key: type(value) for key, value in own.items()}
    usual = f"it has {', '.join(f'{key}={value}' for key, value in own.items()) or 'no settings'}"
    found: dict[str, Any] = {}
    for text in changed:
        key, _, value = text.partition("=")
        kind = kinds.get(key)
        try:
            if kind is None:
                raise ValueError
            found[key] = BOOLEANS[value.lower()] if kind is bool else kind(value)
        except (ValueError, KeyError):
            message = f"`{text}` is not a setting of `{name}`"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=usual) from None
    if isinstance(defaults, Settings):
        try:
            type(defaults).of({**own, **found})
        except ValueError as error:
            raise HearthError.of(Code.BAD_ARGUMENT, f"{error}", suggestion=usual) from None
    return found
