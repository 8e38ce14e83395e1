"""Training of the goal proposal network on episodes of an agent alone, and its use (thesis 7.3.3, C.3.2)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any, NamedTuple

from hearth.models.interface import Settings, Training
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import rng
from hearth.storage.files import value_digest
from hearth.storage.parallel import Seen, unseen

if TYPE_CHECKING:
    import numpy as np

    from hearth.models.checkpoint import Checkpoint
    from hearth.models.proposals.proposal_network import ProposalNetwork

NAME = "goal-proposals"

VALIDATION = 10
"""One of how many episodes is for validation."""

Increases = tuple[int, ...]
"""The growth of each predicate's count since the start."""


class Episode(NamedTuple):
    """An episode of the training data.

    Attributes:
        states: the increases at each tick.
        counts: how often each predicate of goals was wanted.
    """

    states: tuple[Increases, ...]
    counts: tuple[int, ...]


@dataclass(frozen=True)
class GoalProposals(Settings):
    """Settings of the network, those of table C.3.

    Attributes:
        inputs: p, the predicates that states are counted by.
        outputs: the predicates of goals.
        counts: c, counts are below it.
        d, h: units of its layers.
        batch: episodes of a step of training.
    """

    inputs: int
    outputs: int
    counts: int = 9
    d: int = 100
    h: int = 128
    batch: int = 256

    def network(self) -> ProposalNetwork:
        """Return a network that has learnt nothing."""
        from hearth.models.proposals.proposal_network import ProposalNetwork

        return ProposalNetwork(self.inputs, self.outputs, self.counts, self.d, self.h)

    def fit(self, episodes: Sequence[Episode], how: Training, seen: Seen = unseen) -> TrainedGoalProposals:
        """Return the network trained on one state of each episode in each pass, drawn uniformly.

        A tenth is for validation.

        Args:
            episodes: of an agent alone.
            how: long and how.
            seen: reports progress.
        """
        import torch

        from hearth.models.training import Task, train

        chosen = set(rng(0, "validation").sample(range(len(episodes)), len(episodes) // VALIDATION))
        held = [each for number, each in enumerate(episodes) if number in chosen] or episodes
        learnt = [each for number, each in enumerate(episodes) if number not in chosen]
        torch.manual_seed(how.seed)
        network = self.network()

        def batches(chooser: Random) -> Iterator[tuple[Any, Any]]:
            order = chooser.sample(learnt, len(learnt))
            for start in range(0, len(order), self.batch):
                yield self._packed(order[start : start + self.batch], chooser)

        def loss(batch: tuple[Any, Any]) -> torch.Tensor:
            states, counts = batch
            return torch.nn.functional.nll_loss(network(states).flatten(0, 1), counts.flatten())

        fixed = self._packed([each for each in held for _ in range(4)], rng(how.seed, "validation states"))
        identity = [asdict(self), value_digest([[each.states, each.counts] for each in episodes])]
        done = train(Task(network, batches, loss, lambda: -float(loss(fixed)), identity), how, seen)
        facts = {"episodes": len(episodes), "seed": how.seed, **done.record()}
        return TrainedGoalProposals(self, network, facts)

    def _packed(self, episodes: Sequence[Episode], chooser: Random) -> tuple[Any, Any]:
        import torch

        states = [chooser.choice(each.states) for each in episodes]
        most = self.counts - 1
        return torch.tensor(states).clamp(0, most), torch.tensor([each.counts for each in episodes]).clamp(0, most)

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> TrainedGoalProposals:
        """Return the trained network of a checkpoint."""
        from hearth.models.checkpoint_weights import filled

        settings = cls.of(checkpoint.settings)
        network = filled(settings.network, checkpoint.weights)
        return TrainedGoalProposals(settings, network, dict(checkpoint.trained))


@dataclass(frozen=True)
class TrainedGoalProposals:
    """A trained network.

    Attributes:
        settings: its own.
        network: with its weights.
        facts: how it was trained.
    """

    settings: GoalProposals
    network: ProposalNetwork
    facts: Mapping[str, Any] = field(default_factory=dict)

    def probabilities(self, increases: Increases) -> np.ndarray:
        """Return (P, c): how probably each predicate of goals is wanted 0, 1, ... times, each by itself."""
        import torch

        with torch.no_grad():
            state = torch.tensor([increases]).clamp(0, self.settings.counts - 1)
            found: np.ndarray = self.network(state)[0].exp().double().numpy()
        return found

    def checkpoint(self) -> Checkpoint:
        """Return all that `restored` needs; weights as numbers of 16 bits, which is half the file."""
        import numpy as np

        from hearth.models.checkpoint import Checkpoint

        weights = {name: each.detach().numpy().astype(np.float16) for name, each in self.network.state_dict().items()}
        return Checkpoint(NAME, asdict(self.settings), {}, weights, self.facts)

    def about(self, facts: Mapping[str, Any]) -> TrainedGoalProposals:
        """Return the same model with more facts about its training."""
        return replace(self, facts={**facts, **self.facts})


@lru_cache(maxsize=4)
def restored(model: str) -> TrainedGoalProposals:
    """Return a trained network; read once.

    Args:
        model: a checkpoint's folder, or the name of one that comes with Hearth.

    Raises:
        HearthError: MISSING_FILE, if there is none or the extra is not installed; DAMAGED_FILE.
    """
    from hearth.models.checkpoint import MISFITS, load, misfit
    from hearth.models.devices import device
    from hearth.models.model_registry import TRAINED, trained_names

    folder = TRAINED / model if model in trained_names() else Path(model)
    if not folder.exists():
        remedy = f"challenge learn owah --what proposals --out {model}"
        raise HearthError.of(Code.MISSING_FILE, "no goal proposal network here", file=str(folder), suggestion=remedy)
    checkpoint = load(folder)
    device()
    try:
        if checkpoint.model != NAME:
            raise ValueError(f"a checkpoint of `{checkpoint.model}`")
        return GoalProposals.restored(checkpoint)
    except MISFITS as error:
        raise misfit(folder, error) from error
