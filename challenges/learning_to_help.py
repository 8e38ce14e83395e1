"""Training of Hybrid and HRL: the planner's choices are imitated, then A2C goes on from there (thesis B.3.3 to B.3.5).

The thesis begins with episodes in which the agent is alone; here imitating the planner takes their place. The thesis
trains with RMSprop and 126,000 episodes; this training uses AdamW and as many episodes as two cores can play. The
weights of imitation stay if practice earns no more on the tasks for validation.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from copy import deepcopy
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from pathlib import Path
from random import Random
from statistics import mean
from typing import Any

from hearth.agents.human_like import HumanLike
from hearth.agents.imitation_targets import ShownChoices
from hearth.agents.learned_helpers import Choice, Hybrid
from hearth.agents.policy_observations import vocabulary
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episode_loop import Played, Player, play
from hearth.challenges.episodes import Known, start_of
from hearth.challenges.practice_episodes import Practice, low_rewards, practised
from hearth.challenges.task_files import suite
from hearth.challenges.tasks import Task
from hearth.envs.rewards import HIERARCHICAL
from hearth.models.helping.policies import TrainedPolicy, untrained
from hearth.models.helping.policy_inputs import Batch, Trace, Words, packed
from hearth.models.interface import Training
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import derive
from hearth.storage.files import value_digest
from hearth.storage.parallel import Seen, spread, unseen

DISCOUNT = 0.98
"""Discount of a tick."""

VALIDATION = 30
"""Tasks of training that are for validation only."""


@dataclass(frozen=True)
class Lesson:
    """A task that the planner does next to the human-like agent, with its choices recorded."""

    task: Task
    words: Words
    known: Known


@dataclass(frozen=True)
class Effort:
    """The amount of practice.

    Attributes:
        imitation: passes over the planner's choices.
        epochs: of practice.
        updates: of the network in an epoch.
        episodes: that an update learns from.
        rate: of learning while practising.
    """

    imitation: int = 20
    epochs: int = 6
    updates: int = 10
    episodes: int = 16
    rate: float = 1e-4


EFFORTS = {"subgoals": Effort(), "actions": Effort(imitation=9, epochs=2, updates=5)}
"""Amounts of training that two cores manage in some minutes."""


def lesson(given: Lesson) -> tuple[list[Trace], list[Trace]]:
    """Return the planner's choices in an episode: subgoals, and actions for each of them."""
    main = HumanLike()
    shown = ShownChoices(given.words, main)
    done = beside(given.task, main, shown, given.known, 0)
    high = [traced(shown.choices, high_rewards(done))] if shown.choices else []
    low = [
        traced(choices, low_rewards(done, 1, shown.aims, part, choices)) for part, choices in shown.spells if choices
    ]
    return high, low


def beside(task: Task, main: HumanLike, helper: Any, known: Known, seed: int) -> Played:
    """Play an episode in which a helper knows the true goal."""
    which, knowledge = challenge(task.challenge), known()
    start = start_of(task, knowledge, None)
    goal = task.goal_in(start.home)
    return play(
        start,
        goal,
        [Player(main, goal), Player(helper, goal)],
        derive(task.seed, "learning", seed),
        actions=which.allowed(knowledge),
        partial=which.partial,
        limit=which.ticks,
        rules=which.rules,
    )


def high_rewards(done: Played) -> list[float]:
    """Return the reward of each tick: 2 for a predicate, by any agent, -0.1 for the tick (B.3.3)."""
    worlds = [done.env.ticks[0].before, *(tick.world for tick in done.env.ticks)] if done.env.ticks else []
    pairs = list(zip(done.progress, worlds, strict=False))
    return [HIERARCHICAL.of(before, after, 1) for before, after in pairwise(pairs)]


def traced(choices: Sequence[Choice], rewards: Sequence[float]) -> Trace:
    """Return choices with their returns."""
    from hearth.models.helping.actor_critic import discounted

    returns = discounted(rewards, [each.tick for each in choices], DISCOUNT)
    return Trace(tuple(each.scene for each in choices), tuple(each.chosen for each in choices), tuple(returns))


def learn(
    name: str,
    chooses: str,
    known: Known,
    how: Training,
    effort: Effort | None = None,
    limit: int | None = None,
    workers: int = 1,
    seen: Seen = unseen,
    trained: Seen = unseen,
) -> TrainedPolicy:
    """Return a policy trained on the challenge's tasks of training.

    Args:
        name: of the challenge.
        chooses: `subgoals` or `actions`.
        known: gives the knowledge.
        how: the seed, the rate of imitation, and the folder in which a stopped training is kept.
        effort: how much is practised.
        limit: the first tasks only.
        workers: processes that play lessons.
        seen, trained: report progress: lessons and epochs done.
    """
    effort = effort or EFFORTS[chooses]
    tasks = suite(name, "train", limit=limit).tasks
    if len(tasks) < 2:
        raise HearthError.of(
            Code.BAD_ARGUMENT, "one task to learn from and none to check with", suggestion="more tasks"
        )
    held = tasks[-min(VALIDATION, len(tasks) // 2) :]
    words = vocabulary([_aims_of(task, known) for task in tasks])
    lessons = list(spread(lesson, [Lesson(task, words, known) for task in tasks], workers, seen))
    traces = [[trace for each in lessons[i:j] for trace in each[chooses == "actions"]]
              for i, j in ((0, -len(held)), (-len(held), None))]  # fmt: skip
    policy = untrained(chooses, words, how.seed)
    imitated = _imitate(policy, traces, how, effort, trained)
    rollout: Rollout = partial(_PLAYED[chooses], policy, known)
    before = _score(rollout, held)
    imitating = deepcopy(policy.network.state_dict())
    practised = _practise(policy, tasks[: -len(held)], held, rollout, how, effort, trained)
    better = max(practised["curves"]["score"], default=before) > before
    if not better:
        policy.network.load_state_dict(imitating)
    facts = {
        "challenge": name,
        "tasks": len(tasks) - len(held),
        "choices": sum(len(trace.choices) for trace in traces[0]),
        "seed": how.seed,
        "episodes": practised["epochs"] * effort.updates * effort.episodes,
        "return_imitated": round(before, 4),
        "kept": "practice" if better else "imitation",
        "imitation": imitated,
        **practised,
    }
    return policy.with_facts(facts)


Rollout = Callable[[Task, int], tuple[list[Trace], float]]
"""(task, seed) -> the choices in an episode, and all its rewards."""


def _aims_of(task: Task, known: Known) -> Any:
    home = start_of(task, known(), None).home
    return task.goal_in(home), home, home.agents[1]


def _imitate(
    policy: TrainedPolicy, traces: Sequence[Sequence[Trace]], how: Training, effort: Effort, seen: Seen
) -> dict[str, Any]:
    import torch

    from hearth.models.helping import actor_critic
    from hearth.models.training import Task as Learning
    from hearth.models.training import train

    network = policy.network

    def batches(chooser: Random) -> Iterator[Batch]:
        return _batches(chooser.sample(traces[0], len(traces[0])), effort.episodes)

    def score() -> float:
        losses = [float(actor_critic.imitation(network, batch)) for batch in _batches(traces[1], effort.episodes)]
        return -mean(losses) if losses else 0.0

    with torch.enable_grad():
        identity = [
            "imitation",
            policy.settings.chooses,
            value_digest([[each.choices, each.returns] for each in traces[0]]),
        ]
        task = Learning(network, batches, partial(actor_critic.imitation, network), score, identity)
        settings = replace(how, epochs=effort.imitation, patience=0, folder=_below(how, "imitation"))
        return train(task, settings, seen).record()


def _practise(
    policy: TrainedPolicy,
    tasks: Sequence[Task],
    held: Sequence[Task],
    rollout: Rollout,
    how: Training,
    effort: Effort,
    seen: Seen,
) -> dict[str, Any]:
    from hearth.models.helping import actor_critic
    from hearth.models.training import Task as Learning
    from hearth.models.training import train

    network = policy.network

    def batches(chooser: Random) -> Iterator[Batch]:
        for _ in range(effort.updates):
            found: list[Trace] = []
            for _ in range(effort.episodes):
                found += rollout(chooser.choice(tasks), chooser.randrange(1 << 30))[0]
            if found:
                yield packed(found)

    identity = ["practice", policy.settings.chooses, value_digest([task.id for task in tasks]), str(effort)]
    score = partial(_score, rollout, held)
    learning = Learning(network, batches, partial(actor_critic.actor_critic, network), score, identity)
    settings = replace(how, epochs=effort.epochs, rate=effort.rate, patience=0, halve_after=0,
                       folder=_below(how, "practice"))  # fmt: skip
    return train(learning, settings, seen).record()


def _below(how: Training, part: str) -> Path | None:
    return None if how.folder is None else how.folder / part


def _batches(traces: Sequence[Trace], size: int) -> Iterator[Batch]:
    for start in range(0, len(traces), size):
        yield packed(traces[start : start + size])


def _score(rollout: Rollout, tasks: Sequence[Task]) -> float:
    """Return the mean of all rewards of an episode."""
    return mean(rollout(task, 0)[1] for task in tasks)


def _helping(policy: TrainedPolicy, known: Known, task: Task, seed: int) -> tuple[list[Trace], float]:
    """Play an episode of Hybrid next to the human-like agent."""
    helper = Hybrid(policy)
    done = beside(task, HumanLike(), helper, known, seed)
    rewards = high_rewards(done)
    return ([traced(helper.choices, rewards)] if helper.choices else []), sum(rewards)


def _practising(policy: TrainedPolicy, known: Known, task: Task, seed: int) -> tuple[list[Trace], float]:
    """Play an episode of an agent alone, with one predicate of a goal (B.3.4)."""
    agent = Practice(policy)
    _, rewards = practised(task, agent, known, seed)
    return ([traced(agent.actions, rewards)] if agent.actions else []), sum(rewards)


_PLAYED: dict[str, Callable[..., tuple[list[Trace], float]]] = {"subgoals": _helping, "actions": _practising}
