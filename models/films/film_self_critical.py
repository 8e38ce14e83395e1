"""The second phase of training for writers of films: policy gradient by LCS and by execution (thesis 4.3.1).

The programs are executed in the film's home.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from hearth.datasets.dataset import Dataset
from hearth.models.checkpoint import Checkpoint
from hearth.models.films.film_training_examples import FilmExample, film_examples
from hearth.models.films.film_writer import FilmWriter, TrainedFilmWriter
from hearth.models.interface import Settings, Steps, Training
from hearth.models.model_registry import restore
from hearth.models.text.self_critical import SIM, Reward, go_on, lcs_reward, rewarding
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.parallel import Seen, unseen


@dataclass(frozen=True, slots=True)
class FilmCritical(Settings):
    """A writer of films after the first phase, trained on.

    Attributes:
        reward: `lcs`, or `lcs+sim`.
        start: a checkpoint of `films-mle`; for `lcs+sim` one of `films-pg-lcs`, as in the thesis.
        batch: films in a batch.
        films: of training, at most; 0 for all.
    """

    reward: Literal["lcs", "lcs+sim"] = "lcs"
    start: str = "films-mle"
    batch: int = 16
    films: int = 0

    def fit(self, dataset: Dataset, how: Training, seen: Seen = unseen) -> TrainedFilmWriter:
        """Train by policy gradient, at a tenth of the rate; the best epoch is the one with the best validation LCS.

        Raises:
            HearthError: the checkpoint of the first phase is missing, or holds another model; errors of `Clips.of`.
        """
        model = restore(self.start)[1]
        if not isinstance(model, TrainedFilmWriter):
            message = f"`{Path(self.start).name}` writes no programs of films"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="--set start=FOLDER of `films-mle`")
        learned = film_examples(dataset, "train", model.reader, self.films)
        checked = film_examples(dataset, "validation", model.reader)
        rewarded: Reward = lcs_reward if self.reward == "lcs" else sim_reward
        task = rewarding(model, learned, rewarded, self.batch, lambda: model.score(checked),
                         [self.reward, self.batch, len(learned), model.trained])  # fmt: skip
        facts = {"films": len(learned), "classifier": model.trained.get("classifier", {}), "seed": how.seed}
        go_on(model, task, how, seen)
        model.trained.update(facts)
        return model

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> TrainedFilmWriter:
        """Return the model of a checkpoint, which has the settings of the network."""
        return FilmWriter.restored(checkpoint)


def sim_reward(examples: Sequence[FilmExample], programs: Sequence[Steps]) -> list[float]:
    """Return the LCS, and `SIM` for programs that run in the environment of their film."""
    pairs = zip(lcs_reward(examples, programs), examples, programs, strict=True)
    return [value + SIM * example.trial.runs(steps) for value, example, steps in pairs]
