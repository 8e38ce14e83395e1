"""An episode for learners: starts from seeds, numbers as actions, arrays as observations, rewards.

`pettingzoo_env` and `gymnasium_env` give it the interfaces that libraries of reinforcement learning expect.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from hearth.envs.action_codes import ActionCode, Listed, Number, Triples, fixed_list, played, str_step
from hearth.envs.goal_arrays import check
from hearth.envs.node_slots import Slots
from hearth.envs.observation_arrays import Arrays, Encoder, Rows, Sizes
from hearth.envs.rewards import Reward, Rewards, checked_reward
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.goals import Goal
from hearth.schemas.program import Step
from hearth.schemas.rng import rng
from hearth.simulation.actions.legal import Legal
from hearth.simulation.env import Env, Tick, with_agents
from hearth.simulation.goal_text import read_goal
from hearth.simulation.goals import Progress
from hearth.simulation.motion.positions import placed
from hearth.simulation.observation.views import View
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.edit import edit
from hearth.simulation.world.home import Home
from hearth.simulation.world.pose import STRIDE
from hearth.simulation.world.world import World

if TYPE_CHECKING:
    from gymnasium.spaces import Dict, Space

Opening = Callable[[int], tuple[World, Goal]]
"""The world in which an episode begins and the goal, from a seed; equal for equal seeds."""

MOST_TICKS = 250
"""Ticks after which an episode ends (thesis 6.5)."""

CODES = ("triples", "listed", "fixed")
"""Codes of actions by name; any other is given as an `ActionCode`."""


def opening(
    home: Home | str | Sequence[Home | str],
    goal: Goal | str | Sequence[Goal | str],
    agents: int = 2,
    strides: tuple[float, ...] = (),
) -> HomeOpening:
    """Episodes in a home as it is, without its own characters, with agents in random rooms.

    Args:
        home: the home, its name, or several, of which the seed draws one.
        goal: for all of them; as text, too (see `read_goal`); of several the seed draws one.
        agents: how many.
        strides: metres that each walks in a tick; 1 where not given.

    Raises:
        HearthError: UNKNOWN_HOME; BAD_ARGUMENT: no home or goal, or a goal that only forbids; every fault of a goal's
            text.
    """
    several: Any = home if isinstance(home, Sequence) and not isinstance(home, str) else [home]
    homes = tuple(_empty(each) for each in several)
    given = [goal] if isinstance(goal, (Goal, str)) else goal
    if not homes or not given:
        message = f"{len(homes)} homes and {len(given)} goals"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion='opening("maple", "HOLDS(agent, milk)")')
    goals = tuple(read_goal(each, homes[0].home) if isinstance(each, str) else each for each in given)
    for each in goals:
        need_something_to_do(each)
    return HomeOpening(homes, goals, agents, strides)


def need_something_to_do(goal: Goal) -> None:
    """Refuse a goal that only forbids: it holds at the start, so that the episode would be won before it begins.

    Raises:
        HearthError: BAD_ARGUMENT.
    """
    if goal.only_forbids:
        message = f"the goal `{str(goal)[:80]}` only forbids: it holds at the start, and nothing is left to do"
        remedy = f"add what is to be done, as in `HOLDS(agent, milk) and {str(goal)[:80]}`"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=remedy)


@dataclass(frozen=True)
class HomeOpening:
    """The start of an episode in a home, by its seed; a value that can be pickled.

    Attributes:
        homes: worlds without characters, of which the seed draws one.
        goals: of which the seed draws one.
        agents: how many.
        strides: metres that each walks in a tick; 1 where not given.
    """

    homes: tuple[World, ...]
    goals: tuple[Goal, ...]
    agents: int
    strides: tuple[float, ...] = ()

    def __call__(self, seed: int) -> tuple[World, Goal]:
        """Return the world in which an episode begins, and its goal."""
        empty = self.homes[0] if len(self.homes) == 1 else rng(seed, "home").choice(self.homes)
        goal = self.goals[0] if len(self.goals) == 1 else rng(seed, "goal").choice(self.goals)
        world = placed(with_agents(empty, self.agents, seed), rng(seed, "poses", empty.home.name))
        every = (*self.strides, *[STRIDE] * self.agents)
        walkers = (agent._replace(stride=stride) for agent, stride in zip(world.agents, every, strict=False))
        return World(world.home, world.states, tuple(walkers), world.moved), goal


def _empty(home: Home | str) -> World:
    """Return a home without its own characters.

    Raises:
        HearthError: UNKNOWN_HOME; BAD_ARGUMENT: neither a home nor a name.
    """
    if isinstance(home, str):
        from hearth.homes.library import named_graph
        from hearth.kb.loading.load import default

        title, graph = named_graph(home, default())
        home = Home.from_graph(graph, title, default())
    if not isinstance(home, Home):
        message = f"`home` is {type(home).__name__}, not a home or its name"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion='opening("maple", "HOLDS(agent, milk)")')
    own = [home.ids[i] for i in home.agents]
    empty = edit(World.start(home), remove=own, check=False) if own else World.start(home)
    assert isinstance(empty, World)
    return empty


MOST_SEED = 2**63 - 1
"""Seeds of episodes are below it."""


@dataclass(frozen=True)
class Setting:
    """Settings of episodes.

    Attributes:
        opening: the start of an episode, and its goal.
        actions: names of the actions that may be tried; None: those of challenges (see `action_codes.played`).
        code: how instructions are numbered (see `action_codes`): `triples`, `listed`, `fixed` (of `actions` and
            `things`), or an `ActionCode`.
        partial: whether agents see only the area around them.
        told: numbers of the agents that know the goal; all of them where None.
        limit: ticks after which an episode is cut off.
        rewards: of a tick; `Rewards`, or a function (see `rewards.Reward`).
        rules: of actions.
        sizes: of the arrays.
        things: the nodes of arrays and instructions (see `Slots.of`); all nodes where None.
        arrays: names of the arrays that an observation has; all of them where None.
    """

    opening: Opening
    actions: tuple[str, ...] | None = None
    code: str | ActionCode = "listed"
    partial: bool = True
    told: frozenset[int] | None = None
    limit: int = MOST_TICKS
    rewards: Reward = field(default_factory=Rewards)
    rules: Rules = DEFAULT
    sizes: Sizes = field(default_factory=Sizes)
    things: tuple[str | int, ...] | None = None
    arrays: tuple[str, ...] | None = None


def checked_setting(given: object) -> Setting:
    """Return the settings of episodes; an opening alone has the usual ones.

    Raises:
        HearthError: BAD_ARGUMENT: it is neither.
    """
    if isinstance(given, Setting):
        return given
    if callable(given):
        return Setting(given)
    message = f"episodes are set by {type(given).__name__}, not by a Setting"
    raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion='Setting(opening("maple", "HOLDS(agent, milk)"))')


class Session:
    """Episodes one after another.

    Attributes:
        setting: how they are played.
        agents: how many agents there are.
        names: of the actions that may be tried.
        code: how instructions are numbered.
        env: the current episode.
        progress: of its goal, in the real world.
        failures: of the last tick, by agent.
    """

    def __init__(self, setting: Setting | Opening) -> None:
        setting = checked_setting(setting)
        checked_reward(setting.rewards)
        world, goal = setting.opening(0)
        known = world.home.knowledge
        self.setting = setting
        self.agents = len(world.agents)
        self.names = tuple(sorted(setting.actions)) if setting.actions is not None else played(known)
        if unknown := [name for name in self.names if name not in known.actions]:
            raise HearthError.of(Code.UNKNOWN_ACTION, f"`{unknown[0]}` is not a known action")
        check(goal, setting.sizes.literals)
        self.code = self._code(setting.code, world.home)
        self.encoder = Encoder(replace(setting.sizes, agents=max(setting.sizes.agents, self.agents)), self.names, known)
        self.env = Env(setting.rules, setting.partial, known)
        self._rows: Rows | None = None
        self._begin(world, goal)

    def _code(self, code: str | ActionCode, home: Home) -> ActionCode:
        sizes = self.setting.sizes
        if code == "triples":
            return Triples(self.names, sizes.nodes)
        if code == "listed":
            return Listed(self.names, sizes.legal)
        if code == "fixed":
            return fixed_list(self.names, Slots.of(home, sizes.nodes, self.setting.things))
        if isinstance(code, str):
            raise HearthError.of(Code.BAD_ARGUMENT, f"no code of actions is called `{code}`",
                                 suggestion=" or ".join(CODES))  # fmt: skip
        return code

    def observation_space(self) -> Dict:
        """Return the space of every agent's arrays."""
        from gymnasium.spaces import Dict

        return Dict(self._kept({**self.encoder.spaces(), **self.code.spaces()}))

    def action_space(self) -> Space[Any]:
        """Return the space of every agent's numbers."""
        return self.code.space()

    def begin(self, seed: int) -> None:
        """Start an episode.

        Raises:
            HearthError: those of the opening; BAD_ARGUMENT, where its world or goal does not fit the arrays. The last
                episode then goes on.
        """
        self._begin(*self.setting.opening(seed))

    def _begin(self, world: World, goal: Goal) -> None:
        if len(world.agents) != self.agents:
            raise HearthError.of(Code.BAD_ARGUMENT, f"{len(world.agents)} agents, where {self.agents} are expected")
        check(goal, self.setting.sizes.literals)
        progress = Progress.start(goal, world)
        if self._rows is None or self._rows.slots.home is not world.home:
            self._rows = self.encoder.rows(world.home, self.setting.things)
        self.env.restore(world)
        self.progress = progress
        self.failures: dict[int, Failure] = {}
        self._seen: dict[int, tuple[View, Legal]] = {}

    @property
    def rows(self) -> Rows:
        """Return the slots of the home."""
        assert self._rows is not None
        return self._rows

    @property
    def succeeded(self) -> bool:
        """Return whether the goal is reached."""
        return self.progress.satisfied

    @property
    def cut_off(self) -> bool:
        """Return whether time is over and the goal is not reached."""
        return len(self.env.ticks) >= self.setting.limit and not self.succeeded

    def seen(self, agent: int) -> tuple[View, Legal]:
        """Return an agent's observation and its legal actions."""
        if agent not in self._seen:
            self._seen[agent] = self.env.observe(agent), self.env.legal(agent, actions=self.names)
        return self._seen[agent]

    def observe(self, agent: int) -> Arrays:
        """Return an agent's observation as arrays."""
        view, legal = self.seen(agent)
        told = self.setting.told is None or agent in self.setting.told
        time = len(self.env.ticks) / self.setting.limit
        arrays = self.encoder.arrays(view, self.rows, self.progress if told else None, time)
        return self._kept({**arrays, **self.code.masks(legal, self.rows.slots)})

    def _kept(self, arrays: dict[str, Any]) -> dict[str, Any]:
        """Return the arrays, or spaces, that an observation has.

        Raises:
            HearthError: BAD_ARGUMENT: there is no array of a name.
        """
        names = self.setting.arrays
        if names is None:
            return arrays
        if unknown := [name for name in names if name not in arrays]:
            message = f"no array is called `{unknown[0][:40]}`"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=", ".join(arrays))
        return {name: arrays[name] for name in names}

    def info(self, agent: int) -> dict[str, Any]:
        """Return facts about an episode that the agent must not observe.

        Returns:
            `legal`, how many instructions it could do; `left_out`, how many of them have no number; `failure`, why its
            last could not be done (a `Failure`, or None); `success`; `progress`, the share of the goal that is reached.
        """
        _, legal = self.seen(agent)
        count = self.rows.slots.count(legal)
        return {
            "legal": count,
            "left_out": max(0, 1 + count - self.code.size) if isinstance(self.code, Listed) else 0,
            "failure": self.failures.get(agent),
            "success": self.succeeded,
            "progress": self.progress.fraction,
        }

    def texts(self, agent: int) -> list[str]:
        """Return an agent's legal instructions in words, in the order of the code `listed`: 0 is to wait."""
        _, legal = self.seen(agent)
        return ["wait", *map(str_step, self.rows.slots.instructions(legal))]

    def read(self, agent: int, number: Number) -> Step | Failure | None:
        """Return the instruction of an agent's number.

        A number without an instruction now, or about a node that the agent does not see, gives a failure.

        Raises:
            HearthError: UNKNOWN_AGENT; BAD_ARGUMENT, where it is not in the action space.
        """
        if not isinstance(agent, int) or not 0 <= agent < self.agents:
            raise HearthError.of(Code.UNKNOWN_AGENT, f"no agent {str(agent)[:40]}; there are {self.agents}, from 0")
        view, legal = self.seen(agent)
        found = self.code.read(number, legal, self.rows.slots)
        if not isinstance(found, Step):
            return found
        hidden = [ref for ref in found.objects if ref.node is not None and not view.sees(ref.node)]
        names = tuple(ref.name for ref in found.objects)
        if len({ref.node for ref in found.objects}) < len(names):
            return Failure(Code.WRONG_ARITY, 0, agent, found.action, (), names, "different objects", "one named twice")
        if hidden:
            return Failure(Code.UNBOUND, 0, agent, found.action, (), names, "an object that the agent sees", "not seen")
        return found

    def step(self, numbers: Mapping[int, Number]) -> dict[int, float]:
        """Let agents act; an agent without a number waits. If a number is refused, no agent acts.

        Returns:
            The reward of each agent.

        Raises:
            HearthError: as `read`.
        """
        return self.act({agent: self.read(agent, number) for agent, number in numbers.items()})

    def act(self, read: Mapping[int, Step | Failure | None]) -> dict[int, float]:
        """Let agents act by instructions instead of numbers, and return the reward of each agent."""
        before = self.progress, self.env.world
        tick = self.env.step({agent: step for agent, step in read.items() if isinstance(step, Step)})
        self.progress = self.progress.then(tick.before, tick.world, done(tick))
        refused = {agent: each for agent, each in read.items() if isinstance(each, Failure)}
        self.failures = {**refused, **tick.failures}
        self._seen = {}
        after = self.progress, self.env.world
        return {agent: self.setting.rewards(before, after, agent) for agent in range(self.agents)}


def done(tick: Tick) -> list[Step]:
    """Return the instructions of a tick that did not fail."""
    return [step for number, step in tick.instructions.items() if number not in tick.failures]
