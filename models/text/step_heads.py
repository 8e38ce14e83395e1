"""The heads of decoders, from a state to probabilities of steps: whole ones of a list, or composed of their parts."""

from collections.abc import Sequence
from typing import NamedTuple

import torch
from torch import nn
from torch.nn import functional

from hearth.models.text.step_vocabulary import END, StepVocabulary
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

NEVER = -1e9
"""Score of a choice that is never made."""


class Context(NamedTuple):
    """The decoder's state at N places of programs; D features, C classes and one.

    Attributes:
        features: (N, D) of the decoder and of the words attended to.
        attended: (N, C) the share of the attention that is on mentions of each class.
        mentioned: (N, C) 1 where the text mentions the class.
        used: (N, C) how often the program has each class so far.
        last: (N,) the first object of the step before, 0 for none.
    """

    features: torch.Tensor
    attended: torch.Tensor
    mentioned: torch.Tensor
    used: torch.Tensor
    last: torch.Tensor


class StepEmbedding(nn.Module):
    """Vectors of actions and classes (W_a, W_o of eq. 4.3): those of the words of their names, and a learned part."""

    def __init__(self, vocabulary: StepVocabulary, size: int, names: torch.Tensor) -> None:
        """`names`: (C - 1, V), the vectors of the classes' names."""
        super().__init__()
        self.actions = nn.Embedding(len(vocabulary.actions) + 2, size)  # the end, the actions, the beginning
        self.classes = nn.Embedding(len(vocabulary.classes) + 1, size, padding_idx=0)
        self.names = nn.Linear(names.shape[1], size, bias=False)
        self.register_buffer("of_names", functional.pad(names, (0, 0, 1, 0)))  # (C, V)
        nn.init.normal_(self.classes.weight, std=0.1)

    def of_classes(self) -> torch.Tensor:
        """Return (C, E) the vectors of all classes; 0 for no object."""
        return self.classes.weight + self.names(self.of_names)

    def forward(self, steps: torch.Tensor) -> torch.Tensor:
        """Map (..., 3) numbers to (..., E): the mean of the vectors of a step's parts, v of eq. 4.3."""
        objects = functional.embedding(steps[..., 1:], self.of_classes())  # (..., 2, E)
        count = 1 + (steps[..., 1:] > 0).sum(-1, keepdim=True)  # (..., 1)
        mean: torch.Tensor = (self.actions(steps[..., 0]) + objects.sum(-2)) / count
        return mean


class ComposedHead(nn.Module):
    """The action, then the first object given the action, then the second given both; objects may be copied (ours).

    A class scores by its vector, and by four facts whose weights depend on the action: whether the text mentions it,
    how much of the attention is on its mentions, whether the program has it already, and whether the step before does.
    """

    FACTS = 4

    def __init__(
        self, vocabulary: StepVocabulary, embedding: StepEmbedding, features: int, size: int, copy: bool
    ) -> None:
        super().__init__()
        self.embedding, self.copy = embedding, copy
        actions, classes = len(vocabulary.actions) + 1, len(vocabulary.classes) + 1
        self.action = nn.Linear(features, actions)
        self.query = nn.ModuleList(
            nn.Sequential(nn.Linear(features + size * (1 + place), size), nn.Tanh(), nn.Linear(size, size))
            for place in range(2)
        )
        self.bias = nn.Parameter(torch.zeros(2, classes))
        self.weigh = nn.ModuleList(nn.Linear(features + size, self.FACTS) for _ in range(2))
        for layer in (self.action, *(query[-1] for query in self.query), *self.weigh):
            nn.init.normal_(layer.weight, std=0.01)
            nn.init.zeros_(layer.bias)
        takes = torch.zeros(actions, 2, classes, dtype=torch.bool)
        for number, places in enumerate(vocabulary.takes, 1):
            for place, found in enumerate(places):
                takes[number, place, list(found)] = True
        self.register_buffer("takes", takes, persistent=False)
        self.register_buffer("arity", torch.tensor([0, *vocabulary.arity]), persistent=False)

    def actions(self, context: Context) -> torch.Tensor:
        """Return (N, A + 1) logarithms of the probabilities of the end and of each action."""
        return self.action(context.features).log_softmax(-1)

    def objects(self, context: Context, place: int, action: torch.Tensor, first: torch.Tensor) -> torch.Tensor:
        """Return (N, C) logarithms of the probabilities of each class as an argument.

        Args:
            context: N places.
            place: 0 or 1.
            action: (N,) the action.
            first: (N,) the first object, for place 1.
        """
        chosen = self.embedding.actions(action)  # (N, E)
        vectors = self.embedding.of_classes()  # (C, E)
        given = (context.features, chosen, *((functional.embedding(first, vectors),) if place else ()))
        scores = self.query[place](torch.cat(given, -1)) @ vectors.T + self.bias[place]  # (N, C)
        if self.copy:
            weights = self.weigh[place](torch.cat((context.features, chosen), -1))  # (N, 4)
            scores = scores + torch.einsum("nf,nfc->nc", weights, self._facts(context))
        allowed = self.takes[action, place]  # (N, C)
        if place:
            allowed = allowed & ~functional.one_hot(first, allowed.shape[1]).bool()
        return scores.masked_fill(~allowed, NEVER).log_softmax(-1)

    def _facts(self, context: Context) -> torch.Tensor:
        """Return (N, 4, C), each about 0 to 3, so that no weight has to be large."""
        last = functional.one_hot(context.last, context.used.shape[1]).to(context.used.dtype)
        return torch.stack((context.mentioned, context.attended, context.used.clamp(max=1), last), 1) * 3

    def log_probability(self, context: Context, steps: torch.Tensor) -> torch.Tensor:
        """Return (N,) the logarithm of the probability of each of N steps, (N, 3); of the end for the number 0."""
        action, first, second = steps.unbind(-1)
        total = self.actions(context).gather(1, action[:, None])[:, 0]
        for place, number in enumerate((first, second)):
            needed = self.arity[action] > place
            if needed.any():
                part = _rows(context, needed)
                found = self.objects(part, place, action[needed], first[needed])
                total = total.index_put(
                    (needed.nonzero()[:, 0],), found.gather(1, number[needed][:, None])[:, 0], accumulate=True
                )
        return total

    def best(self, context: Context, width: int) -> tuple[torch.Tensor, torch.Tensor]:
        """Return the `width` best steps of each place, by the best actions and their best objects.

        Returns:
            (N, width) logarithms of probabilities, best first, and (N, width, 3) steps.
        """
        count = len(context.features)
        scores, action = self.actions(context).topk(min(width, self.action.out_features))  # (N, K)
        steps = functional.pad(action[..., None], (0, 2))  # (N, K, 3)
        for place in range(2):
            kept = steps.shape[1]
            many = _repeated(context, kept)
            flat = steps.reshape(-1, 3)
            found, number = self.objects(many, place, flat[:, 0], flat[:, 1]).topk(width)  # (N K, W)
            needed = (self.arity[flat[:, 0]] > place)[:, None]
            first_only = torch.arange(width, device=flat.device) == 0
            found = torch.where(needed, found, torch.where(first_only, 0.0, NEVER))
            number = torch.where(needed, number, 0)
            total = (scores.reshape(-1, 1) + found).reshape(count, -1)  # (N, K W)
            grown = flat[:, None].repeat(1, width, 1)
            grown[..., 1 + place] = number
            scores, order = total.topk(min(width, total.shape[1]))
            steps = grown.reshape(count, -1, 3).gather(1, order[..., None].expand(-1, -1, 3))
        return scores, steps

    def sample(self, context: Context, generator: torch.Generator) -> torch.Tensor:
        """Return (N, 3) a step for each place, drawn from the probabilities."""
        action = _drawn(self.actions(context), generator)
        steps = [action]
        for place in range(2):
            number = _drawn(self.objects(context, place, action, steps[-1]), generator)
            steps.append(torch.where(self.arity[action] > place, number, 0))
        return torch.stack(steps, -1)


class ClosedHead(nn.Module):
    """One probability for each step of the training programs: eq. 4.3, with a learned temperature."""

    def __init__(self, vocabulary: StepVocabulary, embedding: StepEmbedding, features: int, size: int,
                 listed: Sequence[tuple[int, int, int]]) -> None:  # fmt: skip
        super().__init__()
        self.embedding = embedding
        self.project = nn.Linear(features, size)  # W_v
        self.scale = nn.Parameter(torch.zeros(()))
        nn.init.normal_(self.project.weight, std=0.01)
        nn.init.zeros_(self.project.bias)
        steps = [(END, 0, 0), *listed]
        self.register_buffer("steps", torch.tensor(steps), persistent=False)  # (I + 1, 3)
        self.places = {row: number for number, row in enumerate(steps)}

    def every(self, context: Context) -> torch.Tensor:
        """Return (N, I + 1) logarithms of the probabilities of the end and of each step of the list."""
        vectors = functional.normalize(self.embedding(self.steps), dim=-1)  # v / |v|, (I + 1, E)
        scores = self.project(context.features) @ vectors.T * (3 + self.scale).exp()
        return scores.log_softmax(-1)

    def log_probability(self, context: Context, steps: torch.Tensor) -> torch.Tensor:
        """Return (N,) as of `ComposedHead`; steps that the list lacks get `NEVER`."""
        found = self.every(context)
        places = [self.places.get(tuple(row), -1) for row in steps.tolist()]
        numbers = torch.tensor(places, device=found.device)
        scores = found.gather(1, numbers.clamp(min=0)[:, None])[:, 0]
        return scores.masked_fill(numbers < 0, NEVER)

    def best(self, context: Context, width: int) -> tuple[torch.Tensor, torch.Tensor]:
        """Return the most probable steps, as `ComposedHead` does."""
        scores, numbers = self.every(context).topk(min(width, len(self.steps)))
        return scores, self.steps[numbers]

    def sample(self, context: Context, generator: torch.Generator) -> torch.Tensor:
        """Return drawn steps, as `ComposedHead` does."""
        return self.steps[_drawn(self.every(context), generator)]


def _drawn(scores: torch.Tensor, generator: torch.Generator) -> torch.Tensor:
    """Return (N,) a number for each row of logarithms, drawn on the processor: the same on every device."""
    probabilities = scores.detach().exp().cpu()
    if not probabilities.isfinite().all():  # of weights so large that their products are no numbers
        message = "the network's probabilities are not numbers"
        raise HearthError.of(Code.DAMAGED_FILE, message, suggestion="train the model again")
    drawn = torch.multinomial(probabilities, 1, generator=generator)
    return drawn[:, 0].to(scores.device)


def _rows(context: Context, chosen: torch.Tensor) -> Context:
    return Context(*(part[chosen] for part in context))


def _repeated(context: Context, times: int) -> Context:
    """Return each place `times` times, one after another."""
    return Context(*(part.repeat_interleave(times, 0) for part in context)) if times > 1 else context
