"""Losses: of imitating choices, and of the advantage actor-critic (A2C; Mnih et al. 2016; thesis B.3.4, B.3.5)."""

from collections.abc import Sequence

import torch
from torch import Tensor, nn

from hearth.models.helping.policy_inputs import Batch
from hearth.models.helping.policy_networks import Outlook

VALUE, ENTROPY, CLOSE = 0.25, 0.01, 0.1
"""Weights of the parts of a loss: the error of expected returns, the entropy of choices, the prediction of reach."""


def discounted(rewards: Sequence[float], ticks: Sequence[int], discount: float) -> list[float]:
    """Return the returns from some ticks on.

    Args:
        rewards: of each tick.
        ticks: at which something was chosen, ascending.
        discount: of a tick.
    """
    after, total = [0.0] * (len(rewards) + 1), 0.0
    for tick in range(len(rewards) - 1, -1, -1):
        total = after[tick] = rewards[tick] + discount * total
    return [after[min(tick, len(rewards))] for tick in ticks]


def imitation(network: nn.Module, batch: Batch) -> Tensor:
    """Return the mean negative log probability of the choices made, plus the loss of predicted returns."""
    seen: Outlook = network(batch)
    there = torch.as_tensor(batch.there)
    loss = -_chosen(seen, batch)[there].mean()
    return loss + VALUE * _value_error(seen, batch, there) + CLOSE * _close_error(seen, batch, there)


def actor_critic(network: nn.Module, batch: Batch) -> Tensor:
    """Return the loss of A2C over whole episodes that the network has just played.

    Advantages are brought to one scale.
    """
    seen: Outlook = network(batch)
    there = torch.as_tensor(batch.there)
    advantage = (torch.as_tensor(batch.returns) - seen.value.detach())[there]
    advantage = (advantage - advantage.mean()) / (advantage.std(correction=0) + 1e-6)
    loss = -(_chosen(seen, batch)[there] * advantage).mean() - ENTROPY * entropy(seen)[there].mean()
    return loss + VALUE * _value_error(seen, batch, there) + CLOSE * _close_error(seen, batch, there)


def entropy(seen: Outlook) -> Tensor:
    """Return the entropy of both choices together, (B, T)."""
    first, second = seen.first.exp(), seen.second.exp()
    of_second = -(second * seen.second.clamp(min=-1e3)).sum(-1)
    return -(first * seen.first.clamp(min=-1e3)).sum(-1) + (first * of_second).sum(-1)


def _chosen(seen: Outlook, batch: Batch) -> Tensor:
    """Return the log probabilities of the choices made, (B, T)."""
    first, second = torch.as_tensor(batch.choices).unbind(-1)
    of_second = seen.second.gather(2, first[..., None, None].expand(-1, -1, 1, seen.second.shape[-1]))[:, :, 0]
    return seen.first.gather(-1, first[..., None])[..., 0] + of_second.gather(-1, second[..., None])[..., 0]


def _value_error(seen: Outlook, batch: Batch, there: Tensor) -> Tensor:
    return nn.functional.smooth_l1_loss(seen.value[there], torch.as_tensor(batch.returns)[there])


def _close_error(seen: Outlook, batch: Batch, there: Tensor) -> Tensor | float:
    """Return the loss of the low-level policy's predictions of the nodes within its reach (B.3.4)."""
    if seen.close is None:
        return 0.0
    nodes = there[..., None] & (torch.as_tensor(batch.classes) > 0)
    wanted = torch.as_tensor(batch.close)[nodes].to(seen.close.dtype)
    return nn.functional.binary_cross_entropy_with_logits(seen.close[nodes], wanted)
