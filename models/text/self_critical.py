"""The second phase of training: policy gradient with the greedy program as its baseline (thesis 4.3.1, eq. 4.6 to 4.8).

The reward is the LCS of a program with the true one (eq. 4.1), or that and a tenth if the program runs in the
environment of its example, as scores tell it.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from random import Random
from typing import Any, Literal, NamedTuple, Protocol

import torch

from hearth.models.checkpoint import Checkpoint
from hearth.models.execution_trials import trials
from hearth.models.interface import Settings, Steps, Training
from hearth.models.text.pretrained_model import first_phase
from hearth.models.text.program_writer import Numbers, Writer, beam, sample
from hearth.models.text.text_batches import InputBatch, step_batch
from hearth.models.text.text_models import TextModel, TrainedTextModel
from hearth.models.text_examples import Corpus
from hearth.models.training import Task, train, weights_digest
from hearth.scoring.metrics.lcs import score_pairs
from hearth.storage.parallel import Seen, unseen

SIM = 0.1
"""The weight of running in the reward."""

Reward = Callable[[Sequence[Any], Sequence[Steps]], list[float]]
"""The rewards of programs for examples."""


class Learner(Protocol):
    """A trained model that is trained on: of texts, or of films."""

    @property
    def settings(self) -> Any:
        """Return its settings; `longest` has the steps of its longest program."""

    @property
    def writer(self) -> Writer:
        """Return the network."""

    @property
    def trained(self) -> dict[str, Any]:
        """Return the record of its training."""

    def asked(self, examples: Sequence[Any], random: Random) -> InputBatch:
        """Return the inputs of examples; drawn from `random` where there is noise."""

    def program(self, numbers: Numbers) -> Steps:
        """Return the program of some numbers."""


class Drawn(NamedTuple):
    """A batch: examples, and the seed for drawing their programs."""

    examples: list[Any]
    seed: int


@dataclass(frozen=True, slots=True)
class SelfCritical(Settings):
    """A model after the first phase, trained on.

    Attributes:
        reward: `lcs`, or `lcs+sim`.
        start: a checkpoint of the first phase, its folder or its name; if empty, the first phase is trained here, too.
        batch: examples in a batch.
    """

    reward: Literal["lcs", "lcs+sim"] = "lcs"
    start: str = ""
    batch: int = 32

    def fit(self, corpus: Corpus, how: Training, seen: Seen = unseen) -> TrainedTextModel:
        """Train by policy gradient, at a tenth of the rate; the best epoch is the one with the best validation LCS.

        Raises:
            HearthError: BAD_ARGUMENT, if there is nothing for validation; errors of `pretrained_model`.
        """
        checked = corpus.checked()
        if self.start:
            model = first_phase(self.start, corpus)
        else:
            first = replace(how, folder=how.folder / "first") if how.folder else how
            model = TextModel().fit(corpus, first, seen)
        rewarded = lcs_reward if self.reward == "lcs" else sim_reward(corpus)
        task = rewarding(model, corpus.train, rewarded, self.batch, lambda: model.score(checked),
                         [self.reward, self.batch, corpus.facts, weights_digest(model.writer)])  # fmt: skip
        go_on(model, task, how, seen)
        return model

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> TrainedTextModel:
        """Return the model of a checkpoint, which has the settings of the network."""
        return TextModel.restored(checkpoint)


def rewarding(
    model: Learner, data: Sequence[Any], rewarded: Reward, batch: int, validate: Callable[[], float], identity: Any
) -> Task[Drawn]:
    """Training by policy gradient.

    Args:
        model: after the first phase.
        data: its examples.
        rewarded: the rewards of programs.
        batch: examples in a batch.
        validate, identity: as of `Task`.
    """

    def batches(random: Random) -> Iterator[Drawn]:
        order = random.sample(range(len(data)), len(data))
        for begin in range(0, len(order), batch):
            yield Drawn([data[place] for place in order[begin : begin + batch]], random.getrandbits(32))

    return Task(model.writer, batches, lambda each: surrogate(model, each, rewarded), validate, identity)


def go_on(model: Learner, task: Task[Drawn], how: Training, seen: Seen) -> None:
    """Train a model on, at a tenth of the rate; the record of its former training is kept as its first phase."""
    before = {"first_phase": dict(model.trained)}
    model.trained.clear()
    model.trained.update({**train(task, replace(how, rate=how.rate / 10), seen).record(), **before})


def surrogate(model: Learner, batch: Drawn, rewarded: Reward) -> torch.Tensor:
    """Return a number whose gradient is that of minus the expected reward: eq. 4.8 with one sample for each example.

    There is no dropout, so that the drawn programs and the rewarded programs come from the same policy.
    """
    writer = model.writer
    writer.eval()
    texts = model.asked(batch.examples, Random(batch.seed))
    with torch.no_grad():
        drawn = sample(writer, texts, model.settings.longest, torch.Generator().manual_seed(batch.seed))
        greedy = beam(writer, texts, 1, model.settings.longest)
    gain = [one - other for one, other in zip(_rewards(model, batch, drawn, rewarded),
                                              _rewards(model, batch, greedy, rewarded), strict=True)]  # fmt: skip
    programs = step_batch(drawn, writer.device, model.settings.longest)
    logarithms = writer.log_probabilities(texts, programs).sum(1)  # (B,)
    return -(logarithms * torch.tensor(gain, device=writer.device)).mean()


def _rewards(model: Learner, batch: Drawn, programs: Sequence[Numbers], rewarded: Reward) -> list[float]:
    return rewarded(batch.examples, [model.program(numbers) for numbers in programs])


def lcs_reward(examples: Sequence[Any], programs: Sequence[Steps]) -> list[float]:
    """Return the LCS of whole steps, from 0 to 1 (eq. 4.1)."""
    pairs = ((program, example.steps) for example, program in zip(examples, programs, strict=True))
    return [score.step for score in score_pairs(pairs)]


def sim_reward(corpus: Corpus) -> Reward:
    """Return the LCS, and `SIM` for programs that run in the environment of the first execution of their example."""

    def rewards(examples: Sequence[Any], programs: Sequence[Steps]) -> list[float]:
        names = [example.executions[0] for example in examples]
        found = trials(corpus.dataset, sorted(set(names)))
        pairs = zip(lcs_reward(examples, programs), names, programs, strict=True)
        return [value + SIM * found[name].runs(steps) for value, name, steps in pairs]

    return rewards
