"""The common part of all writers of programs: the first phase of training, and writing programs batch by batch."""

from collections.abc import Callable, Iterator, Sequence
from random import Random
from typing import Any, TypeVar

import torch

from hearth.models.text.program_writer import Numbers, Writer, beam
from hearth.models.text.text_batches import InputBatch, StepBatch, step_batch
from hearth.models.training import Task

AT_ONCE = 64
"""Texts or films that are read at once in prediction."""

TOGETHER = 20
"""Batches whose examples are put in the order of their lengths."""

Asked = TypeVar("Asked")
"""The input that a program is written for: a text, or the contents of a film."""

Read = Callable[[Sequence[Asked], Random | None], InputBatch]
"""A function that makes a batch of inputs; with noise, if a generator is given."""


def likelihood(
    writer: Writer, data: Sequence[tuple[Asked, Sequence[tuple[int, int, int]]]], read: Read[Asked], batch: int,
    longest: int, validate: Callable[[], float], identity: Any,
) -> Task[tuple[InputBatch, StepBatch]]:  # fmt: skip
    """Training by the likelihood of the true steps, given the true steps before them (thesis 4.3.1, first phase).

    Args:
        writer: that is trained.
        data: inputs, and the numbers of their programs' steps.
        read: see `Read`.
        batch: examples in a batch.
        longest: steps of the longest program.
        validate, identity: as of `Task`.
    """

    def batches(random: Random) -> Iterator[tuple[InputBatch, StepBatch]]:
        for places in alike([len(steps) for _, steps in data], batch, random):
            rows = [data[place] for place in places]
            inputs = read([asked for asked, _ in rows], random)
            yield inputs, step_batch([steps for _, steps in rows], writer.device, longest)

    return Task(writer, batches, lambda each: writer.loss(*each), validate, identity)


def alike(lengths: Sequence[int], batch: int, random: Random) -> list[list[int]]:
    """Places of examples in batches of about the same length, in random order.

    Twenty batches' examples, drawn at random, are put in the order of their lengths before they are parted: a batch
    takes as many steps as its longest program.
    """
    order = random.sample(range(len(lengths)), len(lengths))
    found = []
    for start in range(0, len(order), batch * TOGETHER):
        some = sorted(order[start : start + batch * TOGETHER], key=lambda place: lengths[place])
        found += [some[first : first + batch] for first in range(0, len(some), batch)]
    random.shuffle(found)
    return found


def written(
    writer: Writer, asked: Sequence[Asked], read: Read[Asked], length: Callable[[Asked], int], width: int, longest: int
) -> list[Numbers]:
    """Return the most probable program for each, by greedy or beam search; no answer depends on another.

    Args:
        writer: trained.
        asked: the inputs that programs are written for.
        read: see `Read`; without noise here.
        length: of an input: inputs of similar length are read together.
        width: programs followed at once; 1 is greedy.
        longest: steps at most.
    """
    writer.eval()
    order = sorted(range(len(asked)), key=lambda place: length(asked[place]))
    found: dict[int, Numbers] = {}
    with torch.no_grad():
        for start in range(0, len(order), AT_ONCE):
            places = order[start : start + AT_ONCE]
            inputs = read([asked[place] for place in places], None)
            found |= dict(zip(places, beam(writer, inputs, width, longest), strict=True))
    return [found[place] for place in range(len(asked))]
