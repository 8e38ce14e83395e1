"""Clips as vectors for an encoder: the expected vectors of their actions and objects (thesis 4.3.3)."""

import torch
from torch import Tensor, nn


class ClipReader(nn.Module):
    """Vectors of clips, computed from the probabilities of their actions and objects.

    The thesis takes the embedding of the instruction that a clip is taken for; here every action and object counts by
    its probability. A class is known by its properties and by learned numbers, of which some classes' are left out in
    training, so that classes that training never has as objects are understood.

    Args:
        actions: how many the classifier knows.
        traits: (C, traits) the properties of classes; row 0 stands for no object.
        size: of the vectors of actions, first and second objects; `width` is that of all three.
        unnamed: share of classes whose learned numbers are left out in training.
    """

    def __init__(self, actions: int, traits: Tensor, size: int, unnamed: float) -> None:
        super().__init__()
        self.actions, self.unnamed, self.width = actions, unnamed, 3 * size
        self.of_actions = nn.Linear(actions + 1, size)
        self.of_classes = nn.Embedding(len(traits), size)
        nn.init.normal_(self.of_classes.weight, std=0.1)
        self.of_traits = nn.Linear(traits.shape[1], size, bias=False)
        self.register_buffer("traits", traits, persistent=False)

    def forward(self, clips: Tensor) -> Tensor:
        """Map (B, L, A + 1 + 2 C) probabilities of actions, length, first and second objects to (B, L, width)."""
        learned = self.of_classes.weight
        if self.training:
            learned = learned * (torch.rand(len(learned), 1, device=learned.device) >= self.unnamed)
        vectors = learned + self.of_traits(self.traits)  # (C, size)
        actions, first, second = clips.split((self.actions + 1, len(vectors), len(vectors)), -1)
        return torch.cat((self.of_actions(actions), first @ vectors, second @ vectors), -1)
