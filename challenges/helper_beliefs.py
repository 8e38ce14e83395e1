"""A helper's beliefs about the goal in each tick of an episode: the episode is replayed, and the helper watches."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hearth.agents.goal_space import Counts
from hearth.agents.online_helper import OnlineHelper
from hearth.agents.online_helper_registry import ONLINE
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episode_loop import Playing
from hearth.challenges.episodes import Record, read_choices, start_of
from hearth.challenges.tasks import Task
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import derive


@dataclass(frozen=True, slots=True)
class Moment:
    """A helper's beliefs before a tick.

    Attributes:
        wanted: (P) the probability, by its exact posterior, that the goal has each predicate.
        truth: the probability that its posterior gives to the true goal.
        f1: how well the goals agree with the true one that it reckons with, in expectation.
    """

    wanted: tuple[float, ...]
    truth: float
    f1: float


@dataclass(frozen=True, slots=True)
class Beliefs:
    """A helper's beliefs in an episode.

    Attributes:
        predicates: (P) in the words of the grammar.
        goal: (P) how often the true goal wants each.
        moments: one for each tick.
    """

    predicates: tuple[str, ...]
    goal: Counts
    moments: tuple[Moment, ...]


def beliefs(task: Task, record: Record, helper: str, knowledge: Knowledge) -> Beliefs:
    """Follow an episode with a helper that was not given the goal.

    Raises:
        HearthError: BAD_ARGUMENT: the helper infers no goals, or was not there, or the goal is none of those that it
            reckons with; every fault of its actions.
    """
    if helper not in ONLINE or not record.helped or record.helper_goal is not None:
        raise HearthError.of(Code.BAD_ARGUMENT, f"`{helper[:40]}` infers no goal here", suggestion=", ".join(ONLINE))
    which = challenge(task.challenge)
    start = start_of(task, knowledge, None)
    goal, allowed = task.goal_in(start.home), which.allowed(knowledge)
    playing = Playing(
        start,
        goal,
        [which.partial] * 2,
        actions=allowed,
        limit=which.ticks,
        rules=which.rules,
        messages=which.messages,
    )
    agent = ONLINE[helper].make(which.goals_in)
    assert isinstance(agent, OnlineHelper)
    agent.reset(playing.view(1), None, derive(derive(task.seed, "episode", record.seed), "agent", 1))
    if goal not in agent.space.goals:
        message = f"the goal of {task.id[:80]} is none that people have in {task.home[:80]}: {str(goal)[:200]}"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="tasks of `challenge tasks`")
    number = agent.space.goals.index(goal)
    moments = []
    for texts in record.actions:
        agent.act(playing.view(1), playing.legal(1))
        moments.append(_moment(agent, number))
        steps, said = read_choices(texts, start.home, allowed, which.messages)
        playing.step({**steps, **said})
    names = tuple(f"{each.name}({each.subject}, {start.home.classes[start.home.index[int(str(each.target))]]})"
                  for each in agent.space.predicates)  # fmt: skip
    return Beliefs(names, agent.space.wanted[number], tuple(moments))


def _moment(agent: OnlineHelper, number: int) -> Moment:
    posterior, true = agent.posterior, agent.space.counts[number]
    wanted = posterior.weights @ (agent.space.counts > 0)
    agreed = sum(
        share * 2 * float(np.minimum(goal, true).sum()) / float(sum(goal) + true.sum())
        for goal, share in agent.proposed.items()
    )
    return Moment(tuple(np.round(wanted, 6).tolist()), round(posterior.probability(number), 9), round(agreed, 6))
