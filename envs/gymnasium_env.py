"""Episodes as an `Env` of Gymnasium: one agent learns, the others are agents of ours or of a user."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar

from hearth.agents.protocol import Agent
from hearth.envs.action_codes import Number
from hearth.envs.observation_arrays import Arrays
from hearth.envs.render_modes import MODES, PLAN, Pictures
from hearth.envs.session import MOST_SEED, Session, Setting
from hearth.schemas.agent_messages import Message
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.optional_libraries import library
from hearth.schemas.program import Step
from hearth.schemas.rng import derive

if TYPE_CHECKING:
    from gymnasium import Env, Space
else:
    Env = library("gymnasium").Env


class HomeEnv(Env[Arrays, Number]):
    """A home with one learner. Observations, actions, rewards and infos are those of `pettingzoo_env.ParallelHome`.

    Args:
        setting: how episodes are played.
        partners: the other agents, in the order of their numbers; one fewer than the opening has agents.
        learner: number of the agent that learns.
        render_mode: `rgb_array`, `ansi`, or None.
        camera: of `rgb_array` (see `render_modes.Pictures`).

    Attributes:
        session: the episode: its `env`, `progress` and `failures`.

    Raises:
        HearthError: BAD_ARGUMENT, where the numbers do not agree.

    Examples:
        >>> from hearth.envs.session import Setting, opening
        >>> from hearth.envs.gymnasium_env import HomeEnv
        >>> env = HomeEnv(Setting(opening(home, "HOLDS(agent, milk)", agents=1)))
        >>> observation, info = env.reset(seed=1)
        >>> env.step(0)[1:4]
        (-0.004, False, False)
    """

    metadata: ClassVar[dict[str, Any]] = {  # type: ignore[misc]
        "render_modes": list(MODES),
        "render_fps": 4,
    }

    def __init__(
        self,
        setting: Setting,
        partners: Sequence[Agent] = (),
        learner: int = 0,
        render_mode: str | None = None,
        camera: str = PLAN,
    ) -> None:
        self.session = Session(setting)
        self.render_mode = render_mode
        self.learner = learner
        others = [number for number in range(self.session.agents) if number != learner]
        if len(others) != len(partners) or not 0 <= learner < self.session.agents:
            message = f"{len(partners)} partners of agent {learner}, where there are {self.session.agents} agents"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="opening(..., agents=1 + partners)")
        self.partners = dict(zip(others, partners, strict=True))
        self.observation_space: Space[Any] = self.session.observation_space()
        self.action_space = self.session.action_space()
        self._pictures = Pictures(render_mode, camera)
        self._begun = False

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Arrays, dict[str, Any]]:
        """Begin an episode.

        Args:
            seed: of this episode and, one after another, of those that follow; None goes on.
            options: not used.
        """
        super().reset(seed=seed)
        chosen = int(self.np_random.integers(MOST_SEED))
        self.session.begin(chosen)
        self._begun = True
        told = self.session.setting.told
        for number, partner in self.partners.items():
            view, _ = self.session.seen(number)
            goal = self.session.progress.goal if told is None or number in told else None
            partner.reset(view, goal, derive(chosen, "agent", number))
        return self._now()

    def step(self, action: Number) -> tuple[Arrays, float, bool, bool, dict[str, Any]]:
        """Run one tick: the learner's action, and its partners' choices.

        Raises:
            HearthError: OUT_OF_ORDER before the first `reset`; BAD_ARGUMENT, where the action is not in its space. The
                episode is as before.
        """
        if not self._begun:
            raise HearthError.of(Code.OUT_OF_ORDER, "`step` came before the first `reset`", suggestion="call `reset()`")
        session = self.session
        chosen: dict[int, Step | Failure | None] = {self.learner: session.read(self.learner, action)}
        for number, partner in self.partners.items():
            choice = partner.act(*session.seen(number))
            chosen[number] = None if isinstance(choice, Message) else choice
        rewards = session.act(chosen)
        return (self._now()[0], rewards[self.learner], session.succeeded, session.cut_off, session.info(self.learner))

    def _now(self) -> tuple[Arrays, dict[str, Any]]:
        return self.session.observe(self.learner), self.session.info(self.learner)

    def texts(self) -> list[str]:
        """Return the learner's legal instructions in words, in the order of the code `listed`: 0 is to wait."""
        return self.session.texts(self.learner)

    def render(self) -> Any:
        """Return a picture or text of now, by the render mode; None without one."""
        return self._pictures.take(self.session)
