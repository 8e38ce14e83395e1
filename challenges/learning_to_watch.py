"""Training goal inference on a challenge's demonstrations (thesis 6.4, B.2.2, B.3.1)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from hearth.challenges.challenge_definition import challenge
from hearth.challenges.demonstration_episodes import Wish, demonstrate
from hearth.challenges.episodes import Known
from hearth.challenges.published_tasks import DEMONSTRATIONS
from hearth.challenges.task_files import suite
from hearth.challenges.tasks import Task
from hearth.challenges.watch_stage import bound
from hearth.models.interface import Training
from hearth.models.watching.demonstration_batches import Counts, Watched
from hearth.models.watching.goal_decoding import possible_goals
from hearth.models.watching.goal_inference import GoalInference
from hearth.models.watching.object_sightings import sightings
from hearth.storage.parallel import Seen, spread, unseen

if TYPE_CHECKING:
    from hearth.models.watching.goal_inference import TrainedGoalInference


def watched(wish: Wish) -> Watched:
    """Return a demonstration as its states show it, with its goal."""
    task = wish.task
    ticks = demonstrate(wish).ticks(wish.known())
    seen = sightings(ticks, tuple(bound(task, ticks[0].before.home))) if ticks else ()
    return Watched(seen, challenge(task.challenge).grammar.counts(task.goal))


def examples(
    tasks: Sequence[Task], known: Known, rate: float = 1.0, workers: int = 1, seen: Seen = unseen
) -> list[Watched]:
    """Return the demonstrations of tasks, in their order, for any number of workers."""
    return list(spread(watched, [Wish(task, rate, known) for task in tasks], workers, seen))


def goals_of_tests(name: str) -> frozenset[Counts]:
    """Return the goals of all tasks that are for testing."""
    which = challenge(name)
    testing = [split for split, found in which.splits.items() if found.homes == which.test]
    return frozenset(which.grammar.counts(task.goal) for split in testing for task in suite(name, split).tasks)


def learn(
    name: str,
    known: Known,
    how: Training,
    limit: int | None = None,
    rate: float = 1.0,
    workers: int = 1,
    seen: Seen = unseen,
    trained: Seen = unseen,
    shape: str = "things",
) -> TrainedGoalInference:
    """Goal inference trained on the published demonstrations.

    Args:
        name: of the challenge.
        known: gives the knowledge.
        how: long and how.
        limit: the first demonstrations only.
        rate: of habits (see `Wish`).
        workers: processes that play demonstrations.
        seen, trained: report progress: demonstrations and epochs done.
        shape: of the network (see `GoalInference`).
    """
    grammar = challenge(name).grammar
    found = suite(name, DEMONSTRATIONS, limit=limit)
    shown = examples(found.tasks, known, rate, workers, seen)
    possible = possible_goals(tuple(grammar.goals), tuple(map(str, grammar.predicates)))
    done = GoalInference(shape=shape).fit(shown, grammar.predicates, possible, goals_of_tests(name), how, trained)
    facts: dict[str, Any] = {"challenge": name, "digest": found.digest, "rate_of_habits": rate, **done.facts}
    return replace(done, facts=facts)
