"""ResActGraph and its kin (thesis 5.4.2, tables 5.2 and 5.3): settings, training, and decoding."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from random import Random
from typing import Any, NamedTuple

import numpy as np
import torch

from hearth.models.checkpoint import Checkpoint
from hearth.models.checkpoint_weights import filled
from hearth.models.decoding.scorers import Asked, Part, Scores
from hearth.models.decoding.search import Search, Start, decode
from hearth.models.devices import device
from hearth.models.interface import Request, Settings, Steps, Training, texts
from hearth.models.sketches.graph_inputs import NO_NODE, Batch, GraphInput, batched, graph_input, targets
from hearth.models.sketches.graph_network import Change, GraphNetwork, Memory, loss_of
from hearth.models.sketches.name_numbers import Words
from hearth.models.sketches.sketch_examples import grounded
from hearth.models.text_examples import Corpus, Example
from hearth.models.training import Task, train
from hearth.schemas.program import Program, Step
from hearth.simulation.world.world import World
from hearth.storage.parallel import Seen, unseen

Row = tuple[GraphInput, np.ndarray]


@dataclass(frozen=True, slots=True)
class GraphModel(Settings):
    """A model of table 5.2.

    Attributes:
        change: `residual` is ResActGraph, `layer` FCActGraph, `recurrent` GRUActGraph, `none` Graph.
        rounds: of messages, K; 0 is Unaries.
        size: of a node's state.
        hidden: of encoder and decoder.
        batch: programs at a time.
        programs: that are learned from, at most.
        constrained: whether only possible steps are written; the thesis's models are free.
    """

    change: Change = "residual"
    rounds: int = 2
    size: int = 32
    hidden: int = 128
    batch: int = 32
    programs: int = 4_000
    constrained: bool = True

    def fit(self, corpus: Corpus, how: Training, seen: Seen = unseen) -> TrainedGraphModel:
        """Learn from the executions of the training part; those of the validation part decide when to stop.

        Raises:
            HearthError: BAD_ARGUMENT, if there are no sketches for validation.
        """
        checked, knowledge = corpus.checked(sketches=True), corpus.dataset.knowledge
        words = Words.of(knowledge)
        actions = tuple(sorted(name for name, action in knowledge.actions.items() if action.executed))
        learn = list(self._rows(corpus, corpus.train, self.programs, how.seed, words, actions))
        check = list(self._rows(corpus, checked, self.programs // 8 + 1, how.seed, words, actions))
        torch.manual_seed(how.seed)
        network = self.network(words, actions)

        def batches(random: Random) -> Iterable[Batch]:
            return _batches(random.sample(learn, len(learn)), self.batch)

        def validate() -> float:
            return -float(np.mean([float(loss_of(network, batch)) for batch in _batches(check, self.batch)]))

        identity = [asdict(self), len(learn), corpus.facts]
        task = Task(network, batches, lambda batch: loss_of(network, batch), validate, identity)
        outcome = train(task, how, seen)
        return TrainedGraphModel(self, words, actions, network, {"programs": len(learn), **outcome.record()})

    def _rows(
        self, corpus: Corpus, examples: Sequence[Example], most: int, seed: int, words: Words, actions: Sequence[str]
    ) -> Iterator[Row]:
        for each in grounded(corpus.dataset, examples, most, seed, "graphs"):
            given = graph_input(Program(steps=each.sketch).unbound().steps, each.world, words)
            yield given, targets(each.steps, given, each.world, actions)

    def network(self, words: Words, actions: Sequence[str]) -> GraphNetwork:
        """Return the network, with random weights."""
        return GraphNetwork(words.size, len(actions), self.size, self.hidden, self.rounds, self.change)

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> TrainedGraphModel:
        """Return the model of a checkpoint."""
        device()
        settings, content = cls.of(checkpoint.settings), checkpoint.content
        classes, actions, written = (texts(content[name]) for name in ("classes", "actions", "written"))
        words = Words(classes, actions)
        network = filled(lambda: settings.network(words, written), checkpoint.weights)
        return TrainedGraphModel(settings, words, written, network, dict(checkpoint.trained))


def _batches(rows: Sequence[Row], size: int) -> Iterator[Batch]:
    """Batches of programs of like lengths, in the order of the rows' first."""
    for first in range(0, len(rows), size * 8):
        window = sorted(rows[first : first + size * 8], key=lambda row: len(row[1]))
        for start in range(0, len(window), size):
            inputs, steps = zip(*window[start : start + size], strict=True)
            yield batched(inputs, steps)


@dataclass(frozen=True)
class TrainedGraphModel:
    """A trained model of table 5.2."""

    settings: GraphModel
    words: Words
    actions: tuple[str, ...]
    network: GraphNetwork
    learned: dict[str, Any] = field(default_factory=dict)

    def predict(self, requests: Sequence[Request], beam: int = 1) -> list[Steps]:
        """Return a program for each request with a sketch and a world; without a world none."""
        asked = [each for each in requests if each.world is not None]
        starts = [Start(each.world, each.sketch, rules=each.rules) for each in asked if each.world is not None]
        search = Search(beam=beam, constrained=self.settings.constrained)
        found = dict(zip((each.id for each in asked), decode(self.scorer(), starts, search), strict=True))
        return [found.get(each.id, ()) for each in requests]

    def free(self) -> TrainedGraphModel:
        """Return the same model without the mask, as the thesis has it."""
        return replace(self, settings=replace(self.settings, constrained=False))

    def scorer(self) -> GraphScorer:
        """Return the model as a scorer of the parts of steps."""
        return GraphScorer(self.network, self.words, self.actions)

    def checkpoint(self) -> Checkpoint:
        """Return all that `restored` needs."""
        weights = {name: value.detach().cpu().numpy() for name, value in self.network.state_dict().items()}
        content = {"classes": self.words.classes, "actions": self.words.actions, "written": self.actions}
        lists = {name: list(values) for name, values in content.items()}
        return Checkpoint("resactgraph", asdict(self.settings), lists, weights, self.learned)


class _State(NamedTuple):
    """The memory of one program, and where its graph's nodes stand in the home."""

    memory: Memory
    place: dict[int, int]
    nodes: np.ndarray


class GraphScorer:
    """A network as decoding sees it. Steps are scored in batches of graphs of any size."""

    order = (Part.FIRST, Part.ACTION, Part.SECOND)

    def __init__(self, network: GraphNetwork, words: Words, actions: Sequence[str]) -> None:
        self.network, self.words, self.actions = network, words, tuple(actions)

    @torch.no_grad()  # type: ignore[untyped-decorator]
    def begin(self, worlds: Sequence[World], inputs: Sequence[Steps]) -> list[_State]:
        """Return the memory before the first step of each sketch."""
        given = [graph_input(sketch, world, self.words) for world, sketch in zip(worlds, inputs, strict=True)]
        if not given:
            return []
        memory = self.network.begin(batched(given))
        places = [{node: n for n, node in enumerate(each.nodes)} for each in given]
        return [_State(_one(memory, n), places[n], np.array(each.nodes)) for n, each in enumerate(given)]

    @torch.no_grad()  # type: ignore[untyped-decorator]
    def score(self, asked: Sequence[Asked], part: Part) -> list[Scores]:
        """Return the scores of nodes or actions; -inf for nodes that the graph leaves out."""
        memory = _many([each.state.memory for each in asked])
        first = torch.tensor([self._place(each, each.chosen.first) for each in asked])
        if part is Part.FIRST:
            values = self.network.scores_first(memory).numpy()
            return [self._spread(each, row, special=2) for each, row in zip(asked, values, strict=True)]
        if part is Part.ACTION:
            return [Scores(row) for row in self.network.scores_action(memory, first).numpy()]
        action = torch.tensor([self.actions.index(each.chosen.action or "") for each in asked])
        values = self.network.scores_second(memory, first, action).numpy()
        return [self._spread(each, row, special=0) for each, row in zip(asked, values, strict=True)]

    def _spread(self, asked: Asked, row: np.ndarray, special: int) -> Scores:
        count = len(asked.world.home)
        values = np.full(count + special, -np.inf)
        values[asked.state.nodes] = row[: len(asked.state.nodes)]
        if special:
            values[count:] = row[-special:]
        return Scores(values)

    def _place(self, asked: Asked, node: int | None) -> int:
        return NO_NODE if node is None else asked.state.place.get(node, NO_NODE)

    @torch.no_grad()  # type: ignore[untyped-decorator]
    def advance(self, asked: Sequence[Asked], steps: Sequence[Step]) -> list[_State]:
        """Return the memory after a step of each program."""
        if not asked:
            return []
        places = []
        for each, step in zip(asked, steps, strict=True):
            index = each.world.home.index
            nodes = [each.state.place.get(index[ref.node], NO_NODE) for ref in step.objects if ref.node is not None]
            places.append([self.actions.index(step.action), *[*nodes, NO_NODE, NO_NODE][:2]])
        action, first, second = torch.tensor(places).unbind(1)
        memory = self.network.after(_many([each.state.memory for each in asked]), action, first, second)
        return [each.state._replace(memory=_one(memory, n)) for n, each in enumerate(asked)]


def _one(memory: Memory, row: int) -> Memory:
    return Memory(*(tensor[row : row + 1] for tensor in memory))


def _many(memories: Sequence[Memory]) -> Memory:
    """Memories as one; graphs are filled up to the largest."""
    most = max(each.nodes.shape[1] for each in memories)

    def filled(tensor: torch.Tensor) -> torch.Tensor:
        missing = most - tensor.shape[1]
        return torch.nn.functional.pad(tensor, (0, 0, 0, missing) if tensor.dim() == 3 else (0, missing))

    nodes, real = (torch.cat([filled(each[n]) for each in memories]) for n in (0, 1))
    sketch, hidden = (torch.cat([each[n] for each in memories]) for n in (2, 3))
    return Memory(nodes, real, sketch, hidden)
