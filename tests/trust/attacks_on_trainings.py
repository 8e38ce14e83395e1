"""Attacks by what checkpoints say of their training, and by states of trainings that were stopped."""

from __future__ import annotations

import json
import pickle
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from attack import Attack, Ground
from attacks_on_models import FEW, Change, _Calls, _copy, _document_of, _places, _put, _short

from hearth.models.checkpoint import NAME


def trainings() -> Iterator[Attack]:
    """Yield attacks by trainings that checkpoints describe, which are drawn, and by states of stopped trainings."""
    base = "helping-subgoals"
    document = _document_of(base)
    for place in (*_places(document, "trained", 4), ("model",)):
        for bad in (*FEW, "</text><script>alert(1)</script>", 10**30, "\x1b[2J"):
            yield Attack("trainings", f"drawn: {'.'.join(map(str, place))[:40]} = {_short(bad)}",
                         lambda ground, p=place, b=bad: _drawn(ground, base, _put(p, b)))  # fmt: skip
    for name, change in STATES.items():
        yield Attack("trainings", f"stopped: {name}", lambda ground, c=change: _continued(ground, c))


def _drawn(ground: Ground, base: str, change: Change) -> Any:
    from hearth.analysis.training_curves import drawn, runs

    folder = _copy(ground, base)
    document = json.loads((folder / NAME).read_text())
    change(document)
    (folder / NAME).write_text(json.dumps(document))
    found = runs([folder])
    picture = drawn(found)
    assert "<script" not in picture and "\x1b" not in picture
    return [run.row() for run in found]


def _line(folder: Path | None) -> Any:
    """A network of one layer, trained on for two epochs."""
    import torch

    from hearth.models.interface import Training
    from hearth.models.training import Task, train

    torch.manual_seed(0)
    module, data = torch.nn.Linear(3, 1), torch.ones(8, 3)
    task = Task(module, lambda _: [data], lambda rows: module(rows).square().mean(), lambda: 0.0, "line")
    train(task, Training(epochs=4, patience=0, folder=folder))
    return {name: value.tolist() for name, value in module.state_dict().items()}


def _continued(ground: Ground, change: Callable[[dict[str, Any], dict[str, str]], bytes]) -> None:
    """Train on from a state that was changed: it is taken up as it should be, or not at all."""
    from safetensors import safe_open

    from hearth.models.training import STATE

    whole, folder = _line(None), ground.folder / "training"
    _line(folder)
    with safe_open(folder / STATE, "np") as file:
        tensors, said = {name: file.get_tensor(name) for name in file.keys()}, dict(file.metadata())  # noqa: SIM118
    (folder / STATE).write_bytes(change(tensors, said))
    assert _line(folder) == whole, "other weights"


def _stored(tensors: dict[str, Any], said: dict[str, str]) -> bytes:
    import safetensors.numpy

    return safetensors.numpy.save(tensors, said)


def _saying(run: Callable[[Any], Any]) -> Callable[[dict[str, Any], dict[str, str]], bytes]:
    return lambda tensors, said: _stored(tensors, {**said, "run": json.dumps(run(json.loads(said["run"])))})


STATES: dict[str, Callable[[dict[str, Any], dict[str, str]], bytes]] = {
    "as it was": _stored,
    "cut": lambda tensors, said: _stored(tensors, said)[:-9],
    "pickle": lambda tensors, said: pickle.dumps(_Calls()),
    "no head": lambda tensors, said: _stored(tensors, {}),
    "deep head": lambda tensors, said: _stored(tensors, {"run": "[" * 100_000}),
    "other head": lambda tensors, said: _stored(tensors, {"run": "7"}),
    "no weights": lambda tensors, said: _stored({}, said),
    "one weight": lambda tensors, said: _stored(dict([*tensors.items()][:1]), said),
    "other names": lambda tensors, said: _stored({f"x{name}": value for name, value in tensors.items()}, said),
    "names without parts": lambda tensors, said: _stored({"x": np.zeros(1), "optimiser/x": np.zeros(1)}, said),
    "no numbers of weights": lambda tensors, said: _stored({**tensors, "optimiser/x/exp_avg": np.zeros(1)}, said),
    "other shapes": lambda tensors, said: _stored({name: np.zeros(7) for name in tensors}, said),
    **{
        f"epochs {_short(bad)}": _saying(lambda run, b=bad: {**run, "epochs": b})  # type: ignore[misc]
        for bad in (None, {}, "x", [1], [[]], [["x"] * 5], [[1, 2, 3, 4, 5, 6]], [[None] * 5], [[{}] * 5])
    },
}  # fmt: skip
"""States that nobody who was stopped has left."""
