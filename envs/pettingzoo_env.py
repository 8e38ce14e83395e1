"""Episodes as a `ParallelEnv` of PettingZoo: all agents act at once and see arrays.

`parallel_env` and `env` have the names that PettingZoo's tools look for; `env` lets agents take turns.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from hearth.envs.action_codes import Number
from hearth.envs.observation_arrays import Arrays
from hearth.envs.render_modes import MODES, PLAN, Pictures
from hearth.envs.session import MOST_SEED, MOST_TICKS, Opening, Session, Setting
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import library

if TYPE_CHECKING:
    from gymnasium.spaces import Dict, Space
    from pettingzoo import AECEnv, ParallelEnv
else:
    ParallelEnv = library("pettingzoo").ParallelEnv


class ParallelHome(ParallelEnv[str, Arrays, Number]):  # type: ignore[misc]
    """Agents `agent_0`, `agent_1`, ... in a home, with one goal. An episode ends for all of them at once.

    Observations are dicts of arrays (see `observation_arrays.Encoder.spaces`) with masks of legal actions (see
    `action_codes`); rewards are those of `rewards.Rewards`. An agent that `step` gives no action waits. Why something
    could not be done is in `infos[agent]["failure"]`; nothing of it is done.

    Args:
        setting: how episodes are played.
        render_mode: `rgb_array`, `ansi`, or None.
        camera: of `rgb_array` (see `render_modes.Pictures`).

    Attributes:
        session: the episode: its `env`, `progress` and `failures`.

    Examples:
        >>> from hearth.envs.pettingzoo_env import ParallelHome
        >>> from hearth.envs.session import Setting, opening
        >>> env = ParallelHome(Setting(opening(home, "HOLDS(agent, milk)")))
        >>> observations, infos = env.reset(seed=1)
        >>> sorted(infos), observations["agent_0"]["seen"].shape
        (['agent_0', 'agent_1'], (768,))
    """

    metadata: ClassVar[dict[str, Any]] = {
        "name": "hearth_home_v0",
        "render_modes": list(MODES),
        "render_fps": 4,
        "is_parallelizable": True,
    }

    def __init__(self, setting: Setting, render_mode: str | None = None, camera: str = PLAN) -> None:
        self.session = Session(setting)
        self.render_mode = render_mode
        self._pictures = Pictures(render_mode, camera)
        self.possible_agents = [f"agent_{number}" for number in range(self.session.agents)]
        self.agents: list[str] = []
        self._numbers = {name: number for number, name in enumerate(self.possible_agents)}
        self._observation_spaces = {name: self.session.observation_space() for name in self.possible_agents}
        self._action_spaces = {name: self.session.action_space() for name in self.possible_agents}
        self._np_random = np.random.default_rng()
        self._begun = False

    def observation_space(self, agent: str) -> Dict:
        """Return the space of an agent's arrays; always the same object."""
        return self._observation_spaces[agent]

    def action_space(self, agent: str) -> Space[Any]:
        """Return the space of an agent's actions; always the same object."""
        return self._action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Arrays], dict[str, dict[str, Any]]]:
        """Begin an episode.

        Args:
            seed: of this episode and, one after another, of those that follow; None goes on.
            options: not used.
        """
        if seed is not None:
            self._np_random = np.random.default_rng(seed)
        self.session.begin(int(self._np_random.integers(MOST_SEED)))
        self.agents, self._begun = list(self.possible_agents), True
        return self._observed(), self._infos()

    def step(
        self, actions: Mapping[str, Number]
    ) -> tuple[
        dict[str, Arrays], dict[str, float], dict[str, bool], dict[str, bool], dict[str, dict[str, Any]]
    ]:  # fmt: skip
        """One tick.

        Raises:
            HearthError: OUT_OF_ORDER before the first `reset`; UNKNOWN_AGENT; BAD_ARGUMENT, where an action is not in
                its space. The episode is as before.
        """
        if not self._begun:
            raise HearthError.of(Code.OUT_OF_ORDER, "`step` came before the first `reset`", suggestion="call `reset()`")
        if not self.agents:
            return {}, {}, {}, {}, {}
        if unknown := sorted(str(name) for name in actions if name not in self._numbers):
            raise HearthError.of(Code.UNKNOWN_AGENT, f"no agent is called `{unknown[0][:40]}`",
                                 suggestion=", ".join(self.possible_agents))  # fmt: skip
        rewards = self.session.step({self._numbers[name]: action for name, action in actions.items()})
        names = self.agents
        found = (
            self._observed(),
            {name: rewards[self._numbers[name]] for name in names},
            dict.fromkeys(names, self.session.succeeded),
            dict.fromkeys(names, self.session.cut_off),
            self._infos(),
        )
        if self.session.succeeded or self.session.cut_off:
            self.agents = []
        return found

    def _observed(self) -> dict[str, Arrays]:
        return {name: self.session.observe(self._numbers[name]) for name in self.agents}

    def _infos(self) -> dict[str, dict[str, Any]]:
        return {name: self.session.info(self._numbers[name]) for name in self.agents}

    def texts(self, agent: str) -> list[str]:
        """Return the legal instructions of an agent in words, in the order of the code `listed`: 0 is to wait."""
        return self.session.texts(self._numbers[agent])

    def render(self) -> Any:
        """Return a picture or text of now, by the render mode; None without one."""
        return self._pictures.take(self.session)

    def close(self) -> None:
        """Nothing is held open."""


def parallel_env(
    begin: Opening, max_cycles: int = MOST_TICKS, render_mode: str | None = None, **settings: Any
) -> ParallelHome:
    """Return the environment by PettingZoo's names: `settings` are fields of `Setting`."""
    return ParallelHome(replace(Setting(begin, **settings), limit=max_cycles), render_mode)


def env(begin: Opening, max_cycles: int = MOST_TICKS, render_mode: str | None = None, **settings: Any) -> AECEnv:
    """Return the same environment in turns: a tick is done when all agents have chosen."""
    from pettingzoo.utils.conversions import parallel_to_aec

    return parallel_to_aec(parallel_env(begin, max_cycles, render_mode, **settings))
