"""The classifier of clips that reads each class of the masks: its position, and its behavior near the person."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterator, Sequence
from dataclasses import asdict, dataclass, field
from random import Random
from typing import Any, NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray

from hearth.datasets.dataset import Dataset
from hearth.models.checkpoint import Checkpoint
from hearth.models.checkpoint_weights import filled
from hearth.models.devices import device, moved, place_of
from hearth.models.films.class_accuracy import accuracies
from hearth.models.films.clip_data import Clips, Instruction, OfFilms
from hearth.models.films.mask_clip_network import FRAMES, HEADS, SeenBatch, SeenNetwork, loss_of
from hearth.models.films.mask_clips import SeenClips, joined, offsets, seen_clips
from hearth.models.films.object_class_properties import PLACES, ClassTable
from hearth.models.films.possible_instructions import Reading, reading
from hearth.models.films.predicted_masks import mask_predictor, predicted
from hearth.models.films.step_order import StepOrder, programs_of
from hearth.models.interface import Settings, Training
from hearth.models.text_examples import facts_of
from hearth.models.training import Task, train, weights_digest
from hearth.storage.parallel import Seen, unseen

NAME = "clips-seen"
"""Name of the model's checkpoints."""

AT_ONCE = 128
"""Clips that are classified at once."""


class Scored(NamedTuple):
    """The scores of a classifier for clips, as logarithms of probabilities.

    Attributes:
        actions: (N, A).
        objects: (N, 2, A, rows) of each action's first and second object.
    """

    actions: NDArray[np.float32]
    objects: NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class SeenModel(Settings):
    """Settings of the classifier.

    Attributes:
        width, layers: of the transformer.
        vector: numbers that are learned for a class.
        dropout: share of numbers left out in training.
        unnamed: share of classes whose learned numbers are left out in training.
        batch: clips in a batch.
        balance: the power of a class's share by which its loss is divided: 0 counts clips, 1 classes.
        films: of training, at most; 0 for all.
        context: whether seconds before and after a clip are looked at, too, which the thesis's networks do not see.
        masks: a checkpoint of `masks`: films with colours are learned from as it predicts them, too, and those of
            `validation` alone decide when to stop; "" for true masks alone.
    """

    width: int = 96
    layers: int = 2
    vector: int = 16
    dropout: float = 0.2
    unnamed: float = 0.5
    batch: int = 64
    balance: float = 0.5
    films: int = 0
    context: bool = False
    masks: str = ""

    def fitting(self) -> None:
        """Check that the heads divide the width."""
        self.multiple("width", HEADS, "the heads of the transformer share it")

    def fit(self, dataset: Dataset, how: Training, seen: Seen = unseen) -> TrainedSeenModel:
        """Train on the clips of `train`; those of `validation` decide when to stop.

        Raises:
            HearthError: errors of `Clips.of`; the checkpoint of `masks` is missing, or is another model.
        """
        true, checked = Clips.of(dataset, "train", self.films), Clips.of(dataset, "validation")
        parts = [true]
        if self.masks:
            known = predicted(self.masks, dataset, "train", self.films)
            checked = predicted(self.masks, dataset, "validation")
            parts.append(known)
        learned = [clip.done for part in parts for clip in part.clips]
        table = ClassTable.of(dataset.knowledge, learned)
        shown = joined([seen_clips(part, table, self.context) for part in parts])
        looked_at = seen_clips(checked, table, self.context)
        torch.manual_seed(how.seed)
        model = TrainedSeenModel(self, table, StepOrder.of(programs_of(true)), self.network(table).to(device()))
        wanted = torch.tensor([*map(table.numbers, learned)])
        labels: tuple[Sequence[Hashable], ...] = ([each.action for each in learned], [each.objects for each in learned])
        weights = torch.tensor(np.stack([*map(self._weights, labels)], 1), dtype=torch.float32)

        def batches(random: Random) -> Iterator[tuple[SeenBatch, torch.Tensor, torch.Tensor]]:
            order = random.sample(range(len(learned)), len(learned))
            for start in range(0, len(order), self.batch):
                which = np.array(order[start : start + self.batch])
                batch = tensors(shown.part(which)).mirrored(torch.rand(len(which)) < 0.5)
                yield batch, wanted[which], weights[which]

        def loss(batch: tuple[SeenBatch, torch.Tensor, torch.Tensor]) -> torch.Tensor:
            return loss_of(model.network, *moved(batch, place_of(model.network)))

        def validate() -> float:
            return accuracies([clip.done for clip in checked.clips], model.named_of(looked_at))["mean"]

        data = [facts_of(dataset)["digest"], self.masks and weights_digest(mask_predictor(self.masks).network)]
        task = Task(model.network, batches, loss, validate, [asdict(self), len(learned), len(table), *data])
        model.facts.update({"clips": len(learned), "seed": how.seed, **train(task, how, seen).record()})
        return model

    def _weights(self, labels: Sequence[Hashable]) -> NDArray[np.float64]:
        counts = Counter(labels)
        found = np.array([counts[label] ** -self.balance for label in labels], np.float64)
        weights: NDArray[np.float64] = found / found.mean()
        return weights

    def network(self, table: ClassTable) -> SeenNetwork:
        """Return the network, with random weights."""
        named = torch.zeros(len(table) + 1, dtype=torch.bool)
        named[list(table.named)] = True
        tensors = torch.from_numpy(table.traits), torch.from_numpy(table.afforded), named
        times = len(offsets(FRAMES, self.context))
        return SeenNetwork(*tensors, times, self.width, self.layers, self.vector, self.dropout, self.unnamed)

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> TrainedSeenModel:
        """Return the model of a checkpoint."""
        settings, table = cls.of(checkpoint.settings), ClassTable.read(checkpoint.content["table"])
        network = filled(lambda: settings.network(table), checkpoint.weights).to(device())
        order = StepOrder.read(checkpoint.content["order"])
        return TrainedSeenModel(settings, table, order, network, dict(checkpoint.trained))


def tensors(shown: SeenClips) -> SeenBatch:
    """Clips for the network; places for classes that no clip fills are left out."""
    most = max(int((shown.classes > 0).sum(1).max(initial=0)), 1)
    full = shown._replace(classes=shown.classes[:, :most], numbers=shown.numbers[:, :most])
    classes, numbers, people, crops = (torch.from_numpy(np.ascontiguousarray(each)) for each in full)
    return SeenBatch(classes.long(), numbers.float(), people.float(), crops.long())


@dataclass(frozen=True)
class TrainedSeenModel(OfFilms):
    """A trained classifier."""

    name = NAME

    settings: SeenModel
    table: ClassTable
    order: StepOrder
    network: SeenNetwork
    facts: dict[str, Any] = field(default_factory=dict)

    def named(self, clips: Clips) -> list[Instruction]:
        """Return the instruction that each clip is taken for."""
        return self.named_of(seen_clips(clips, self.table, self.settings.context))

    def named_of(self, shown: SeenClips) -> list[Instruction]:
        """Return the instructions predicted from features of clips.

        The most probable action and its most probable objects.
        """
        found = []
        for scores in self._scored(shown):
            actions = scores.actions.argmax(1)
            objects = scores.objects[np.arange(len(actions)), :, actions].argmax(-1)  # (N, 2)
            found += [
                self._instruction(action, rows) for action, rows in zip(actions.tolist(), objects.tolist(), strict=True)
            ]
        return found

    def _instruction(self, action: int, rows: Sequence[int]) -> Instruction:
        names = tuple(self.table.names[row - 1] for row in rows[: self.table.objects[action]])
        return Instruction(self.table.actions[action], names)

    def readings(self, clips: Clips) -> Iterator[Reading]:
        """Yield the possible instructions of the clips of each film, film by film."""
        for found in self.scored(clips):
            yield reading(found.actions, found.objects, self.table)

    def scored(self, clips: Clips) -> Iterator[Scored]:
        """Yield the scores of the clips of each film, film by film."""
        for part in clips.by_film():
            shown = seen_clips(part, self.table, self.settings.context)
            yield Scored(*(np.concatenate(columns) for columns in zip(*self._scored(shown), strict=True)))

    def _scored(self, shown: SeenClips) -> Iterator[Scored]:
        self.network.eval()
        place = place_of(self.network)
        every = torch.arange(len(self.table.actions), device=place)[None]
        for start in range(0, len(shown.classes), AT_ONCE):
            with torch.no_grad():
                batch = moved(tensors(shown.part(slice(start, start + AT_ONCE))), place)
                clip, classes = self.network.read(batch)
                asked = every.expand(len(clip), -1)
                objects = [self.network.objects(batch, clip, classes, asked, number) for number in range(PLACES)]
                found = Scored(self.network.actions(clip).cpu().numpy(), torch.stack(objects, 1).cpu().numpy())
            yield found  # outside: generators that take turns would leave gradients off

    def checkpoint(self) -> Checkpoint:
        """Return all that `restored` needs."""
        weights = {name: value.cpu().numpy() for name, value in self.network.state_dict().items()}
        content = {"table": self.table.document(), "order": self.order.document()}
        return Checkpoint(NAME, asdict(self.settings), content, weights, self.facts)
