"""The models that belong in a table, by their inputs and outputs."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

from hearth.models.model_registry import MODELS, Entry, named
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

Kind = tuple[str, str]
"""Input and output, as of `Entry`."""

KINDS: Mapping[str, tuple[Kind, ...]] = MappingProxyType({
    **dict.fromkeys(("4.4", "4.5"), (("text", "program"),)),
    **dict.fromkeys(("5.2", "5.3"), (("sketch", "program"),)),
    "5.4": (("text", "sketch"), ("sketch", "program")),
    "5.5": (("film", "sketch"), ("sketch", "program")),
    "A.4": (("film", "sketch"), ("text", "sketch")),
})  # fmt: skip
"""The inputs and outputs of the models of each table."""

BY_ROUNDS = "5.3"
"""The table that compares graph models by their rounds of messages with the planner."""


def fits(table: str, name: str, entry: Entry) -> bool:
    """Return whether a table has rows for a model."""
    if table == BY_ROUNDS and name != "planner" and not entry.place.startswith("sketches.graph_model:"):
        return False
    return not entry.by and (entry.input, entry.output) in KINDS[table]


def refuse_others(table: str, models: Sequence[str | Path]) -> None:
    """Refuse models that a table has no rows for.

    Args:
        table: one of `KINDS`.
        models: as of `restore`.

    Raises:
        HearthError: BAD_ARGUMENT, with those that fit; errors of `named`.
    """
    for model in models:
        name = named(model)
        if name in MODELS and not fits(table, name, MODELS[name]):
            known = ", ".join(each for each, entry in MODELS.items() if fits(table, each, entry))
            message = f"table {table} has no row for `{Path(model).name}`, a model `{name}`"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=f"it takes {known}")
