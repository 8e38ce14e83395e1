"""Policies over subgoals and over actions: their settings, their choices, their checkpoints."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from functools import lru_cache
from random import Random
from typing import TYPE_CHECKING, Any

from hearth.models.helping.policy_inputs import Pair, Scene, Trace, Words, packed
from hearth.models.interface import Settings
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

if TYPE_CHECKING:
    import numpy as np
    from torch import nn

    from hearth.models.checkpoint import Checkpoint
    from hearth.models.helping.policy_networks import State

NAMES = {"subgoals": "helping-subgoals", "actions": "helping-actions"}
"""The models of the registry, by the kind of their choices."""


@dataclass(frozen=True)
class HelpingPolicy(Settings):
    """Settings of a policy.

    Attributes:
        chooses: `subgoals` (figure B-8) or `actions` (figure B-7).
        width, heads: of its network.
    """

    chooses: str = "subgoals"
    width: int = 128
    heads: int = 4

    def fitting(self) -> None:
        """Check that the heads divide the width."""
        self.multiple("width", self.heads, "its `heads` share it")

    def network(self, words: Words) -> nn.Module:
        """Return a network that has learnt nothing."""
        from hearth.models.helping import policy_networks

        made = policy_networks.SubgoalNetwork if self.chooses == "subgoals" else policy_networks.ActionNetwork
        return made(len(words.things), len(words.places), self.width, self.heads)

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> TrainedPolicy:
        """Return the trained policy of a checkpoint."""
        from hearth.models.checkpoint_weights import filled

        settings = cls.of(checkpoint.settings)
        if settings.chooses not in NAMES or NAMES[settings.chooses] != checkpoint.model:
            raise ValueError(f"a policy of `{settings.chooses[:40]}`")
        words = Words(*(tuple(map(str, checkpoint.content[name])) for name in Words._fields))
        network = filled(lambda: settings.network(words), checkpoint.weights)
        return TrainedPolicy(settings, words, network, dict(checkpoint.trained))


@dataclass(frozen=True)
class TrainedPolicy:
    """A policy that may be asked.

    Attributes:
        settings: its own.
        words: the vocabulary of its subgoals.
        network: with its weights.
        facts: how it was trained.
    """

    settings: HelpingPolicy
    words: Words
    network: nn.Module
    facts: Mapping[str, Any] = field(default_factory=dict)

    def choose(self, scene: Scene, state: State | None, chooser: Random) -> tuple[Pair, State]:
        """Draw a choice by the policy's probabilities, and return it with the state for the next choice."""
        import torch

        with torch.no_grad():
            seen = self.network(packed([Trace((scene,), (), ())]), state)
            first = _drawn(seen.first[0, 0].double().exp().numpy(), chooser)
            second = _drawn(seen.second[0, 0, first].double().exp().numpy(), chooser)
        return (first, second), seen.state

    def with_facts(self, facts: Mapping[str, Any]) -> TrainedPolicy:
        """Return the same policy with facts about its training."""
        return replace(self, facts=facts)

    def checkpoint(self) -> Checkpoint:
        """Return all that `restored` needs."""
        from hearth.models.checkpoint import Checkpoint

        weights = {name: value.detach().numpy() for name, value in self.network.state_dict().items()}
        content = {name: list(words) for name, words in self.words._asdict().items()}
        return Checkpoint(NAMES[self.settings.chooses], asdict(self.settings), content, weights, self.facts)


def untrained(chooses: str, words: Words, seed: int) -> TrainedPolicy:
    """Return a policy whose network has learnt nothing; equal for equal seeds."""
    import torch

    from hearth.models.devices import device

    device()
    torch.manual_seed(seed)
    settings = HelpingPolicy(chooses)
    return TrainedPolicy(settings, words, settings.network(words))


def _drawn(probabilities: np.ndarray, chooser: Random) -> int:
    """Return a number drawn by probabilities."""
    import numpy as np

    total = np.cumsum(probabilities)
    return min(int(np.searchsorted(total, chooser.random() * total[-1], side="right")), len(total) - 1)


@lru_cache(maxsize=8)
def restored(model: str, chooses: str) -> TrainedPolicy:
    """Return a trained policy; read once.

    Args:
        model: a checkpoint's folder, or the name of one that comes with Hearth.
        chooses: the kind of its choices.

    Raises:
        HearthError: MISSING_FILE, if there is none or the extra is not installed; BAD_ARGUMENT: it chooses something
            else; DAMAGED_FILE.
    """
    from hearth.models.devices import device
    from hearth.models.model_registry import restore_any

    device()
    name, found = restore_any(model)
    if name != NAMES[chooses]:
        raise HearthError.of(Code.BAD_ARGUMENT, f"a checkpoint of `{name}` chooses no {chooses}", file=model)
    policy: TrainedPolicy = found
    return policy
