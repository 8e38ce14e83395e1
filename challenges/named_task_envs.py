"""Environments of tasks by name, as `gymnasium.make` takes them: `hearth/WatchAndHelp-v0`, `hearth/Household-v0`.

`import hearth` after `import gymnasium` registers them; `gym.make("hearth.challenges.named_task_envs:hearth/Home-v0")`
does in any order.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from hearth.envs import named_envs
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import rng

if TYPE_CHECKING:
    from hearth.challenges.tasks import Task
    from hearth.envs.gymnasium_env import HomeEnv
    from hearth.schemas.goals import Goal
    from hearth.simulation.world.world import World

REGISTERED = {
    **named_envs.REGISTERED,
    "hearth/WatchAndHelp-v0": "hearth.challenges.named_task_envs:watch_and_help_env",
    "hearth/Household-v0": "hearth.challenges.named_task_envs:household_env",
}
"""Function that makes the environment of each id."""

ROLES = ("main", "helper")
"""The roles of a learner in Watch-And-Help: alone with the goal, or as the helper of a human-like agent that has it."""


def register() -> None:
    """Give Gymnasium the ids that it does not have yet."""
    named_envs.register(REGISTERED)


@dataclass(frozen=True)
class TaskOpening:
    """The start of an episode with a task that the seed draws.

    Attributes:
        tasks: to draw from.
        agents: how many there are.
    """

    tasks: tuple[Any, ...]
    agents: int

    def __call__(self, seed: int) -> tuple[World, Goal]:
        """Return the world in which an episode begins, and its goal."""
        from hearth.kb.loading.load import default

        task = rng(seed, "task").choice(self.tasks)
        goal_in = getattr(task, "goal_in", None)
        if goal_in is None:
            return task.start(), task.goal
        world = task.start(default(), self.agents)
        return world, goal_in(world.home)


def watch_and_help_env(
    split: str = "train",
    role: str = "main",
    name: str = "wah",
    limit_tasks: int | None = None,
    render_mode: str | None = None,
    **settings: Any,
) -> HomeEnv:
    """Return the environment of `hearth/WatchAndHelp-v0`: the seed draws a task.

    Args:
        split: of the tasks.
        role: `main`, alone with the goal; or `helper` of a human-like agent; both have the goal.
        name: of the challenge.
        limit_tasks: the first tasks only.
        render_mode: as of `gymnasium_env.HomeEnv`.
        settings: fields of `session.Setting`; those of the challenge where not given.

    Raises:
        HearthError: BAD_ARGUMENT: no such challenge, split, role or setting.
    """
    from hearth.agents.human_like import HumanLike
    from hearth.challenges.challenge_definition import challenge
    from hearth.challenges.published_tasks import tasks
    from hearth.envs.gymnasium_env import HomeEnv
    from hearth.kb.loading.load import default

    if role not in ROLES:
        raise HearthError.of(Code.BAD_ARGUMENT, f"there is no role `{role[:40]}`", suggestion=" or ".join(ROLES))
    which = challenge(name)
    usual = {"actions": sorted(which.allowed(default())), "limit": which.ticks, "rules": which.rules}
    helps = role == "helper"
    begin = TaskOpening(_some(tasks(name, split, limit=limit_tasks)), 1 + helps)
    setting = named_envs.setting_of(begin, {**usual, "partial": which.partial, **settings})
    return HomeEnv(setting, [HumanLike()] if helps else (), int(helps), render_mode)


def household_env(
    split: str = "train", limit_tasks: int = 1000, seed: int = 0, render_mode: str | None = None, **settings: Any
) -> HomeEnv:
    """Return the environment of `hearth/Household-v0`: the seed of an episode draws one of the tasks.

    Args:
        split: of the tasks.
        limit_tasks: how many there are to draw from.
        seed: of these tasks.
        render_mode: as of `gymnasium_env.HomeEnv`.
        settings: fields of `session.Setting`.

    Raises:
        HearthError: BAD_ARGUMENT: no such split or setting.
    """
    from importlib import import_module

    from hearth.envs.gymnasium_env import HomeEnv

    household: Any = import_module("hearth.challenges.household")
    begin = TaskOpening(_some(household.household_tasks(split, limit_tasks, seed)), 1)
    return HomeEnv(named_envs.setting_of(begin, settings), render_mode=render_mode)


def _some(tasks: Sequence[Task] | Any) -> tuple[Any, ...]:
    found = tuple(tasks)
    if not found:
        raise HearthError.of(Code.BAD_ARGUMENT, "no tasks to draw from", suggestion="limit_tasks=100")
    return found


if sys.modules.get("gymnasium") is not None:
    register()
