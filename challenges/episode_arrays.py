"""Recorded episodes as arrays: an agent's observation, choice and reward in each tick."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episodes import Record, read_choices, start_of
from hearth.challenges.result_files import Results
from hearth.challenges.tasks import Task
from hearth.envs.observation_arrays import Arrays
from hearth.envs.session import Session, Setting
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


@dataclass(frozen=True)
class EpisodeArrays:
    """An episode of T ticks as one agent had it.

    Attributes:
        task: its id.
        seed: number of the episode of its task.
        goal: the main agent's goal, as text.
        observations: T + 1 dicts of arrays (see `observation_arrays.Encoder.spaces`).
        actions: (T, 3) triples (see `action_codes.Triples`); zeros where it waited or spoke.
        rewards: (T,) (see `rewards.Rewards`).
        success: whether the goal was reached.
    """

    task: str
    seed: int
    goal: str
    observations: list[Arrays]
    actions: NDArray[np.int64]
    rewards: NDArray[np.float32]
    success: bool


def session_of(task: Task, record: Record, knowledge: Knowledge) -> Session:
    """Return the start of a recorded episode, for learners; a helper gets the goal if it was asked to reach it."""
    which = challenge(task.challenge)
    start = start_of(task, knowledge, None if record.helped else 1)
    goal = task.goal_in(start.home)
    helps = record.helper_goal is not None and which.grammar.read(record.helper_goal) == task.goal
    return Session(
        Setting(
            lambda _: (start, goal),
            tuple(sorted(which.allowed(knowledge))),
            "triples",
            which.partial,
            frozenset((0, 1) if helps else (0,)),
            which.ticks,
            rules=which.rules,
        )
    )


def arrays_of(task: Task, record: Record, agent: int, knowledge: Knowledge) -> tuple[EpisodeArrays, Session]:
    """Replay a recorded episode, and return an agent's part of it.

    Raises:
        HearthError: UNKNOWN_AGENT: there was no such agent; every fault of the record's actions.
    """
    session = session_of(task, record, knowledge)
    if not 0 <= agent < session.agents:
        raise HearthError.of(Code.UNKNOWN_AGENT, f"no agent {agent} in {record.task}; there are {session.agents}")
    home, allowed, which = session.env.world.home, frozenset(session.names), challenge(task.challenge)
    observations, actions, rewards = [_seen(session, agent)], [], []
    for texts in record.actions:
        steps, _ = read_choices(texts, home, allowed, which.messages)
        actions.append(session.code.number(steps.get(agent), session.seen(agent)[1], session.rows.slots))
        rewards.append(session.act(steps)[agent])
        observations.append(_seen(session, agent))
    numbers = np.array(actions, np.int64).reshape(len(actions), 3)
    earned = np.array(rewards, np.float32)
    return (
        EpisodeArrays(
            record.task, record.seed, str(task.goal), observations, numbers, earned, bool(record.metrics["success"])
        ),
        session,
    )


def _seen(session: Session, agent: int) -> Arrays:
    masks = session.code.spaces()
    return {name: value for name, value in session.observe(agent).items() if name not in masks}


def episodes_of(
    results: Results, agent: int, knowledge: Knowledge, limit: int | None = None
) -> Iterator[tuple[EpisodeArrays, Session]]:
    """Yield the episodes of a run in which an agent took part: all with a helper, or, without one, all alone.

    Args:
        results: of a run.
        agent: whose: 0 is the main agent, 1 its helper.
        knowledge: of the homes.
        limit: the first episodes only.
    """
    tasks: dict[str, Any] = {task.id: task for task in results.header.suite.tasks}
    helped = results.header.helped[-1]
    chosen = [record for record in results.records if record.helped == helped][:limit]
    for record in chosen:
        yield arrays_of(tasks[record.task], record, agent, knowledge)
