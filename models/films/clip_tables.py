"""Table 4.3 (a): what clips are taken for by true masks, the thesis's figures beside ours beside yardsticks."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from hearth.models.films.class_accuracy import accuracies
from hearth.models.films.clip_data import Clips, Instruction
from hearth.models.films.clip_model import TrainedClipModel
from hearth.models.films.seen_model import TrainedSeenModel
from hearth.models.model_registry import restore
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import rng

if TYPE_CHECKING:
    from hearth.datasets.dataset import Dataset

TABLE = "4.3"

COLUMNS = ("action", "objects", "steps", "mean")

HOMES = {"seen": ("seen",), "unseen": ("unseen",), "all": ("seen", "validation", "unseen")}
"""Rows of the table, and the kinds of homes that each has; the home of validation counts under all alone."""

THESIS = {
    "seen": (0.7806, 0.7300, 0.5642, 0.6916),
    "unseen": (0.5489, 0.5294, 0.4350, 0.5044),
    "all": (0.6258, 0.6118, 0.4849, 0.5742),
}
"""Table 4.3 (a), ground-truth segmentation."""


class ClipRow(NamedTuple):
    """A method's accuracies in some homes.

    Attributes:
        method: its name.
        of: `thesis`, `yardstick` or `ours`.
        homes: see `HOMES`.
        scores: by column; of several seeds their means.
        spread: the standard error over seeds of `mean`; None of fewer than two.
        clips: how many were named; None where the thesis does not say.
        seeds: how many trained models the scores are means of; 0 for what is not trained.
    """

    method: str
    of: str
    homes: str
    scores: dict[str, float]
    spread: float | None = None
    clips: int | None = None
    seeds: int = 0


def clip_table(dataset: Dataset, models: Sequence[Path | str], seed: int = 0) -> list[ClipRow]:
    """The rows of table 4.3 (a), over the clips of the test part.

    Args:
        dataset: with clips.
        models: checkpoints of classifiers of clips; several of one model are its seeds.
        seed: of the random yardstick.

    Raises:
        HearthError: errors of `restore` and of `Clips.of`; BAD_ARGUMENT, for a model of another kind.
    """
    learned, test = Clips.of(dataset, "train"), Clips.of(dataset, "test")
    done = [clip.done for clip in learned.clips]
    draw = rng(seed, "random clips")
    commonest = Counter(done).most_common(1)[0][0]
    rows = [ClipRow("MLE, true masks", "thesis", homes, dict(zip(COLUMNS, found, strict=True)))
            for homes, found in THESIS.items()]  # fmt: skip
    rows += _rows("random retrieval", "yardstick", test, [[draw.choice(done) for _ in test.clips]], 0)
    rows += _rows("commonest", "yardstick", test, [[commonest] * len(test)], 0)
    named: dict[str, list[list[Instruction]]] = {}
    for model in models:
        name, trained = classifier(model)
        named.setdefault(name, []).append(trained.named(test))
    return [*rows, *(row for name, each in named.items() for row in _rows(name, "ours", test, each, len(each)))]


def classifier(model: Path | str) -> tuple[str, TrainedClipModel | TrainedSeenModel]:
    """A trained classifier of clips, and its name.

    Raises:
        HearthError: errors of `restore`; BAD_ARGUMENT, for a model of another kind.
    """
    name, found = restore(model)
    if not isinstance(found, TrainedClipModel | TrainedSeenModel):
        raise HearthError.of(Code.BAD_ARGUMENT, f"`{model}` is not a classifier of clips")
    return name, found


def _rows(method: str, of: str, test: Clips, named: Sequence[Sequence[Instruction]], seeds: int) -> Iterator[ClipRow]:
    """A row for each kind of homes, of the answers of each seed."""
    for homes, kinds in HOMES.items():
        which = [number for number, clip in enumerate(test.clips) if clip.kind in kinds]
        wanted = [test.clips[number].done for number in which]
        each = [accuracies(wanted, [answers[number] for number in which]) for answers in named]
        means = {name: sum(scores[name] for scores in each) / len(each) for name in COLUMNS}
        yield ClipRow(method, of, homes, means, _error([scores["mean"] for scores in each]), len(which), seeds)


def _error(values: Sequence[float]) -> float | None:
    """The standard error of a mean."""
    from statistics import stdev

    return stdev(values) / len(values) ** 0.5 if len(values) > 1 else None
