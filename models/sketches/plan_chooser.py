"""The learned chooser on the exact planner: it chooses nodes for a sketch, and steps that the plan may do without.

The planner and the mask ensure that each program runs. The network makes it similar to people's programs.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from itertools import islice
from random import Random
from typing import Any

import numpy as np
import torch

from hearth.kb.knowledge import Knowledge
from hearth.models.checkpoint import Checkpoint
from hearth.models.checkpoint_weights import filled
from hearth.models.decoding.scorers import Asked, Part, Scores
from hearth.models.decoding.search import Search, Start, decode
from hearth.models.devices import device
from hearth.models.interface import Request, Settings, Steps, Training
from hearth.models.sketches.candidate_choices import Choice, Packed, joined, packed
from hearth.models.sketches.candidate_ranker import Ranker, best, log_probabilities, loss_of
from hearth.models.sketches.chooser_examples import node_choices, step_choices
from hearth.models.sketches.name_numbers import Words
from hearth.models.sketches.next_steps import Habits
from hearth.models.sketches.node_features import KINDS, NUMBERS, Places, node_choice
from hearth.models.sketches.sketch_examples import grounded
from hearth.models.sketches.sketch_progress import Progress
from hearth.models.sketches.step_features import CANDIDATE_NUMBERS, Offer
from hearth.models.sketches.text_features import AROUND, NO_CLUES, Clues, frequent
from hearth.models.text_examples import Corpus, Example
from hearth.models.training import Outcome, Task, train
from hearth.repair.sketch_plan import bound_to_nearest, complete_steps
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.simulation.rules import Rules
from hearth.simulation.world.world import World
from hearth.storage.parallel import Seen, unseen

NO_HABITS = Habits(frozenset(), (), {})

PARTS = ("train", "validation")

SIZES = {"nodes": (7, 1, KINDS, NUMBERS), "steps": (15, 25, 3 + AROUND, CANDIDATE_NUMBERS)}
"""Numbers of names and numbers, of a choice and of a candidate."""

PACK = 3_000
"""Choices whose features are packed at once: as lists they take ten times the memory."""


@dataclass(frozen=True, slots=True)
class Chooser(Settings):
    """A chooser of nodes and steps.

    Attributes:
        programs: from which steps are learned, at most; nodes are learned from all.
        width: of embeddings.
        hidden: units of the first layer.
        dropout: of hidden units.
        batch: choices at a time.
        nodes: whether nodes are chosen, or the nearest are taken.
        style: whether optional steps are chosen, or the plan is taken.
        text: whether the title and the description are read, in addition to the sketch.
    """

    programs: int = 2_500
    width: int = 16
    hidden: int = 128
    dropout: float = 0.1
    batch: int = 256
    nodes: bool = True
    style: bool = True
    text: bool = False

    def fit(self, corpus: Corpus, how: Training, seen: Seen = unseen) -> TrainedChooser:
        """Learn from the executions of the training part; those of the validation part decide when to stop.

        Raises:
            HearthError: BAD_ARGUMENT, if there are no sketches for validation.
        """
        corpus.checked(sketches=True)
        own = {each.description: each.request for each in corpus.train}
        words = Words.of(corpus.dataset.knowledge, frequent(own.values()) if self.text else ())
        habits = Habits.of(
            ((each.sketch, each.steps) for each in corpus.train if any(each.keep)), corpus.dataset.knowledge
        )
        learned: dict[str, Any] = {}
        rankers = {}
        for name, wanted in (("nodes", self.nodes), ("steps", self.style)):
            if wanted:
                learn, check = (self._choices(name, corpus, part, how.seed, habits, words) for part in PARTS)
                if learn is None or check is None:  # no object has two candidates, or nothing is to be learned from
                    continue
                rankers[name], outcome = self._trained(name, learn, check, how, words, seen)
                learned[name] = {"choices": len(learn), **outcome.record()}
        minutes = round(sum(each["minutes"] for each in learned.values()), 2)
        return TrainedChooser(self, words, habits, rankers, {"minutes": minutes, **learned})

    def _choices(self, name: str, corpus: Corpus, part: str, seed: int, habits: Habits, words: Words) -> Packed | None:
        examples: Sequence[Example] = corpus.train if part == "train" else corpus.validation
        if name == "nodes":
            return _packed(node_choices(grounded(corpus.dataset, examples), words))
        most = self.programs if part == "train" else max(1, self.programs // 8)
        found = grounded(corpus.dataset, examples, most, seed, part)
        return _packed(step_choices(found, habits, words, text=self.text))

    def _trained(
        self, name: str, learned: Packed, checked: Packed, how: Training, words: Words, seen: Seen
    ) -> tuple[Ranker, Outcome]:
        torch.manual_seed(how.seed)
        ranker = self.ranker(words, [column.shape[1] for column in (learned[0], *learned[2:5])])

        def batches(random: Random) -> Iterable[Packed]:
            order = np.array(random.sample(range(len(learned)), len(learned)))
            return (learned.part(order[first : first + self.batch]) for first in range(0, len(order), self.batch))

        def validate() -> float:
            parts = (checked.part(range(n, min(n + 2_000, len(checked)))) for n in range(0, len(checked), 2_000))
            return -sum(float(loss_of(ranker, part)) * len(part) for part in parts) / max(1, len(checked))

        folder = how.folder / name if how.folder else None
        how = Training(how.seed, how.epochs, how.minutes, how.rate, how.clip, how.patience, how.halve_after, folder)
        identity = [name, asdict(self), len(learned), len(checked)]
        outcome = train(Task(ranker, batches, lambda batch: loss_of(ranker, batch), validate, identity), how, seen)
        return ranker, outcome

    def ranker(self, words: Words, sizes: Sequence[int]) -> Ranker:
        """Return a network for choices with these numbers of names and numbers, of the choice and of a candidate."""
        names, numbers, more, values = sizes
        return Ranker(words.size, names, numbers, more, values, self.width, self.hidden, self.dropout)

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> TrainedChooser:
        """Return the model of a checkpoint."""
        device()
        settings, content = cls.of(dict(checkpoint.settings)), checkpoint.content
        words = Words(content["classes"], content["actions"], content["words"])
        tools = {name: tuple(each) for name, each in content["tools"].items()}
        habits = Habits(frozenset(content["optional"]), tuple(content["style"]), tools)
        rankers = {}
        for name, sizes in content["sizes"].items():
            if tuple(sizes) != SIZES[name]:
                raise ValueError(f"choices of {name} have other features in this version")
            named = checkpoint.weights.items()
            own = {key.removeprefix(f"{name}."): value for key, value in named if key.startswith(f"{name}.")}
            rankers[name] = filled(partial(settings.ranker, words, sizes), own)
        return TrainedChooser(settings, words, habits, rankers, dict(checkpoint.trained))


def _packed(choices: Iterable[Choice]) -> Packed | None:
    found = iter(choices)
    parts = []
    while share := list(islice(found, PACK)):
        parts.append(packed(share))
    return joined(parts) if parts else None


@dataclass(frozen=True)
class TrainedChooser:
    """A trained chooser."""

    settings: Chooser
    words: Words
    habits: Habits
    rankers: Mapping[str, Ranker]
    learned: Mapping[str, Any]

    def predict(self, requests: Sequence[Request], beam: int = 1) -> list[Steps]:
        """Return a program for each request with a sketch and a world; it runs there."""
        worlds = [_world(request) for request in requests]
        sketches = self.bound([request.sketch for request in requests], worlds)
        clues = [self._clues(request, world) for request, world in zip(requests, worlds, strict=True)]
        starts = [
            Start(world, (sketch, clue, request.rules), rules=request.rules)
            for world, sketch, clue, request in zip(worlds, sketches, clues, requests, strict=True)
        ]
        search = Search(beam=beam, least=0)
        programs = decode(self.scorer(), starts, search)
        every = zip(programs, sketches, worlds, strict=True)
        return [_named(program, sketch, world.home.knowledge) for program, sketch, world in every]

    def _clues(self, request: Request, world: World) -> Clues:
        return Clues.of(request, world.home.knowledge) if self.settings.text else NO_CLUES

    def scorer(self) -> PlanScorer:
        """Return the model as a scorer of steps; its input is the bound sketch, the text's clues, and the rules."""
        return PlanScorer(self.rankers.get("steps"), self.habits if self.settings.style else NO_HABITS, self.words)

    def bound(self, sketches: Sequence[Steps], worlds: Sequence[World]) -> list[Steps]:
        """Sketches bound to nodes, object by object, those of all sketches at once; steps without a node go."""
        ranker = self.rankers.get("nodes")
        if ranker is None:
            return [bound_to_nearest(sketch, world) for sketch, world in zip(sketches, worlds, strict=True)]
        free = [Program(steps=sketch).unbound().steps for sketch in sketches]
        places = [Places(world, sketch, self.words) for world, sketch in zip(worlds, free, strict=True)]
        nodes: list[dict[tuple[str, int], int]] = [{} for _ in places]
        for turn in range(max((len(each.objects) for each in places), default=0)):
            asked = [n for n, each in enumerate(places) if turn < len(each.objects)]
            asked = [n for n in asked if places[n].candidates[places[n].objects[turn].key]]
            choices = [node_choice(places[n], places[n].objects[turn], nodes[n]) for n in asked]
            for n, found in zip(asked, _chosen(ranker, choices), strict=True):
                use = places[n].objects[turn]
                nodes[n][use.key] = places[n].candidates[use.key][found]
        return [_bound(sketch, found, world) for sketch, found, world in zip(free, nodes, worlds, strict=True)]

    def checkpoint(self) -> Checkpoint:
        """Return all that `restored` needs."""
        weights = {
            f"{name}.{key}": value.detach().cpu().numpy()
            for name, ranker in self.rankers.items()
            for key, value in ranker.state_dict().items()
        }
        content = {
            "classes": list(self.words.classes),
            "actions": list(self.words.actions),
            "words": list(self.words.words),
            "optional": sorted(self.habits.actions),
            "style": list(self.habits.style),
            "tools": {name: list(found) for name, found in sorted(self.habits.tools.items())},
            "sizes": {name: list(ranker.sizes) for name, ranker in self.rankers.items()},
        }
        return Checkpoint("chooser", asdict(self.settings), content, weights, dict(self.learned))


def _world(request: Request) -> World:
    assert request.world is not None, "a chooser needs the world"
    return request.world


def _chosen(ranker: Ranker, choices: Sequence[Choice]) -> list[int]:
    if not choices:
        return []
    batch = packed(choices)
    with torch.no_grad():
        return best(ranker(batch), torch.as_tensor(batch.starts))


def _bound(sketch: Steps, nodes: Mapping[tuple[str, int], int], world: World) -> Steps:
    ids = {key: world.home.ids[node] for key, node in nodes.items()}
    return complete_steps(Program(steps=sketch).bound(ids).steps)


def _named(steps: Steps, sketch: Steps, known: Knowledge) -> Steps:
    """Return a program that calls nodes as the sketch does, where that name affords all that is done to the node.

    A kitchen may serve as the sketch's dining room; a box of cereal that is opened is not called food.
    """
    names = {ref.node: ref.name for step in sketch for ref in step.objects}
    for step in steps:
        for position, ref in enumerate(step.objects):
            if ref.node in names and not known.affords(step.action, position, names[ref.node]):
                del names[ref.node]

    def renamed(ref: ObjectRef) -> ObjectRef:
        return ObjectRef(names.get(ref.node, ref.name), ref.instance, ref.node)

    return tuple(Step(step.action, tuple(map(renamed, step.objects))) for step in steps)


class PlanScorer:
    """A scorer of whole steps that the sketch and the plan offer.

    Without a network the plan's own step is the best: the planner.
    """

    order = (Part.STEP,)
    actions: Sequence[str] = ()

    def __init__(self, ranker: Ranker | None, habits: Habits, words: Words) -> None:
        self.ranker, self.habits, self.words = ranker, habits, words

    def begin(self, worlds: Sequence[World], inputs: Sequence[tuple[Steps, Clues, Rules]]) -> list[Progress]:
        """Return the progress before the first step of each bound sketch."""
        given = zip(worlds, inputs, strict=True)
        return [Progress.start(sketch, world, rules, clues) for world, (sketch, clues, rules) in given]

    def advance(self, asked: Sequence[Asked], steps: Sequence[Step]) -> list[Progress]:
        """Return the progress after each step."""
        return [each.state.after(step, each.world) for each, step in zip(asked, steps, strict=True)]

    def score(self, asked: Sequence[Asked], part: Part) -> list[Scores]:
        """Return the scores of the offered steps; the end has one only where nothing of the sketch is left."""
        offers = [self._offer(each) for each in asked]
        if self.ranker is None:
            return [_as_planned(offer) for offer in offers]
        found: list[Scores] = [_ended() for _ in offers]
        open_ = [n for n, offer in enumerate(offers) if offer.candidates]
        if open_:
            batch = packed(offers[n].choice() for n in open_)
            starts = torch.as_tensor(batch.starts)
            with torch.no_grad():
                values = log_probabilities(self.ranker(batch), starts).numpy()
            for n, first, end in zip(open_, batch.starts, batch.starts[1:], strict=False):
                found[n] = _scores(offers[n], values[first:end])
        return found

    def _offer(self, asked: Asked) -> Offer:
        assert asked.options is not None, "a plan is made of possible steps"
        return Offer(asked.state, asked.options, self.habits, self.words)


def _scores(offer: Offer, values: np.ndarray) -> Scores:
    steps = [step for step in offer.candidates if step is not None]
    end = values[len(steps) :] if len(values) > len(steps) else np.array([-np.inf])
    return Scores(np.concatenate([values[: len(steps)], end]), steps)


def _as_planned(offer: Offer) -> Scores:
    values = np.array([0.0 if step == offer.proposed else -1.0 for step in offer.candidates])
    return _scores(offer, values)


def _ended() -> Scores:
    return Scores(np.zeros(1))
