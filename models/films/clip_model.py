"""The classifier of clips by colours: it is trained on pictures of training films (thesis table 4.3 b)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, field
from random import Random
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray

from hearth.datasets.dataset import Dataset
from hearth.models.checkpoint import Checkpoint
from hearth.models.checkpoint_weights import filled
from hearth.models.devices import device, moved, place_of
from hearth.models.films.class_accuracy import accuracies
from hearth.models.films.clip_data import Clips, Instruction, OfFilms
from hearth.models.films.clip_network import RELATED, ClipNetwork, loss_of
from hearth.models.films.film_arrays import COLOURS
from hearth.models.films.frame_data import Labels, Pictures, frames_of, pictures_of
from hearth.models.films.possible_instructions import Reading
from hearth.models.interface import Settings, Training
from hearth.models.text_examples import facts_of
from hearth.models.training import Task, train
from hearth.storage.parallel import Seen, unseen

NAME = "clips-rgb"
"""Name of the model's checkpoints."""

AT_ONCE = 128
"""Clips that are classified at once."""

RELATIONS = ((0, 3, 5, 8), (0, 2, 4, 6), (1, 3, 6, 8), (2, 4, 5, 7))
"""Frames that are related in prediction; the mean of their logarithms decides."""


@dataclass(frozen=True, slots=True)
class ClipModel(Settings):
    """Settings of the classifier.

    Attributes:
        width: numbers for a frame.
        dropout: share of numbers left out in training.
        batch: clips in a batch.
        balance: the power of a class's share by which its loss is divided: 0 counts clips, 1 classes.
        films: of training, at most; 0 for all.
    """

    width: int = 128
    dropout: float = 0.3
    batch: int = 64
    balance: float = 0.5
    films: int = 0

    def fit(self, dataset: Dataset, how: Training, seen: Seen = unseen) -> TrainedClipModel:
        """Train on the clips of `train`; those of `validation` decide when to stop."""
        learned = Clips.of(dataset, "train", self.films, array=COLOURS)
        checked = Clips.of(dataset, "validation", array=COLOURS)
        labels = Labels.of(learned)
        torch.manual_seed(how.seed)
        model = TrainedClipModel(self, labels, self.network(labels).to(device()))
        wanted = np.array([labels.numbers(clip.done) for clip in learned.clips])
        place = place_of(model.network)
        weights = [torch.tensor(each, dtype=torch.float32, device=place) for each in self._weights(wanted, labels)]
        pictures, looked_at = pictures_of(learned), pictures_of(checked)

        def batches(random: Random) -> Iterator[tuple[torch.Tensor, torch.Tensor]]:
            order = random.sample(range(len(learned)), len(learned))
            for start in range(0, len(order), self.batch):
                which = order[start : start + self.batch]
                taken = sorted(random.sample(range(learned.frames), RELATED))
                frames = torch.from_numpy(frames_of(learned, pictures, which, taken))
                yield frames, torch.from_numpy(wanted[which])

        def loss(batch: tuple[torch.Tensor, torch.Tensor]) -> torch.Tensor:
            frames, numbers = moved(batch, place)
            return loss_of(model.network(frames), numbers, weights)

        def validate() -> float:
            done = [clip.done for clip in checked.clips]
            best = model.scores_of(checked, looked_at, RELATIONS[:1]).argmax(1).tolist()
            return accuracies(done, [labels.instructions[number] for number in best])["mean"]

        task = Task(model.network, batches, loss, validate, [asdict(self), len(learned), facts_of(dataset)["digest"]])
        model.facts.update({"clips": len(learned), "seed": how.seed, **train(task, how, seen).record()})
        return model

    def _weights(self, wanted: NDArray[np.int64], labels: Labels) -> Iterator[NDArray[np.float64]]:
        sizes = (len(labels.actions), len(labels.objects) + 1, len(labels.objects) + 1)
        for place, size in enumerate(sizes):
            counts = np.bincount(wanted[:, place], minlength=size)
            weights = np.where(counts > 0, np.maximum(counts, 1) ** -self.balance, 0.0)
            yield weights * len(wanted) / (weights * counts).sum()

    def network(self, labels: Labels) -> ClipNetwork:
        """Return the network, with random weights."""
        sizes = len(labels.actions), len(labels.objects) + 1
        return ClipNetwork(self.width, *sizes, self.dropout)

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> TrainedClipModel:
        """Return the model of a checkpoint."""
        settings, labels = cls.of(checkpoint.settings), Labels.read(checkpoint.content["labels"])
        network = filled(lambda: settings.network(labels), checkpoint.weights).to(device())
        return TrainedClipModel(settings, labels, network, dict(checkpoint.trained))


@dataclass(frozen=True)
class TrainedClipModel(OfFilms):
    """A trained classifier."""

    name = NAME

    settings: ClipModel
    labels: Labels
    network: ClipNetwork
    facts: dict[str, Any] = field(default_factory=dict)

    def named(self, clips: Clips, relations: Iterable[Sequence[int]] = RELATIONS) -> list[Instruction]:
        """Return the instruction that each clip is taken for: the most probable of training's."""
        best = self.scores(clips, relations).argmax(1)
        return [self.labels.instructions[number] for number in best.tolist()]

    def scores(self, clips: Clips, relations: Iterable[Sequence[int]] = RELATIONS) -> NDArray[np.float32]:
        """(N, I) logarithms of how probable each of training's instructions is in each clip, up to a constant."""
        return self.scores_of(clips, pictures_of(clips), relations)

    def scores_of(self, clips: Clips, pictures: Pictures, relations: Iterable[Sequence[int]]) -> NDArray[np.float32]:
        """Return the same scores, from the pictures of the clips' films."""
        rows = torch.from_numpy(self.labels.rows).to(place_of(self.network))  # (I, 3)
        ways = list(relations)
        self.network.eval()
        found = []
        for start in range(0, len(clips), AT_ONCE):
            which = range(start, min(start + AT_ONCE, len(clips)))
            with torch.no_grad():
                each = [self._parts(frames_of(clips, pictures, which, taken), rows) for taken in ways]
            found.append(torch.stack(each).mean(0).cpu().numpy())
        return np.concatenate(found)

    def readings(self, clips: Clips) -> Iterator[Reading]:
        """Yield the possible instructions of the clips of each film, film by film: instructions of training."""
        for part in clips.by_film():
            yield Reading(self.labels.instructions, self.scores(part))

    def _parts(self, frames: NDArray[np.uint8], rows: torch.Tensor) -> torch.Tensor:
        heads = self.network(torch.from_numpy(frames).to(rows.device))
        return torch.stack([scores[:, rows[:, place]] for place, scores in enumerate(heads)]).sum(0)

    def checkpoint(self) -> Checkpoint:
        """Return all that `restored` needs."""
        weights = {name: value.cpu().numpy() for name, value in self.network.state_dict().items()}
        return Checkpoint(NAME, asdict(self.settings), {"labels": self.labels.document()}, weights, self.facts)
