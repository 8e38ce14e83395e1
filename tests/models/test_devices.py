"""Networks and batches on another device: the parts of a batch stay what they are."""

from __future__ import annotations

from typing import NamedTuple

import pytest
import torch

from hearth.models.devices import device, moved, place_of
from hearth.models.films.mask_model import MaskModel, TrainedMaskModel


class Batch(NamedTuple):
    texts: torch.Tensor
    lengths: torch.Tensor


def test_a_batch_is_moved_whole():
    """A type of numbers stands for a device: both are what tensors are moved to."""
    one = torch.ones(2)
    batch = (Batch(one, one), [one], one)
    found = moved(batch, torch.float64)
    assert isinstance(found[0], Batch) and isinstance(found[1], list)
    assert {each.dtype for each in (*found[0], *found[1], found[2])} == {torch.float64}
    assert one.dtype == torch.float32


def test_a_network_is_where_its_weights_are():
    assert place_of(torch.nn.Linear(2, 2)).type == "cpu"
    assert place_of(torch.nn.Linear(2, 2, device="meta")).type == "meta"


@pytest.mark.skipif(not torch.cuda.is_available(), reason="there is no GPU here")
def test_a_gpu_predicts_what_a_processor_does():
    settings, classes = MaskModel(width=16), (7, 300)
    torch.manual_seed(0)
    model = TrainedMaskModel(settings, classes, settings.network(classes))
    pictures = torch.randint(0, 256, (3, 48, 64, 3), dtype=torch.uint8).numpy()
    here = model.masks(pictures)
    model.network.to(device())
    assert (model.masks(pictures) == here).mean() > 0.99
