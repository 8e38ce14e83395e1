"""Interactive mode: agents that act tick by tick and see what they can."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from typing import Any, overload

from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge, Node
from hearth.schemas.graph_change import Change
from hearth.schemas.program import Step
from hearth.schemas.rng import rng
from hearth.schemas.short_repr import brief
from hearth.schemas.vocabulary import CHARACTER_CATEGORY, CHARACTER_CLASS
from hearth.simulation import engine
from hearth.simulation.actions.legal import Legal, legal
from hearth.simulation.instructions import instruction_of
from hearth.simulation.motion.positions import placed
from hearth.simulation.observation.views import LastAction, View, view
from hearth.simulation.processes import widened
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.bits import indices
from hearth.simulation.world.edit import edit, free_id
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

MOST_ADDED = 1_000
"""Characters that a home takes in at once."""


@dataclass(frozen=True, slots=True)
class Tick:
    """One tick of an episode.

    Attributes:
        instructions: each agent's instruction, by number; an agent that did nothing is not named.
        failures: why, for those who could not.
        before, world: the world before and after it.
    """

    instructions: Mapping[int, Step]
    failures: Mapping[int, Failure]
    before: World
    world: World

    __repr__ = brief

    @property
    def change(self) -> Change:
        """The differences from the world before, poses aside."""
        return self.world.changes(self.before)


class Env:
    """A home in which agents act. Worlds stay values: `env.world` may be kept, and put back with `env.restore`.

    Attributes:
        rules: how actions are read.
        partial: whether agents see only what is around them.
        knowledge: what homes that `reset` names are read with. `hearth.Env()` has our own.
        ticks: what happened since `reset`.
        camera_sensor: takes the pictures of `observe` (`hearth.rendering.cameras.sensor.CameraSensor`); None at first.

    Examples:
        >>> env = hearth.Env()
        >>> sorted(env.reset("maple", agents=2, seed=1))
        [0, 1]
    """

    camera_sensor: Callable[[Env, int, tuple[str, ...]], Mapping[str, Any]] | None = None

    def __init__(self, rules: Rules = DEFAULT, partial: bool = True, knowledge: Knowledge | None = None) -> None:
        self.rules = rules
        self.partial = partial
        self.knowledge = knowledge
        self._world: World | None = None
        self.ticks: list[Tick] = []
        self._last_actions: dict[int, LastAction] = {}

    def __repr__(self) -> str:
        return f"Env({'no episode' if self._world is None else self._world!r}, {len(self.ticks):,} ticks)"

    @property
    def world(self) -> World:
        """The world as it is now.

        Raises:
            HearthError: UNKNOWN_HOME before the first `reset`.
        """
        if self._world is None:
            raise HearthError.of(Code.UNKNOWN_HOME, "no episode has begun", suggestion='env.reset("maple")')
        return self._world

    def reset(self, home: Home | World | str, agents: int = 1, seed: int = 0) -> dict[int, View]:
        """Begin anew. In a home with geometry every character stands at a place (see `motion.positions`).

        Args:
            home: where, or its name, or the path of its file; a world is taken up as it stands.
            agents: how many are wanted at least. Those the home lacks are added, each in a random room.
            seed: decides the rooms, and the places in them of characters that are added.

        Returns:
            What each agent sees, by number.

        Raises:
            HearthError: UNKNOWN_HOME; NO_ROOM, where agents are to be added and the home has no room.
        """
        if isinstance(home, str):
            home = self._home(home)
        world = with_agents(World.start(home) if isinstance(home, Home) else home, agents, seed)
        begun = placed(world, rng(seed, "poses", world.home.name))
        self.restore(widened(begun) if self.rules.consequences else begun)
        return {number: self.observe(number) for number in range(len(self.world.agents))}

    def restore(self, world: World) -> None:
        """Go on from a world, as if nothing had happened before.

        Raises:
            HearthError: BAD_ARGUMENT, if it is not a world; the episode then stays as it is.
        """
        if not isinstance(world, World):
            raise HearthError.of(Code.BAD_ARGUMENT, f"`world` is {type(world).__name__}, not World")
        self._world = world
        self.ticks = []
        self._last_actions = {}

    def step(self, instructions: Mapping[int, Step | str | None] | Step | str) -> Tick:
        """Let each agent do one instruction; one that fails does nothing, and `failures` says why (see `engine.tick`).

        Args:
            instructions: agent number -> its instruction, as a step or as text (see `instruction_of`); or one alone,
                of the agent that it names, else of agent 0.

        Raises:
            HearthError: every fault of an instruction's text.

        Examples:
            >>> env.step("[Walk] <fridge> (1)").failures
            {}
            >>> tick = env.step({0: "[Close] <fridge> (1)"})
            >>> str(tick.failures[0].code), tick.failures[0].names
            ('IS_CLOSED', ('fridge',))
        """
        before = self.world
        if not isinstance(instructions, Mapping):
            alone = self._read(instructions)
            instructions = {alone.agent: alone}
        items = sorted(instructions.items())
        # The number names the acting agent: a step read from text without an agent says 0, and is stored as the agent
        # did it.
        tried = {n: replace(self._read(given), agent=n) for n, given in items if given is not None}
        after, failures = engine.tick(before, tried, self.rules)
        self._world = after
        self._last_actions |= {number: LastAction(step, failures.get(number)) for number, step in tried.items()}
        tick = Tick(tried, failures, before, after)
        self.ticks.append(tick)
        return tick

    @overload
    def observe(self, agent: int = 0) -> View: ...
    @overload
    def observe(self, agent: int, modality: str, /, *more: str) -> Mapping[str, Any]: ...

    def observe(self, agent: int = 0, *modalities: str) -> View | Mapping[str, Any]:
        """Return an agent's observation.

        Facts, or, where modalities are named (`rgb`, `depth`, ...), pictures by modality.

        Raises:
            HearthError: UNKNOWN_AGENT; NOT_RENDERED when pictures are asked for and there is no camera sensor.

        Examples:
            >>> env.observe().me.holding, len(env.observe().ids) < len(env.world.home)
            ((), True)
        """
        self.world.agent(agent)
        if modalities:
            if self.camera_sensor is None:
                remedy = "env.camera_sensor = hearth.rendering.cameras.sensor.CameraSensor(graph, knowledge)"
                raise HearthError.of(Code.NOT_RENDERED, "the environment has no camera sensor", suggestion=remedy)
            return self.camera_sensor(self, agent, modalities)
        return view(self.world, agent, partial=self.partial, last_actions=self._last_actions, tick=len(self.ticks))

    def legal(
        self,
        agent: int = 0,
        *,
        only_visible: bool | None = None,
        only_reachable: bool = False,
        actions: Collection[str] | None = None,
    ) -> Legal:
        """Return an agent's legal instructions.

        By default only about visible nodes, if the agent does not see everything.

        Args:
            agent: its number.
            only_visible, only_reachable, actions: as in `legal`.

        Raises:
            HearthError: UNKNOWN_AGENT.

        Examples:
            >>> _ = env.step("[Walk] <fridge> (1)")
            >>> [step.objects[0].name for step in env.legal() if step.action == "Open"]
            ['window', 'curtain', 'fridge', 'coffe_maker', 'oven', 'cupboard', 'cupboard', 'microwave']
        """
        seen = self.partial if only_visible is None else only_visible
        return legal(self.world, agent, self.rules, only_visible=seen, only_reachable=only_reachable, actions=actions)

    def _read(self, given: Step | str) -> Step:
        return given if isinstance(given, Step) else instruction_of(given, self.world.home)

    def _home(self, name: str) -> Home:
        from hearth.homes.library import named_graph

        if self.knowledge is None:
            message, remedy = f"no knowledge to read the home `{name}` with", "hearth.Env(), or Env(knowledge=...)"
            raise HearthError.of(Code.UNKNOWN_HOME, message, suggestion=remedy)
        title, graph = named_graph(name, self.knowledge)
        return Home.from_graph(graph, title, self.knowledge)


def with_agents(world: World, count: int, seed: int = 0) -> World:
    """Return a world with at least that many characters: those it lacks are added, standing in random rooms.

    Raises:
        HearthError: NO_ROOM, when there is no room to put them in.
    """
    missing = count - len(world.agents)
    if missing <= 0:
        return world
    home = world.home
    rooms = [home.ids[i] for i in indices(home.rooms)]
    if not rooms or missing > MOST_ADDED:
        raise HearthError.of(Code.NO_ROOM, f"{home!r} has no room for {missing:,} more characters")
    first = free_id(home, 1)
    chooser = rng(seed, "agents", home.name)
    nodes = [Node(first + n, CHARACTER_CLASS, CHARACTER_CATEGORY, ("PERSON",)) for n in range(missing)]
    more = edit(world, add=nodes, link=[Edge(node.id, "INSIDE", chooser.choice(rooms)) for node in nodes])
    assert isinstance(more, World)
    return more
