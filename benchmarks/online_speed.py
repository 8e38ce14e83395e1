"""Decisions of helpers that are not given the goal, and updates of the posterior: mean and 99th percentile.

    python benchmarks/online_speed.py [--tasks N]

Timed in tasks of training: all of `act` of NOPA and of the helper that expects times, and `Posterior.observe` within.
"""

from __future__ import annotations

from time import process_time

from agents_speed import Timed, figures
from measurement import as_line, finish, parser

from hearth.agents.agent_registry import MAIN
from hearth.agents.goal_posterior import Posterior
from hearth.agents.goal_space import Scene
from hearth.agents.online_helper_registry import ONLINE
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episode_loop import Player, play
from hearth.challenges.tasks import task
from hearth.kb.loading.load import default
from hearth.simulation.observation.views import Pose

OWAH = challenge("owah")


class TimedPosterior(Posterior):
    """A posterior whose updates are timed."""

    seconds: list[float] = []  # noqa: RUF012

    def observe(self, scene: Scene, other: Pose) -> None:
        """As a posterior does."""
        start = process_time()
        super().observe(scene, other)
        self.seconds.append(process_time() - start)


def measure(number: int, helper: str) -> list[float]:
    """Seconds of a helper's decisions in that many tasks."""
    known, seconds = default(), []  # type: ignore[var-annotated]
    for i in range(number):
        one = task("owah", "train", i)
        world = one.start(known)
        goal = one.goal_in(world.home)
        players = [
            Player(MAIN["human_like"](OWAH.goals_in), goal),
            Player(Timed(ONLINE[helper].make(OWAH.goals_in), seconds), None),
        ]
        play(world, goal, players, i, actions=OWAH.allowed(known), partial=OWAH.partial, limit=OWAH.ticks)
    return seconds


def main() -> None:
    """Measure."""
    from hearth.agents import online_helper

    options = parser(__doc__)
    options.add_argument("--tasks", type=int, default=20)
    asked = options.parse_args()
    measure(asked.tasks, "nopa")
    nopa, expected = measure(asked.tasks, "nopa"), measure(asked.tasks, "expected_time")
    online_helper.Posterior = TimedPosterior  # type: ignore[misc]
    measure(asked.tasks, "nopa")
    found = figures("NOPA", nopa, (5, 50)) + figures("expected time", expected, (None, None))
    found += figures("posterior update", TimedPosterior.seconds, (1, None))
    for figure in found:
        print(as_line(figure))
    finish(found, asked.json)


if __name__ == "__main__":
    main()
