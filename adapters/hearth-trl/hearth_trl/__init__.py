"""Household tasks in text as an environment of TRL: `GRPOTrainer(environment_factory=HearthEnv, ...)`."""

from typing import Any

import hearth

__all__ = ["HearthEnv", "rows"]


class HearthEnv:
    """A world whose only tool is `act`; a row of the dataset chooses it by `seed` and a source of tasks, or a home.

    TRL makes every public method but `reset` and `get_reward` a tool, and reads its docstring.
    """

    def __init__(self) -> None:
        self._episode: hearth.TextEpisode | None = None

    def reset(
        self, seed: int = 0, tasks: str = "wah:train:100", home: str = "", goal: str = "", limit: int = 250, **row: Any
    ) -> str:
        """Begin the world of a row, and return the first observation, which follows the prompt."""
        given = {"home": home, "goal": goal} if home or goal else {"tasks": tasks}
        self._episode = hearth.TextEpisode(**given, limit=limit)
        return self._episode.reset(seed).observation

    def act(self, command: str) -> str:
        """Do one command in the home and see what follows.

        Args:
            command: One line, for example `Walk fridge 142`.

        Returns:
            Your goal, what you see afterwards, and commands that make sense then.
        """
        if self._episode is None:
            raise ValueError("OUT_OF_ORDER: the episode has not begun (call `reset`)")
        return self._episode.step(command).observation

    def get_reward(self) -> float:
        """Return the part of the goal that was reached: 1.0 for all of it, 0.0 before the first command."""
        turn = None if self._episode is None else self._episode.turn
        return turn.goal_fraction if turn is not None else 0.0


def rows(count: int, tasks: str = "wah:train:100", home: str = "", goal: str = "", limit: int = 250) -> list[dict]:
    """Return rows of a training dataset: a prompt with the instructions, and one seed each.

    Args:
        count: how many.
        tasks: the source of the tasks.
        home: the name of a home, with a goal, instead of tasks.
        goal: in that home.
        limit: ticks of an episode.
    """
    given = {"home": home, "goal": goal} if home or goal else {"tasks": tasks}
    said = hearth.TextEpisode(**given).instructions
    where = {"tasks": tasks, "home": home, "goal": goal, "limit": limit}
    return [{"prompt": [{"role": "user", "content": f"{said}\n\n"}], "seed": seed, **where} for seed in range(count)]
