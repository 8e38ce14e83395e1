"""Decisions of agents in tasks of training: the mean and the 99th percentile, in milliseconds.

    python benchmarks/agents_speed.py [--tasks N]

Timed is `act` alone, without views and legal actions; a first pass computes the distance fields of homes, which stay.
"""

from __future__ import annotations

from collections.abc import Callable
from statistics import mean
from time import process_time

from measurement import Figure, as_line, finish, parser

from hearth.agents.agent_registry import HELPERS, MAIN
from hearth.agents.protocol import Agent
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episode_loop import Player, play
from hearth.challenges.tasks import task
from hearth.kb.loading.load import default
from hearth.schemas.goals import Goal
from hearth.schemas.program import Step
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View

WAH = challenge("wah")


class Timed:
    """An agent whose decisions are timed."""

    def __init__(self, agent: Agent, seconds: list[float]) -> None:
        self.agent, self.seconds = agent, seconds

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """As the agent does."""
        self.agent.reset(observation, goal, seed)

    def act(self, observation: View, legal: Legal) -> Step | None:
        """As the agent does."""
        start = process_time()
        step = self.agent.act(observation, legal)
        self.seconds.append(process_time() - start)
        return step


def measure(number: int, helper: str) -> tuple[list[float], list[float]]:
    """Seconds of the decisions of the main agent and of a helper, in that many tasks."""
    known, main, other = default(), [], []  # type: ignore[var-annotated]
    for i in range(number):
        one = task("wah", "train", i)
        world = one.start(known)
        goal = one.goal_in(world.home)
        alice = MAIN["human_like"](WAH.goals_in)
        players = [Player(Timed(alice, main), goal), Player(Timed(HELPERS[helper].make(alice), other), goal)]
        play(world, goal, players, i, actions=WAH.allowed(known), limit=WAH.ticks)
    return main, other


def figures(name: str, seconds: list[float], limits: tuple[float | None, float | None]) -> list[Figure]:
    """Mean and 99th percentile; targets are upper limits."""
    ordered = sorted(seconds)
    values: list[tuple[str, Callable[[], float]]] = [
        ("mean", lambda: mean(ordered)),
        ("99th percentile", lambda: ordered[int(len(ordered) * 0.99)]),
    ]
    found = []
    for (what, value), limit in zip(values, limits, strict=True):
        about = f" (at most {limit:g})" if limit else ""
        found.append(Figure(f"{name}: {what}{about}", 1000 * value(), "ms"))
    return found


def main() -> None:
    """Measure."""
    options = parser(__doc__)
    options.add_argument("--tasks", type=int, default=30)
    asked = options.parse_args()
    measure(asked.tasks, "hp_timed")
    alice, timed = measure(asked.tasks, "hp_timed")
    found = figures("human-like", alice, (1, 20)) + figures("hp_timed", timed, (None, None))
    for figure in found:
        print(as_line(figure))
    finish(found, asked.json)


if __name__ == "__main__":
    main()
