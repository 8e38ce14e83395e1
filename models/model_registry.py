"""The models by name. To add one: a file with its settings, a row of `model_registry.yaml`, a test."""

from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any, Literal, NamedTuple

from hearth.models.checkpoint import MISFITS, load, misfit
from hearth.models.protocols import Model, Trained
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import library
from hearth.schemas.yaml_limits import packaged

TRAINED = Path(__file__).parent / "trained"
"""Checkpoints that come with Hearth, a folder each, named as in `model list`."""


class Entry(NamedTuple):
    """A model: the place of its settings (`module:Class` of `hearth.models`), its input, its line, its source.

    `learns` is false for one that needs no training; `output` is `sketch` for one that learns to write sketches;
    `by` is the command that trains one that writes no programs.
    """

    place: str
    input: Literal["text", "sketch", "film", "episode"]
    line: str
    source: str
    settings: dict[str, Any] = {}  # noqa: RUF012
    learns: bool = True
    output: Literal["program", "sketch"] = "program"
    by: str = ""


MODELS: dict[str, Entry] = {
    name: Entry(**fields) for name, fields in packaged("hearth.models", "model_registry.yaml").items()
}


def settings_of(name: str, **changed: Any) -> Model:
    """Return the settings of a model, its own or with some changed.

    Raises:
        HearthError: UNKNOWN_ID, if there is no such model; BAD_ARGUMENT, if it writes no programs; MISSING_FILE, if the
            extra is not installed.
    """
    entry = MODELS.get(name)
    if entry is None:
        import difflib

        near = difflib.get_close_matches(name, MODELS, n=1)
        suggestion = f"did you mean `{near[0]}`?" if near else f"there are {', '.join(MODELS)}"
        raise HearthError.of(Code.UNKNOWN_ID, f"no model is called `{name}`", suggestion=suggestion)
    if entry.by:
        raise _writes_nothing(name, f"hearth {entry.by} --out FOLDER trains it")
    made: Model = _class(entry)(**{**entry.settings, **changed})
    return made


def _writes_nothing(name: str, remedy: str) -> HearthError:
    return HearthError.of(Code.BAD_ARGUMENT, f"`{name}` writes no programs", suggestion=remedy)


def _class(entry: Entry) -> Any:
    module, name = entry.place.split(":")
    try:
        return getattr(import_module(f"hearth.models.{module}"), name)
    except ModuleNotFoundError as error:
        library(str(error.name))
        raise


def trained_names() -> list[str]:
    """Return the names of the checkpoints that come with Hearth."""
    return sorted(path.parent.name for path in TRAINED.glob("*/model.json"))


def restore(model: str | Path) -> tuple[str, Trained]:
    """Return a trained model that writes programs, and its name: of a checkpoint's folder, or of one that comes
    with Hearth.

    Raises:
        HearthError: as of `restore_any`; BAD_ARGUMENT, if it writes no programs.
    """
    name, trained = restore_any(model)
    if MODELS[name].by:
        raise _writes_nothing(str(model), "hearth challenge run TASKS --helper hybrid uses such models")
    found: Trained = trained
    return name, found


def restore_any(model: str | Path) -> tuple[str, Any]:
    """Return the name and the trained model of a checkpoint of any kind.

    Raises:
        HearthError: there is none, it is broken or of another version, or the extra is not installed.
    """
    if _learns_nothing(model):
        return str(model), _class(MODELS[str(model)])()
    folder = _folder(model)
    if str(model) in MODELS and not folder.exists():
        message = f"`{model}` has not been trained"
        command = MODELS[str(model)].by or f"model train {model} DATASET"
        suggestion = f"hearth {command} --out FOLDER, and name that folder"
        raise HearthError.of(Code.MISSING_FILE, message, suggestion=suggestion)
    checkpoint = load(folder)
    entry = MODELS.get(checkpoint.model)
    if entry is None:
        message = f"a checkpoint of the model `{checkpoint.model}`, which this version of Hearth does not have"
        raise HearthError.of(Code.UNSUPPORTED_FILE, message, file=str(folder), suggestion="install a newer Hearth")
    try:
        return checkpoint.model, _class(entry).restored(checkpoint)
    except MISFITS as error:
        raise misfit(folder, error) from error


def named(model: str | Path) -> str:
    """Return the name in the registry of a model that can be restored; of a newer version's the one that it has there.

    Raises:
        HearthError: there is none, or it is broken.
    """
    return str(model) if _learns_nothing(model) else load(_folder(model)).model


def recorded(model: str | Path) -> Mapping[str, Any]:
    """Return the facts about its training that a model's checkpoint records; nothing if it has no checkpoint.

    Raises:
        HearthError: there is none, or it is broken.
    """
    return {} if _learns_nothing(model) else load(_folder(model)).trained


def _learns_nothing(model: str | Path) -> bool:
    return str(model) in MODELS and not MODELS[str(model)].learns and not Path(model).exists()


def _folder(model: str | Path) -> Path:
    return TRAINED / str(model) if str(model) in trained_names() else Path(model)
