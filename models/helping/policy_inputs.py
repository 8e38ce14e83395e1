"""The input of a policy at each choice, as numbers, and sequences of inputs as padded arrays."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import numpy as np

FEATURES = (
    "open", "closed", "held", "held_by_other", "same_room", "looked_into", "wanted", "target", "dx", "dz", "metres",
)  # fmt: skip
"""Features of a node in addition to its class; the last three are tens of meters from the agent."""

KINDS = ("walk", "open", "close", "grab", "put")
"""The kinds of actions of the low-level policy (B.3.4), but for `follow`, which the challenge's actions lack."""

MOST_CLASSES = 1024
"""Numbers of classes: 0 for none, 1 for one that the knowledge lacks, else 2 + its published id."""

Pair = tuple[int, int]
"""A subgoal: numbers of a class of things and of a place among `Words`; or an action: kind and number of a node."""


class Words(NamedTuple):
    """The vocabulary of subgoals: classes of things, and of the furniture or character that they are brought to."""

    things: tuple[str, ...]
    places: tuple[str, ...]

    def number(self, thing: str, place: str) -> Pair | None:
        """Return a subgoal's numbers; None where one of its words is not known."""
        known = thing in self.things and place in self.places
        return (self.things.index(thing), self.places.index(place)) if known else None


class Scene(NamedTuple):
    """One moment at which something is chosen.

    Attributes:
        classes: numbers of the classes of N visible nodes.
        features: (N, FEATURES).
        wanted: (thing, place, how many are missing) of each part of the goal, or of the subgoal alone.
        legal: (KINDS, N), the possible actions; empty where subgoals are chosen.
        close: (N,), the nodes within reach, which the low-level policy is also to predict.
    """

    classes: tuple[int, ...]
    features: tuple[tuple[float, ...], ...]
    wanted: tuple[tuple[int, int, int], ...]
    legal: tuple[tuple[bool, ...], ...] = ()
    close: tuple[bool, ...] = ()


class Trace(NamedTuple):
    """A sequence of choices and their returns: the discounted rewards from each choice to the end."""

    scenes: tuple[Scene, ...]
    choices: tuple[Pair, ...]
    returns: tuple[float, ...]


class Batch(NamedTuple):
    """B sequences of at most T scenes of at most N nodes, padded with zeros.

    Attributes:
        classes: (B, T, N).
        features: (B, T, N, FEATURES).
        wanted: (B, T, G, 3); numbers of words from 1, 0 for none.
        legal: (B, T, KINDS, N).
        close: (B, T, N).
        there: (B, T), which scenes there are.
        choices: (B, T, 2).
        returns: (B, T).
    """

    classes: np.ndarray
    features: np.ndarray
    wanted: np.ndarray
    legal: np.ndarray
    close: np.ndarray
    there: np.ndarray
    choices: np.ndarray
    returns: np.ndarray


def packed(traces: Sequence[Trace]) -> Batch:
    """Sequences as arrays."""
    import numpy as np

    most = max((len(trace.scenes) for trace in traces), default=0) or 1
    scenes = [scene for trace in traces for scene in trace.scenes]
    nodes = max((len(scene.classes) for scene in scenes), default=0) or 1
    parts = max((len(scene.wanted) for scene in scenes), default=0) or 1
    shape = (len(traces), most)
    found = Batch(
        np.zeros((*shape, nodes), np.int64),
        np.zeros((*shape, nodes, len(FEATURES)), np.float32),
        np.zeros((*shape, parts, 3), np.int64),
        np.zeros((*shape, len(KINDS), nodes), bool),
        np.zeros((*shape, nodes), bool),
        np.zeros(shape, bool),
        np.zeros((*shape, 2), np.int64),
        np.zeros(shape, np.float32),
    )
    for b, trace in enumerate(traces):
        length = len(trace.scenes)
        found.there[b, :length] = True
        if length and trace.choices:
            found.choices[b, :length], found.returns[b, :length] = trace.choices, trace.returns
        for t, scene in enumerate(trace.scenes):
            _fill(found, (b, t), scene)
    return found


def _fill(found: Batch, at: tuple[int, int], scene: Scene) -> None:
    number = len(scene.classes)
    if number:
        found.classes[at][:number] = scene.classes
        found.features[at][:number] = scene.features
    for row, (thing, place, count) in zip(found.wanted[at], scene.wanted, strict=False):
        row[:] = thing + 1, place + 1, count
    if scene.legal:
        found.legal[at][:, :number] = scene.legal
    if scene.close:
        found.close[at][:number] = scene.close
