"""Thousands of worlds as arrays: a `VectorEnv` of Gymnasium, and the same for several agents in PettingZoo's shape.

The worlds run in `simulation.arrays`, tick by tick equal to the engine. The next step overwrites arrays; a learner
copies those that it keeps.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from hearth.envs.rewards import USUAL_REWARDS, Rewards
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import library
from hearth.schemas.program import Step
from hearth.simulation.arrays.batch import Batch, Payment
from hearth.simulation.arrays.task_records import Begin
from hearth.simulation.rules import DEFAULT, Rules

if TYPE_CHECKING:
    from gymnasium.spaces import Dict
    from gymnasium.vector import VectorEnv
else:
    VectorEnv = library("gymnasium.vector").VectorEnv

Arrays = dict[str, NDArray[Any]]
"""An observation by name; the first axis is the world."""

MOST_WORLDS = 1_000_000
"""Worlds of one environment: each takes 10 to 15 KB."""


class Worlds:
    """Worlds of some tasks, and the spaces of their numbers and arrays.

    Args:
        begins: starts of tasks.
        worlds: how many are played at once.
        actions: names of the actions that may be tried.
        rules: of actions.
        partial: whether agents see only the area around them.
        limit: ticks after which an episode is over.
        reward: of a tick; without `approach`.
        seed: of the tasks that episodes are drawn from.
        threads: of one step; more than one is faster only where cores are free.

    Attributes:
        batch: the engine.

    Raises:
        HearthError: BAD_ARGUMENT: a number out of range; a home, goal, start, action, rule or reward out of scope.
    """

    def __init__(
        self,
        begins: Iterable[Begin],
        worlds: int,
        actions: Iterable[str],
        rules: Rules = DEFAULT,
        partial: bool = True,
        limit: int = 250,
        reward: Rewards = USUAL_REWARDS,
        seed: int = 0,
        threads: int = 1,
    ) -> None:
        for name, given, most in (
            ("worlds", worlds, MOST_WORLDS),
            ("threads", threads, 1_000),
            ("limit", limit, 10**6),
        ):
            if not isinstance(given, int) or not 1 <= given <= most:
                raise HearthError.of(Code.BAD_ARGUMENT, f"`{name}` is {given!r:.40}, not an integer from 1 to {most:,}")
        if not isinstance(reward, Rewards) or reward.approach:
            message = "arrays pay for the goal, ticks and predicates alone"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="Rewards(success=..., tick=..., predicate=...)")
        payment = Payment(reward.success, reward.tick, reward.predicate)
        self.batch = Batch(begins, worlds, actions, rules, partial, limit, payment, seed, threads)
        self.seed = seed

    def space(self) -> Dict:
        """Return the space of one agent's observation in one world."""
        from gymnasium.spaces import Box
        from gymnasium.spaces import Dict as Spaces

        shown, batch = self.batch.shown, self.batch
        return Spaces(
            {
                "mask": Box(0, 1, shown.mask.shape[2:], np.uint8),
                "nodes": Box(0, 255, shown.nodes.shape[2:], np.uint8),
                "places": Box(0, batch.bucket.nodes, shown.places.shape[2:], np.int16),
                "agents": Box(-np.inf, np.inf, shown.agents.shape[2:], np.float32),
                "time": Box(0, np.inf, (1,), np.float32),
                "task": Box(0, len(batch.begins) - 1, (1,), np.int32),
            }
        )

    def arrays(self, agent: int) -> Arrays:
        """Return what an agent observes in each world: views that the next step overwrites."""
        shown, batch = self.batch.shown, self.batch
        return {
            "mask": shown.mask[:, agent],
            "nodes": shown.nodes[:, agent],
            "places": shown.places[:, agent],
            "agents": shown.agents[:, agent],
            "time": shown.time[:, agent : agent + 1],
            "task": batch.worlds["task"][:, None],
        }

    def begin(self, seed: int | None) -> None:
        """Begin all worlds; with a seed, as they began the first time."""
        batch = self.batch
        if seed is not None:
            batch.reseed(seed)
        batch.reset()

    def classes(self) -> list[list[str]]:
        """Return for each task the class of each node, "" where there is none: the words behind the arrays."""
        return [self.batch.classes(task) for task in range(len(self.batch.begins))]


class ArrayWorlds(VectorEnv[Arrays, NDArray[Any], NDArray[Any]]):
    """Worlds with one agent each, as a vector environment of Gymnasium.

    An episode that ends begins anew in the same step.
    Actions are numbers of legal instructions, 1 in `mask`; one that is not legal is refused, and nothing is done.
    Observations:
        mask: uint8, the legal numbers.
        nodes: uint8 a node, bits: seen, close, OPEN, CLOSED, ON, in a hand, a subject of the goal, a target of it.
        places: int16 a movable thing, the node that it is on or in, + 1; 0 where that is not seen.
        agents: float32, `AGENT_COLUMNS` of each agent.
        time: float32, the share of the ticks that has passed.
        task: int32, the number of the task.

    Args:
        worlds: what is played.
        copy: whether observations are copies; else the next step overwrites them.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": []}  # type: ignore[misc]

    def __init__(self, worlds: Worlds, copy: bool = False) -> None:
        from gymnasium.spaces import Discrete
        from gymnasium.vector import AutoresetMode
        from gymnasium.vector.utils import batch_space

        if worlds.batch.agents != 1:
            message = f"the tasks have {worlds.batch.agents} agents"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="ParallelArrayWorlds, or `agents=1`")
        self.worlds, self.copy = worlds, copy
        self.metadata = {**type(self).metadata, "autoreset_mode": AutoresetMode.SAME_STEP}  # type: ignore[misc]
        self.num_envs = len(worlds.batch)
        self.single_observation_space = worlds.space()
        self.single_action_space = Discrete(worlds.batch.size)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self._begun = False

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Arrays, dict[str, Any]]:
        """Begin all worlds.

        Args:
            seed: of the tasks that episodes are drawn from; None goes on.
            options: not used.
        """
        super().reset(seed=seed)
        self.worlds.begin(seed)
        self._begun = True
        return self._observed(), {}

    def step(
        self, actions: NDArray[Any]
    ) -> tuple[Arrays, NDArray[Any], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Run one tick of all worlds.

        Returns:
            Observations, rewards, whether the goal is reached, whether the time is over, and facts: `refused` by world;
            of worlds whose episode ended `final_obs` and `final_info`.

        Raises:
            HearthError: OUT_OF_ORDER before the first `reset`; BAD_ARGUMENT, where an action is out of range. The
                worlds are then as before.
        """
        if not self._begun:
            raise HearthError.of(Code.OUT_OF_ORDER, "`step` came before the first `reset`", suggestion="call `reset()`")
        batch = self.worlds.batch
        batch.step(np.asarray(actions))
        rewards, reached, over = batch.rewards.copy(), batch.reached.copy(), batch.over.copy()
        every = np.ones(len(batch), np.bool_)
        infos: dict[str, Any] = {"refused": batch.status & 1 != 0, "_refused": every}
        ended = np.flatnonzero(reached | over)
        if len(ended):
            infos |= self._final(ended, reached)
            batch.reset(ended)
        return self._observed(), rewards, reached, over, infos

    def _final(self, ended: NDArray[np.int64], reached: NDArray[np.bool_]) -> dict[str, Any]:
        """Return the last observations of the worlds whose episode ended, before they begin anew."""
        last = {name: array[ended] for name, array in self.worlds.arrays(0).items()}
        rows = np.full(self.num_envs, None, object)
        for number, world in enumerate(ended.tolist()):
            rows[world] = {name: array[number] for name, array in last.items()}
        which = np.zeros(self.num_envs, np.bool_)
        which[ended] = True
        return {"final_obs": rows, "_final_obs": which, "final_info": {"success": reached, "_success": which},
                "_final_info": which}  # fmt: skip

    def _observed(self) -> Arrays:
        arrays = self.worlds.arrays(0)
        return {name: array.copy() for name, array in arrays.items()} if self.copy else arrays

    def random_actions(self, seed: int) -> NDArray[np.int64]:
        """Return a random legal action for each world, each equally probable; equal for equal seeds and worlds."""
        return self.worlds.batch.random_numbers(seed)[:, 0]

    def tensors(self) -> dict[str, Any]:
        """Return the observations as tensors of torch over the same memory: each step changes their content."""
        torch = library("torch")
        return {name: torch.from_numpy(array) for name, array in self.worlds.arrays(0).items()}

    def instruction(self, world: int, number: int) -> Step | None:
        """Return the instruction of a number in a world now; None to wait."""
        return self.worlds.batch.instruction(world, 0, number)


class ParallelArrayWorlds:
    """Worlds with several agents, in the shape of PettingZoo's parallel environments: dicts by agent, arrays by world.

    All agents of a world act at once; an episode ends for all of them, and begins anew in the same step.

    Args:
        worlds: what is played.

    Attributes:
        possible_agents, agents: `agent_0`, `agent_1`, ...
        num_envs: how many worlds there are.
    """

    def __init__(self, worlds: Worlds) -> None:
        from gymnasium.spaces import Discrete

        self.worlds = worlds
        self.num_envs = len(worlds.batch)
        self.possible_agents = [f"agent_{number}" for number in range(worlds.batch.agents)]
        self.agents: list[str] = []
        self._observation_space, self._action_space = worlds.space(), Discrete(worlds.batch.size)

    def observation_space(self, agent: str) -> Any:
        """Return the space of an agent's observation in one world."""
        return self._observation_space

    def action_space(self, agent: str) -> Any:
        """Return the space of an agent's numbers."""
        return self._action_space

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Arrays], dict[str, dict[str, Any]]]:
        """Begin all worlds; arguments as of `ArrayWorlds.reset`."""
        self.worlds.begin(seed)
        self.agents = list(self.possible_agents)
        return self._observed(), {name: {} for name in self.agents}

    def step(
        self, actions: Mapping[str, NDArray[Any]]
    ) -> tuple[dict[str, Arrays], dict[str, Any], dict[str, Any], dict[str, Any], dict[str, dict[str, Any]]]:
        """Run one tick of all worlds; an agent without actions waits.

        Raises:
            HearthError: OUT_OF_ORDER before the first `reset`; UNKNOWN_AGENT; BAD_ARGUMENT, where an action is out of
                range. The worlds are then as before.
        """
        if not self.agents:
            raise HearthError.of(Code.OUT_OF_ORDER, "`step` came before the first `reset`", suggestion="call `reset()`")
        if unknown := sorted(str(name) for name in actions if name not in self.possible_agents):
            message = f"no agent is called `{unknown[0][:40]}`"
            raise HearthError.of(Code.UNKNOWN_AGENT, message, suggestion=", ".join(self.possible_agents))
        batch = self.worlds.batch
        waiting = np.zeros(len(batch), np.int64)
        batch.step(np.stack([np.asarray(actions.get(name, waiting)) for name in self.possible_agents], axis=1))
        rewards, reached, over, status = (
            batch.rewards.copy(),
            batch.reached.copy(),
            batch.over.copy(),
            batch.status.copy(),
        )
        ended = np.flatnonzero(reached | over)
        if len(ended):
            batch.reset(ended)
        infos = {
            name: {"refused": status >> number & 1 != 0, "conflict": status >> 4 + number & 1 != 0}
            for number, name in enumerate(self.agents)
        }
        return (self._observed(), dict.fromkeys(self.agents, rewards), dict.fromkeys(self.agents, reached),
                dict.fromkeys(self.agents, over), infos)  # fmt: skip

    def _observed(self) -> dict[str, Arrays]:
        return {name: self.worlds.arrays(number) for number, name in enumerate(self.agents)}

    def close(self) -> None:
        """Nothing is held open."""
