"""Strengths: how much programs are perturbed, and how much a repair clears away (`perturbations.yaml`)."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from hearth.repair.handlers.common import Handler
from hearth.repair.handlers.posture import CLEARS
from hearth.repair.handlers.registry import HANDLERS
from hearth.repair.perturbation import MOST, PERTURBATIONS, Chances
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.input_files import load_yaml

STRENGTHS_FILE = Path(__file__).with_name("perturbations.yaml")

MILD = "mild"
"""The default."""


@dataclass(frozen=True, slots=True)
class Strength:
    """Strengths of perturbation, and of the clearing that a repair does.

    Attributes:
        chances: how likely perturbations are.
        clears: what is taken off a seat on which there is no room, a key of `CLEARS`.
        says: a sentence about it, for the card of a dataset.
        options: those of a build that go with it, unless they are given.
        allowance: environments drawn for each program wanted, since some give none.
    """

    chances: Chances
    clears: str = "enough"
    says: str = ""
    options: Mapping[str, int] | None = None
    allowance: float = 1.3

    @property
    def handlers(self) -> Mapping[Code, Handler]:
        """The handlers by failure code."""
        return {**HANDLERS, Code.OCCUPIED: CLEARS[self.clears]}


def strength(name: str) -> Strength:
    """Return a strength of perturbations.yaml, by its name.

    Raises:
        HearthError: UNKNOWN_ID, with the known names.
    """
    known = load_strengths(STRENGTHS_FILE)
    if name not in known:
        suggestion = f"strengths are {', '.join(known)}"
        raise HearthError.of(Code.UNKNOWN_ID, f"unknown strength `{name}`", suggestion=suggestion)
    return known[name]


@lru_cache(maxsize=8)
def load_strengths(path: Path) -> Mapping[str, Strength]:
    """Read the strengths of a file like perturbations.yaml, by name.

    Raises:
        HearthError: BAD_TABLE, naming an unknown perturbation, draw or extent, or a value that is not a probability.
    """
    data = load_yaml(path)
    faults = list(_faults(data))
    if faults:
        raise HearthError.of(Code.BAD_TABLE, "; ".join(faults), file=str(path), suggestion=_PARTS)
    return {name: _strength(**fields) for name, fields in data.items()}


def _strength(kinds: dict[str, float], draws: dict[str, float], most: int = MOST, **others: Any) -> Strength:
    return Strength(Chances(kinds, draws, most), **others)


_KEYS = frozenset({"kinds", "draws", "most", "clears", "says", "options", "allowance"})

_PARTS = "`kinds` gives each perturbation a probability; `draws` gives each, one and two a weight"


def _faults(data: object) -> Iterator[str]:
    if not isinstance(data, dict) or not data:
        yield "a strength is missing"
        return
    for name, fields in data.items():
        yield from (f"{fault}, in `{name}`" for fault in _faults_of(fields))


def _faults_of(data: object) -> Iterator[str]:
    if not isinstance(data, dict) or not all(isinstance(data.get(part), dict) for part in ("kinds", "draws")):
        yield "`kinds` or `draws` is missing"
        return
    yield from (f"`{key}` does not belong to a strength" for key in sorted(map(str, data.keys() - _KEYS)))
    for part, known in (("kinds", PERTURBATIONS.keys()), ("draws", ("each", "one", "two"))):
        for name, value in data[part].items():
            if name not in known:
                yield f"`{name}` is none of the {part}"
            elif not isinstance(value, int | float) or value < 0 or (part == "kinds" and value > 1):
                yield f"{value!r} is not a {'probability' if part == 'kinds' else 'weight'} of `{name}`"
    if not any(isinstance(weight, int | float) and weight > 0 for weight in data["draws"].values()):
        yield "no draw has a weight"
    most = data.get("most", MOST)
    if not isinstance(most, int) or most < 1:
        yield "`most` is not a count"
    if data.get("clears", "enough") not in CLEARS:
        yield f"`clears` is not one of {', '.join(CLEARS)}"
