"""Episodes of tasks: played by agents, or replayed from a record of their actions."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from hearth.agents.agent_registry import MainAgent
from hearth.agents.protocol import Choice
from hearth.challenges.agent_standard_streams import StandardDescriptors
from hearth.challenges.behavior_counts import analysed
from hearth.challenges.challenge_definition import Challenge, challenge
from hearth.challenges.episode_agents import Lineup
from hearth.challenges.episode_loop import play
from hearth.challenges.harm_counts import harm_counts
from hearth.challenges.language_agents import transcripts
from hearth.challenges.metrics import Outcome, outcome
from hearth.challenges.tasks import Task
from hearth.kb.knowledge import Knowledge
from hearth.schemas.agent_messages import Message
from hearth.schemas.agent_messages import read as read_message
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.rng import derive
from hearth.simulation.env import Env, Tick
from hearth.simulation.goals import Progress
from hearth.simulation.world.digest import digest
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

Known = Callable[[], Knowledge]
"""Gives the knowledge; a function of a module, so that other processes find it."""


@dataclass(frozen=True)
class Job:
    """An episode to be played.

    Attributes:
        task: the task to do.
        seed: number of the episode of its task.
        lineup: the agents that take part.
        helped: whether the helper does.
        helper_goal: the helper's goal; None if it has none.
        known: gives the knowledge.
        make: makes the main agent, if it is not the lineup's; a function that other processes find.
    """

    task: Task
    seed: int
    lineup: Lineup
    helped: bool
    helper_goal: Goal | None
    known: Known
    make: Callable[[], MainAgent] | None = None


@dataclass(frozen=True)
class Record:
    """An episode that was played, as result files have it.

    Attributes:
        task: id of its task.
        seed: number of the episode of its task.
        helped: whether there was a helper.
        helper_goal: the helper's goal, in the words of the grammar; None if it has none.
        actions: of each tick each agent's attempt, `Grab 41`; None where it waited.
        final: digest of the world at the end.
        metrics: the outcome.
        end: why an agent could not go on: its number, a code, a message; None where all could.
        language: the answers of language models, by the agent's number (see `llm.turns`); None where none took part.
    """

    task: str
    seed: int
    helped: bool
    helper_goal: Mapping[str, int] | None
    actions: tuple[tuple[str | None, ...], ...]
    final: str
    metrics: Mapping[str, Any]
    end: Mapping[str, Any] | None = None
    language: Mapping[str, Any] | None = None


TRIES = 2
"""Times that an episode is played whose agent can't go on: a server that fails once may not fail again."""

PASSING = frozenset({Code.AGENT_FAILED, Code.DISCONNECTED})
"""The failures of agents after which their episode is played again."""


def played(job: Job) -> Record:
    """Play an episode; once more where an agent could not go on."""
    alone = threading.current_thread() is threading.main_thread()  # else others write to the same descriptors
    with StandardDescriptors() if job.lineup.own and alone else nullcontext():
        for _ in range(TRIES):
            record = _played(job)
            if record.end is None or record.end["code"] not in PASSING:
                break
    return record


def _played(job: Job) -> Record:
    which, knowledge = challenge(job.task.challenge), job.known()
    start = start_of(job.task, knowledge, None if job.helped else 1)
    goals = _goals(which, job.task, job.helper_goal, start.home, job.helped)
    players: Sequence[Any] = job.lineup.players(
        which, goals[0], goals[-1], knowledge, job.helped, job.make, lambda: job.task.instruction
    )
    seed = derive(job.task.seed, "episode", job.seed)
    allowed = which.allowed(knowledge)
    done = play(
        start,
        goals[0],
        players,
        seed,
        actions=allowed,
        partial=which.partial,
        limit=which.ticks,
        rules=which.rules,
        messages=which.messages,
    )
    for player in players:
        player.agent.close()
    found = measured(which, start, done.env.ticks, goals, done.progress)
    actions = tuple(
        tuple(written(said.get(n) or tick.instructions.get(n)) for n in range(len(players)))
        for tick, said in zip(done.env.ticks, done.said, strict=True)
    )
    asked = None if job.helper_goal is None or not job.helped else which.grammar.written(job.helper_goal)
    fault = done.fault
    end = {"agent": fault.agent, "code": str(fault.fault.code), "message": fault.fault.message} if fault else None
    final = digest(done.env.world)
    said_by_models = transcripts(players)
    return Record(job.task.id, job.seed, job.helped, asked, actions, final, found.as_json(), end, said_by_models)


def again(task: Task, record: Record, knowledge: Knowledge) -> tuple[Outcome, str]:
    """Replay the actions of a record and return the outcome and the digest of the last world.

    Raises:
        HearthError: BAD_ARGUMENT: an action is not one of the challenge's; REPLAY_DIFFERS: something is done after the
            goal was reached, or after the last tick; every fault of the helper's goal.
    """
    which = challenge(task.challenge)
    start = start_of(task, knowledge, None if record.helped else 1)
    ticks, goals, progress = replayed(which, task, record, start)
    return measured(which, start, ticks, goals, progress), digest(ticks[-1].world if ticks else start)


def replayed(
    which: Challenge, task: Task, record: Record, start: World
) -> tuple[list[Tick], list[Goal | None], list[Progress]]:
    """Return the ticks of a record, the agents' goals, and the progress of the first; errors as of `again`."""
    home = start.home
    goals = goals_of(which, task, record, home)
    allowed = which.allowed(home.knowledge)
    env = Env(which.rules, which.partial)
    env.restore(start)
    progress = [Progress.start(goals[0] or Goal(), start)]
    for number, texts in enumerate(record.actions):
        if progress[-1].satisfied or number >= which.ticks or len(texts) != len(start.agents):
            raise HearthError.of(Code.REPLAY_DIFFERS, f"tick {number + 1} comes after the end, or has other agents")
        done = env.step(read_choices(texts, home, allowed, which.messages)[0])
        tried = [step for n, step in done.instructions.items() if n not in done.failures]
        progress.append(progress[-1].then(done.before, done.world, tried))
    if not progress[-1].satisfied and len(env.ticks) < which.ticks and record.end is None:
        raise HearthError.of(Code.REPLAY_DIFFERS, f"it ends after {len(env.ticks)} ticks without a reason")
    return env.ticks, goals, progress


def measured(
    which: Challenge, start: World, ticks: Sequence[Tick], goals: Sequence[Goal | None], progress: Sequence[Progress]
) -> Outcome:
    """Return the metrics of an episode."""
    columns = analysed(which, start, ticks, goals, progress)
    harm = harm_counts(which, start, ticks, goals[0]) if which.consequences else None
    return outcome(which, progress[-1].satisfied, len(ticks), columns, harm)


@lru_cache(maxsize=4)
def start_of(task: Task, knowledge: Knowledge, agents: int | None) -> World:
    """Return a task's start, kept for its next episode."""
    return task.start(knowledge, agents)


def _goals(which: Challenge, task: Task, helper_goal: Goal | None, home: Home, helped: bool) -> list[Any]:
    goals: list[Goal | None] = [task.goal_in(home)]
    if helped:
        goals.append(None if helper_goal is None else which.grammar.in_home(helper_goal, home))
    return goals


def goals_of(which: Challenge, task: Task, record: Record, home: Home) -> list[Any]:
    """Return the goals of the agents of a recorded episode; faults of the helper's goal are raised."""
    helper_goal = None if record.helper_goal is None else which.grammar.read(record.helper_goal)
    return _goals(which, task, helper_goal, home, record.helped)


def read_choices(
    texts: Sequence[str | None], home: Home, allowed: frozenset[str], messages: bool
) -> tuple[dict[int, Step], dict[int, Message]]:
    """Return each agent's instruction and message in a tick of a record; errors as of `read_instruction`."""
    said = {n: told for n, text in enumerate(texts) if messages and text and (told := read_message(text)) is not None}
    rest = {n: text for n, text in enumerate(texts) if text is not None and n not in said}
    return {n: read_instruction(text, n, home, allowed) for n, text in rest.items()}, said


def written(choice: Choice) -> str | None:
    """Return an instruction as records have it, `Grab 41`, or a message as `schemas.agent_messages` has it."""
    if choice is None or isinstance(choice, Message):
        return None if choice is None else str(choice)
    return " ".join([choice.action, *(str(ref.node) for ref in choice.objects)])


def read_instruction(text: str, agent: int, home: Home, allowed: frozenset[str]) -> Step:
    """Return the instruction of a record's text.

    Raises:
        HearthError: BAD_ARGUMENT: it is not an instruction about nodes of the home.
    """
    action, *numbers = text.split(" ")
    nodes = [int(number) if number.isascii() and number.isdigit() and len(number) < 10 else -1 for number in numbers]
    if action not in allowed or any(node not in home.index for node in nodes):
        raise HearthError(Diagnostic(Code.BAD_ARGUMENT, f"`{text[:60]}` is not an instruction of the challenge"))
    return Step(action, tuple(ObjectRef(home.classes[home.index[node]], 0, node) for node in nodes), agent)
