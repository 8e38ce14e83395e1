"""Tables 4.2 to 4.6 and 5.2 to 5.4 whole: which models each needs, trained with each seed where they are not yet."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from shutil import rmtree
from types import MappingProxyType
from typing import Any, Literal, NamedTuple

from hearth.datasets.dataset import Dataset
from hearth.models.checkpoint import NAME, identity
from hearth.models.fit_model import STATE, fit
from hearth.models.model_registry import settings_of
from hearth.models.text_examples import facts_of
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.files import read_json, value_digest, write_json
from hearth.storage.names import inside
from hearth.storage.parallel import Seen, unseen

Data = Literal["people", "drawn", "clips"]
"""The kind of dataset: people's programs, drawn ones (`corpus synthesize`), or their films (`--tier clips`)."""

LSTM = ("mle", "mle-composed")
CRITICS = ("pg-lcs", "pg-lcs-sim")

CLASSIFIERS = ("clips-seen", "clips-context")
"""Classifiers of clips by true masks."""

PREDICTED = "clips-predicted"
"""The one that learns from predicted masks, too."""

WRITERS = ("films-mle", "films-pg-lcs", "films-pg-lcs-sim")
"""Writers of programs of films."""

STARTS: Mapping[str, str] = MappingProxyType({
    **dict.fromkeys((*CRITICS, "consensus"), "mle-composed"),
    "consensus-sketch": "desc2sketch",
    PREDICTED: "masks",
    **dict(zip(WRITERS, ("clips-context", *WRITERS), strict=False)),
})  # fmt: skip
"""Models that go on from another one of the same seed, or read its answers."""

ONCE = ("masks",)
"""Models that are trained with one seed alone: films of all seeds' classifiers are the same."""

GRAPHS = ("unaries", "graph", "fcactgraph", "gruactgraph", "resactgraph")

RATES: Mapping[str, float] = MappingProxyType({
    **dict.fromkeys((*LSTM, "desc2sketch", "films-mle"), 3e-3),
    **dict.fromkeys((*CLASSIFIERS, PREDICTED, "masks"), 2e-3),
})  # fmt: skip
"""Rates of learning that are not the usual one."""

EPOCHS: Mapping[str, int] = MappingProxyType(dict.fromkeys((*CLASSIFIERS, PREDICTED), 22))
"""Passes over the examples, at most, that are not the usual number."""

USUAL_RATE, USUAL_EPOCHS = 1e-3, 30

DRAWN_SETTINGS = ("dropout=0.2", "batch=64")
"""Settings of the first phase with drawn programs: of many texts less has to be left out, and more fit in a batch."""


RECIPE = "recipe.json"
"""The file that says how a checkpoint of a table is trained, or was."""


class Needed(NamedTuple):
    """A model that a table needs."""

    data: Data
    split: str
    name: str
    seed: int
    changed: str = ""
    """A setting that is not the usual one, as `model train --set` takes it."""

    def folder(self, out: Path) -> Path:
        """Return the folder of its checkpoint; tables share the checkpoints."""
        name = ".".join(part for part in (self.name, self.changed) if part)
        return inside(out / "models", f"{self.data}.{self.split}.{name}.{self.seed}")

    @property
    def before(self) -> Needed | None:
        """Return the model that its training goes on from."""
        if self.name not in STARTS:
            return None
        name = STARTS[self.name]
        return self._replace(name=name, changed="", seed=0 if name in ONCE else self.seed)

    def settings(self, out: Path) -> list[str]:
        """Return the settings that are not the usual ones, as `model train --set` takes them."""
        many = DRAWN_SETTINGS if self.data == "drawn" and self.name in LSTM else ()
        word = "masks" if self.name == PREDICTED else "start"
        start = [f"{word}={self.before.folder(out)}"] if self.before else []
        return [*start, *many, *([self.changed] if self.changed else [])]

    @property
    def pace(self) -> tuple[float, int]:
        """Rate of learning, and the most passes over the examples."""
        return RATES.get(self.name, USUAL_RATE), EPOCHS.get(self.name, USUAL_EPOCHS)

    def recipe(self, out: Path, dataset: str, how: Mapping[str, Any]) -> str:
        """Return a digest of the inputs of its weights: dataset, settings, training, the model that it goes on from."""
        before = identity(self.before.folder(out)) if self.before else ""
        settings = repr(settings_of(self.name))
        return value_digest([dataset, self.name, settings, self.settings(out)[bool(before) :], dict(how), before])

    @property
    def chain(self) -> list[Needed]:
        """Return the models that its training needs, one after another, and itself."""
        return [*(self.before.chain if self.before else ()), self]


@dataclass(frozen=True, slots=True)
class Plan:
    """A table and its models.

    Attributes:
        table: its number.
        data: the dataset.
        split: of the dataset.
        once: models without chance: one seed is enough.
        seeded: models that are trained with each seed.
        varied: the same, with a setting changed: a model's name, and the setting.
        given: methods that need no training.
        repaired: as of `text_result_tables.table`.
    """

    table: str
    data: Data
    split: str
    once: tuple[str, ...] = ()
    seeded: tuple[str, ...] = ()
    varied: tuple[tuple[str, str], ...] = ()
    given: tuple[str, ...] = ()
    repaired: bool = False

    @property
    def name(self) -> str:
        """Return the table, and the split where it is not the usual one."""
        return self.table if self.split == "activities" else f"{self.table}-{self.split}"

    def needed(self, seeds: int) -> Iterator[Needed]:
        """Yield its models, each after the one that it goes on from."""
        for name in self.once:
            yield Needed(self.data, self.split, name, 0)
        for name, changed in (*((name, "") for name in self.seeded), *self.varied):
            yield from (Needed(self.data, self.split, name, seed, changed) for seed in range(seeds))


_TEXTS = (*LSTM, *CRITICS, "consensus")
_DRAWN = Plan("4.4", "drawn", "pairs", ("nearest",), _TEXTS)
_SKETCHES = Plan("5.2", "people", "activities", (), (*GRAPHS, "chooser"), given=("planner",))
_ROUNDS = tuple(("resactgraph", f"rounds={rounds}") for rounds in (1, 3))

PLANS: dict[str, Plan] = {plan.name: plan for plan in (
    _DRAWN,
    replace(_DRAWN, split="paraphrases"),
    Plan("4.5", "people", "activities", ("nearest", "retrieve-edit"), (*_TEXTS, "transformer"), repaired=True),
    _SKETCHES,
    replace(_SKETCHES, table="5.3", seeded=("unaries", "resactgraph"), varied=_ROUNDS),
    Plan("5.4", "people", "activities", ("retrieve-sketch", "chooser"), ("desc2sketch", "consensus-sketch")),
    Plan("4.2", "clips", "activities", ("masks",), (*CLASSIFIERS, PREDICTED)),
    Plan("4.3", "clips", "activities", (), CLASSIFIERS),
    Plan("4.3b", "clips", "activities", (), ("clips-rgb",)),
    Plan("4.6", "clips", "activities", (), ("clips-context", *WRITERS)),
)}  # fmt: skip
"""The parts of tables by name: `4.4-pairs`, `4.5`.

A pair of tasks, or the paraphrases, of the test are not in training.
"""


def chosen(names: Sequence[str], without: Sequence[Data] = ()) -> list[Plan]:
    """Return the plans of these tables, in the order of all. `4.4` stands for both of its splits.

    Args:
        names: of tables; every one if there is none.
        without: datasets that lack: their tables are made only if they are named.

    Raises:
        HearthError: BAD_ARGUMENT, an unknown table.
    """
    unknown = [name for name in names if not any(name in (plan.name, plan.table) for plan in PLANS.values())]
    if unknown:
        message = f"no table `{unknown[0][:20]}` is made from several models"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=f"there are {', '.join(PLANS)}")
    if not names:
        return [plan for plan in PLANS.values() if plan.data not in without]
    return [plan for plan in PLANS.values() if {plan.name, plan.table} & {*names}]


def training(plans: Sequence[Plan], seeds: int) -> list[Needed]:
    """Return the models of some tables, each once, and each after the one that it goes on from."""
    every = (each for plan in plans for each in plan.needed(seeds))
    return list(dict.fromkeys(one for each in every for one in each.chain))


def train(needed: Needed, dataset: Path, out: Path, minutes: float, seen: Seen = unseen) -> bool:
    """Train a model unless it was trained in this way on this dataset already; whether it was trained now.

    Args:
        needed: the model.
        dataset: of `needed.data`.
        out: the folder of the tables.
        minutes: the budget of the training; 0 for none.
        seen: reports epochs.
    """
    folder, rate, epochs = needed.folder(out), *needed.pace
    how = {"epochs": epochs, "minutes": minutes, "rate": rate, "seed": needed.seed}
    recipe = {"digest": needed.recipe(out, facts_of(Dataset.open(dataset))["digest"], how)}
    same = read_json(folder / RECIPE) == recipe
    if same and (folder / NAME).exists():
        rmtree(folder / STATE, ignore_errors=True)  # of a training that was stopped at its very end
        return False
    if not same:  # of another dataset, other settings, or a model before it that was trained anew
        rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True, exist_ok=True)
    write_json(folder / RECIPE, recipe)  # first: a training that is stopped goes on only by the same recipe
    fit(needed.name, dataset, folder, needed.split, needed.settings(out), how=how, seen=seen)
    return True


def rows(plan: Plan, dataset: Path, out: Path, seeds: int, most: int, seen: Seen = unseen) -> list[Any]:
    """Return the rows of a table, from its trained models.

    Args:
        plan: the table.
        dataset: of `plan.data`.
        out: the folder of the tables.
        seeds: how many of each trained model.
        most: test executions of 5.2 to 5.4.
        seen: reports executions.
    """
    from hearth.models.films import clip_result_tables, film_result_tables
    from hearth.models.sketches import sketch_result_tables
    from hearth.models.text import text_result_tables

    models: list[Any] = [*plan.given, *(each.folder(out) for each in plan.needed(seeds))]
    data = Dataset.open(dataset)
    if plan.table in clip_result_tables.TABLES:
        return clip_result_tables.clip_table(plan.table, data, models)
    if plan.table == film_result_tables.TABLE:
        return film_result_tables.film_table(data, models, seen=seen)
    if plan.table in sketch_result_tables.TABLES:
        return sketch_result_tables.table(plan.table, data, plan.split, models, beam=1, most=most, seen=seen)
    return text_result_tables.table(plan.table, data, plan.split, models, beam=1, repaired=plan.repaired)
