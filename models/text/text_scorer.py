"""A model of texts or films as decoding with the engine in the loop sees it: its classes score the nodes of a home."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import torch

from hearth.kb.knowledge import Knowledge
from hearth.models.decoding.scorers import Asked, Part, Scores
from hearth.models.text.program_writer import Draft, Writer
from hearth.models.text.seq2seq import Memory
from hearth.models.text.step_heads import NEVER, ComposedHead, Context
from hearth.models.text.step_vocabulary import StepVocabulary
from hearth.models.text.text_batches import InputBatch
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import Step
from hearth.simulation.world import edge_rows
from hearth.simulation.world.world import World

STAND_IN = 0.5
"""Penalty of a node whose class is not the named one but one that can replace it, in score."""

AWAY = 0.25
"""Penalty of a node that is not close to the agent, in score; twice as much if the program uses another of its class.
"""


class Place(NamedTuple):
    """A program so far, and the head's input after it; each has one row."""

    draft: Draft
    context: Context


class TextScorer:
    """Scores actions, then nodes as first and second objects. A node has the score of its class."""

    order = (Part.ACTION, Part.FIRST, Part.SECOND)

    def __init__(self, writer: Writer, vocabulary: StepVocabulary, read: Callable[[Sequence[Any]], InputBatch]) -> None:
        """`read` makes a batch of the inputs of programs.

        Raises HearthError, BAD_ARGUMENT: the model chooses whole steps of a list.
        """
        if not isinstance(writer.head, ComposedHead):
            message = "a model with a closed list of steps can't be decoded with the engine in the loop"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="use one with composed steps: `mle-composed`")
        self.writer, self.head, self.vocabulary = writer.eval(), writer.head, vocabulary
        self.actions, self.read = vocabulary.actions, read
        self._nodes: dict[int, dict[str, list[tuple[int, float]]]] = {}

    def begin(self, worlds: Sequence[World], inputs: Sequence[Any]) -> list[Place]:
        """Return the places before the first steps.

        The inputs are those that `read` reads: requests, of films their clips.
        """
        with torch.no_grad():
            return self._places(self.writer.begin(self.read(inputs)))

    def score(self, asked: Sequence[Asked], part: Part) -> list[Scores]:
        """Return the logarithms of the probabilities of actions and of the end, or the scores of nodes."""
        context = Context(*(torch.cat(found) for found in zip(*(each.state.context for each in asked), strict=True)))
        with torch.no_grad():
            if part is Part.ACTION:
                found = self.head.actions(context)  # (N, 1 + A), the end first
                return [Scores(row) for row in torch.cat((found[:, 1:], found[:, :1]), 1).cpu().double().numpy()]
            action = torch.tensor([self.vocabulary.action_numbers[each.chosen.action or ""] for each in asked])
            first = torch.tensor([self._class(each.world, each.chosen.first) for each in asked])
            device = self.writer.device
            found = self.head.objects(context, int(part is Part.SECOND), action.to(device), first.to(device))
        return [
            Scores(self._of_nodes(each, row)) for each, row in zip(asked, found.cpu().double().numpy(), strict=True)
        ]

    def advance(self, asked: Sequence[Asked], steps: Sequence[Step]) -> list[Place]:
        """Return the places after steps."""
        if not steps:
            return []
        numbers = [self._numbers(each.world, step) for each, step in zip(asked, steps, strict=True)]
        with torch.no_grad():
            draft = _joined([each.state.draft for each in asked])
            return self._places(self.writer.write(draft, torch.tensor(numbers, device=self.writer.device)))

    def _places(self, draft: Draft) -> list[Place]:
        draft, context = self.writer.look(draft)
        every = (torch.tensor([row], device=self.writer.device) for row in range(len(draft.last)))
        return [Place(draft.rows(row), Context(*(part[row] for part in context))) for row in every]

    def _numbers(self, world: World, step: Step) -> tuple[int, int, int]:
        nodes = [self._class(world, world.home.index[ref.node or 0]) for ref in step.objects]
        first, second, *_ = (*nodes, 0, 0)
        return self.vocabulary.action_numbers[step.action], first, second

    def _class(self, world: World, node: int | None) -> int:
        """Return the number of a node's class, 0 for none."""
        if node is None or node < 0:
            return 0
        found = self._classes(world.home.knowledge).get(world.home.classes[node])
        return found[0][0] if found else 0

    def _of_nodes(self, asked: Asked, scores: np.ndarray) -> np.ndarray:
        """(nodes,) scores from (C,): of the best of the classes that a node may stand for; -inf where there is none."""
        world, home = asked.world, asked.world.home
        known = self._classes(home.knowledge)
        best = {
            name: max((scores[number] - loss for number, loss in known.get(name, ())), default=NEVER)
            for name in home.by_class
        }
        used = {home.index[ref.node] for step in asked.steps for ref in step.objects if ref.node in home.index}
        names = {home.classes[node] for node in used}
        found = np.full(len(home.ids), -np.inf)
        agent = world.agents[0]
        for node, name in enumerate(home.classes):
            if best[name] > NEVER / 2:
                away = (
                    0 if node in used else AWAY * (2 if name in names else not edge_rows.is_close(world, agent, node))
                )
                found[node] = best[name] - away
        return found

    def _classes(self, knowledge: Knowledge) -> dict[str, list[tuple[int, float]]]:
        """Return for each class of nodes the classes that it may stand for, and the cost of each; itself first."""
        known = self._nodes.get(id(knowledge))
        if known is None:
            known = self._nodes[id(knowledge)] = {}
            for number, name in enumerate(self.vocabulary.classes, 1):
                for other in knowledge.same_class(name):
                    known.setdefault(other, []).append((number, 0.0 if other == name else STAND_IN))
            for pairs in known.values():
                pairs.sort(key=lambda pair: pair[1])
        return known


def _joined(drafts: Sequence[Draft]) -> Draft:
    """Drafts of one row each as one."""
    memory = Memory(*(torch.cat(found) for found in zip(*(each.memory for each in drafts), strict=True)))
    state = tuple(torch.cat(found) for found in zip(*(each.state for each in drafts), strict=True))
    return Draft(memory, state, torch.cat([each.last for each in drafts]), torch.cat([each.used for each in drafts]))
