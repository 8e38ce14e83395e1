"""Bodies in helped episodes: two in one place, and agents that wait for ever, with and without the rule `bodies`.

    python benchmarks/bodies_in_episodes.py [--episodes 300] [--without]

Tasks of Watch-And-Help and of Online Watch-And-Help come in turn, with four helpers. Two bodies are in one place where
their middles come nearer than two radii, less the tolerance, at the end of a tick or, where they walk, on the straight
way of both during it. An agent waits for ever if it tries to walk and does not get on for `PATIENCE` ticks.
"""

from __future__ import annotations

import argparse
import math
from collections import Counter
from collections.abc import Iterator, Sequence

from hearth.agents.agent_registry import HELPERS, MAIN
from hearth.agents.online_helper_registry import ONLINE
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episode_loop import Player, play
from hearth.challenges.tasks import task
from hearth.kb.loading.load import default
from hearth.simulation.env import Tick
from hearth.simulation.motion.navigation import BODY_RADIUS
from hearth.simulation.world.world import World

LINEUPS = (("wah", "hp_true"), ("wah", "random"), ("owah", "expected_time"), ("owah", "nopa"))
"""Challenges with helpers."""

PATIENCE = 40
"""Ticks without progress after which an agent counts as waiting for ever."""

NEAR = 2 * BODY_RADIUS - 0.05
"""Distance below which two bodies are in one place, metres."""

WALKS = frozenset({"Walktowards", "Walkforward"})

Ticks = Sequence[Tick]


def played(number: int, bodies: bool) -> tuple[str, Ticks, bool]:
    """Return the helper of an episode, its ticks, and whether its goal was reached."""
    name, helper = LINEUPS[number % len(LINEUPS)]
    this, known = challenge(name), default()
    one = task(name, "train", number // len(LINEUPS))
    world = one.start(known)
    goal = one.goal_in(world.home)
    main = MAIN["human_like"](this.goals_in)
    online = ONLINE.get(helper)
    other = online.make(this.goals_in) if online else HELPERS[helper].make(main)
    given = None if online or HELPERS[helper].goal == "none" else goal
    players = [Player(main, goal), Player(other, given)]
    found = play(
        world,
        goal,
        players,
        number,
        actions=this.allowed(known),
        partial=this.partial,
        limit=this.ticks,
        rules=one.rules._replace(bodies=bodies),
    )
    return helper, found.env.ticks, found.progress[-1].satisfied


def points(world: World) -> list[tuple[float, float]]:
    """Return where the characters stand."""
    return [each.pose.point for each in world.agents if each.pose is not None]


def nearest(before: World, world: World) -> float:
    """Return the least distance of two characters while they go straight from place to place, metres."""
    (a, b), (c, d) = points(before), points(world)
    least = math.inf
    for part in range(11):
        share = part / 10
        one, other = (
            [start + (end - start) * share for start, end in zip(*way, strict=True)] for way in ((a, c), (b, d))
        )
        least = min(least, math.dist(one, other))
    return least


def overlaps(ticks: Ticks) -> int:
    """Return the ticks in which two bodies are in one place and come nearer or go on so."""
    return sum(_is_near(each) for each in ticks)


def _is_near(tick: Tick) -> bool:
    """Return whether a tick brings two together; on the way only if both walk or stand, since others find a way."""
    if math.dist(*points(tick.world)) < NEAR:
        return True
    walks = all(
        one == other or ((step := tick.instructions.get(number)) is None or step.action in WALKS)
        for number, (one, other) in enumerate(zip(points(tick.before), points(tick.world), strict=True))
    )
    return walks and nearest(tick.before, tick.world) < NEAR


def waits(ticks: Ticks) -> Iterator[int]:
    """Yield for each agent the most ticks in a row in which it tried to walk and did not get on."""
    for number in (0, 1):
        row = most = 0
        for each in ticks:
            step = each.instructions.get(number)
            one, other = each.before.agents[number], each.before.agents[1 - number]
            blocked = math.dist(*points(each.before)) < 2 * BODY_RADIUS + one.stride + other.stride
            after = each.world.agents[number]
            there = step is not None and bool(step.objects) and _is_there(each.world, after.close, step.objects[0].node)
            stood = number not in each.failures and one.pose == after.pose and not there
            row = row + 1 if step is not None and step.action in WALKS and stood and blocked else 0
            most = max(most, row)
        yield most


def _is_there(world: World, close: int, node: int | None) -> bool:
    return node is not None and bool(close >> world.home.index[node] & 1)


def measured(episodes: int, bodies: bool) -> None:
    """Play episodes and print what was counted."""
    count: Counter[str] = Counter()
    for number in range(episodes):
        helper, ticks, reached = played(number, bodies)
        near = overlaps(ticks)
        longest = max(waits(ticks))
        count.update(ticks=len(ticks), near=near, reached=reached, helped=1)
        count["episodes with two bodies in one place"] += near > 0
        count["episodes in which an agent waits for ever"] += longest >= PATIENCE
        count[f"{helper}: overlapping"] += near > 0
        count[f"{helper}: waiting"] += longest >= PATIENCE
        if near or longest >= PATIENCE:
            print(f"  episode {number} ({helper}): {near} ticks in one place, waits {longest} ticks", flush=True)
    rule = "with" if bodies else "without"
    print(f"{rule} the rule `bodies`: {count['helped']} episodes, {count['ticks']:,} ticks, {count['reached']} reached")
    for name in sorted(each for each in count if each.startswith("episodes") or ":" in each):
        print(f"  {name}: {count[name]}")
    print(f"  ticks with two bodies in one place: {count['near']}")


def main() -> None:
    """Measure."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--episodes", type=int, default=300)
    options.add_argument("--without", action="store_true", help="without the rule")
    asked = options.parse_args()
    measured(asked.episodes, bodies=not asked.without)


if __name__ == "__main__":
    main()
