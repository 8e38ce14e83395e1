"""Goal inference from states (thesis 6.4, B.3.1): a person's goal, from the observed places of things."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any

from hearth.models.interface import Settings, Training, texts
from hearth.models.watching.demonstration_batches import Counts, Joining, Watched, epoch, in_batches, packed
from hearth.models.watching.goal_decoding import PossibleGoals, possible_goals
from hearth.models.watching.object_sightings import Layout, Predicate, sightings
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.rng import rng
from hearth.simulation.env import Tick
from hearth.storage.files import value_digest
from hearth.storage.parallel import Seen, unseen

if TYPE_CHECKING:
    from hearth.models.checkpoint import Checkpoint
    from hearth.models.watching.object_network import ThingNetwork
    from hearth.models.watching.state_network import MomentNetwork

NAME = "goal-inference"

VALIDATION = 10
"""One of how many goals is for validation; its demonstrations are not learnt from."""


@dataclass(frozen=True)
class GoalInference(Settings):
    """Settings of the network.

    Attributes:
        width, layers, heads, dropout: see `ThingNetwork`.
        batch: demonstrations of a step of training.
        joined: the share of demonstrations that are joined with another of another set.
        shape: `things`, ours, or `moments`, the thesis's (see `MomentNetwork`).
    """

    width: int = 128
    layers: int = 1
    heads: int = 4
    dropout: float = 0.1
    batch: int = 64
    joined: float = 0.6
    shape: str = "things"

    def fitting(self) -> None:
        """Check that the heads divide the width."""
        self.multiple("width", self.heads, "its `heads` share it")

    def network(self, layout: Layout) -> ThingNetwork | MomentNetwork:
        """Return a network that has learnt nothing."""
        from hearth.models.watching.object_network import ThingNetwork
        from hearth.models.watching.state_network import MomentNetwork

        shapes: dict[str, type[ThingNetwork | MomentNetwork]] = {"things": ThingNetwork, "moments": MomentNetwork}
        kind = shapes[self.shape]
        return kind(layout, self.width, self.layers, self.heads, dropout=self.dropout)

    def fit(
        self,
        examples: Sequence[Watched],
        predicates: Sequence[Predicate],
        possible: PossibleGoals,
        forbidden: frozenset[Counts],
        how: Training,
        seen: Seen = unseen,
    ) -> TrainedGoalInference:
        """Return the network trained on demonstrations.

        Args:
            examples: of single goal sets.
            predicates: whose counts the examples have.
            possible: the goals that there are.
            forbidden: goals that demonstrations must not be joined to, because tests have them.
            how: long and how.
            seen: reports progress.
        """
        import torch

        from hearth.models.training import Task, train

        layout = Layout.of(predicates)
        joining = Joining(layout, possible.set_of, forbidden)
        learnt, held = _parted(examples)
        held = [*held, *epoch(held, joining, 1.0, rng(how.seed, "joined validation"))] or learnt
        torch.manual_seed(how.seed)
        network = self.network(layout)
        trained = TrainedGoalInference(self, tuple(map(str, predicates)), network, layout)

        def batches(chooser: Random) -> Any:
            return in_batches(epoch(learnt, joining, self.joined, chooser), self.batch, len(predicates))

        def loss(batch: Any) -> torch.Tensor:
            from hearth.models.watching.object_network import loss_of

            return loss_of(network, batch)

        identity = [
            asdict(self),
            value_digest([[[list(thing) for thing in each.things], each.counts] for each in examples]),
        ]
        done = train(Task(network, batches, loss, lambda: trained.score(held, possible), identity), how, seen)
        facts = {"demonstrations": len(examples), "learnt": len(learnt), "seed": how.seed, **done.record()}
        return replace(trained, facts=facts)

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> TrainedGoalInference:
        """Return the trained network of a checkpoint."""
        from hearth.models.checkpoint_weights import filled

        settings = cls.of(checkpoint.settings)
        content = checkpoint.content
        layout = Layout(content["kinds"], content["places"], tuple((a, b) for a, b in content["cells"]))
        predicates = texts(content["predicates"])
        if len(predicates) != len(layout.cells):
            raise ValueError(f"{len(predicates)} predicates, but {len(layout.cells)} cells")
        network = filled(lambda: settings.network(layout), checkpoint.weights)
        return TrainedGoalInference(settings, predicates, network, layout, dict(checkpoint.trained))


def _parted(examples: Sequence[Watched]) -> tuple[list[Watched], list[Watched]]:
    """Split examples into those to train on and those for validation, which have other goals.

    There is no validation where there are few goals.
    """
    goals = list(dict.fromkeys(each.counts for each in examples))
    chosen = set(rng(0, "validation goals").sample(goals, len(goals) // VALIDATION))
    return [e for e in examples if e.counts not in chosen], [e for e in examples if e.counts in chosen]


@dataclass(frozen=True)
class TrainedGoalInference:
    """A trained network.

    Attributes:
        settings: its own.
        predicates: their texts, in order.
        network: with its weights.
        layout: of the predicates.
        facts: how it was trained.
    """

    settings: GoalInference
    predicates: tuple[str, ...]
    network: ThingNetwork | MomentNetwork
    layout: Layout
    facts: Mapping[str, Any] = field(default_factory=dict)

    def counts(self, demonstrations: Sequence[Watched], possible: PossibleGoals) -> list[Counts]:
        """Return the most probable goals of demonstrations, whose own goals are not looked at."""
        import torch

        found = []
        with torch.no_grad():
            for start in range(0, len(demonstrations), 256):
                logs = self.network(packed(demonstrations[start : start + 256], len(self.predicates)))
                found += [possible.best(each) for each in logs.double().numpy()]
        return found

    def score(self, examples: Sequence[Watched], possible: PossibleGoals) -> float:
        """F1 of predicates with their counts; each that is wanted several times counts as often."""
        inferred = self.counts(examples, possible)
        pairs = [
            (a, b)
            for each, ours in zip(examples, inferred, strict=True)
            for a, b in zip(ours, each.counts, strict=True)
        ]
        return 2 * sum(map(min, pairs)) / max(1, sum(map(sum, pairs)))

    def infer(self, ticks: Sequence[Tick], predicates: Sequence[Predicate], goals: tuple[Goal, ...]) -> Goal:
        """Return the goal of a demonstration.

        Args:
            ticks: of a demonstration.
            predicates: in the network's order, with the nodes of the demonstration's home; the goal is made of them.
            goals: all of single goal sets that there are, with the names of furniture.

        Raises:
            HearthError: BAD_ARGUMENT, if the network was trained for other predicates.
        """
        wanted = {str(each) for goal in goals for each, _ in goal}
        if Layout.of(predicates) != self.layout or not wanted <= {*self.predicates}:
            remedy = "challenge learn CHALLENGE --out FOLDER"
            raise HearthError.of(Code.BAD_ARGUMENT, "the network knows other predicates", suggestion=remedy)
        possible = possible_goals(goals, self.predicates)
        things = sightings(ticks, predicates)
        (counts,) = self.counts([Watched(things, (0,) * len(predicates))], possible)
        return Goal(tuple((each, count) for each, count in zip(predicates, counts, strict=True) if count))

    def checkpoint(self) -> Checkpoint:
        """All that `restored` needs."""
        from hearth.models.checkpoint import Checkpoint

        content = {"predicates": list(self.predicates), **asdict(self.layout)}
        weights = {name: value.detach().numpy() for name, value in self.network.state_dict().items()}
        return Checkpoint(NAME, asdict(self.settings), content, weights, self.facts)


@lru_cache(maxsize=4)
def restored(model: str) -> TrainedGoalInference:
    """Return a trained network; read once.

    Args:
        model: a checkpoint's folder, or the name of one that comes with Hearth.

    Raises:
        HearthError: MISSING_FILE, if there is none or the extra is not installed; DAMAGED_FILE.
    """
    from hearth.models.checkpoint import MISFITS, load, misfit
    from hearth.models.devices import device
    from hearth.models.model_registry import TRAINED, trained_names

    device()
    folder = TRAINED / model if model in trained_names() else Path(model)
    checkpoint = load(folder)
    try:
        if checkpoint.model != NAME:
            raise ValueError(f"a checkpoint of `{checkpoint.model}`")
        return GoalInference.restored(checkpoint)
    except MISFITS as error:
        raise misfit(folder, error) from error
