"""The model that a training of texts goes on from, or that another one reads."""

from pathlib import Path

from hearth.models.model_registry import MODELS, restore
from hearth.models.text.text_models import TrainedTextModel
from hearth.models.text_examples import Corpus
from hearth.models.training_overlap import refuse_seen_tests
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

STARTS = {"program": ("programs", "mle-composed"), "sketch": ("sketches", "desc2sketch")}
"""The plural name of each kind of output, and the usual model to go on from."""


def first_phase(start: str, corpus: Corpus) -> TrainedTextModel:
    """Return a trained network of texts.

    Args:
        start: a checkpoint's folder, or the name of one that comes with Hearth.
        corpus: on which it is trained on.

    Raises:
        HearthError: BAD_ARGUMENT, if it is another model, writes sketches and the corpus teaches programs or the
            reverse, or was trained by another split on test programs of the corpus's; errors of `restore`.
    """
    name, model = restore(start)
    if not isinstance(model, TrainedTextModel) or MODELS[name].output != corpus.writes:
        what, usual = STARTS[corpus.writes]
        message = f"`{Path(start).name}` does not write {what} of texts"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=f"--set start=FOLDER of `{usual}`")
    refuse_seen_tests(start, corpus.dataset, corpus.split)
    return model
