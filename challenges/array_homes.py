"""`hearth.ArrayHomes`: tasks of a challenge, thousands of worlds at once, as arrays."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from hearth.challenges.challenge_definition import Challenge, challenge
from hearth.challenges.published_tasks import tasks as published
from hearth.envs.array_worlds import ArrayWorlds, ParallelArrayWorlds, Worlds
from hearth.envs.rewards import USUAL_REWARDS, Rewards
from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.simulation.arrays.task_records import Begin

MOST_TASKS = 256
"""Tasks of a challenge of which a name alone stands for the first."""

REMEDY = 'ArrayHomes("wah", worlds=4096)'


class ArrayHomes(ArrayWorlds):
    """Many worlds of tasks with one agent each, as a `VectorEnv` of Gymnasium.

    Args:
        tasks: name of a challenge, or tasks of one: anything with `goal` and `start()`.
        worlds: how many are played at once.
        split: of a challenge's tasks.
        limit_tasks: the first tasks of a challenge only.
        reward: of a tick; without `approach`.
        seed: of the tasks that episodes are drawn from.
        threads: of one step; more than one is faster only where cores are free.
        copy: whether observations are copies; else the next step overwrites them.
        settings: `actions`, `rules`, `partial` and `limit`, instead of those of the challenge.

    Raises:
        HearthError: BAD_ARGUMENT: no such challenge or split; a home, goal or start out of scope.
    """

    def __init__(
        self,
        tasks: str | Iterable[Any] = "wah",
        worlds: int = 1024,
        split: str = "train",
        limit_tasks: int = MOST_TASKS,
        reward: Rewards = USUAL_REWARDS,
        seed: int = 0,
        threads: int = 1,
        copy: bool = False,
        **settings: Any,
    ) -> None:
        made = worlds_of(tasks, worlds, split, limit_tasks, 1, reward, seed, threads, **settings)
        super().__init__(made, copy)


def parallel_array_homes(
    tasks: str | Iterable[Any] = "wah",
    worlds: int = 1024,
    split: str = "train",
    limit_tasks: int = MOST_TASKS,
    agents: int = 2,
    reward: Rewards = USUAL_REWARDS,
    seed: int = 0,
    threads: int = 1,
    **settings: Any,
) -> ParallelArrayWorlds:
    """Return many worlds with several agents each; arguments and errors as of `ArrayHomes`."""
    made = worlds_of(tasks, worlds, split, limit_tasks, agents, reward, seed, threads, **settings)
    return ParallelArrayWorlds(made)


def worlds_of(
    tasks: str | Iterable[Any],
    worlds: int,
    split: str,
    limit_tasks: int,
    agents: int,
    reward: Rewards,
    seed: int,
    threads: int,
    **settings: Any,
) -> Worlds:
    """Return worlds of tasks, by the settings of their challenge; arguments and errors as of `ArrayHomes`."""
    known = default()
    given = tuple(published(tasks, split, limit=limit_tasks) if isinstance(tasks, str) else tasks)
    if not given:
        raise HearthError.of(Code.BAD_ARGUMENT, "there are no tasks to play", suggestion=REMEDY)
    which = challenge(tasks if isinstance(tasks, str) else getattr(given[0], "challenge", "wah"))
    usual = {"actions": sorted(which.allowed(known)), "rules": which.rules, "partial": which.partial,
             "limit": which.ticks}  # fmt: skip
    if unknown := [name for name in settings if name not in usual]:
        message = f"no setting is called `{unknown[0][:40]}`"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=", ".join(usual))
    begins = begins_of(given, which, known, agents)
    return Worlds(begins, worlds, reward=reward, seed=seed, threads=threads, **{**usual, **settings})


def begins_of(tasks: Iterable[Any], which: Challenge, knowledge: Knowledge, agents: int) -> Iterator[Begin]:
    """Yield the starts of tasks with a number of agents."""
    for number, task in enumerate(tasks):
        name = str(getattr(task, "id", number))
        if hasattr(task, "goal_in"):
            world = task.start(knowledge, agents)
            yield Begin(name, world, task.goal_in(world.home))
        else:
            yield Begin(name, task.start(), task.goal)
