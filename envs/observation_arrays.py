"""An agent's observation as padded arrays; one row for each slot (see `node_slots`), zeros where nothing is visible.

Of a partial view only the visible part is in the arrays: scrambling the rest of the world changes no byte of them.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hearth.envs.edge_arrays import Edges, seen_edges, start_edges
from hearth.envs.goal_arrays import GOAL_COLUMNS, class_number, goal_array
from hearth.envs.node_slots import Slots
from hearth.kb.action_sets import states_of_set
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.vocabulary import RELATIONS
from hearth.simulation.goals import Progress
from hearth.simulation.motion import positions
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.observation import reach
from hearth.simulation.observation.views import Pose, View
from hearth.simulation.world.action_set_3_states import rows_with_further
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home

if TYPE_CHECKING:
    from gymnasium.spaces import Space

Arrays = dict[str, NDArray[Any]]
"""An observation by the names of `Encoder.spaces`."""

AGENT_COLUMNS = ("seen", "x", "z", "sin_yaw", "cos_yaw", "sitting", "lying", "stride")
"""Columns of `agents`: metres, and the yaw from +z towards +x."""

LAST_COLUMNS = ("action", "first", "second", "failed")
"""Columns of `last`: number of the action from 1 (one more than their number where it is none of them), slots + 1."""

FAR = 1_000.0
"""Metres that no place exceeds."""

MANY = np.iinfo(np.int16).max


@dataclass(frozen=True)
class Sizes:
    """The lengths of padded arrays.

    Attributes:
        nodes: slots; the largest of our homes has 674 nodes.
        edges: in the order of the ids of source, relation and target; visible edges beyond them are left out.
        agents: characters; the first row is the agent itself, the others follow by number.
        literals: rows of a goal (see `goal_arrays`).
        legal: instructions of the padded list (`action_codes.Listed`).
    """

    nodes: int = 768
    edges: int = 1024
    agents: int = 2
    literals: int = 8
    legal: int = 512


@dataclass(frozen=True, eq=False)
class Rows:
    """The constant facts about a home, by slot.

    Attributes:
        slots: of the home.
        classes, categories: their numbers.
        places: metres at the start, 0 where there are none.
        edges: between things at the start, by index.
    """

    slots: Slots
    classes: NDArray[np.int16]
    categories: NDArray[np.int16]
    places: NDArray[np.float32]
    edges: Edges


@dataclass(frozen=True)
class Encoder:
    """Makes arrays of views.

    Attributes:
        sizes: their lengths.
        names: the actions that are numbered.
        knowledge: whose classes are numbered.
        relations: of the edges; CLOSE between things is most of all edges, and left out unless it is named.
    """

    sizes: Sizes
    names: tuple[str, ...]
    knowledge: Knowledge
    relations: tuple[str, ...] = tuple(name for name in RELATIONS if name != "CLOSE")

    def spaces(self) -> dict[str, Space[Any]]:
        """Return the spaces of every array but the masks."""
        from gymnasium.spaces import Box, MultiBinary

        sizes, kinds = self.sizes, len(_categories(self.knowledge))
        classes = 2 + max(each.id for each in self.knowledge.objects.values())
        most = max(classes, sizes.nodes, MANY)
        return {
            "seen": MultiBinary(sizes.nodes),
            "classes": Box(0, classes, (sizes.nodes,), np.int16),
            "categories": Box(0, kinds + 1, (sizes.nodes,), np.int16),
            "states": MultiBinary((sizes.nodes, len(states_of_set(self.knowledge.action_set)))),
            "close": MultiBinary(sizes.nodes),
            "places": Box(-FAR, FAR, (sizes.nodes, 2), np.float32),
            "edges": Box(-1, max(sizes.nodes, len(RELATIONS)), (sizes.edges, 3), np.int16),
            "agents": Box(-FAR, FAR, (sizes.agents, len(AGENT_COLUMNS)), np.float32),
            "characters": Box(0, sizes.nodes, (sizes.agents,), np.int16),
            "hands": Box(0, sizes.nodes, (sizes.agents, 2), np.int16),
            "last": Box(0, most, (sizes.agents, len(LAST_COLUMNS)), np.int16),
            "goal": Box(0, most, (sizes.literals, len(GOAL_COLUMNS)), np.int16),
            "time": Box(0, 1, (1,), np.float32),
        }

    def rows(self, home: Home, things: Iterable[str | int] | None = None) -> Rows:
        """Return the facts about a home that `arrays` needs.

        Args:
            home: the home.
            things: as in `Slots.of`.

        Raises:
            HearthError: BAD_ARGUMENT (see `Slots.of`).
        """
        slots = Slots.of(home, self.sizes.nodes, things)
        classes, categories = np.zeros(slots.size, np.int16), np.zeros(slots.size, np.int16)
        places = np.zeros((slots.size, 2), np.float32)
        kinds, here = _categories(self.knowledge), ground_of(home)
        for slot, i in enumerate(slots.order):
            classes[slot] = class_number(home.classes[i], self.knowledge)
            categories[slot] = 1 + kinds.get(home.node(i).category, len(kinds))
            box = None if here is None else here.ground.box(i)
            if box is not None:
                places[slot] = box.center[0], box.center[2]
        return Rows(slots, classes, categories, places, start_edges(home, self.relations))

    def arrays(self, view: View, rows: Rows, progress: Progress | None = None, time: float = 0.0) -> Arrays:
        """Return a view as arrays that nobody else holds.

        Args:
            view: an agent's view.
            rows: of its home.
            progress: of the goal that the agent knows; None where it knows none.
            time: the part of the episode that has passed.

        Raises:
            HearthError: BAD_ARGUMENT, where there are more characters or rows of the goal than rows of an array.
        """
        world, sizes = view.world, self.sizes
        if len(world.agents) > sizes.agents:
            raise _too_many("agents", len(world.agents), sizes.agents)
        slots = rows.slots
        close = reach.close_to(world, world.agents[view.agent])
        rows_of = rows_with_further(world)[: len(states_of_set(self.knowledge.action_set))]
        seen, near, *states = slots.rows([mask & view.mask for mask in (view.mask, close, *rows_of)])
        return {
            "seen": seen,
            "classes": rows.classes * seen,
            "categories": rows.categories * seen,
            "states": np.ascontiguousarray(np.transpose(states)),
            "close": near,
            "places": _places(view, rows) * seen[:, None],
            "edges": self._edges(view, rows),
            **self._agents(view, slots),
            "goal": goal_array(view, slots, progress, sizes.literals),
            "time": np.array([min(1.0, time)], np.float32),
        }

    def _edges(self, view: View, rows: Rows) -> NDArray[np.int16]:
        mask = view.mask & rows.slots.mask
        edges = seen_edges(view.world, mask, frozenset(self.relations), rows.edges)
        found = np.full((self.sizes.edges, 3), -1, np.int16)
        number = rows.slots.by_index
        named = np.stack([number[edges[:, 0]], edges[:, 1], number[edges[:, 2]]], 1)[: len(found)]
        found[: len(named)] = named
        return found

    def _agents(self, view: View, slots: Slots) -> Arrays:
        count = self.sizes.agents
        poses = np.zeros((count, len(AGENT_COLUMNS)), np.float32)
        characters, hands = np.zeros(count, np.int16), np.zeros((count, 2), np.int16)
        last = np.zeros((count, len(LAST_COLUMNS)), np.int16)
        for pose in (view.me, *view.others):
            row = 0 if pose.agent == view.agent else pose.agent + (pose.agent < view.agent)
            agent = view.world.agents[pose.agent]
            poses[row] = _pose(pose)
            held = agent.right, agent.left
            for place, mask in enumerate((agent.bit, *held)):
                slot = slots.members(mask & view.mask)
                if slot:
                    (characters if not place else hands)[(row,) if not place else (row, place - 1)] = slot[0] + 1
            if pose.last is not None:
                step = pose.last.instruction
                slot_of = [(slots.slot(ref) if view.sees(ref.node or 0) else None) for ref in step.objects]
                numbers = [0 if slot is None else slot + 1 for slot in slot_of][:2]
                action = 1 + (self.names.index(step.action) if step.action in self.names else len(self.names))
                last[row] = (action, *numbers, *[0] * (2 - len(numbers)), pose.last.failure is not None)
        return {"agents": poses, "characters": characters, "hands": hands, "last": last}


def _places(view: View, rows: Rows) -> NDArray[np.float32]:
    """Return the places of nodes: with their holders, at their targets, or as the home has them."""
    world = view.world
    here = ground_of(world.home)
    found = rows.places.copy()
    if here is not None:
        carried = world.home.characters
        for agent in world.agents:
            carried |= agent.held
        for i in indices((here.displaced(world) | carried) & view.mask & rows.slots.mask):
            found[rows.slots.by_index[i]] = positions.spot(world, i) or (0.0, 0.0)
    return found


@lru_cache(maxsize=8)
def _categories(knowledge: Knowledge) -> dict[str, int]:
    names = sorted({each.category for each in knowledge.objects.values()} | {"Characters"})
    return {name: number for number, name in enumerate(names)}


def _pose(pose: Pose) -> tuple[float, ...]:
    place = pose.place
    rest = (float(pose.posture == "sitting"), float(pose.posture == "lying"), pose.stride)
    if place is None:
        return (1.0, 0.0, 0.0, 0.0, 0.0, *rest)
    yaw = math.radians(place.yaw)
    return (1.0, place.x, place.z, math.sin(yaw), math.cos(yaw), *rest)


def _too_many(what: str, number: int, most: int) -> HearthError:
    return HearthError.of(Code.BAD_ARGUMENT, f"{number} {what} for {most} rows", suggestion=f"Sizes({what}={number})")
