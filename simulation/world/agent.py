"""A character's own edges, kept apart from the things' because almost every step changes them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

from hearth.schemas.short_repr import brief
from hearth.simulation.world.pose import STRIDE, Pose

AGENT_OUT = {
    "CLOSE": "close", "FACING": "facing", "INSIDE": "inside", "ON": "on", "HOLDS_RH": "right", "HOLDS_LH": "left",
}  # fmt: skip
"""The field in which an edge from a character stands, by relation."""

AGENT_IN = {"CLOSE": "close", "FACING": "faced", "INSIDE": "contents", "ON": "worn"}
"""The field in which an edge to a character stands, by relation."""


class Agent(NamedTuple):
    """One character.

    An edge between two characters stands in the row of the one it goes out from; CLOSE stands in both.

    Attributes:
        index: its node's index.
        bit: the set of it alone.
        close: the nodes that it is CLOSE to, and those CLOSE to it.
        facing, faced: what it is FACING; the things that are FACING it.
        inside, contents: what it is INSIDE; the things that are INSIDE it.
        on, worn: what it is ON; the things that are ON it.
        right, left: what each hand holds.
        origins: where grabbed things came from: (thing, place, kind of relation), for PutObjBack.
        pose: where it stands and looks; None where it is not placed (see `motion.positions`).
        stride: metres that it walks in a tick.
    """

    index: int  # type: ignore[assignment] # what tuples call index is of no use here
    bit: int
    close: int = 0
    facing: int = 0
    faced: int = 0
    inside: int = 0
    contents: int = 0
    on: int = 0
    worn: int = 0
    right: int = 0
    left: int = 0
    origins: tuple[tuple[int, int, int], ...] = ()
    pose: Pose | None = None
    stride: float = STRIDE

    def __repr__(self) -> str:
        return brief(self)

    @property
    def held(self) -> int:
        """The objects in both hands."""
        return self.right | self.left

    def without(self, bit: int) -> Agent:
        """Without the edges to and from these nodes."""
        return made((self.index, self.bit, *[row & ~bit for row in self[2:11]], *self[11:]))

    def parted(self, bit: int) -> Agent:
        """Without the edges to and from these nodes but those of FACING."""
        index, me, close, facing, faced, *_ = self
        rest = [row & ~bit for row in self[5:11]]
        return made((index, me, close & ~bit, facing, faced, *rest, *self[11:]))


made: Callable[[tuple[Any, ...]], Agent] = partial(tuple.__new__, Agent)
"""A character from all its fields, in half the time of `Agent._make`: every step makes one."""


def replaced(agents: tuple[Agent, ...], number: int, agent: Agent) -> tuple[Agent, ...]:
    """Return the characters with one replaced, and the others CLOSE to it where it is CLOSE to them, and only there."""
    return tuple(
        agent if i == number else _beside(other, agent.bit if agent.close & other.bit else 0, agent.bit)
        for i, other in enumerate(agents)
    )


def _beside(agent: Agent, close: int, other: int) -> Agent:
    if agent.close & other == close:
        return agent
    return agent._replace(close=agent.close & ~other | close)


def change_characters(agents: list[Agent], edge: tuple[int, str, int], change: Callable[[int, int], int]) -> bool:
    """Change the rows of the characters at either end; whether there were any. Edges between two characters stand in
    the row of the one they go out from, CLOSE in both.
    """
    i, relation, j = edge
    part = False
    for me, fields, other in ((i, AGENT_OUT, j), (j, AGENT_IN, i)):
        number = next((n for n, agent in enumerate(agents) if agent.index == me), -1)
        field = fields.get(relation)
        if number < 0 or field is None or (part and relation != "CLOSE"):
            continue
        part = True
        agent = agents[number]
        row: dict[str, Any] = {field: change(getattr(agent, field), 1 << other)}
        agents[number] = agent._replace(**row)
    return part
