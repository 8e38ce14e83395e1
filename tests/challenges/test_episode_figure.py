"""An episode on the floor plan."""

from __future__ import annotations

from itertools import pairwise
from math import dist

from hearth.analysis.episode_figure import ticks_of, trails
from hearth.challenges.episode_agents import Lineup
from hearth.challenges.episodes import Job, played
from hearth.challenges.published_tasks import tasks
from hearth.kb.loading.load import default
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.world.home import Home


def _walkable(home: Home, start: tuple[float, float], end: tuple[float, float]) -> bool:
    """Return whether each decimeter of a straight line is near a cell on which an agent can stand."""
    ways = ground_of(home).ground.ways
    number = max(1, int(dist(start, end) / 0.1))
    points = ((start[0] + (end[0] - start[0]) * n / number, start[1] + (end[1] - start[1]) * n / number)
              for n in range(number + 1))  # fmt: skip
    return all(dist(point, ways.points[ways.nearest(point)]) < 0.2 for point in points)


def test_the_ways_of_a_helper_of_three_metres_cross_no_wall(knowledge):
    (task,) = tasks("owah", "test", limit=1)
    record = played(Job(task, 0, Lineup(helper="random"), True, None, default))
    start, ticks = ticks_of(task, record, knowledge)
    main, helper = trails(start, ticks)
    strides = [dist(*pair) for pair in pairwise(tick.world.agents[1].pose.point for tick in ticks)]
    assert max(strides) > 1.5
    assert all(_walkable(start.home, *pair) for trail in (main, helper) for pair in pairwise(trail.points))
