"""The task `household`, its solver and its scorer."""

import asyncio

from inspect_ai import Task, task
from inspect_ai.dataset import MemoryDataset, Sample
from inspect_ai.model import ChatMessageSystem, ChatMessageUser
from inspect_ai.scorer import Score, Scorer, Target, accuracy, mean, scorer, stderr
from inspect_ai.solver import Generate, Solver, TaskState, solver

import hearth

METRICS = {
    "won": [accuracy(), stderr()],
    "goal_fraction": [mean()],
    "total": [mean()],
    "faults": [mean()],
    "ticks": [mean()],
    "turn": [mean()],
}
"""Measures of an episode: success, the part of the goal, the engine's reward, refused commands, ticks, commands."""


@solver
def acting(turns: int = 50) -> Solver:
    """Play an episode: each answer of the model is a command, and the next observation follows.

    Args:
        turns: commands that the model has.
    """

    async def solve(state: TaskState, generate: Generate) -> TaskState:
        episode = hearth.TextEpisode(**state.metadata["episode"])
        turn = await asyncio.to_thread(episode.reset, state.metadata["seed"])
        state.messages = [ChatMessageSystem(content=episode.instructions)]
        while not turn.done and turn.turn < turns:
            state.messages.append(ChatMessageUser(content=turn.observation))
            state = await generate(state)
            turn = await asyncio.to_thread(episode.step, state.output.completion)
            state.store.set("hearth", turn.as_json())
        return state

    return solve


@scorer(metrics=METRICS)
def reached() -> Scorer:
    """Score an episode by the engine's facts."""

    async def score(state: TaskState, target: Target) -> Score:
        facts = state.store.get("hearth", {})
        return Score(value={name: float(facts.get(name, 0)) for name in METRICS}, explanation=facts.get("task"))

    return score


@task
def household(
    tasks: str = "wah:test-1",
    home: str = "",
    goal: str | list[str] = "",
    episodes: int = 20,
    limit: int = 250,
    turns: int = 50,
) -> Task:
    """Return episodes of a source of tasks, or of a home with a goal.

    Args:
        tasks: CHALLENGE:SPLIT, with :N for the first N tasks, or a file of `hearth challenge tasks`.
        home: the name of a home, with a goal.
        goal: in that home; the command line takes a goal apart at its commas, so a list is put together again.
        episodes: how many, each with a seed of its own.
        limit: ticks of an episode.
        turns: commands of an episode.
    """
    goal = goal if isinstance(goal, str) else ",".join(goal)
    given = {"home": home, "goal": goal} if home or goal else {"tasks": tasks}
    hearth.TextEpisode(**given)  # what is wrong is said before the first sample
    rows = [
        Sample(input=goal or tasks, id=f"seed-{n}", metadata={"episode": {**given, "limit": limit}, "seed": n})
        for n in range(episodes)
    ]
    return Task(dataset=MemoryDataset(rows, name="hearth"), solver=acting(turns), scorer=reached())
