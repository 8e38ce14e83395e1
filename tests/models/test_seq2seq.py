"""The encoder in one call a direction is that of packed sequences; batches of about the same length have everything."""

from __future__ import annotations

from random import Random

import pytest

LENGTHS = (7, 1, 4, 7, 2)


@pytest.fixture
def lstm():
    import torch

    torch.manual_seed(1)
    return torch.nn.LSTM(5, 3, batch_first=True, bidirectional=True)


@pytest.fixture
def inputs():
    import torch

    return torch.randn(5, 7, 5, generator=torch.Generator().manual_seed(2), requires_grad=True)


def packed(lstm, inputs):
    """The plain twin."""
    from torch.nn.utils.rnn import pack_padded_sequence, pad_packed_sequence

    sequences = pack_padded_sequence(inputs, LENGTHS, batch_first=True, enforce_sorted=False)
    return pad_packed_sequence(lstm(sequences)[0], batch_first=True)[0]


def encoded(lstm, inputs):
    import torch

    from hearth.models.text.seq2seq import both_ways

    return both_ways(lstm, inputs, torch.tensor(LENGTHS))


def test_states_and_gradients_are_those_of_packed_sequences(lstm, inputs):
    import torch

    found = []
    for states in (encoded(lstm, inputs), packed(lstm, inputs)):
        gradients = torch.autograd.grad((states**2).sum(), (inputs, *lstm.parameters()))
        found.append((states, *gradients))
    for ours, theirs in zip(*found, strict=True):
        assert torch.allclose(ours, theirs, atol=1e-5)


def test_what_stands_in_the_padding_changes_nothing(lstm, inputs):
    import torch

    padded = torch.cat((inputs.detach().clone(), torch.full((5, 2, 5), 9.0)), 1)
    for row, length in enumerate(LENGTHS):
        padded[row, length:] = 9.0
    found, wider = encoded(lstm, inputs), encoded(lstm, padded)
    assert torch.equal(found, wider[:, :7]) and not wider[:, 7:].any()


@pytest.mark.parametrize("training", [True, False])
@pytest.mark.parametrize("gradients", [True, False])
def test_it_is_called_for_training_wherever_there_are_gradients(lstm, inputs, monkeypatch, training, gradients):
    """Policy gradient has them in `eval` mode, and a GPU refuses those of a call that is not for training."""
    import torch

    asked, plain = [], torch.lstm
    monkeypatch.setattr(torch, "lstm", lambda *given: asked.append(given[6]) or plain(*given))
    with torch.set_grad_enabled(gradients):
        encoded(lstm.train(training), inputs)
    assert asked == [gradients] * 2


@pytest.mark.parametrize(("count", "batch"), [(0, 4), (3, 4), (4, 4), (1_003, 8)])
def test_batches_have_every_example_once_and_are_of_about_the_same_length(count, batch):
    from hearth.models.text.likelihood_training import alike

    lengths = [Random(place).randint(1, 40) for place in range(count)]
    found = alike(lengths, batch, Random(5))
    assert sorted(place for places in found for place in places) == list(range(count))
    assert all(1 <= len(places) <= batch for places in found)
    assert found == alike(lengths, batch, Random(5))
    if count > 1_000:
        assert found != alike(lengths, batch, Random(6))
        spread = [max(some) - min(some) for some in ([lengths[place] for place in places] for places in found)]
        assert sum(spread) / len(spread) < 8, "of 40"
