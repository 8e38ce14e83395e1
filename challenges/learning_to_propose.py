"""Training the goal proposal network on episodes of the main agent alone (thesis 7.4, C.3.2)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from hearth.agents.agent_registry import MAIN
from hearth.agents.goal_space import GoalSpace
from hearth.agents.predicate_count_changes import StateChanges
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episode_loop import Player, play
from hearth.challenges.episodes import Known
from hearth.challenges.task_files import suite
from hearth.challenges.tasks import Task
from hearth.models.interface import Training
from hearth.models.proposals.goal_proposals import Episode, GoalProposals
from hearth.schemas.rng import derive
from hearth.storage.parallel import Seen, spread, unseen

if TYPE_CHECKING:
    from hearth.models.proposals.goal_proposals import TrainedGoalProposals

RATE = 0.0009
"""Rate of learning (table C.3)."""


@dataclass(frozen=True)
class Wish:
    """An episode to be played: a task, and the source of the knowledge."""

    task: Task
    known: Known


def episode(wish: Wish) -> Episode:
    """Play an agent alone at a task, and return it as the network sees it; errors as of `Task.start`."""
    which, knowledge = challenge(wish.task.challenge), wish.known()
    start = wish.task.start(knowledge, 1)
    goal = wish.task.goal_in(start.home)
    seed = derive(wish.task.seed, "alone")
    players = [Player(MAIN["human_like"](which.goals_in), goal)]
    done = play(
        start,
        goal,
        players,
        seed,
        actions=which.allowed(knowledge),
        partial=which.partial,
        limit=which.ticks,
        rules=which.rules,
    )
    space = GoalSpace.of(which.goals_in(start.home), start.home)
    changes = StateChanges(space, start.agents[0].index, space.places(start))
    wanted = space.counts[space.goals.index(goal)].tolist()
    return Episode(tuple(changes.since(space.places(tick.before)) for tick in done.env.ticks), tuple(wanted))


def learn(
    name: str,
    split: str,
    known: Known,
    how: Training,
    limit: int | None = None,
    workers: int = 1,
    seen: Seen = unseen,
    trained: Seen = unseen,
) -> TrainedGoalProposals:
    """Return the network trained on a split of a challenge.

    Args:
        name: of the challenge.
        split: `train`, or `train-small`.
        known: gives the knowledge.
        how: long and how.
        limit: the first tasks only.
        workers: processes that play episodes.
        seen, trained: report progress: episodes and epochs done.
    """
    found = suite(name, split, limit=limit)
    shown = episodes(found.tasks, known, workers, seen)
    settings = GoalProposals(len(shown[0].states[0]), len(shown[0].counts))
    facts = {"challenge": name, "split": split, "digest": found.digest}
    return settings.fit(shown, how, trained).about(facts)


def episodes(tasks: Sequence[Task], known: Known, workers: int = 1, seen: Seen = unseen) -> list[Episode]:
    """Return the episodes of tasks, in their order, for any number of workers."""
    return [each for each in spread(episode, [Wish(task, known) for task in tasks], workers, seen) if each.states]
