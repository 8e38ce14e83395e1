"""The one training loop: seeds, a budget, early stopping, clipped gradients, curves, and resuming.

The loop knows a module, batches, a loss and a validation score, and nothing about their meaning. Random numbers of an
epoch are derived from the seed and its number. On the processor, a run that was stopped and continued is the same as an
uninterrupted run.
"""

import json
import math
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from hashlib import blake2b
from pathlib import Path
from random import Random
from typing import Any, Generic, NamedTuple, TypeVar

import torch
from safetensors import SafetensorError, safe_open
from safetensors.torch import save_file

from hearth.models.devices import device
from hearth.models.interface import Training
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import derive, rng
from hearth.storage.files import replacing, value_digest
from hearth.storage.parallel import Seen, unseen

B = TypeVar("B")

STATE = "state.safetensors"
"""The file of a training that is not finished: weights, the optimiser's numbers, and in its head the epochs."""

RUN = "run"
"""The place in its head."""

_OPTIMISER = "optimiser/"
"""Before the names of the optimiser's numbers: of each weight, by its number."""


@dataclass(frozen=True, slots=True)
class Task(Generic[B]):
    """A training task.

    Attributes:
        module: with the weights; those that need no gradient stay.
        batches: the batches of an epoch, in an order drawn from the generator.
        loss: the mean loss of a batch, a tensor of one number.
        validate: a score of the module as it is, the greater the better.
        identity: the parts of the task, as JSON; a kept state of another task is not continued.
    """

    module: torch.nn.Module
    batches: Callable[[Random], Iterable[B]]
    loss: Callable[[B], torch.Tensor]
    validate: Callable[[], float]
    identity: Any = None


class Epoch(NamedTuple):
    """One pass over the examples: its number from 1, mean loss, validation score, rate of learning, and seconds."""

    number: int
    loss: float
    score: float
    rate: float
    seconds: float


class Outcome(NamedTuple):
    """A finished training: its epochs, the best one, whose weights the module now has, and the reason of its end."""

    epochs: tuple[Epoch, ...]
    best: int
    ended: str

    def record(self) -> dict[str, Any]:
        """Return the outcome as a checkpoint's `trained` has it."""
        minutes = round(sum(epoch.seconds for epoch in self.epochs) / 60, 2)
        curves = {name: [getattr(epoch, name) for epoch in self.epochs] for name in ("loss", "score", "rate")}
        facts = {"epochs": len(self.epochs), "best_epoch": self.best, "ended": self.ended, "minutes": minutes}
        return {**facts, "curves": curves}


def weights_digest(module: torch.nn.Module) -> str:
    """Return a digest of a module's weights."""
    found = blake2b(digest_size=16)
    for name, values in sorted(module.state_dict().items()):
        found.update(name.encode())
        found.update(values.detach().cpu().contiguous().numpy().tobytes())
    return found.hexdigest()


def train(task: Task[B], how: Training, seen: Seen = unseen) -> Outcome:
    """Train until the epochs, the minutes or the patience are used up; the module then has its best weights.

    A budget in minutes ends training between epochs only, so that on the processor the same number of epochs gives the
    same weights; a GPU adds some gradients in another order each time.

    Args:
        task: the task to train.
        how: how long and how.
        seen: reports progress: epochs done, and their greatest number.

    Raises:
        HearthError: BAD_ARGUMENT, if a loss or a score is not a number.
    """
    device()  # one thread: sums are the same on any number of cores, and small networks are faster
    optimiser = torch.optim.AdamW([each for each in task.module.parameters() if each.requires_grad], lr=how.rate)
    state = _State(task, how, optimiser)
    epochs = state.restore()
    best = best_of(epochs)
    while not (ended := _ended(epochs, best, how)):
        began, rate = time.monotonic(), _rate(epochs, how)
        number = len(epochs) + 1
        for group in optimiser.param_groups:
            group["lr"] = rate
        loss = _epoch(task, how, optimiser, number)
        task.module.eval()
        with torch.no_grad():
            score = _finite(float(task.validate()), f"the validation score of epoch {number}")
        epochs.append(Epoch(number, round(loss, 6), round(score, 6), rate, round(time.monotonic() - began, 3)))
        best = best_of(epochs)
        if best == number:
            state.remember()
        state.keep(epochs)
        seen(number, how.epochs)
    state.recall()
    task.module.eval()
    return Outcome(tuple(epochs), best, ended)


def _epoch(task: Task[B], how: Training, optimiser: torch.optim.Optimizer, number: int) -> float:
    """Train for one epoch; its mean loss."""
    torch.manual_seed(derive(how.seed, "epoch", number))
    task.module.train()
    total, count = 0.0, 0
    for batch in task.batches(rng(how.seed, "batches", number)):
        loss = task.loss(batch)
        value = _finite(float(loss.detach()), f"the loss of epoch {number}")
        optimiser.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(task.module.parameters(), how.clip)
        optimiser.step()
        total, count = total + value, count + 1
    return total / max(count, 1)


def _finite(value: float, what: str) -> float:
    """Return a score, checked to be a number: another value would be neither better nor worse than any other."""
    if not math.isfinite(value):
        raise HearthError.of(Code.BAD_ARGUMENT, f"{what} is {value}", suggestion="train with a lower rate")
    return value


def best_of(epochs: Sequence[Epoch]) -> int:
    """Return the number of the first epoch with the best score; 0 before the first."""
    return max(epochs, key=lambda epoch: (epoch.score, -epoch.number)).number if epochs else 0


def _ended(epochs: Sequence[Epoch], best: int, how: Training) -> str:
    """Return why training ends now; "" if it goes on."""
    spent = sum(epoch.seconds for epoch in epochs)
    if len(epochs) >= how.epochs:
        return "epochs"
    if how.patience and len(epochs) - best >= how.patience:
        return "patience"
    if how.minutes and epochs and spent + epochs[-1].seconds / 2 > how.minutes * 60:
        return "minutes"
    return ""


def _rate(epochs: Sequence[Epoch], how: Training) -> float:
    """Return the rate of the next epoch: halved after each `halve_after` epochs without a better score."""
    halvings, waited, best = 0, 0, -math.inf
    for epoch in epochs:
        waited = 0 if epoch.score > best else waited + 1
        best = max(best, epoch.score)
        if how.halve_after and waited == how.halve_after:
            halvings, waited = halvings + 1, 0
    return how.rate * 0.5**halvings


class _State:
    """The weights now and at their best, and those of the optimiser; kept in a folder after each epoch."""

    def __init__(self, task: Task[Any], how: Training, optimiser: torch.optim.Optimizer) -> None:
        self.module, self.optimiser, self.folder = task.module, optimiser, how.folder
        same = {name: value for name, value in asdict(how).items() if name not in ("epochs", "minutes", "folder")}
        self.key = value_digest([same, task.identity])
        self.best: dict[str, torch.Tensor] = {}

    def remember(self) -> None:
        self.best = {name: value.detach().clone() for name, value in self.module.state_dict().items()}

    def recall(self) -> None:
        if self.best:
            self.module.load_state_dict(self.best)

    def keep(self, epochs: Sequence[Epoch]) -> None:
        """Write one file, so that a stopped run has the weights of the epochs that it lists, or those before."""
        if self.folder is None:
            return
        self.folder.mkdir(parents=True, exist_ok=True)
        parts = {"now": self.module.state_dict(), "best": self.best}
        tensors = {f"{part}/{name}": value for part, found in parts.items() for name, value in found.items()}
        for number, values in self.optimiser.state_dict()["state"].items():
            tensors |= {f"{_OPTIMISER}{number}/{name}": value for name, value in values.items()}
        said = json.dumps({"key": self.key, "epochs": [list(epoch) for epoch in epochs]})
        with replacing(self.folder / STATE) as path:
            whole = {name: value.detach().cpu().contiguous().clone() for name, value in tensors.items()}
            save_file(whole, path, {RUN: said})

    def restore(self) -> list[Epoch]:
        """Take up a kept state of the same task; its epochs, none if there is no such state."""
        if self.folder is None or not kept(self.folder):
            return []
        try:
            with safe_open(self.folder / STATE, "pt") as file:
                run = json.loads((file.metadata() or {}).get(RUN, "null"))
                tensors = {name: file.get_tensor(name) for name in file.keys()}  # noqa: SIM118  (it is not a mapping)
        except (OSError, SafetensorError, ValueError, RecursionError):
            return []
        if not isinstance(run, dict) or run.get("key") != self.key:
            return []
        epochs = _epochs(run.get("epochs"))
        if not epochs or not self._fits(tensors):
            return []
        self._take_up(tensors)
        return epochs

    def _fits(self, tensors: Mapping[str, torch.Tensor]) -> bool:
        """Return whether these are current and best weights of the module, with the optimizer's numbers for them."""
        own = {name: value.shape for name, value in self.module.state_dict().items()}
        wanted = {f"{part}/{name}": shape for part in ("now", "best") for name, shape in own.items()}
        given = {name: value.shape for name, value in tensors.items() if not name.startswith(_OPTIMISER)}
        trained = [each.shape for group in self.optimiser.param_groups for each in group["params"]]
        numbers = {
            f"{_OPTIMISER}{number}/{name}": shape
            for number, of_weight in enumerate(trained)
            for name, shape in (("step", ()), ("exp_avg", of_weight), ("exp_avg_sq", of_weight))
        }
        others = {name: value.shape for name, value in tensors.items() if name.startswith(_OPTIMISER)}
        return given == wanted and all(numbers.get(name) == tuple(shape) for name, shape in others.items())

    def _take_up(self, tensors: Mapping[str, torch.Tensor]) -> None:
        state = self.optimiser.state_dict()
        state["state"] = {}
        now: dict[str, torch.Tensor] = {}
        for key, value in tensors.items():
            part, name = key.split("/", 1)
            if part == _OPTIMISER[:-1]:
                number, name = name.split("/", 1)
                state["state"].setdefault(int(number), {})[name] = value
            else:
                (now if part == "now" else self.best)[name] = value
        self.module.load_state_dict(now)
        self.optimiser.load_state_dict(state)


def _epochs(rows: Any) -> list[Epoch]:
    """Return the epochs of a kept state; none if these are not epochs."""
    kinds = (int, float, float, float, float)
    if not isinstance(rows, list) or not all(isinstance(row, list) and len(row) == len(kinds) for row in rows):
        return []
    fits = (isinstance(value, kind) for row in rows for value, kind in zip(row, kinds, strict=True))
    return [Epoch(*row) for row in rows] if all(fits) else []


def kept(folder: Path) -> bool:
    """Return whether a folder has the state of a training."""
    return (folder / STATE).is_file()
