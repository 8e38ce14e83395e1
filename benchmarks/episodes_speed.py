"""Episodes of two agents that move by metres: ticks, views with legal masks, copies, and records that are done again.

`python benchmarks/episodes_speed.py --episodes 1000` records that many random episodes of 250 ticks, writes and reads
them, does them again in two processes with other hash seeds, and changes one action in each.
"""

from __future__ import annotations

import copy
import os
import random
import subprocess
import sys
import tempfile
from dataclasses import replace
from itertools import accumulate
from pathlib import Path
from time import process_time

from measurement import Figure, as_line, finish, parser, passes, rate, runs
from plain_reference import Yardstick, strides_by_search

from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.schemas.goals import Goal
from hearth.schemas.literals import Literal
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.actions.legal import legal
from hearth.simulation.engine import tick
from hearth.simulation.env import Env, Tick
from hearth.simulation.episode import Episode
from hearth.simulation.episode_files import read, write
from hearth.simulation.goals import Progress
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.observation.views import view
from hearth.simulation.world.bits import indices

TICKS = 250
GOAL = Goal.of(
    (Literal.of("ON", "plate", "table"), 2),
    (Literal.of("INSIDE", "milk", "fridge"), 1),
    Literal.of("HOLDS", "agent", "book"),
)
AGAIN = (
    "import sys; from pathlib import Path; from hearth.kb.loading.load import default;"
    "from hearth.simulation.episode_files import read;"
    "print(sum(each.verify() is None for each in read(Path(sys.argv[1]), default())))"
)


def chosen(env: Env, number: int, chooser: random.Random, mostly: str) -> Step:
    """A legal instruction: half of them of one action, the others of any."""
    found = legal(env.world, number)
    action = mostly if mostly in found.masks and chooser.random() < 0.5 else chooser.choice(list(found.masks))
    nodes = [chooser.choice(found.objects(action, position)) for position in range(len(found.masks[action]))]
    home = env.world.home
    return Step(action, tuple(ObjectRef(home.classes[home.index[node]], 0, node) for node in nodes), number)


def played(number: int) -> Env:
    """A random episode."""
    chooser = random.Random(number)
    env = Env(knowledge=default())
    env.reset(library.names()[number % 7], 2, seed=number)
    for _ in range(TICKS):
        env.step({agent: chosen(env, agent, chooser, "Walktowards") for agent in (0, 1)})
    return env


def fetched(number: int) -> Env:
    """An episode in which both go from thing to thing and take or put something wherever they have arrived."""
    chooser = random.Random(number)
    env = Env(knowledge=default())
    env.reset("maple", 2, seed=number)
    home = env.world.home
    places = list(indices(home.furniture))
    towards = [chooser.choice(places), chooser.choice(places)]
    for _ in range(TICKS):
        steps = {}
        for agent in (0, 1):
            ref = ObjectRef(home.classes[towards[agent]], 0, home.ids[towards[agent]])
            steps[agent] = Step("Walktowards", (ref,), agent)
            there = ground_of(home).ground.stands(towards[agent])  # type: ignore[union-attr]
            pose = env.world.agents[agent].pose
            assert pose is not None
            if ground_of(home).ground.ways.at(*pose.point) in there:  # type: ignore[union-attr]
                steps[agent] = chosen(env, agent, chooser, "PutBack" if env.world.agents[agent].held else "Grab")
                towards[agent] = chooser.choice(places)
        env.step(steps)
    return env


def seen(each: Tick) -> None:
    """Compute each agent's view and possible actions."""
    for agent in (0, 1):
        view(each.world, agent)
        dict(legal(each.world, agent).masks)


def searched(env: Env) -> Yardstick:
    """The strides of an episode, each by a search of its own."""
    ground = ground_of(env.world.home).ground  # type: ignore[union-attr]
    found = []
    for each in env.ticks:
        for number, step in each.instructions.items():
            pose = each.before.agents[number].pose
            if step.action == "Walktowards" and pose is not None and step.objects[0].node is not None:
                end = ground.stands(env.world.home.index[step.objects[0].node])[0]
                found.append((*ground.floor.index(*pose.point), *map(int, ground.ways.cells[end])))
    return strides_by_search(ground.floor.walkable, found[:40])


def speeds() -> list[Figure]:
    """Ticks with metres and a goal, views with legal masks, and copies."""
    env = fetched(1)
    yardstick = searched(env)
    world = env.world
    first = Progress.start(GOAL, env.ticks[0].before)
    states = list(accumulate(env.ticks, lambda now, each: now.then(each.before, each.world), initial=first))

    def followed(item: tuple[Tick, Progress]) -> None:
        each, progress = item
        after, _ = tick(each.before, each.instructions, env.rules)
        progress.then(each.before, after)

    ticks = passes(followed, list(zip(env.ticks, states, strict=False)), 15)
    sights = passes(seen, env.ticks, 15)
    copies = runs(lambda: [copy.copy(world) for _ in range(10_000)])
    return [
        rate("ticks of two agents, metres, goal", TICKS, ticks, "ticks/s", 20_000, yardstick.ratio(2 * TICKS, ticks)),
        rate("views with legal masks", 2 * TICKS, sights, "agents/s", 5_000),
        rate("copies of a state", 10_000, copies, "copies/s", 1e6),
    ]


def records(count: int) -> list[Figure]:
    """Record, write, read, do again elsewhere, and change one action of each."""
    began = process_time()
    episodes = [Episode.of(played(number)) for number in range(count)]
    recorded = count * TICKS / (process_time() - began)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "episodes.jsonl.gz")
        write(file, episodes)
        again = [_again(file, seed) for seed in ("1", "2")]
        changed = sum(_changed(each, number) for number, each in enumerate(read(file, default())))
    print(f"{count} episodes of {TICKS} ticks; done again with equal digests: {again}; changes detected: {changed}")
    if {*again, changed} != {count}:
        raise SystemExit("not all were the same, or a change was not found")
    return [Figure("ticks recorded", recorded, "ticks/s")]


def _again(file: Path, seed: str) -> int:
    """Return the number of a file's episodes that a process with another hash seed repeats with equal digests."""
    env = os.environ | {"PYTHONHASHSEED": seed}
    done = subprocess.run([sys.executable, "-c", AGAIN, file], check=True, capture_output=True, text=True, env=env)
    return int(done.stdout)


def _changed(episode: Episode, number: int) -> bool:
    chooser = random.Random(number)
    at, agent = chooser.randrange(TICKS), chooser.randrange(2)
    ticks = list(episode.ticks)
    other = Step("Turnleft" if ticks[at][agent].action != "Turnleft" else "Turnright", (), agent)
    ticks[at] = {**ticks[at], agent: other}
    found = replace(episode, ticks=tuple(ticks)).verify()
    return found is not None and found.line == at + 1


def main() -> None:
    """All figures; with more episodes if asked."""
    own = parser(__doc__)
    own.add_argument("--episodes", type=int, default=10)
    asked = own.parse_args()
    found = [*speeds(), *records(asked.episodes)]
    print(*map(as_line, found), sep="\n")
    finish(found, asked.json)


if __name__ == "__main__":
    main()
