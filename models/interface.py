"""The requests to models, their training, and the common part of their settings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Self, get_args, get_origin, get_type_hints

from hearth.schemas.program import Step
from hearth.simulation.rules import DEFAULT, Rules

if TYPE_CHECKING:
    from hearth.simulation.world.world import World

Steps = tuple[Step, ...]

LARGEST_SETTING = 10_000_000
"""The largest number that a checkpoint's settings may have."""

MOST = {
    **{"layers": 64, "rounds": 64, "heads": 1024, "longest": 10_000, "draws": 1_000, "sharpness": 100},
    **dict.fromkeys(("d", "h", "hidden", "size", "vector", "width"), 10_000),
    **dict.fromkeys(("dropout", "joined", "light", "share", "unnamed"), 1),
}
"""Largest values of some settings.

Repetitions, sizes whose squares are in memory, and shares. A greater `sharpness` makes weights 0.
"""


@dataclass(frozen=True, slots=True)
class Request:
    """A request to a model. It has no reference: a prediction cannot depend on one.

    Attributes:
        id: of the execution, or any name.
        title: the activity; may be empty.
        description: the text.
        sketch: steps that the program should have, without nodes; for models of sketches.
        world: where the program will run; for models that look at it, and for constrained decoding.
        rules: by which it will run.
    """

    id: str
    title: str = ""
    description: str = ""
    sketch: Steps = ()
    world: World | None = None
    rules: Rules = DEFAULT


@dataclass(frozen=True, slots=True)
class Training:
    """The length and the method of a model's training.

    Attributes:
        seed: of all random choices.
        epochs: the most passes over the examples.
        minutes: a budget: training ends after the epoch with which it is about used up; 0 for none. A model that trains
            several networks, or one in two phases, gives it to each.
        rate: of learning, at first; halved whenever `halve_after` epochs in a row were not the best.
        clip: the longest gradient.
        patience: the epochs in a row without a better validation score after which training ends; 0 for never.
        halve_after: see `rate`; 0 for never.
        folder: where the state is kept after each epoch, so that a stopped run continues; None to keep none.
    """

    seed: int = 0
    epochs: int = 30
    minutes: float = 0.0
    rate: float = 1e-3
    clip: float = 5.0
    patience: int = 6
    halve_after: int = 2
    folder: Path | None = None


POSITIVE = {
    *("batch", "counts", "d", "draws", "every", "h", "heads", "hidden", "layers", "longest", "neighbours", "passes"),
    *("size", "vector", "width"),
}
"""Settings that are at least 1."""


def _choices(settings: type, name: str) -> tuple[str, ...]:
    """Return the values that a setting can have; none where it can have any."""
    hint = get_type_hints(settings).get(name)
    return get_args(hint) if get_origin(hint) is Literal else ()


class Settings:
    """The common part of settings: they are read from a checkpoint and written to it."""

    @classmethod
    def of(cls, values: Mapping[str, Any]) -> Self:
        """Return the settings with these values, which may be a stranger's; lists become tuples.

        Raises:
            TypeError: a value is unknown or missing.
            ValueError: a value is not of the kind of the default, out of its bounds, or fits no other.
        """
        defaults = {each.name: each.default for each in fields(cls)}  # type: ignore[arg-type]
        for name, value in values.items():
            if not _like(value, defaults.get(name)):
                raise ValueError(f"the setting `{name}` is {str(value)[:40]}")
            if isinstance(value, str) and value not in (allowed := _choices(cls, name) or (value,)):
                raise ValueError(f"the setting `{name}` is {value[:40]}, not one of {', '.join(allowed)}")
            least, most = int(name in POSITIVE), MOST.get(name, LARGEST_SETTING)
            if type(value) in (int, float) and not least <= value <= most:
                raise ValueError(f"the setting `{name}` is {value:g}, not {least} to {most:,}")
        made = cls(**{name: tuple(value) if isinstance(value, list) else value for name, value in values.items()})
        made.fitting()
        return made

    def fitting(self) -> None:
        """Look at settings that depend on each other, or on the form of a network; most have none.

        Raises:
            ValueError: with them no network can be made.
        """

    def multiple(self, name: str, of: int, reason: str) -> None:
        """Look whether a setting is a multiple of a number, for `fitting`.

        Raises:
            ValueError: it is not.
        """
        if (value := getattr(self, name)) % of:
            raise ValueError(f"the setting `{name}` is {value}, not a multiple of {of} ({reason})")


def texts(values: Any) -> tuple[str, ...]:
    """Return a list of a checkpoint that should be of different texts, and may be a stranger's.

    Raises:
        TypeError: it is not a list.
        ValueError: it is of something else, or says a text twice.
    """
    found = tuple(values)
    if not all(isinstance(each, str) for each in found) or len({*found}) < len(found):
        raise ValueError("a list of names has something else, or a name twice")
    return found


def _like(value: Any, default: Any) -> bool:
    """Return whether a value is of the kind of a default; without a default, or with None, all JSON values are."""
    if not isinstance(default, int | float | str):
        return True
    if isinstance(default, float):
        return type(value) in (int, float)
    return type(value) is type(default)
