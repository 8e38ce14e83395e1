"""An episode played by agents: each is asked once a tick, until the goal is reached or the time is over."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from hearth.agents.protocol import Agent, Resigned
from hearth.challenges.guard import AgentError
from hearth.schemas.goals import Goal
from hearth.schemas.rng import derive
from hearth.simulation.env import Env
from hearth.simulation.goals import Progress
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.world import World

MOST_TICKS = 250
"""Ticks after which an episode ends (thesis 6.5)."""


@dataclass(frozen=True, slots=True)
class Player:
    """An agent in an episode.

    Attributes:
        agent: who decides.
        goal: what it is asked to reach; None if nothing.
        partial: whether it sees only what is around it; as the episode has it where None.
    """

    agent: Agent
    goal: Goal | None
    partial: bool | None = None


@dataclass(frozen=True, slots=True)
class Played:
    """An episode as it was played.

    Attributes:
        env: with its ticks.
        progress: of the goal in the real world, at the start and after each tick.
        fault: why an agent could not go on, which ended the episode; None where all could.
    """

    env: Env
    progress: tuple[Progress, ...]
    fault: AgentError | None = None

    @property
    def success(self) -> bool:
        """Whether the goal was reached."""
        return self.progress[-1].satisfied

    @property
    def ticks(self) -> int:
        """How long it took."""
        return len(self.env.ticks)


def play(
    start: World,
    goal: Goal,
    players: Sequence[Player],
    seed: int,
    *,
    actions: Iterable[str] | None = None,
    partial: bool = True,
    limit: int = MOST_TICKS,
    rules: Rules = DEFAULT,
) -> Played:
    """Let agents act in a world, one instruction each a tick, until a goal is reached or an agent ends it.

    Args:
        start: a world in which character n belongs to player n.
        goal: what ends the episode; progress is counted in the real world only.
        players: who acts.
        seed: of the episode; each agent gets one derived from it.
        actions: what may be tried; everything where None.
        partial: whether agents see only what is around them.
        limit: ticks after which it ends.
        rules: of actions.
    """
    env = Env(rules, partial)
    env.restore(start)
    progress = [Progress.start(goal, start)]
    allowed = None if actions is None else frozenset(actions)
    try:
        for number, player in enumerate(players):
            env.partial = partial if player.partial is None else player.partial
            player.agent.reset(env.observe(number), player.goal, derive(seed, "agent", number))
        while len(env.ticks) < limit and not progress[-1].satisfied:
            chosen = {}
            for number, player in enumerate(players):
                env.partial = partial if player.partial is None else player.partial
                chosen[number] = player.agent.act(env.observe(number), env.legal(number, actions=allowed))
            done = env.step(chosen)
            tried = [step for number, step in done.instructions.items() if number not in done.failures]
            progress.append(progress[-1].then(done.before, done.world, tried))
    except AgentError as fault:
        return Played(env, tuple(progress), fault)
    except Resigned:
        pass
    return Played(env, tuple(progress))
