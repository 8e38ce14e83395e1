"""Tables 4.2 and 4.3: instructions predicted from clips, with the thesis's figures, ours and yardsticks."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from hearth.datasets.dataset import Dataset
from hearth.models.films.class_accuracy import accuracies
from hearth.models.films.clip_data import Clips, Instruction
from hearth.models.films.clip_model import TrainedClipModel
from hearth.models.films.film_arrays import COLOURS, MASKS
from hearth.models.films.film_smoothing import named_in_films
from hearth.models.films.mask_clip_model import TrainedSeenModel
from hearth.models.films.mask_model import TrainedMaskModel
from hearth.models.films.predicted_masks import PredictedMasks
from hearth.models.model_registry import restore
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import rng

COLUMNS = ("action", "objects", "steps", "mean")

HOMES = {"seen": ("seen",), "unseen": ("unseen",), "all": ("seen", "validation", "unseen")}
"""Rows of the tables, and the kinds of homes that each has; the home of validation counts under all alone."""

Classifier = TrainedClipModel | TrainedSeenModel


class ClipTable(NamedTuple):
    """A table of the thesis.

    Attributes:
        line: the input of the table's models.
        kind: of the models that are compared.
        array: of a film that is looked at.
        thesis: the thesis's figures by homes.
    """

    line: str
    kind: type[Any]
    array: str
    thesis: dict[str, tuple[float, ...]]


TABLES = {
    "4.2": ClipTable("predicted masks", TrainedSeenModel, COLOURS, {
        "seen": (0.7032, 0.4214, 0.2381, 0.4542),
        "unseen": (0.3134, 0.1455, 0.1148, 0.1912),
        "all": (0.4685, 0.2576, 0.1841, 0.3034),
    }),
    "4.3": ClipTable("true masks", TrainedSeenModel, MASKS, {
        "seen": (0.7806, 0.7300, 0.5642, 0.6916),
        "unseen": (0.5489, 0.5294, 0.4350, 0.5044),
        "all": (0.6258, 0.6118, 0.4849, 0.5742),
    }),
    "4.3b": ClipTable("colours", TrainedClipModel, COLOURS, {
        "seen": (0.7746, 0.6021, 0.4445, 0.6071),
        "unseen": (0.4056, 0.2656, 0.2646, 0.3119),
        "all": (0.5460, 0.4044, 0.3517, 0.4340),
    }),
}  # fmt: skip
"""The tables by number; 4.3 is its part (a)."""


class ClipRow(NamedTuple):
    """A method's accuracies in some homes.

    Attributes:
        method: its name.
        of: `thesis`, `yardstick` or `ours`.
        homes: see `HOMES`.
        scores: by column; of several seeds their means.
        spread: the standard error over seeds of `mean`; None of fewer than two.
        clips: how many were named; None where the thesis does not say.
        seeds: how many trained models the scores are means of; 0 for methods without training.
    """

    method: str
    of: str
    homes: str
    scores: dict[str, float]
    spread: float | None = None
    clips: int | None = None
    seeds: int = 0


def clip_table(number: str, dataset: Dataset, models: Sequence[Path | str], seed: int = 0) -> list[ClipRow]:
    """Return the rows of a table, over the clips of the test part: each clip by itself, and by the whole film.

    Args:
        number: of `TABLES`.
        dataset: with clips.
        models: checkpoints of classifiers of clips, several of one model are its seeds; for 4.2 also one of `masks`.
        seed: of the random yardstick.

    Raises:
        HearthError: errors of `restore` and of `Clips.of`; BAD_ARGUMENT, for a model of another kind.
    """
    table = TABLES[number]
    learned = Clips.of(dataset, "train")
    test, found = looked_at(number, dataset, models)
    done = [clip.done for clip in learned.clips]
    draw = rng(seed, "random clips")
    commonest = Counter(done).most_common(1)[0][0]
    rows = [ClipRow(f"Thesis, {table.line}", "thesis", homes, dict(zip(COLUMNS, values, strict=True)))
            for homes, values in table.thesis.items()]  # fmt: skip
    rows += _rows("random retrieval", "yardstick", test, [[draw.choice(done) for _ in test.clips]], 0)
    rows += _rows("commonest", "yardstick", test, [[commonest] * len(test)], 0)
    named: dict[str, list[list[Instruction]]] = {}
    for name, trained in found:
        named.setdefault(name, []).append(trained.named(test))
        if isinstance(trained, TrainedSeenModel):
            named.setdefault(f"{name}, whole film", []).append(named_in_films(trained, test, done))
    return [*rows, *(row for name, each in named.items() for row in _rows(name, "ours", test, each, len(each)))]


def looked_at(
    number: str, dataset: Dataset, models: Sequence[Path | str]
) -> tuple[Clips, list[tuple[str, Classifier]]]:
    """Return the test clips as a table's models look at them, and the models with their names.

    Raises:
        HearthError: as of `clip_table`.
    """
    table = TABLES[number]
    test = Clips.of(dataset, "test", array=table.array)
    given = [restore(model) for model in models]
    if number == "4.2":
        networks = [trained for _, trained in given if isinstance(trained, TrainedMaskModel)]
        if len(networks) != 1:
            message = f"{len(networks)} checkpoints of `masks`, not one"
            raise HearthError.of(
                Code.BAD_ARGUMENT,
                message,
                suggestion="name one such checkpoint in addition to the classifiers of clips",
            )
        test = replace(test, films=PredictedMasks(test.films, networks[0]))
        given = [each for each in given if each[1] is not networks[0]]
    return test, [(name, _classifier(trained, name, table.kind)) for name, trained in given]


def _classifier(trained: Any, name: str, kind: type[Any]) -> Classifier:
    """Return a trained model.

    Raises:
        HearthError: BAD_ARGUMENT, if it is of another kind.
    """
    if not isinstance(trained, kind):
        message = f"`{name}` does not read the input of this table"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="`model list` has the input of each model")
    return trained  # type: ignore[no-any-return]


def classifier(model: Path | str) -> tuple[str, TrainedSeenModel]:
    """Return a trained classifier of clips by masks, and its name.

    Raises:
        HearthError: errors of `restore`; BAD_ARGUMENT, for a model of another kind.
    """
    name, found = restore(model)
    return name, looks_at_masks(found, name)


def looks_at_masks(trained: Any, name: str) -> TrainedSeenModel:
    """Return a trained classifier of clips by masks.

    Raises:
        HearthError: BAD_ARGUMENT, if it is another model.
    """
    return _classifier(trained, name, TrainedSeenModel)  # type: ignore[return-value]


def _rows(method: str, of: str, test: Clips, named: Sequence[Sequence[Instruction]], seeds: int) -> Iterator[ClipRow]:
    """Yield a row for each kind of homes, of the answers of each seed."""
    for homes, kinds in HOMES.items():
        which = [number for number, clip in enumerate(test.clips) if clip.kind in kinds]
        if not which:
            continue
        wanted = [test.clips[number].done for number in which]
        each = [accuracies(wanted, [answers[number] for number in which]) for answers in named]
        means = {name: sum(scores[name] for scores in each) / len(each) for name in COLUMNS}
        yield ClipRow(method, of, homes, means, standard_error([scores["mean"] for scores in each]), len(which), seeds)


def standard_error(values: Sequence[float]) -> float | None:
    """Return the standard error of a mean; None of fewer than two values."""
    from statistics import stdev

    return stdev(values) / len(values) ** 0.5 if len(values) > 1 else None
