"""The check that a model is not asked about its training programs: another split of the dataset may contain them."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from hearth.datasets.dataset import Dataset
from hearth.models.model_registry import recorded
from hearth.models.text_examples import facts_of
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

_LEARNED = "SELECT DISTINCT program_id FROM splits WHERE split = $split AND starts_with(part, 'train')"


def refuse_seen(model: str | Path, dataset: Dataset, split: str, asked: Sequence[str]) -> None:
    """Refuse a model that was trained by another split on programs that it is asked about.

    Within a split its parts see to that; of other datasets nothing is known.

    Args:
        model: as of `restore`.
        dataset: with the executions.
        split: of which they are a part.
        asked: ids of executions.

    Raises:
        HearthError: BAD_ARGUMENT; errors of `recorded`.
    """
    digest = facts_of(dataset)["digest"]
    for phase in _phases(recorded(model)):
        own = phase.get("split")
        if phase.get("digest") != digest or not isinstance(own, str) or own == split:
            continue
        learned = {program for (program,) in dataset.rows(_LEARNED, split=own)[1]}
        program_of = dict(dataset.rows("SELECT execution_id, program_id FROM executions")[1])
        seen = {program_of[each] for each in asked if each in program_of} & learned
        if seen:
            message = f"`{Path(model).name}` was trained on {len(seen):,} of these programs, by the split `{own}`"
            suggestion = f"take a part of `{own}`, or train the model by `{split}`"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=suggestion)


def refuse_seen_tests(model: str | Path, dataset: Dataset, split: str) -> None:
    """Refuse a model to train on that was trained by another split on test programs of this one.

    Raises:
        HearthError: BAD_ARGUMENT.
    """
    query = "SELECT execution_id FROM splits WHERE split = $split AND starts_with(part, 'test')"
    refuse_seen(model, dataset, split, [each for (each,) in dataset.rows(query, split=split)[1]])


def _phases(trained: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    """Yield the record of a training, and of each training that it went on from."""
    while isinstance(trained, Mapping):
        yield trained
        trained = trained.get("first_phase")  # type: ignore[assignment]
