"""Policy gradient: the baseline leaves the mean gradient as it is, and a rewarded step becomes more probable."""

from __future__ import annotations

from copy import deepcopy

import pytest

from hearth.models.interface import Training


@pytest.fixture
def untrained(dataset, eight):
    from hearth.models.text.text_models import TextModel
    from hearth.models.text_examples import Corpus

    settings = TextModel(hidden=16, vector=16, dropout=0.0, longest=4)
    corpus = Corpus(dataset, "activities", eight[:1], eight[:1])
    return settings.fit(corpus, Training(epochs=1, rate=1e-6)), corpus


def test_the_mean_gradient_of_the_baseline_is_about_zero(untrained, eight):
    """Eq. 4.7: any constant times the gradient of the logarithm of the probability of samples has the mean 0."""
    import torch

    from hearth.models.text.program_writer import sample
    from hearth.models.text.text_batches import step_batch, text_batch

    model, _ = untrained
    writer = model.writer.eval()
    gradients = []
    texts = text_batch([eight[0].request] * 400, model.vocabulary, writer.device)
    with torch.no_grad():
        programs = sample(writer, texts, 40, torch.Generator().manual_seed(0))
    for start in range(0, 400, 20):
        part = text_batch([eight[0].request] * 20, model.vocabulary, writer.device)
        writer.zero_grad()
        writer.log_probabilities(part, step_batch(programs[start : start + 20], writer.device, 40)).sum(
            1
        ).mean().backward()
        gradients.append(writer.head.action.bias.grad.clone())
    found = torch.stack(gradients)  # (20, A + 1)
    error = found.std(0) / len(found) ** 0.5
    assert (found.mean(0).abs() < 4.5 * error + 1e-3).all()
    assert found.abs().max() > 0.05


def test_what_is_rewarded_becomes_more_probable(untrained, eight):
    import torch

    from hearth.models.text.self_critical import Drawn, surrogate
    from hearth.models.text.text_batches import step_batch, text_batch

    model, _ = untrained
    wanted = model.vocabulary.action_numbers["Sleep"]
    program = step_batch([[(wanted, 0, 0)]], model.writer.device)

    def probability():
        texts = text_batch([eight[0].request], model.vocabulary, model.writer.device)
        with torch.no_grad():
            return float(model.writer.log_probabilities(texts, program)[0, 0])

    def rewarded(examples, programs):
        return [float(any(step.action == "Sleep" for step in steps)) for steps in programs]

    before = probability()
    optimiser = torch.optim.Adam(model.writer.parameters(), lr=0.02)
    for seed in range(8):
        optimiser.zero_grad()
        surrogate(model, Drawn([eight[0]] * 32, seed), rewarded).backward()
        optimiser.step()
    assert probability() > before + 0.1


def test_rewards(dataset, eight):
    from hearth.models.text.self_critical import SIM, lcs_reward, sim_reward
    from hearth.models.text_examples import Corpus, examples

    assert lcs_reward(eight, [each.steps for each in eight]) == [1.0] * 8
    assert lcs_reward(eight[:1], [()]) == [0.0]
    known = examples(dataset, "activities", "train", originals=True)[:3]
    rewarded = sim_reward(Corpus(dataset, "activities", known, ()))
    assert all(value <= 1 + SIM for value in rewarded(known, [each.steps for each in known]))
    assert max(rewarded(known, [each.steps for each in known])) == pytest.approx(1 + SIM)
    assert rewarded(known, [()] * len(known)) == [0.0] * len(known), "the empty program runs, and is not rewarded"


def test_both_phases_run_and_are_recorded(dataset, monkeypatch):
    from hearth.models.text import self_critical, text_models
    from hearth.models.text.self_critical import SelfCritical
    from hearth.models.text_examples import Corpus, examples

    known = examples(dataset, "activities", "train", originals=True)[:4]
    corpus = Corpus(dataset, "activities", known, known)
    budgets = []
    for module in (self_critical, text_models):
        monkeypatch.setattr(
            module, "train", lambda task, how, seen, plain=module.train: budgets.append(how.minutes) or plain(task, how)
        )
    model = SelfCritical(reward="lcs+sim", batch=4).fit(corpus, Training(epochs=1, minutes=7))
    assert budgets == [7, 7], "as `--help` says"
    assert model.trained["epochs"] == 1 and model.trained["first_phase"]["epochs"] == 1


def test_a_stopped_training_does_not_go_on_from_another_start(dataset, eight, tmp_path, monkeypatch):
    """The kept state has the weights of the start before."""
    from hearth.models.text import self_critical
    from hearth.models.text.text_models import TextModel
    from hearth.models.text_examples import Corpus

    corpus = Corpus(dataset, "activities", eight, eight[:2])
    settings = TextModel(hidden=16, vector=16, longest=4)
    starts = [settings.fit(corpus, Training(epochs=1, rate=1e-6, seed=seed)) for seed in (0, 1)]
    given = iter([starts[0], starts[0], starts[1]])
    monkeypatch.setattr(self_critical, "first_phase", lambda start, corpus: deepcopy(next(given)))
    done = []
    for epochs in (1, 2, 2):  # stopped after one, went on, began anew
        found = []
        how = Training(epochs=epochs, folder=tmp_path)
        self_critical.SelfCritical(start="x").fit(corpus, how, lambda number, _, found=found: found.append(number))
        done.append(found)
    assert done == [[1], [2], [1, 2]]
