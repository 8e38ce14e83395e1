"""Episodes of the low-level policy: alone, one predicate of a goal, rewards of B.3.4 in tenths."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from hearth.agents.learned_helpers import Choice, Learned
from hearth.agents.subgoals import Aims, Missing, Subgoal
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episode_loop import Played, Player, play
from hearth.challenges.episodes import Known, start_of
from hearth.challenges.tasks import Task
from hearth.kb.knowledge import Knowledge
from hearth.schemas.goals import Goal
from hearth.schemas.literals import AGENT, Name
from hearth.schemas.rng import derive, rng
from hearth.simulation.observation import reach
from hearth.simulation.observation.views import View
from hearth.simulation.world.bits import mask_of

if TYPE_CHECKING:
    from hearth.models.helping.policies import TrainedPolicy

CLOSE, DONE = 0.005, 1.0
"""Rewards for being close to a wanted thing or its target, and for taking or putting it: tenths of the thesis's."""

LIMIT = 100
"""Ticks after which practising ends."""


class Practice(Learned):
    """HRL with one predicate to bring about, so that there is no subgoal to choose."""

    def __init__(self, policy: TrainedPolicy) -> None:
        super().__init__(policy, policy)

    def choose(self, view: View, subgoals: Sequence[Subgoal], missing: Missing) -> Subgoal | None:
        """Any: they are of one part."""
        return next((each for each in subgoals if each.part in self.reader.pairs), None)


def practised(task: Task, agent: Practice, known: Known, seed: int) -> tuple[Played, list[float]]:
    """Return an episode alone, in which one predicate of a task's goal is wanted once; the rewards of its ticks."""
    which, knowledge = challenge(task.challenge), known()
    start = start_of(task, knowledge, 1)
    things = [(each, 1) for each, _ in task.goal_in(start.home) if not _of_characters(each.subject)]
    goal = Goal((rng(derive(task.seed, "practice", seed), "predicate").choice(things),)) if things else Goal()
    done = play(
        start,
        goal,
        [Player(agent, goal)],
        derive(task.seed, "practice", seed),
        actions=which.allowed(knowledge),
        partial=which.partial,
        limit=LIMIT,
        rules=which.rules,
    )
    return done, low_rewards(done, 0, agent.aims, 0, agent.actions)


def _of_characters(term: Name | None) -> bool:
    return isinstance(term, str) and term.partition(":")[0] == AGENT


def low_rewards(done: Played, number: int, aims: Aims, part: int, choices: Sequence[Choice]) -> list[float]:
    """Return the rewards of an episode's ticks for one agent's choices for one part of a goal."""
    wanted = next(each for each in aims.wanted if each.part == part)
    things, places = wanted.counted, wanted.candidates.targets
    chosen = {each.tick for each in choices}
    rewards, earned = [0.0] * len(done.env.ticks), set[str]()
    for time in sorted(chosen):
        if time >= len(done.env.ticks):
            continue
        tick = done.env.ticks[time]
        agent, step = tick.world.agents[number], tick.instructions.get(number)
        near = reach.close_to(tick.world, agent)
        rewards[time] = CLOSE if near & (places if agent.held & things else things) else 0.0
        kind = _earned(step.action if step and number not in tick.failures else "", tick.world.home.knowledge)
        nodes = mask_of(tick.world.home.index[ref.node or 0] for ref in step.objects) if step else 0
        right = nodes & things and (kind == "takes" or nodes & places)
        if kind and right and kind not in earned:
            earned.add(kind)
            rewards[time] += DONE
    return rewards


def _earned(action: str, knowledge: Knowledge) -> str:
    return next((name for name in ("takes", "puts") if action in knowledge.group(name)), "")
