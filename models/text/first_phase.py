"""The model that a training of texts goes on from, or that another one reads."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from hearth.models.model_registry import restore
from hearth.models.seen_programs import refuse_seen_tests
from hearth.models.text.text_models import TrainedTextModel
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

if TYPE_CHECKING:
    from hearth.models.data import Corpus


def first_phase(start: str, corpus: Corpus) -> TrainedTextModel:
    """A trained network of texts.

    Args:
        start: a checkpoint's folder, or the name of one that comes with Hearth.
        corpus: on which it is trained on.

    Raises:
        HearthError: BAD_ARGUMENT, if it is another model, or was trained by another split on test programs of the
            corpus's; errors of `restore`.
    """
    model = restore(start)[1]
    if not isinstance(model, TrainedTextModel):
        message = f"`{Path(start).name}` does not write programs of texts"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="--set start=FOLDER of `mle-composed`")
    refuse_seen_tests(start, corpus.dataset, corpus.split)
    return model
