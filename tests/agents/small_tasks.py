"""Small tasks of two agents, and episodes of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace

from hearth.agents.belief import containers
from hearth.agents.protocol import Agent
from hearth.schemas.goals import Goal
from hearth.schemas.graph import Node
from hearth.schemas.literals import Literal
from hearth.schemas.rng import derive, rng
from hearth.simulation.actions.legal import Legal
from hearth.simulation.actions.registry import EVERY
from hearth.simulation.actions.situation import Situation
from hearth.simulation.env import Env, Tick, with_agents
from hearth.simulation.goals import Progress
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.motion.positions import placed
from hearth.simulation.world.bits import indices, lowest
from hearth.simulation.world.edit import edit, free_id
from hearth.simulation.world.home import Home
from hearth.simulation.world.pose import Pose
from hearth.simulation.world.world import World

ALLOWED = ("Walktowards", "Open", "Close", "Grab", "PutBack", "PutIn", "Sit", "StandUp", "SwitchOn")
"""The actions that agents may do."""

CLASSES = ("plate", "fork", "apple", "cupcake", "book")


def start(home: Home, counts: dict[str, int], seed: int = 0) -> World:
    """A home with so many things of some classes, in closed containers and on tables and counters."""
    gone = [home.ids[i] for name in CLASSES for i in indices(home.instances(name))]
    world = edit(World.start(home), remove=gone, check=False)
    nodes = []
    for name, number in counts.items():
        nodes += [
            Node(free_id(home) + len(nodes) + n, name, "placable_objects", ("GRABBABLE", "MOVABLE"))
            for n in range(number)
        ]
    world = edit(world, add=nodes, check=False)
    chooser = rng(seed, "start")
    rooms = world.home.instances("kitchen") | world.home.instances("living_room")
    near = [i for i in indices(containers(world.home)) if rooms & world.home.inside[i]]
    surfaces = [i for name in ("desk", "kitchen_counter") for i in indices(world.home.instances(name))]
    spots = [*(("INSIDE", i) for i in near), *(("ON", i) for i in surfaces)]
    place = {}
    for node in nodes:
        relation, i = chooser.choice(spots)
        place[node.id] = relation, world.home.ids[i]
    world = edit(world, place=place, check=False)
    assert isinstance(world, World)
    return placed(with_agents(world, 2, seed), rng(seed, "poses"))


def standing(world: World, number: int, room: str) -> World:
    """The world with a character in the middle of a room."""
    there = lowest(world.home.instances(room))
    ground = ground_of(world.home).ground
    pose = Pose(*ground.ways.points[ground.stands(there)[0]].tolist())
    agent = world.agents[number]._replace(pose=pose, inside=1 << there, close=0)
    return world.with_agent(number, agent)


def target(world: World, name: str) -> int:
    """Id of the first thing of a class."""
    return world.home.ids[lowest(world.home.instances(name))]


def wanted(world: World, relation: str, furniture: str, **counts: int) -> Goal:
    """A goal of things on or in one piece of furniture."""
    there = target(world, furniture)
    return Goal.of(*((Literal(relation, (name, there)), number) for name, number in counts.items()))


@dataclass
class Played:
    """An episode, and what an agent that is watched thought of it."""

    env: Env
    progress: Progress
    choices: list[str] = field(default_factory=list)

    @property
    def ticks(self) -> tuple[Tick, ...]:
        return tuple(self.env.ticks)


Scramble = Callable[[World, int], World]
"""(world, what the agent sees) -> another world that looks the same to it."""


def play(
    world: World,
    goal: Goal,
    agents: Sequence[Agent | None],
    seed: int = 0,
    *,
    goals: Sequence[Goal | None] | None = None,
    full: Iterable[int] = (),
    limit: int = 250,
    scramble: Scramble | None = None,
    after: Callable[[Env], None] | None = None,
) -> Played:
    """Play an episode.

    Args:
        world: with as many characters as agents.
        goal: ends it.
        agents: who acts; None stands still.
        seed: of the episode.
        goals: what each agent is told; the goal where None.
        full: who sees everything.
        limit: of ticks.
        scramble: what each agent is shown instead of the world.
        after: called after each tick.
    """
    env = Env()
    env.restore(world)
    played = Played(env, Progress.start(goal, world))
    told = goals or [goal] * len(agents)

    def seen(number: int):
        view = env.observe(number)
        if number in full:
            return replace(view, mask=env.world.home.everything)
        return replace(view, world=scramble(env.world, view.mask)) if scramble else view

    for number, agent in enumerate(agents):
        if agent is not None:
            agent.reset(seen(number), told[number], derive(seed, "agent", number))
    while len(env.ticks) < limit and not played.progress.satisfied:
        chosen = {}
        for number, agent in enumerate(agents):
            if agent is not None:
                view = seen(number)
                chosen[number] = agent.act(view, allowed(env, number, view.mask))
        played.choices.append(str(chosen))
        tick = env.step(chosen)
        played.progress = played.progress.then(tick.before, tick.world)
        if after is not None:
            after(env)
    return played


def allowed(env: Env, number: int, mask: int) -> Legal:
    """Return the actions that an agent may do now, by its view."""
    situation = Situation(env.world, number, env.rules)
    found = {}
    for name in ALLOWED:
        masks = EVERY[name].mask(situation)
        if masks is not None and all(kept := tuple(each & mask for each in masks)):
            found[name] = kept
    return Legal(env.world.home, number, found)


def scrambled(world: World, mask: int) -> World:
    """The world with everything movable that is out of view elsewhere, and closed furniture out of view open."""
    home = world.home
    rest = home.everything & home.properties["GRABBABLE"] & ~mask
    chooser = rng(len(str(world.moved)), "scrambled")
    containers = list(indices(home.properties["CAN_OPEN"] & home.furniture & ~mask))
    place = {home.ids[i]: ("INSIDE", home.ids[chooser.choice(containers)]) for i in indices(rest)}
    opened = [(home.ids[i], "OPEN") for i in containers]
    changed = edit(world, place=place if containers else {}, set=opened, check=False)
    assert isinstance(changed, World)
    return changed
