"""Checkpoints: a folder with `model.json`, `weights.safetensors` and a card. Nothing in it is ever executed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

import orjson

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import library
from hearth.schemas.yaml_limits import packaged
from hearth.storage.files import drop_temporary, file_digest, value_digest, write_bytes, write_json
from hearth.storage.input_files import read_input
from hearth.version import ACTION_SET, VERSION

if TYPE_CHECKING:
    import numpy as np

FORMAT = 1
"""Version of the format of checkpoints; it changes when older ones can no longer be read."""

NAME = "model.json"
WEIGHTS = "weights.safetensors"
CARD = "README.md"

LARGEST_WEIGHTS = 2_000_000_000
"""Bytes of weights that are read."""

LICENCE = "MIT"
"""License of checkpoints trained on our own corpora, which are ours; `trained.data_licence` has that of the data."""


@dataclass(frozen=True, slots=True)
class Checkpoint:
    """A trained model, as it is stored.

    Attributes:
        model: its name in the registry.
        settings: of the model, as JSON.
        content: vocabularies and whatever else is not weights, as JSON.
        weights: arrays by name.
        trained: its data and its training: `dataset`, `digest`, `split`, `seed`, `epochs`, `minutes`, `curves`.
    """

    model: str
    settings: Mapping[str, Any]
    content: Mapping[str, Any]
    weights: Mapping[str, np.ndarray]
    trained: Mapping[str, Any] = field(default_factory=dict)


def save(checkpoint: Checkpoint, folder: Path) -> None:
    """Write a checkpoint into a folder; equal checkpoints are equal bytes, but for `minutes` and `curves`.

    Raises:
        HearthError: MISSING_FILE, if the extra is not installed.
    """
    safetensors = library("safetensors.numpy")
    folder.mkdir(parents=True, exist_ok=True)
    drop_temporary(folder.glob(".*"))
    weights = {name: _contiguous(array) for name, array in sorted(checkpoint.weights.items())}
    write_bytes(folder / WEIGHTS, safetensors.save(weights))
    document = {
        "format": FORMAT,
        "version": VERSION,
        "action_set": ACTION_SET,
        "licence": LICENCE,
        "model": checkpoint.model,
        "settings": dict(checkpoint.settings),
        "trained": dict(checkpoint.trained),
        "libraries": _libraries(),
        "weights": file_digest(folder / WEIGHTS),
        "digest": value_digest(dict(checkpoint.content)),
        "content": dict(checkpoint.content),
    }
    write_bytes(folder / CARD, _card(checkpoint).encode())
    write_json(folder / NAME, document)  # last: a folder that has it is whole


def load(folder: Path) -> Checkpoint:
    """Return the checkpoint of a folder.

    Raises:
        HearthError: MISSING_FILE, if there is none or the extra is not installed; UNSUPPORTED_FILE, if it is of another
            format; DAMAGED_FILE, if a part of it differs from the part that was written.
    """
    remedy = "name the folder that `model train` gave with --out, or a name of `model list`"
    if not (folder / NAME).exists():
        raise HearthError.of(Code.MISSING_FILE, "no checkpoint here", file=str(folder), suggestion=remedy)
    document = _document(folder / NAME)
    if not isinstance(document, dict) or not isinstance(document.get("format"), int):
        raise _damaged(folder / NAME, "it is not the JSON of a checkpoint")
    if document["format"] != FORMAT:
        message = f"a checkpoint of format {document['format']}; this version of Hearth reads {FORMAT}"
        raise HearthError.of(Code.UNSUPPORTED_FILE, message, file=str(folder), suggestion="train the model again")
    parts = {name: document.get(name) for name in ("settings", "content", "trained")}
    model = document.get("model")
    named = isinstance(model, str) and model.isprintable()
    if not named or not all(isinstance(part, dict) for part in parts.values()):
        raise _damaged(folder / NAME, "it lacks the model, its settings or its content")
    if not _facts_fit(document["trained"]):
        raise _damaged(folder / NAME, "minutes, seed or curves of its training are not numbers")
    try:
        # Readers see both, and models that are trained from this one record them.
        value_digest([parts["settings"], parts["trained"]])
        written = value_digest(parts["content"])
    except HearthError as error:
        raise _damaged(folder / NAME, error.diagnostics[0].message) from error
    if written != document.get("digest"):
        raise _damaged(folder / NAME, "its content is not what was written")
    return Checkpoint(model, weights=_weights(folder / WEIGHTS, document.get("weights")), **parts)  # type: ignore[arg-type]


def identity(folder: Path) -> str:
    """Return a digest of a folder's checkpoint, without how long its training took: that differs from run to run."""
    document = _document(folder / NAME)
    if not isinstance(document, dict):
        return file_digest(folder / NAME)
    value_digest(document)  # refuses values nested too deep for the next line
    return value_digest({**document, "trained": _without_minutes(document.get("trained"))})


def _without_minutes(trained: Any) -> Any:
    if not isinstance(trained, dict):
        return trained
    return {name: _without_minutes(value) for name, value in trained.items() if name != "minutes"}


def _facts_fit(trained: Mapping[str, Any]) -> bool:
    """Return whether the facts about a training that are computed with or drawn are numbers."""
    phases = [trained, trained.get("imitation", {})]
    return all(isinstance(phase, dict) and _phase_fits(phase) for phase in phases)


def _phase_fits(phase: Mapping[str, Any]) -> bool:
    curves = phase.get("curves", {})
    if not isinstance(curves, dict) or not all(isinstance(values, list) for values in curves.values()):
        return False
    drawn = [number for values in curves.values() for number in values]
    numbers = [phase.get("minutes", 0), phase.get("return_imitated", 0), *drawn]
    return type(phase.get("seed", 0)) is int and all(type(each) in (int, float) and isfinite(each) for each in numbers)


def _document(path: Path) -> Any:
    try:
        return orjson.loads(read_input(path))
    except orjson.JSONDecodeError:
        return None


def _weights(path: Path, digest: Any) -> dict[str, np.ndarray]:
    safetensors = library("safetensors.numpy")
    if not path.is_file():
        raise HearthError.of(Code.MISSING_FILE, "the weights are missing", file=str(path), suggestion=_AGAIN)
    if file_digest(path) != digest:
        raise _damaged(path, "its bytes are not what was written")
    try:
        return dict(safetensors.load(read_input(path, LARGEST_WEIGHTS)))
    except HearthError:
        raise
    except Exception as error:  # of the library's own types, which differ by version
        raise _damaged(path, "it can't be read as safetensors") from error


_AGAIN = "fetch the checkpoint again, or train the model again"


def _damaged(path: Path, message: str) -> HearthError:
    return HearthError.of(Code.DAMAGED_FILE, message, file=str(path), suggestion=_AGAIN)


MISFITS = (KeyError, TypeError, ValueError, IndexError, AttributeError, RuntimeError, AssertionError)
"""Errors that models and libraries raise when settings, content and weights do not fit each other."""


def misfit(folder: Path, error: Exception) -> HearthError:
    """Return the error of a checkpoint whose settings, content and weights do not fit each other or this version's
    model.
    """
    return _damaged(folder, f"it does not fit its model: {type(error).__name__}: {str(error)[:200]}")


def _contiguous(array: np.ndarray) -> np.ndarray:
    import numpy as np

    return np.ascontiguousarray(array)


def _libraries() -> dict[str, str]:
    from importlib.metadata import PackageNotFoundError, version

    found = {}
    for name in ("torch", "safetensors", "numpy"):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found


def _card(checkpoint: Checkpoint) -> str:
    """Return the model card: YAML for machines, then the model, its training data and the uses it is unfit for."""
    trained = checkpoint.trained
    known = packaged("hearth.models", "model_cards.yaml")
    about = known.get(checkpoint.model.partition("-")[0], known[""])
    lists = ("curves", "losses", "imitation")
    facts = [f"- {name}: {trained[name]}" for name in sorted(trained) if name not in lists]
    lines = [
        "---",
        f"license: {LICENCE.lower()}",
        "library_name: hearth",
        f"tags: [household, {about['tag']}]",
        "---",
        f"# {checkpoint.model}",
        "",
        about["what"],
        "",
        *facts,
        "",
        *about["limits"],
        "",
    ]
    return "\n".join(lines)
