"""The plain engine beside the batched one: the same numbers in both, and everything that differs after each tick."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from hearth.envs.rewards import Rewards
from hearth.envs.session import done
from hearth.simulation.arrays.batch import Batch
from hearth.simulation.env import Env
from hearth.simulation.goals import Progress
from hearth.simulation.observation import visible_nodes
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices
from hearth.simulation.world.states import LYING, SITTING

WHOLE = 25
"""Ticks after which the edges of all things are compared, and not only those of things that moved."""

EXACT = 1e-9
"""Metres and degrees by which poses may differ: both are floats of 64 bits, but from different libraries."""


@dataclass
class Pair:
    """A world of a batch and the same world in the engine."""

    batch: Batch
    number: int
    env: Env
    progress: Progress
    rewards: Rewards
    apart: list[str] = field(default_factory=list)

    @property
    def record(self):
        return self.batch.worlds[self.number]

    def mask(self, words) -> int:
        """Return a set of a record as the engine's."""
        batch = self.batch
        whole = int.from_bytes(np.ascontiguousarray(words).tobytes(), "little")
        first, added = len(batch.shapes[batch.tasks["home"][self.record["task"]]].home), batch.bucket.first_added
        return whole & (1 << first) - 1 | whole >> added << first

    def index(self, index: int) -> int:
        """Return a node's index of a record as the engine's, as a set."""
        node = -1 if index < 0 else self.batch.node_id(self.number, int(index))
        return 0 if index < 0 else 1 << self.env.world.home.index[node]


def paired(batch: Batch, rewards: Rewards) -> list[Pair]:
    """Return the worlds of a batch, each with its start in the engine."""
    found = []
    for number, task in enumerate(batch.worlds["task"]):
        begin = batch.begins[task]
        env = Env(batch.table.rules, batch.partial, begin.world.home.knowledge)
        env.restore(begin.world)
        found.append(Pair(batch, number, env, Progress.start(begin.goal, begin.world), rewards))
    return found


def chosen(batch: Batch, rng: np.random.Generator, wild: float) -> np.ndarray:
    """Return a number for each agent: half of them of an action drawn first; some of them anything at all."""
    numbers = np.zeros((len(batch), batch.agents), np.int64)
    nodes, first = batch.bucket.nodes, 64
    for world, agent in np.ndindex(numbers.shape):
        if rng.random() < wild:
            number = int(rng.integers(batch.size))
        else:
            legal = np.flatnonzero(batch.shown.mask[world, agent])
            if rng.random() < 0.5:
                rows = np.where(legal < first, -1 - legal, (legal - first) // nodes)
                legal = legal[rows == rng.choice(np.unique(rows))]
            number = int(rng.choice(legal))
        known = batch.instruction(world, agent, number) is not None
        numbers[world, agent] = number if known else 0
    return numbers


def step(pairs: list[Pair], numbers: np.ndarray, counts: Counter[str]) -> None:
    """Run a tick in both engines, and note in `apart` of each pair what differs."""
    batch = pairs[0].batch
    steps = [[batch.instruction(pair.number, agent, int(numbers[pair.number, agent])) for agent in range(batch.agents)]
             for pair in pairs]  # fmt: skip
    batch.step(numbers)
    for pair, some in zip(pairs, steps, strict=True):
        if pair.apart:
            continue
        before = pair.progress, pair.env.world
        tick = pair.env.step({agent: step for agent, step in enumerate(some) if step is not None})
        pair.progress = pair.progress.then(tick.before, tick.world, done(tick))
        counts.update(step.action for step in some if step is not None)
        counts["refused"] += len(tick.failures)
        counts["conflicts"] += sum(str(each.code) == "CONFLICT" for each in tick.failures.values())
        pair.apart = [*_world(pair), *_results(pair, before, tick.failures)]
        for agent in range(batch.agents):
            pair.apart += _agent(pair, agent) + _sight(pair, agent)


def _results(pair: Pair, before, failures) -> list[str]:
    """Compare refusals, the goal, the reward, and the ends of episodes."""
    batch, number, record = pair.batch, pair.number, pair.record
    refused = sum(1 << agent for agent in failures)
    conflicts = sum(1 << agent for agent, each in failures.items() if str(each.code) == "CONFLICT")
    after = pair.progress, pair.env.world
    wanted = {
        "refused": int(batch.status[number]) & 15 == refused,
        "conflict": int(batch.status[number]) >> 4 & 15 == conflicts,
        "counts": record["counts"][: len(pair.progress.counts)].tolist() == list(pair.progress.counts),
        "satisfied": bool(batch.reached[number]) == pair.progress.satisfied,
        "over": bool(batch.over[number]) == (len(pair.env.ticks) >= batch.limit and not pair.progress.satisfied),
        "reward": float(batch.rewards[number]) == pair.rewards.of(before, after, 0),
    }
    return [name for name, same in wanted.items() if not same]


def _world(pair: Pair) -> list[str]:
    """Compare states and edges between things."""
    record, world = pair.record, pair.env.world
    wrong = [f"state {n}" for n in range(SITTING) if pair.mask(record["states"][n]) != world.states[n]]
    lifted, moved = pair.mask(record["lifted"]), world.moved
    start = pair.batch.begins[record["task"]].world
    added = pair.mask(pair.batch.tasks["start"][record["task"]]["lifted"])
    if lifted != moved.on | added or moved.facing != pair.mask(record["carried"]) | start.moved.facing:
        wrong.append("lifted")
    slots = pair.batch.homes["slot"][pair.batch.tasks["home"][record["task"]]]
    first = len(pair.batch.shapes[pair.batch.tasks["home"][record["task"]]].home)
    gone = lifted & ~(int(record["fresh"]) << first)
    nexts: dict[int, int] = {}
    for i in indices(lifted):
        on, inside, room, near = record["place"][slots[pair.batch.index_of(pair.number, world.home.ids[i])]]
        if pair.index(on) != edge_rows.on(world, i) or pair.index(inside) | pair.index(room) != edge_rows.inside(
            world, i
        ):
            wrong.append("place")
        close = pair.index(near)
        nexts[i] = nexts.get(i, 0) | close
        for j in indices(close):
            nexts[j] = nexts.get(j, 0) | 1 << i
    some = range(len(world.home)) if len(pair.env.ticks) % WHOLE == 0 else indices(lifted)
    for i in some:
        own = 0 if gone >> i & 1 else world.home.close[i] & ~gone
        if edge_rows.close(world, i) != own | nexts.get(i, 0):
            wrong.append("close")
    return wrong


def _agent(pair: Pair, number: int) -> list[str]:
    """Compare an agent's edges, hands, room, posture and pose."""
    record, world = pair.record, pair.env.world
    agent = world.agents[number]
    rows = dict(zip(("close", "facing", "on", "worn", "contents"), record["rows"][number], strict=True))
    wrong = [name for name, words in rows.items() if pair.mask(words) != getattr(agent, name)]
    hands = [pair.index(hand) for hand in record["hands"][number]]
    posture = next((state for state in (LYING, SITTING) if world.states[state] & agent.bit), 0)
    apart = np.abs(record["pose"][number] - np.array(agent.pose))
    apart[2] = min(apart[2], 360 - apart[2])
    checks = {
        "hands": hands == [agent.right, agent.left],
        "room": pair.index(record["room"][number]) == agent.inside and not agent.faced,
        "posture": record["posture"][number] == posture,
        "pose": apart.max() <= EXACT and record["stride"][number] == agent.stride,
    }
    return wrong + [name for name, same in checks.items() if not same]


def _sight(pair: Pair, number: int) -> list[str]:
    """Compare the nodes that an agent sees, and its legal instructions."""
    batch, world, at = pair.batch, pair.env.world, pair.number
    agent = world.agents[number]
    seen = visible_nodes.visible(world, agent) if batch.partial else world.home.everything
    wrong = [] if pair.mask(batch.shown.seen[at, number]) == seen else ["seen"]
    legal = pair.env.legal(number, actions=batch.table.names)
    planes = batch.shown.planes[at, number]
    for row, of_row in enumerate(batch.table.of_row):
        name, hand = of_row or ("wait", -1)
        masks = () if of_row is None else legal.masks.get(name)
        if row < batch.table.first_plane:
            same = (masks is not None) == bool(int(planes[-1, 0]) >> row & 1)
        else:
            allowed = 0 if masks is None else masks[-1]
            if hand >= 0:
                thing = (agent.right, agent.left)[hand]
                allowed = allowed & ~thing if masks is not None and masks[0] & thing else 0
            same = pair.mask(planes[row - batch.table.first_plane]) == allowed
        if not same:
            wrong.append(f"legal {name}")
    return wrong + ([] if _bytes(pair, number) else ["mask"])


def _bytes(pair: Pair, number: int) -> bool:
    """Return whether the mask as bytes says the same as its words."""
    batch, at = pair.batch, pair.number
    planes = batch.shown.planes[at, number]
    order = np.concatenate([planes[-1:, :1].ravel(), planes[:-1].ravel()])
    return np.array_equal(np.unpackbits(order.view(np.uint8), bitorder="little"), batch.shown.mask[at, number])
