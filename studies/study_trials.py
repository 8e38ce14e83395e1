"""Trials of a study as episodes of tasks: played by people or by agents, and checked by a replay."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any

from hearth.agents.agent_registry import MainAgent
from hearth.challenges import published_tasks
from hearth.challenges.demonstration_episodes import Wish
from hearth.challenges.episode_agents import Lineup
from hearth.challenges.episodes import Job, Known, Record, again
from hearth.challenges.result_files import episode_data, episode_of
from hearth.challenges.suite_runs import INFERRED, helper_goal
from hearth.challenges.task_files import Suite
from hearth.challenges.tasks import Task
from hearth.challenges.watch_stage import Watched, infer
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.studies.assignment import Planned
from hearth.studies.study import Condition, Study, Tasks


@lru_cache(maxsize=16)
def suite_of(tasks: Tasks) -> Suite:
    """Return the tasks of a study."""
    found = published_tasks.tasks(tasks.challenge, tasks.split, limit=tasks.number)
    return Suite(tasks.challenge, tasks.split, published_tasks.PUBLISHED, found)


def tasks_of(study: Study) -> tuple[Task, ...]:
    """Return the tasks of a study whose people play, or whose films show people and agents.

    Raises:
        HearthError: BAD_ARGUMENT: it has none.
    """
    if study.tasks is None:
        raise HearthError.of(Code.BAD_ARGUMENT, f"`{study.name}` has no tasks")
    return suite_of(study.tasks).tasks


def practice_task(study: Study, number: int) -> Task:
    """Return a task that does not count, in a home of training."""
    assert study.tasks is not None
    return published_tasks.tasks(study.tasks.challenge, "train", limit=number + 1)[number]


def check_helpers(study: Study) -> None:
    """Refuse a study whose helpers can't be here.

    Raises:
        HearthError: MISSING_FILE: they ask networks, and the extra `models` is not installed.
    """
    for condition in study.conditions:
        lineup_of(condition).installed()


def lineup_of(condition: Condition) -> Lineup:
    """Return the agents under a condition; the person is in the place of the human-like agent."""
    return Lineup(helper=condition.helper, goal=condition.goal).checked()


def job_of(study: Study, planned: Planned, known: Known, make: Callable[[], MainAgent] | None = None) -> Job:
    """Return a trial as an episode.

    Its number among the task's episodes is its repeat, so that a helper with a random goal has the one that it has with
    the human-like agent (thesis 6.6).

    Args:
        study: of the trial.
        planned: the trial.
        known: gives the knowledge.
        make: makes the agent in the person's place; the human-like agent where None.
    """
    condition, task = study.condition(planned.condition), tasks_of(study)[planned.item]
    lineup = lineup_of(condition)
    goal = _asked(study, lineup, task, planned.repeat, known) if condition.helped else None
    return Job(task, planned.repeat, lineup, condition.helped, goal, known, make)


def _asked(study: Study, lineup: Lineup, task: Task, repeat: int, known: Known) -> Goal | None:
    if (reader := INFERRED.get(lineup.goal)) is not None:
        return _inferred(task, reader, known)
    return helper_goal(lineup.goal, task, repeat, tasks_of(study))


@lru_cache(maxsize=256)
def _inferred(task: Task, reader: str, known: Known) -> Goal:
    return infer(Watched(Wish(task, 1.0, known), reader))


def checked(study: Study, planned: Planned, given: Mapping[str, Any], knowledge: Knowledge) -> dict[str, Any]:
    """Return a record of a trial, with the metrics of a replay of its actions.

    Raises:
        HearthError: BAD_JSON: it is not a record; REPLAY_DIFFERS: it is one of another trial, or ends in another world.
    """
    record = episode_of(dict(given))
    if record is None:
        raise HearthError.of(Code.BAD_JSON, "not a record of an episode")
    task = tasks_of(study)[planned.item]
    helped = study.condition(planned.condition).helped
    if (record.task, record.seed, record.helped) != (task.id, planned.repeat, helped):
        raise HearthError.of(Code.REPLAY_DIFFERS, f"the record is of {record.task}, not of this trial")
    outcome, final = again(task, record, knowledge)
    if final != record.final:
        raise HearthError.of(Code.REPLAY_DIFFERS, "the record ends in another world when it is replayed")
    data = episode_data(replace(record, metrics=outcome.as_json()))
    return {**data, "actions": [list(tick) for tick in record.actions]}


def record_of(data: Mapping[str, Any]) -> Record:
    """Return the record of a checked trial.

    Raises:
        HearthError: BAD_JSON: it is none.
    """
    found = episode_of(data) if isinstance(data, dict) else None
    if found is None:
        raise HearthError.of(Code.BAD_JSON, "not a record of an episode")
    return found
