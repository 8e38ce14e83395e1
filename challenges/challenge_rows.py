"""A row of every table that a challenge publishes; each column has its meaning next to its type."""

from __future__ import annotations

from typing import Annotated, TypedDict

from hearth.schemas.row_types import Seed


class CountedRow(TypedDict):
    """A predicate of a goal."""

    predicate: Annotated[str, "as in `ON(plate, dinnertable)`; furniture stands for the home's instance of it"]
    count: Annotated[int, "how often it is wanted"]


class TaskRow(TypedDict):
    """A task: an agent has a goal in a home; of `household`, it is asked in English and acts alone."""

    task_id: Annotated[str, "unique; files of tasks have it, too"]
    challenge: Annotated[str, "wah, owah, one of their variants, or household"]
    split: Annotated[
        str, "train, test-1, test-2, or demonstrations where there is nothing but a demonstration; of household its own"
    ]
    home: Annotated[str, "where it is done"]
    demonstration_home: Annotated[str, "where it was demonstrated; empty of household, whose expert acts in `home`"]
    sets: Annotated[list[str], "the goal sets of the thesis's table B.1 that the goal is of; of household the family"]
    goal: Annotated[list[CountedRow], "what is wanted"]
    predicates: Annotated[int, "number of predicates with their counts; SIT is not counted"]
    seed: Annotated[Seed, "of its start and its episodes"]
    instruction: Annotated[str, "the goal in English; of an activity a person's words, then `In short:`"]
    expert_ticks: Annotated[int | None, "ticks that an agent took that sees everything; of household alone"]
    activity: Annotated[str, "the program of the corpus that it is of, by id; empty of others"]


class InstructionRow(TypedDict):
    """An agent's attempt in a tick."""

    tick: Annotated[int, "from 0"]
    action: Annotated[str, "name of the action"]
    objects: Annotated[list[int], "node ids"]


class HabitRow(TypedDict):
    """Something that had nothing to do with the goal."""

    tick: Annotated[int, "when it was begun, from 0"]
    name: Annotated[str, "distractor, change_of_mind, detour or failed_try"]


class DemonstrationRow(TypedDict):
    """A task that an agent did alone, in its demonstration home; of household, what its expert did."""

    task_id: Annotated[str, "the task"]
    clean: Annotated[bool, "without habits: counting what was put where gives the goal away"]
    ticks: Annotated[int, "how long it took"]
    instructions: Annotated[list[InstructionRow], "what was tried; in other ticks nothing was"]
    habits: Annotated[list[HabitRow], "what else was begun"]


class EpisodeRow(TypedDict):
    """A task that was done by agents."""

    episode_id: Annotated[str, "unique: task, agents, seed"]
    task_id: Annotated[str, "the task"]
    main: Annotated[str, "the agent that was helped"]
    helper: Annotated[str, "the agent that helped; none of an episode alone"]
    goal: Annotated[str, "what the helper was asked to do: true, inferred, random or none"]
    seed: Annotated[int, "number of the episode among those of its task"]
    success: Annotated[bool, "whether the goal was reached"]
    ticks: Annotated[int, "that were played"]
    length: Annotated[int, "ticks that it counts as: all there are where the goal was not reached"]
    reward: Annotated[float, "1 if the goal was reached, less 0.004 a tick of its length"]
    conflicts: Annotated[int, "things that counted for the other agent's goal and that an agent moved away"]
    undone: Annotated[int, "things that counted for the main agent's goal and did no longer"]
    loops: Annotated[int, "instructions with an effect that the same agent had done to the same objects twice before"]
    false_beliefs: Annotated[
        int, "things an agent had seen where they no longer were, the other having taken them unseen"
    ]
    needless: Annotated[int, "things the helper moved that in the end neither count nor are where they were"]
    revealed: Annotated[int, "containers the helper opened and the main agent then saw open"]
    blocked: Annotated[int, "ticks an agent lost to the other, who stood in its way or had what it reached for"]
    idle: Annotated[int, "ticks in which the helper did nothing, or nothing that could be done"]
    failed: Annotated[int, "instructions that could not be done"]
    end: Annotated[str, "code of the failure of an agent that ended it; empty if none did"]


class HarmfulEpisodeRow(EpisodeRow):
    """A task that was done by agents, where acts have consequences."""

    hazards: Annotated[int, "rows of hazards.yaml that became true while agents acted, and lasted"]
    irreversible: Annotated[int, "things that were broken, burnt or used up for good"]
    wasted: Annotated[int, "things opened without use, left on or open, or moved without counting for the goal"]
    helper_harm: Annotated[int, "the hazards and the irreversible changes that came with an act of the helper"]


class TrajectoryRow(TypedDict):
    """An agent's attempt in a tick of an episode."""

    episode_id: Annotated[str, "the episode"]
    tick: Annotated[int, "from 0"]
    agent: Annotated[int, "0 is the main agent, 1 the helper"]
    action: Annotated[str, "name of the action"]
    objects: Annotated[list[int], "node ids"]


class PosteriorRow(TypedDict):
    """The probability, for a helper without the goal, that the goal has a predicate."""

    episode_id: Annotated[str, "the episode"]
    tick: Annotated[int, "from 0; the belief before the actions of this tick"]
    predicate: Annotated[str, "as in `ON(plate, table)`; with the home's class of the furniture"]
    probability: Annotated[float, "by the exact posterior; rows below a hundredth are left out"]
    wanted: Annotated[int, "how often the true goal wants it; 0 if it does not"]
