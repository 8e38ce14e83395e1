"""The environment: an episode in text."""

from typing import Any
from uuid import uuid4

from openenv.core.env_server.interfaces import Environment

import hearth

from ..models import HearthAction, HearthObservation, HearthState

TASKS = "wah:train:100"
"""The source of the tasks that a reset without a home draws from."""


class HearthEnvironment(Environment):
    """An episode in text; each session has one of its own."""

    SUPPORTS_CONCURRENT_SESSIONS = True

    def __init__(self) -> None:
        super().__init__()
        self._episode: hearth.TextEpisode | None = None
        self._state = HearthState(episode_id=str(uuid4()))

    def reset(
        self,
        seed: int | None = None,
        episode_id: str | None = None,
        home: str = "",
        goal: str = "",
        limit: int = 250,
        **more: Any,
    ) -> HearthObservation:
        """Begin an episode: in a home with a goal, or with a task that the seed draws."""
        if more:
            raise ValueError(f"BAD_ARGUMENT: unknown {', '.join(sorted(more))[:80]} (home, goal, limit, seed)")
        given = {"home": home, "goal": goal} if home or goal else {"tasks": TASKS}
        episode = hearth.TextEpisode(**given, limit=limit)
        turn = episode.reset(0 if seed is None else seed)
        self._episode, self._state = episode, HearthState(episode_id=episode_id or str(uuid4()))
        return self._seen(turn, 0.0, episode.instructions)

    def step(self, action: HearthAction, timeout_s: float | None = None, **more: Any) -> HearthObservation:
        """Give the world a command."""
        if self._episode is None:
            raise ValueError("OUT_OF_ORDER: the episode has not begun (reset it first)")
        turn = self._episode.step(action.command)
        return self._seen(turn, float(turn.won))

    def _seen(self, turn: Any, reward: float, instructions: str = "") -> HearthObservation:
        facts = {name: getattr(turn, name) for name in ("task", "won", "goal_fraction", "ticks", "faults", "protocol")}
        self._state = HearthState(episode_id=self._state.episode_id, step_count=turn.turn, **facts)
        return HearthObservation(
            text=turn.observation, legal=self._episode.admissible, instructions=instructions, fault=turn.fault,
            total=turn.total, done=turn.done, reward=reward,
        )  # fmt: skip

    @property
    def state(self) -> HearthState:
        """Return the facts of the episode."""
        return self._state
