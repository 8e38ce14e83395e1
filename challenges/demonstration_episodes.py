"""Demonstrations: an agent does a task alone, in another home (thesis 6.3, B.2.2)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from hearth.challenges.challenge_definition import challenge
from hearth.challenges.demonstrator import Demonstrator
from hearth.challenges.episode_loop import Played, Player, play
from hearth.challenges.episodes import Known, read_instruction, written
from hearth.challenges.tasks import Task
from hearth.kb.knowledge import Knowledge
from hearth.schemas.rng import derive
from hearth.simulation.env import Env, Tick
from hearth.storage.parallel import Seen, spread, unseen

TRIES = 4
"""A demonstration that does not reach its goal is played again; the last time without habits."""

NO_HABITS = dict.fromkeys(("distractor", "change_of_mind", "detour", "failed_try"), 0.0)


@dataclass(frozen=True)
class Demonstration:
    """A task that was done.

    Attributes:
        task: the task that was done.
        actions: of each tick the instruction that was tried, `Grab 41`; None where nothing was.
        habits: the habits that were acted on, with the tick.
    """

    task: Task
    actions: tuple[str | None, ...]
    habits: tuple[tuple[int, str], ...]

    def ticks(self, knowledge: Knowledge) -> list[Tick]:
        """Replay the demonstration and return its ticks."""
        which = challenge(self.task.challenge)
        env = Env(which.rules, which.partial)
        env.restore(self.task.demonstration_start(knowledge))
        allowed = which.allowed(knowledge)
        for text in self.actions:
            env.step({} if text is None else {0: read_instruction(text, 0, env.world.home, allowed)})
        return env.ticks


@dataclass(frozen=True)
class Wish:
    """A demonstration to be played.

    Attributes:
        task: the task to do.
        rate: of habits; 0 for a clean demonstration, 1 for the challenge's, 2 for twice as many.
        known: gives the knowledge.
    """

    task: Task
    rate: float
    known: Known


def demonstrate(wish: Wish) -> Demonstration:
    """Let an agent do a task in its demonstration's home."""
    which, knowledge = challenge(wish.task.challenge), wish.known()
    for number in range(TRIES):
        last = number == TRIES - 1
        rates = {name: min(1.0, rate * wish.rate) for name, rate in which.habits.items()}
        demonstrator = Demonstrator(which, wish.task, NO_HABITS if last else rates)
        done = _played(wish.task, demonstrator, knowledge, number)
        if done.success or last:
            break
    actions = tuple(written(tick.instructions.get(0)) for tick in done.env.ticks)
    return Demonstration(wish.task, actions, tuple(demonstrator.began))


def _played(task: Task, demonstrator: Demonstrator, knowledge: Knowledge, number: int) -> Played:
    which = challenge(task.challenge)
    start = task.demonstration_start(knowledge)
    goal = task.goal_in(start.home)
    seed = derive(task.seed, "demonstrator", number)
    allowed = which.allowed(knowledge)
    players = [Player(demonstrator, goal)]
    return play(
        start, goal, players, seed, actions=allowed, partial=which.partial, limit=which.ticks, rules=which.rules
    )


def demonstrations(
    tasks: Sequence[Task], known: Known, rate: float = 1.0, workers: int = 1, seen: Seen = unseen
) -> Iterator[Demonstration]:
    """Yield the demonstrations of tasks, in their order, for any number of workers.

    Args:
        tasks: which.
        known: gives the knowledge.
        rate: of habits (see `Wish`).
        workers: processes.
        seen: called with the number done.
    """
    return spread(demonstrate, [Wish(task, rate, known) for task in tasks], workers, seen)
