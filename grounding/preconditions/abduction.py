"""From a failure to the condition on the start that would have prevented it: one small function a failure code.

Each gets the moment of failure and gives the conditions to try, best first; none means that no start can help.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from hearth.grounding.preconditions.conditions import Condition
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Code, Failure
from hearth.schemas.literals import CHARACTER, NAME_OF, Key, Literal
from hearth.schemas.program import Program
from hearth.schemas.vocabulary import OPPOSITE
from hearth.simulation.world import rows
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.bits import indices
from hearth.simulation.world.world import World


@dataclass(frozen=True, slots=True)
class Moment:
    """A failed step: the world before it, the start of it all, and which node is which object."""

    program: Program
    step: int
    failure: Failure
    world: World
    start: World
    keys: dict[int, Key]
    knowledge: Knowledge

    @property
    def agent(self) -> Agent:
        """The character whose step failed."""
        return self.world.agents[self.failure.agent]

    def key(self, position: int = 0) -> Key | None:
        """The program's object that the failure names at this position."""
        return self.keys.get(self.failure.objects[position])

    def index(self, position: int = 0) -> int:
        """Its index in the home."""
        return self.world.home.index[self.failure.objects[position]]

    def group(self, name: str) -> frozenset[str]:
        """The actions of a group (see `kb.groups`)."""
        return self.knowledge.group(name)

    def needs(self, name: str, *objects: Key) -> Condition:
        """The condition, needed by this step."""
        return Condition(Literal(name, objects), self.step)


Demand = Callable[[Moment], Iterator[Condition]]


def conditions_for(moment: Moment) -> Iterator[Condition]:
    """The conditions that could have prevented a failure."""
    demand = DEMANDS.get(moment.failure.code)
    return demand(moment) if demand is not None else iter(())


def state(wanted: str) -> Demand:
    """The object is in a state from the start; no help if the program itself has put it in the opposite."""

    def demand(moment: Moment) -> Iterator[Condition]:
        key = moment.key()
        if key is None:
            return
        node = moment.failure.objects[0]
        now = moment.world.has_state(node, OPPOSITE[wanted])
        then = moment.start.has_state(node, OPPOSITE[wanted])
        if now == then:
            yield moment.needs(NAME_OF[wanted], key)

    return demand


def _at_reach(moment: Moment) -> Iterator[Condition]:
    """Near what the character has gone to, or near the character if it has not gone anywhere."""
    key = moment.key()
    if key is None:
        return
    agent = moment.agent
    if agent == moment.start.agents[moment.failure.agent]:
        yield moment.needs("nearby", key, CHARACTER)
    yield from _had_not_left(moment)
    for anchor in anchors(moment):
        if anchor != key:
            yield moment.needs("atreach", key, anchor)
    if not any(step.action in moment.group("goes") for step in moment.program.steps[: moment.step]):
        yield moment.needs("nearby", key, CHARACTER)


def _had_not_left(moment: Moment) -> Iterator[Condition]:
    """What the program itself has put down is only near while the character stays: so what it then looked for was near
    there, and looking for it took no walk.
    """
    index = moment.index()
    places = (rows.on(moment.world, index) | rows.inside(moment.world, index)) & ~moment.world.home.rooms
    start = rows.on(moment.start, index) | rows.inside(moment.start, index)
    keys = [
        moment.keys[moment.world.home.ids[i]]
        for i in indices(places & ~start)
        if moment.world.home.ids[i] in moment.keys
    ]
    for step in reversed(moment.program.steps[: moment.step]):
        if any(ref.key == moment.key() for ref in step.objects):
            return
        if step.action == "Find":
            for place in keys:
                yield moment.needs("atreach", step.objects[0].key, place)


def anchors(moment: Moment) -> Iterator[Key]:
    """What the character is CLOSE to at this moment, the last mentioned first: furniture, what hands could hold, what
    they hold (for the place it was taken from), parts of the body, rooms.
    """
    world, agent = moment.world, moment.agent
    index = world.home.index
    seen: dict[Key, int] = {}
    for step in reversed(moment.program.steps[: moment.step]):
        for ref in step.objects:
            node = index.get(ref.node) if ref.node is not None else None
            if node is None or ref.key in seen or not agent.close >> node & 1:
                continue
            seen[ref.key] = _clumsiness(moment, node)
    yield from sorted(seen, key=lambda key: seen[key])


def _clumsiness(moment: Moment, node: int) -> int:
    home = moment.world.home
    if home.rooms >> node & 1:
        return 4
    if home.properties["BODY_PART"] >> node & 1:
        return 3
    if moment.agent.held >> node & 1:
        return 2
    return 1 if home.properties["GRABBABLE"] >> node & 1 else 0


def _put_back_place(moment: Moment) -> Iterator[Condition]:
    """Something to be put back where it came from stood, from the start, on or in what the character is now at."""
    step = moment.program.steps[moment.step]
    if step.action != "PutObjBack" or moment.key() is not None:
        return
    key = step.objects[0].key
    for anchor in anchors(moment):
        if anchor != key:
            yield moment.needs("in", key, anchor)


def _not_close(moment: Moment) -> Iterator[Condition]:
    yield from _put_back_place(moment)
    yield from _at_reach(moment)


def _facing(moment: Moment) -> Iterator[Condition]:
    """What the character sits on, or has turned to, faces the object."""
    key = moment.key()
    if key is None:
        return
    agent = moment.agent
    for step in reversed(moment.program.steps[: moment.step]):
        for ref in step.objects:
            node = moment.world.home.index.get(ref.node) if ref.node is not None else None
            if node is None or ref.key == key:
                continue
            seat = agent.on >> node & 1 and step.action in moment.group("rests")
            if seat or agent.facing >> node & 1:
                yield moment.needs("facing", ref.key, key)


def _same_room(moment: Moment) -> Iterator[Condition]:
    key = moment.key()
    room = rows.agent_room(moment.world, moment.agent)
    named = moment.keys.get(moment.world.home.ids[room]) if room >= 0 else None
    if key is None:
        return
    if named is not None:
        yield moment.needs("location", key, named)
    for anchor in anchors(moment):
        if anchor != key:
            yield moment.needs("together", key, anchor)


def _resting(moment: Moment) -> Iterator[Condition]:
    moved = moment.agent != moment.start.agents[moment.failure.agent]
    action = moment.program.steps[moment.step].action
    if not moved or moment.agent.on == moment.start.agents[moment.failure.agent].on:
        yield moment.needs("lying" if action in ("Sleep", "WakeUp") else "sitting", CHARACTER)


def _holding(moment: Moment) -> Iterator[Condition]:
    """In the hand from the start, unless the program let go of it."""
    key = moment.key()
    handles = moment.group("takes") | moment.group("frees_hand")
    if key is not None and not any(
        step.action in handles and step.objects[0].key == key for step in moment.program.steps[: moment.step]
    ):
        yield moment.needs("holds", key, CHARACTER)


def _worn(moment: Moment) -> Iterator[Condition]:
    key = moment.key()
    if key is not None:
        yield moment.needs("in", key, CHARACTER)


def _free(moment: Moment) -> Iterator[Condition]:
    key = moment.key()
    if key is not None:
        yield moment.needs("free", key)


def _closed_or_open(moment: Moment) -> Iterator[Condition]:
    step = moment.program.steps[moment.step]
    yield from state("CLOSED" if step.action == "Open" else "OPEN")(moment)


DEMANDS: dict[Code, Demand] = {
    Code.IS_OPEN: state("CLOSED"),
    Code.IS_CLOSED: state("OPEN"),
    Code.NOT_OPENABLE_STATE: _closed_or_open,
    Code.IS_ON: state("OFF"),
    Code.IS_OFF: state("ON"),
    Code.IS_PLUGGED: state("PLUGGED_OUT"),
    Code.IS_UNPLUGGED: state("PLUGGED_IN"),
    Code.NOT_CLOSE: _not_close,
    Code.NOT_FACING: _facing,
    Code.NOT_IN_ROOM: _same_room,
    Code.NOT_SITTING_OR_LYING: _resting,
    Code.NOT_HOLDING: _holding,
    Code.NOT_WORN: _worn,
    Code.OCCUPIED: _free,
}
