"""Worlds: immutable values, each the home it shares with all others plus what differs from it."""

from __future__ import annotations

from collections.abc import Mapping

from hearth.schemas.call_errors import explained
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import Edge, EnvironmentGraph
from hearth.schemas.graph_change import Change
from hearth.schemas.vocabulary import EVERY_STATE_ID
from hearth.simulation.world import edge_rows
from hearth.simulation.world.action_set_3_states import canonical_states, rows_with_further
from hearth.simulation.world.agent import Agent, replaced
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.moved_edges import NOTHING
from hearth.simulation.world.node_states import with_states
from hearth.simulation.world.state import WorldState
from hearth.simulation.world.world_change import encode


class World(WorldState):
    """The state of everything at one moment.

    Two worlds are equal when they show the same graph with the same memories and poses, however they came about.

    Examples:
        >>> world = hearth.World.start(home)
        >>> (fridge,) = [node.id for node in world.graph().nodes if node.class_name == "fridge"]
        >>> world.has_state(fridge, "OPEN"), execution.final.has_state(fridge, "OPEN")
        (False, True)
    """

    __slots__ = ("_key", "settled", "wide")
    _key: tuple[object, ...]
    wide: World
    """The same world with the further states; only a start of set 2 that has been run by set 3 has it."""
    settled: int
    """`SETTLED` if its `Ticks` name all that goes on in it. `STILL` if nothing goes on and no device is at work: then
    nothing can begin before a state changes. Not set in a world that was made in another way than by a tick (see
    `processes`)."""

    @classmethod
    @explained
    def start(cls, home: Home) -> World:
        """Return the home as it is given."""
        return cls(home, home.states, tuple(home.agent_rows), NOTHING)

    def agent(self, number: int) -> Agent:
        """Return the character of a number.

        Raises:
            HearthError: UNKNOWN_AGENT, if the world has none of that number.
        """
        if not 0 <= number < len(self.agents):
            message = f"no agent {number}; there are {len(self.agents)}, from 0"
            remedy = "`Env.reset(world, agents=...)` adds characters"
            raise HearthError.of(Code.UNKNOWN_AGENT, message, suggestion=remedy)
        return self.agents[number]

    def with_agent(self, number: int, agent: Agent) -> World:
        """Return the same world with one agent's edges replaced."""  # by every step, so not `explained`
        agents = (agent,) if len(self.agents) == 1 else replaced(self.agents, number, agent)
        return World(self.home, self.states, agents, self.moved)

    @explained
    def has_state(self, node_id: int, state: str) -> bool:
        """Return whether a node is in a state.

        Raises:
            HearthError: BAD_ARGUMENT, if there is no such node or state.
        """
        try:
            number, index = EVERY_STATE_ID[state], self.home.index[node_id]
            return bool(rows_with_further(self)[number] >> index & 1)
        except KeyError as error:
            raise HearthError.of(Code.BAD_ARGUMENT, f"there is no node or state {error.args[0]!r}") from None

    @explained
    def graph(self, among: int = -1) -> EnvironmentGraph:
        """Return the graph, rebuilt, or the part of it among these nodes: nodes in id order, edges sorted."""
        home = self.home
        nodes = tuple(with_states(home.node(i), i, self.states) for i in indices(among & home.everything))
        return EnvironmentGraph(nodes, tuple(sorted(self.edges(among))))

    @explained
    def edges(self, among: int = -1) -> list[Edge]:
        """Every edge (among these nodes), each once, in no particular order."""
        return list(edge_rows.edges(self, among))

    @explained
    def changes(self, since: World) -> Change:
        """Return the differences from an earlier world of the same home; the cost follows their number."""
        return encode(since, self)

    def key(self) -> tuple[object, ...]:
        """Its identity: its difference from its home, and the agents' memories and poses."""
        try:
            return self._key
        except AttributeError:
            pass
        memories = tuple((frozenset(agent.origins), agent.pose, agent.stride) for agent in self.agents)
        self._key = (canonical_states(self), edge_rows.difference(self), tuple(a[:11] for a in self.agents), memories)
        return self._key

    def __copy__(self) -> World:
        """Itself, like other values that never change."""
        return self

    def __deepcopy__(self, memo: object) -> World:
        return self

    def __eq__(self, other: object) -> bool:
        if self is other:
            return True
        return isinstance(other, World) and self.home is other.home and self.key() == other.key()

    def __hash__(self) -> int:
        return hash(self.key())

    def __repr__(self) -> str:
        return f"World({self.home!r}, {len(self.agents)} agents)"

    def holding(self) -> Mapping[int, tuple[int, ...]]:
        """Return the objects that each agent holds, by agent number: node ids, right hand first."""
        ids = self.home.ids
        return {
            number: tuple(ids[i] for i in edge_rows.held_indices(agent)) for number, agent in enumerate(self.agents)
        }
