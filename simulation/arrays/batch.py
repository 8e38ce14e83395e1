"""Many worlds as arrays: `Batch(begins, worlds=4096).step(numbers)`, equal to the engine tick by tick."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.arrays.distance_pool import DistancePool
from hearth.simulation.arrays.home_records import HomeShape, bucket_of, home_record
from hearth.simulation.arrays.instruction_table import FIRST_NODE_NUMBER, ActionTable, action_table
from hearth.simulation.arrays.kernels.observations import AGENT_COLUMNS
from hearth.simulation.arrays.kernels.random_instructions import random_legal
from hearth.simulation.arrays.kernels.tick import (
    ARRAYS,
    LOOK,
    MISSING,
    REWARDS,
    SIGHT,
    STEP,
    advance,
)
from hearth.simulation.arrays.record_types import ADDED, MOST_AGENTS, Bucket, world_type
from hearth.simulation.arrays.task_records import Begin, base_of, index_in_record, task_record
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.home import Home

__all__ = ["ARRAYS", "REWARDS", "SIGHT", "Batch", "Observed", "Payment"]

LEAST_OF_A_THREAD = 256
"""Worlds for which a further thread is worth its start."""


class Payment(NamedTuple):
    """The reward of a tick, as of `envs.rewards.Rewards`."""

    success: float = 1.0
    tick: float = -0.004
    predicate: float = 0.0


USUAL = Payment()
"""1 for the goal, and -0.004 a tick."""


@dataclass
class Observed:
    """The arrays that kernels write, by world and agent; each step overwrites them.

    Attributes:
        seen: uint64 words, nodes that an agent sees.
        planes: uint64 words, legal numbers; those below 64 in the first word of the last row.
        mask: uint8 by number, 1 where it is legal.
        nodes: uint8 by node, bits: seen, close, OPEN, CLOSED, ON, in a hand, a subject of the goal, a target of it.
        places: int16 by slot of movable things: the node that it is on or in, + 1; 0 where that is not seen.
        agents: float32 by agent, `kernels.observations.AGENT_COLUMNS`.
        time: float32, the share of an episode's ticks that has passed.
    """

    seen: NDArray[np.uint64]
    planes: NDArray[np.uint64]
    mask: NDArray[np.uint8]
    nodes: NDArray[np.uint8]
    places: NDArray[np.int16]
    agents: NDArray[np.float32]
    time: NDArray[np.float32]


class Batch:
    """Worlds of some tasks, stepped together.

    Args:
        begins: starts of tasks, all with the same number of agents.
        worlds: how many are played at once.
        actions: names of the actions that agents may try.
        rules: of actions.
        partial: whether agents see only the area around them.
        limit: ticks after which an episode is over.
        payment: rewards of a tick.
        seed: of the tasks that episodes are drawn from.
        threads: of one step.
        bucket: sizes of records; the smallest that has room for all homes where None.

    Attributes:
        table: the actions.
        shapes: the homes.
        tasks, homes, worlds: records.
        shown: the arrays that agents observe.
        rewards, reached, over, status: of the last step, by world.

    Raises:
        HearthError: BAD_ARGUMENT: a home too large, a goal, a start, an action or a rule out of scope.
    """

    def __init__(
        self,
        begins: Iterable[Begin],
        worlds: int,
        actions: Iterable[str],
        rules: Rules = DEFAULT,
        partial: bool = True,
        limit: int = 250,
        payment: Payment = USUAL,
        seed: int = 0,
        threads: int = 1,
        bucket: Bucket | None = None,
    ) -> None:
        self.begins = tuple(begins)
        self.agents = _agents(self.begins)
        self.table: ActionTable = action_table(actions, self.begins[0].world.home.knowledge, rules)
        self.limit, self.partial, self.payment, self.threads = limit, partial, payment, threads
        self._compile(bucket)
        self._allocate(worlds, seed)

    def _compile(self, bucket: Bucket | None) -> None:
        """Make the records of homes and tasks."""
        found: dict[int, int] = {}
        self.shapes: list[HomeShape] = []
        bases: list[Home] = []
        for begin in self.begins:
            base = base_of(begin.world.home)
            if id(base) not in found:
                found[id(base)] = len(bases)
                bases.append(base)
                self.shapes.append(HomeShape(base))
        self.bucket = bucket_of(self.shapes) if bucket is None else bucket
        self._home_of = [found[id(base_of(begin.world.home))] for begin in self.begins]
        self.homes = np.array([home_record(shape, self.bucket) for shape in self.shapes])
        records = [
            task_record(begin, home, self.shapes[home], self.bucket, self.table.sets)
            for begin, home in zip(self.begins, self._home_of, strict=True)
        ]
        self.tasks = np.array(records)
        self.pool = DistancePool(self.shapes, self.bucket)

    def _allocate(self, worlds: int, seed: int) -> None:
        bucket, count, agents = self.bucket, worlds, self.agents
        self.size = self.table.size(bucket.nodes)
        self.worlds = np.zeros(count, world_type(bucket))
        self._shown = (
            np.zeros((count, agents, bucket.width), np.uint64),
            np.zeros((count, agents, self.table.planes + 1, bucket.width), np.uint64),
            np.zeros((count, agents, self.size // 8), np.uint64),
            np.zeros((count, agents, bucket.nodes // 8), np.uint64),
            np.zeros((count, agents, bucket.movable + ADDED), np.int16),
            np.zeros((count, agents, agents, len(AGENT_COLUMNS)), np.float32),
            np.zeros((count, agents), np.float32),
        )
        seen, planes, mask, nodes, places, others, time = self._shown
        self.shown = Observed(seen, planes, mask.view(np.uint8), nodes.view(np.uint8), places, others, time)
        self.rewards, self.status = np.zeros(count), np.zeros(count, np.int64)
        self.reached, self.over = np.zeros(count, np.bool_), np.zeros(count, np.bool_)
        self._missing = np.zeros((count, 3), np.int64)
        self._numbers = np.zeros((count, agents), np.int64)
        self.every = np.arange(count)
        self.choose = np.arange(len(self.begins), dtype=np.int32)
        self.reseed(seed)

    def __len__(self) -> int:
        return len(self.worlds)

    def reseed(self, seed: int) -> None:
        """Let the next episodes be the first ones of a seed."""
        self.worlds["seed"] = np.arange(len(self), dtype=np.uint64) + np.uint64(seed % 2**32) * np.uint64(1_000_003)
        self.worlds["episode"] = 0

    def reset(self, which: NDArray[np.int64] | None = None, level: int = ARRAYS) -> None:
        """Begin the next episodes of some worlds, or of all, with tasks drawn from their seeds."""
        some = self.every if which is None else which
        drawn = mixed(self.worlds["seed"][some], self.worlds["episode"][some]) % np.uint64(len(self.choose))
        self.begin_tasks(self.choose[drawn], some, level)

    def begin_tasks(self, tasks: NDArray[Any], which: NDArray[np.int64] | None = None, level: int = ARRAYS) -> None:
        """Begin the next episodes of some worlds, or of all, with these tasks."""
        some = self.every if which is None else which
        now = self.tasks["start"][tasks]
        now["seed"], now["episode"], now["task"] = self.worlds["seed"][some], self.worlds["episode"][some] + 1, tasks
        self.worlds[some] = now
        self._run(LOOK, level, some)

    def look(self, level: int = ARRAYS) -> None:
        """Write the observations of the worlds as they are; after `worlds` was changed."""
        self._run(LOOK, level, self.every)

    def step(self, numbers: NDArray[Any], level: int = ARRAYS) -> None:
        """Run one tick of all worlds.

        Args:
            numbers: by world and agent.
            level: how much is computed: `REWARDS`, `SIGHT` or `ARRAYS`; 0 for the worlds alone.

        Raises:
            HearthError: BAD_ARGUMENT: a number is out of range. No world has changed then.
        """
        self._check(numbers)
        self._numbers[:] = np.asarray(numbers).reshape(self._numbers.shape)
        which = self.every
        while len(which):
            self._run(STEP, level, which)
            which = which[self.status[which] & MISSING != 0]
            self.pool.fill(self._missing[which])

    def random_numbers(self, seed: int) -> NDArray[np.int64]:
        """Return a random legal number for each agent of each world, from a seed and the number of the world."""
        found = np.zeros((len(self), self.agents), np.int64)
        random_legal(self.shown.planes, found, seed % 2**32)
        return found

    def _check(self, numbers: NDArray[Any]) -> None:
        """Refuse numbers that are out of range.

        Raises:
            HearthError: BAD_ARGUMENT.
        """
        given = np.asarray(numbers)
        good = given.size == self._numbers.size and np.issubdtype(given.dtype, np.integer)
        if good and given.min() >= 0 and given.max() < self.size:
            return
        message = f"actions are {self._numbers.size} integers from 0 to {self.size - 1}"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="legal ones have 1 in `mask`")

    def _run(self, job: int, level: int, which: NDArray[np.int64]) -> None:
        threads = max(1, min(self.threads, len(which) // LEAST_OF_A_THREAD))
        if threads == 1:
            self._advance(job, level, which)
            return
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(lambda part: self._advance(job, level, part), np.array_split(which, threads)))

    def _advance(self, job: int, level: int, which: NDArray[np.int64]) -> None:
        table, pay = self.table, self.payment
        width = self.bucket.width
        scratch = np.zeros((6, width), np.uint64), np.zeros((table.registers, width), np.uint64), np.zeros(4, np.int64)
        advance(
            job, level, self.homes, self.tasks, self.worlds, which, self._numbers,
            (table.rows, table.program, table.read, table.first_plane, table.rules.made_bed),
            self.pool.arrays, (self.limit, pay.success, pay.tick, pay.predicate, self.partial), self._shown,
            (self.status, self.rewards, self.reached, self.over), self._missing, scratch,
        )  # fmt: skip

    # Numbers as instructions, for tests, films and explanations.

    def home_of(self, world: int) -> Home:
        """Return the home of a world's task, with the nodes that the task adds."""
        begin: Begin = self.begins[self.worlds["task"][world]]
        return begin.world.home

    def classes(self, task: int) -> list[str]:
        """Return the class of each node of a task by index in records, "" where there is none."""
        home, first = self.begins[task].world.home, len(self.shapes[self._home_of[task]].home)
        found = [""] * self.bucket.nodes
        for i, name in enumerate(home.classes):
            if home.everything >> i & 1:
                found[i if i < first else self.bucket.first_added + i - first] = name
        return found

    def node_id(self, world: int, index: int) -> int | None:
        """Return the id of the node of an index in records; None where there is none."""
        home, shape = self.home_of(world), self.shapes[self._home_of[self.worlds["task"][world]]]
        first = len(shape.home)
        own = index if index < first else first + index - self.bucket.first_added
        good = index < first or index >= self.bucket.first_added
        return home.ids[own] if good and own < len(home) and not home.absent >> own & 1 else None

    def index_of(self, world: int, node_id: int) -> int:
        """Return the index in records of a node."""
        home, shape = self.home_of(world), self.shapes[self._home_of[self.worlds["task"][world]]]
        return index_in_record(home, shape, self.bucket, home.index[node_id])

    def instruction(self, world: int, agent: int, number: int) -> Step | None:
        """Return the instruction of a number; None to wait, and where a number means nothing now."""
        plane, index = divmod(number - FIRST_NODE_NUMBER, self.bucket.nodes)
        row = number if number < FIRST_NODE_NUMBER else self.table.first_plane + plane
        known = row < (self.table.first_plane if number < FIRST_NODE_NUMBER else len(self.table.of_row))
        if row == 0 or not known:
            return None
        found = self.table.of_row[row]
        assert found is not None
        name, hand = found
        nodes: Sequence[int | None] = ()
        if number >= FIRST_NODE_NUMBER:
            nodes = (self.node_id(world, index),)
            if hand >= 0:
                held = int(self.worlds["hands"][world, agent, hand])
                nodes = (None if held < 0 else self.node_id(world, held), *nodes)
        if None in nodes:
            return None
        home = self.home_of(world)
        refs = tuple(ObjectRef(home.classes[home.index[node]], 0, node) for node in nodes if node is not None)
        return Step(name, refs, agent)


def mixed(seeds: NDArray[np.uint64], episodes: NDArray[np.int32]) -> NDArray[np.uint64]:
    """Return numbers that look random, one for each seed and episode."""
    x = seeds * np.uint64(0x9E3779B97F4A7C15) + episodes.astype(np.uint64)
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    found: NDArray[np.uint64] = x ^ (x >> np.uint64(31))
    return found


def _agents(begins: Sequence[Begin]) -> int:
    """Return how many agents all starts have.

    Raises:
        HearthError: BAD_ARGUMENT: there is no start, or they differ.
    """
    counts = sorted({len(begin.world.agents) for begin in begins})
    if len(counts) != 1 or not 1 <= counts[0] <= MOST_AGENTS:
        message = f"{len(begins)} tasks with {' or '.join(map(str, counts)) or 'no'} agents"
        remedy = f"tasks that all have the same number of agents, 1 to {MOST_AGENTS}"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=remedy)
    return counts[0]
