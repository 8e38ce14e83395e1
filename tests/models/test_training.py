"""The training loop on a line that is to be fitted: its seeds, its ends, and stopping half-way."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from hearth.models.interface import Training
from hearth.schemas.diagnostics import HearthError

HOW = Training(epochs=6, rate=0.4, patience=0)


def line(scores=None, dropout=0.2):
    """A task: fit y = 3 x by a layer with dropout; the scores are given, or minus the loss."""
    import torch

    from hearth.models.training import Task

    torch.manual_seed(0)
    module = torch.nn.Sequential(torch.nn.Dropout(dropout), torch.nn.Linear(4, 1))
    data = torch.randn(32, 4)
    given = iter(scores or ())

    def batches(random):
        order = random.sample(range(32), 32)
        return [order[start : start + 8] for start in range(0, 32, 8)]

    def loss(rows):
        return (module(data[rows]) - 3 * data[rows].sum(1, keepdim=True)).square().mean()

    return Task(module, batches, loss, lambda: next(given) if scores else -float(loss(list(range(32)))), "line")


def weights(task):
    return {name: value.tolist() for name, value in task.module.state_dict().items()}


def test_it_learns_and_the_same_seed_gives_the_same_weights():
    from hearth.models.training import train

    found = []
    for seed in (0, 0, 1):
        task = line()
        outcome = train(task, replace(HOW, seed=seed))
        found.append(weights(task))
        assert outcome.epochs[-1].loss < outcome.epochs[0].loss / 2
    assert found[0] == found[1] != found[2]


def test_a_stopped_run_continues_to_the_same_weights_and_curves(tmp_path):
    from hearth.models.training import kept, train

    whole = line()
    outcome = train(whole, HOW)
    train(line(), replace(HOW, epochs=2, folder=tmp_path))
    assert kept(tmp_path)
    halves = line()
    continued = train(halves, replace(HOW, folder=tmp_path))
    assert weights(halves) == weights(whole)
    assert [epoch[:4] for epoch in continued.epochs] == [epoch[:4] for epoch in outcome.epochs]
    json.dumps(continued.record())


def test_the_state_of_another_task_is_not_continued(tmp_path):
    from hearth.models.training import train

    train(line(), replace(HOW, epochs=2, folder=tmp_path))
    whole, other = line(), line()
    train(whole, replace(HOW, seed=5))
    train(other, replace(HOW, seed=5, folder=tmp_path))
    assert weights(whole) == weights(other)


def test_a_damaged_state_is_not_continued(tmp_path):
    from hearth.models.training import STATE, train

    train(line(), replace(HOW, epochs=2, folder=tmp_path))
    (tmp_path / STATE).write_bytes(b"half")
    whole, other = line(), line()
    train(whole, HOW)
    train(other, replace(HOW, folder=tmp_path))
    assert weights(whole) == weights(other)


def test_patience_ends_training_and_the_best_weights_stay():
    from hearth.models.training import train

    first, task = line([1.0]), line([1.0, 0.5, 0.7, 0.9, 2.0, 3.0])
    train(first, replace(HOW, epochs=1))
    outcome = train(task, replace(HOW, patience=3))
    assert (outcome.ended, outcome.best, len(outcome.epochs)) == ("patience", 1, 4)
    assert weights(task) == weights(first)


def test_the_rate_is_halved_after_epochs_without_a_better_score():
    from hearth.models.training import train

    outcome = train(line([1.0, 0.5, 0.5, 0.5, 0.5, 2.0]), replace(HOW, halve_after=2))
    assert [epoch.rate for epoch in outcome.epochs] == [0.4, 0.4, 0.4, 0.2, 0.2, 0.1]


def test_a_budget_in_minutes_ends_between_epochs_and_is_recorded():
    from hearth.models.training import train

    outcome = train(line(), replace(HOW, minutes=1e-9))
    assert (outcome.ended, len(outcome.epochs)) == ("minutes", 1)
    assert outcome.record()["epochs"] == 1


def test_a_loss_that_is_not_a_number_is_an_error_with_a_remedy():
    from hearth.models.training import train

    task = line()
    with pytest.raises(HearthError, match="lower rate"):
        train(replace(task, loss=lambda rows: task.loss(rows) * float("nan")), HOW)


def test_a_score_that_is_not_a_number_is_an_error():
    """No epoch is better than one of such a score, and none is worse."""
    from hearth.models.training import train

    with pytest.raises(HearthError, match="score of epoch 2 is nan"):
        train(line([1.0, float("nan"), 2.0]), HOW)


def test_a_state_is_one_file_so_that_its_weights_are_of_the_epochs_that_it_says(tmp_path):
    from safetensors import safe_open

    from hearth.models.training import RUN, STATE, train

    task = line()
    train(task, replace(HOW, epochs=2, folder=tmp_path))
    assert [path.name for path in tmp_path.iterdir()] == [STATE]
    with safe_open(tmp_path / STATE, "pt") as file:
        assert len(json.loads(file.metadata()[RUN])["epochs"]) == 2


def test_whoever_is_stopped_while_a_state_is_written_continues_from_the_one_before(tmp_path, monkeypatch):
    from hearth.models import training

    whole, other = line(), line()
    training.train(whole, HOW)
    keep, stored = training.save_file, []

    def stopped(tensors, path, said):
        if len(stored) == 2:
            path.write_bytes(b"half")
            raise KeyboardInterrupt
        stored.append(keep(tensors, path, said))

    monkeypatch.setattr(training, "save_file", stopped)
    with pytest.raises(KeyboardInterrupt):
        training.train(line(), replace(HOW, folder=tmp_path))
    monkeypatch.undo()
    training.train(other, replace(HOW, folder=tmp_path))
    assert weights(other) == weights(whole)


@pytest.mark.parametrize("epochs", [None, "x", [1], [[]], [["x"] * 5], [[1, 2.0, 3.0, 4.0, 5.0, 6.0]]])
def test_a_state_with_other_epochs_is_not_continued(tmp_path, epochs):
    from safetensors.torch import load_file, save_file

    from hearth.models.training import RUN, STATE, _State, train

    train(line(), replace(HOW, epochs=2, folder=tmp_path))
    key = _State(line(), HOW, None).key
    save_file(load_file(tmp_path / STATE), tmp_path / STATE, {RUN: json.dumps({"key": key, "epochs": epochs})})
    whole, other = line(), line()
    train(whole, HOW)
    train(other, replace(HOW, folder=tmp_path))
    assert weights(other) == weights(whole)


@pytest.mark.parametrize("change", [
    lambda found: {}, lambda found: dict([*found.items()][:1]),
    lambda found: {f"x{name}": found[name] for name in found},
    lambda found: {name: value.reshape(-1)[:1] for name, value in found.items()},
    lambda found: {**found, "optimiser/x/exp_avg": found["now/1.bias"]},
])  # fmt: skip
def test_a_state_with_other_weights_is_not_continued(tmp_path, change):
    from safetensors import safe_open
    from safetensors.torch import load_file, save_file

    from hearth.models.training import STATE, train

    train(line(), replace(HOW, epochs=2, folder=tmp_path))
    with safe_open(tmp_path / STATE, "pt") as file:
        said = file.metadata()
    changed = {name: value.clone() for name, value in change(load_file(tmp_path / STATE)).items()}
    save_file(changed, tmp_path / STATE, said)
    whole, other = line(), line()
    train(whole, HOW)
    train(other, replace(HOW, folder=tmp_path))
    assert weights(other) == weights(whole)
