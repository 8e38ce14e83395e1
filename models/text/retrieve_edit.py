"""Retrieve and edit: the programs of the most similar texts, with the objects that the new text asks for (ours).

Each retrieved program is edited. An object that its own text mentions, and the new text does not, is replaced by one
that the new text alone mentions, if every action done with it takes that, too. The answer is the edited program most
similar to the others by LCS, each weighted by the similarity of its text. A step of one neighbor alone is thus left
out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from hearth.models.checkpoint import Checkpoint
from hearth.models.interface import Request, Settings, Steps, Training
from hearth.models.text.object_mentions import mentions
from hearth.models.text.retrieval import Memory, Similarity, text_of
from hearth.models.text.step_vocabulary import StepVocabulary
from hearth.models.text.text_words import words
from hearth.schemas.program import Step
from hearth.scoring.metrics.lcs import LEVELS, matrix
from hearth.storage.parallel import Seen, unseen

if TYPE_CHECKING:
    from hearth.models.text_examples import Corpus


@dataclass(frozen=True, slots=True)
class RetrieveEdit(Settings):
    """Retrieve and edit.

    Attributes:
        neighbours: texts whose programs are edited.
        sharpness: the power of the similarity by which a neighbour counts.
        edit: whether objects are replaced.
    """

    neighbours: int = 20
    sharpness: float = 2.0
    edit: bool = True

    def fit(self, corpus: Corpus, how: Training, seen: Seen = unseen) -> TrainedRetrieveEdit:
        """Remember the training texts and programs."""
        pairs = [(each.request, each.steps) for each in corpus.train]
        vocabulary = StepVocabulary.of(pairs, corpus.dataset.knowledge)
        return TrainedRetrieveEdit(self, Memory.of(corpus), vocabulary)

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> TrainedRetrieveEdit:
        """Return the model of a checkpoint."""
        content = checkpoint.content
        vocabulary, memory = StepVocabulary.read(content["vocabulary"]), Memory.read(content["memory"])
        if unknown := [step for steps in memory.programs for step in steps if vocabulary.numbers(step) is None]:
            raise ValueError(f"the vocabulary lacks {unknown[0].action}, or what it is done to")
        found = TrainedRetrieveEdit(cls.of(checkpoint.settings), memory, vocabulary)
        found.similarity  # noqa: B018  (texts without a word are refused now, not when it is asked)
        return found


@dataclass(frozen=True)
class TrainedRetrieveEdit:
    """The training texts with their programs, and which action takes which object."""

    settings: RetrieveEdit
    memory: Memory
    vocabulary: StepVocabulary

    def predict(self, requests: Sequence[Request], beam: int = 1) -> list[Steps]:
        """Return for each text the edited program most similar to the others."""
        return [consensus(*each) for each in self.candidates(requests)]

    def candidates(self, requests: Sequence[Request]) -> list[tuple[list[Steps], list[float]]]:
        """Return for each text the edited programs of its neighbors, and their weights."""
        texts = [text_of(each.title, each.description) for each in requests]
        found = self.similarity.nearest(texts, self.settings.neighbours)
        return [self._edits(text, *neighbours) for text, neighbours in zip(texts, found, strict=True)]

    def _edits(self, text: str, places: Sequence[int], alike: Sequence[float]) -> tuple[list[Steps], list[float]]:
        wanted = self._mentioned(text)
        programs = [self.memory.programs[place] for place in places]
        if self.settings.edit:
            own = (self._mentioned(self.memory.texts[place]) for place in places)
            programs = [self._edited(one, its, wanted) for its, one in zip(own, programs, strict=True)]
        return programs, [max(one, 1e-3) ** self.settings.sharpness for one in alike]

    def _mentioned(self, text: str) -> dict[str, int]:
        """Return the classes that a text mentions, in order of their first mention, and the places of these."""
        found: dict[str, int] = {}
        for place, name in mentions(words(text), self.vocabulary.spelt):
            found.setdefault(name, place)
        return found

    def _edited(self, program: Steps, own: Mapping[str, int], wanted: Mapping[str, int]) -> Steps:
        used = {ref.name for step in program for ref in step.objects}
        new = [name for name in wanted if name not in used]
        swaps: dict[str, str] = {}
        for old in (name for name in own if name in used and name not in wanted):
            fitting = [name for name in new if name not in swaps.values() and self._fits(program, old, name)]
            if fitting:
                swaps[old] = fitting[0]
        return renamed(program, swaps)

    def _fits(self, program: Steps, old: str, new: str) -> bool:
        """Return whether each action that a program does with an object takes another in its place."""
        known, number = self.vocabulary, self.vocabulary.class_numbers[new]
        uses = {(step.action, place) for step in program for place, ref in enumerate(step.objects) if ref.name == old}
        return all(number in known.takes[known.action_numbers[action] - 1][place] for action, place in uses)

    def checkpoint(self) -> Checkpoint:
        """Return all that `restored` needs; the weights of words are made again from the texts."""
        content = {"memory": self.memory.document(), "vocabulary": self.vocabulary.document()}
        return Checkpoint("retrieve-edit", asdict(self.settings), content, {})

    @cached_property
    def similarity(self) -> Similarity:
        """Similarities to the training texts."""
        return Similarity(self.memory.texts)


def renamed(program: Steps, swaps: Mapping[str, str]) -> Steps:
    """Return a program with other classes in place of some."""
    return tuple(_renamed(step, swaps) for step in program)


def _renamed(step: Step, swaps: Mapping[str, str]) -> Step:
    return replace(step, objects=tuple(replace(ref, name=swaps.get(ref.name, ref.name)) for ref in step.objects))


def consensus(programs: Sequence[Steps], weights: Sequence[float]) -> Steps:
    """Return the program with the highest weighted mean LCS (of steps, actions, objects) with all.

    Of equal ones the first is taken.
    """
    if not programs:
        return ()
    shares: dict[Steps, float] = {}
    for program, weight in zip(programs, weights, strict=True):
        shares[program] = shares.get(program, 0.0) + weight
    distinct = list(shares)
    alike = sum(matrix(distinct, distinct, level, workers=1).astype(float) for level in LEVELS)  # (N, N)
    each = np.array(list(shares.values()))
    totals = np.round(alike @ (each / max(each.sum(), np.finfo(float).tiny)), 5)
    return distinct[int(totals.argmax())]
