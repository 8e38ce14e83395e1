"""Effects and messages of steps stay as they are until somebody means to change them."""

from __future__ import annotations

import random
from collections.abc import Iterator

from golden_files import compare, full, known, short
from small_worlds import random_graph, random_step

from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.schemas.failures import Failure
from hearth.simulation.actions.legal import legal
from hearth.simulation.actions.registry import EVERY
from hearth.simulation.engine import act, tick
from hearth.simulation.env import with_agents
from hearth.simulation.motion.positions import placed, spot
from hearth.simulation.observation.views import view
from hearth.simulation.rules import RULES
from hearth.simulation.world.digest import digest
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

GOLDEN = "simulation.json"
WHEN_WRITTEN = RULES["near_hands"]
BODIES = WHEN_WRITTEN._replace(bodies=True)
MOVES = ("Walktowards", "Walktowards", "Walkforward", "Turnleft", "Grab", "PutBack", "PutIn", "Open", "Close", "Sit")


def _actions() -> list[str]:
    """The actions that there were when the file was written: one more changes nothing here."""
    return known(GOLDEN)["actions"]


def _small(seed: int) -> Iterator[str]:
    """Random steps in a small home: what is refused, and the world after what is done."""
    chooser = random.Random(seed)
    graph = random_graph(chooser, characters=1 + seed % 2)
    world, actions = World.start(Home.from_graph(graph, "", default())), _actions()
    for _ in range(60):
        step = random_step(chooser, graph, chooser.randrange(len(world.agents)), actions)
        after = act(world, step, RULES["made_bed"])  # the rules of the day when the file was written
        if isinstance(after, Failure):
            yield after.message()
        else:
            world = after
            yield f"{step.action}: {digest(world)}"


def _large(name: str, seed: int) -> Iterator[tuple[str, str]]:
    """Two who do random things by metres: the world, what may be done, what is seen, where things are; by tick."""
    chooser, home = random.Random(seed), Home.from_graph(library.load_graph(name, default()), name, default())
    world = placed(with_agents(World.start(home), 2, seed), chooser)
    for number in range(40):
        chosen = {}
        for agent in (0, 1):
            wanted = chooser.choice(MOVES)
            options = [each for each in legal(world, agent, WHEN_WRITTEN, actions=EVERY) if each.action == wanted]
            if options:
                chosen[agent] = chooser.choice(options)
        world, failures = tick(world, chosen, BODIES)
        if number % 4 == 0:
            seen = view(world, number // 4 % 2, partial=True)
            poses = [tuple(round(value, 6) for value in each.pose) for each in world.agents if each.pose]
            spots = [
                point and tuple(round(value, 6) for value in point)
                for point in (spot(world, i) for i in range(len(home)))
            ]
            options = sorted(map(full, legal(world, number // 4 % 2, WHEN_WRITTEN, actions=_actions())))
            facts = (digest(world), poses, spots, seen.ids, full(seen.me), full(seen.others), options)
            yield f"{number}", " ".join(map(short, (*facts, sorted(failures.items(), key=str))))


def test_what_random_steps_do_in_small_homes():
    found = {str(seed): list(_small(seed)) for seed in range(40)}
    words = sorted({line for lines in found.values() for line in lines if ": " in line and not line[-16:].isalnum()})
    digests = {seed: short(lines) for seed, lines in found.items()}
    compare(GOLDEN, {"digests": digests, "refused": words[::7]}, "small")


def test_what_two_do_by_metres():
    found = {f"{name} {seed}": dict(_large(name, seed)) for seed, name in enumerate(("maple", "larch", "cedar"))}
    compare(GOLDEN, found, "large")
