"""Texts and programs as tensors."""

from collections.abc import Sequence
from dataclasses import dataclass
from random import Random
from typing import NamedTuple

import torch

from hearth.models.interface import Request, Steps
from hearth.models.text.step_vocabulary import END, UNKNOWN, StepVocabulary
from hearth.models.text.text_words import BREAK, words_of


class InputBatch(NamedTuple):
    """B texts of at most L words, or films of at most L clips; C is the number of classes and one, for no object.

    Attributes:
        inputs: (B, L) int64 words, 0 past the end; of clips (B, L, F) float32 numbers.
        lengths: (B,) int64, at least 1, on the processor.
        mentioned: (B, L, C) float32, 1 where a class is mentioned; in clips how probable it is.
    """

    inputs: torch.Tensor
    lengths: torch.Tensor
    mentioned: torch.Tensor

    @property
    def mask(self) -> torch.Tensor:
        """Return (B, L) bool: whether there is a word."""
        device = self.inputs.device
        return torch.arange(self.inputs.shape[1], device=device) < self.lengths.to(device)[:, None]


class StepBatch(NamedTuple):
    """B programs of at most T steps, each with the end of the program after it.

    Attributes:
        steps: (B, T + 1, 3) int64, the numbers of action and classes; 0 for the end, for no object and past the end.
        weights: (B, T + 1) float32, 1 for each step and the end; 0 past it.
    """

    steps: torch.Tensor
    weights: torch.Tensor


@dataclass(frozen=True)
class Noise:
    """The parts of training texts to leave out, so that a model does not rely on them.

    Attributes:
        title: the share of texts without their title: people's requests have none.
        word: the share of words that count as unknown.
    """

    title: float = 0.3
    word: float = 0.05


def text_batch(
    requests: Sequence[Request], vocabulary: StepVocabulary, device: torch.device, noise: Random | None = None
) -> InputBatch:
    """Return the texts of some requests; with noise, if a generator is given."""
    texts = [words_of(request) or [BREAK] for request in requests]
    shares = Noise()
    if noise is not None:
        texts = [_without_title(words) if noise.random() < shares.title else words for words in texts]
    numbers = [vocabulary.read_words(words) for words in texts]
    if noise is not None:
        numbers = [[UNKNOWN if noise.random() < shares.word else number for number in row] for row in numbers]
    longest = max(map(len, numbers))
    words_in = torch.zeros(len(texts), longest, dtype=torch.int64)
    mentioned = torch.zeros(len(texts), longest, len(vocabulary.classes) + 1)
    for row, (text, found) in enumerate(zip(texts, numbers, strict=True)):
        words_in[row, : len(found)] = torch.tensor(found)
        for place, number in vocabulary.mentioned(text):
            mentioned[row, place, number] = 1
    lengths = torch.tensor([len(found) for found in numbers])
    return InputBatch(words_in.to(device), lengths, mentioned.to(device))


def _without_title(words: list[str]) -> list[str]:
    """Return the words after the break, or all if nothing follows it."""
    return words[words.index(BREAK) + 1 :] or words if BREAK in words else words


def step_batch(programs: Sequence[Sequence[tuple[int, int, int]]], device: torch.device, longest: int = 0) -> StepBatch:
    """Programs as numbers of steps, with their ends; one of `longest` steps was cut off, and its end does not count."""
    width = max(map(len, programs), default=0) + 1
    steps = torch.full((len(programs), width, 3), END, dtype=torch.int64)
    weights = torch.zeros(len(programs), width)
    for row, program in enumerate(programs):
        if program:
            steps[row, : len(program)] = torch.tensor(program)
        weights[row, : len(program) + (not longest or len(program) < longest)] = 1
    return StepBatch(steps.to(device), weights.to(device))


def encoded(steps: Steps, vocabulary: StepVocabulary, longest: int) -> list[tuple[int, int, int]]:
    """Return a program as numbers.

    Steps that the vocabulary lacks are left out, and those after the longest program's end.
    """
    found = (vocabulary.numbers(step) for step in steps[:longest])
    return [numbers for numbers in found if numbers is not None]
