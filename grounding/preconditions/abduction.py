"""Abduced preconditions: the conditions on the start that prevent a failure, one small function a failure code.

Each gets the context of a failure and gives the conditions to try, best first; none if no start prevents the failure.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from hearth.grounding.failure_context import FailureContext
from hearth.grounding.preconditions.conditions import Condition
from hearth.schemas.failures import Code
from hearth.schemas.literals import CHARACTER, NAME_OF, Key, Literal
from hearth.schemas.vocabulary import OPPOSITE
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices
from hearth.simulation.world.world import World


@dataclass(frozen=True, slots=True)
class StartContext(FailureContext):
    """A failure that a condition on the start may prevent.

    Attributes:
        start: the world at the start of the execution.
        keys: the program's object by node id.
    """

    start: World
    keys: dict[int, Key]

    def key(self, position: int = 0) -> Key | None:
        """Return the program's object that the failure names at this position; None where it names none."""
        named = self.failure.objects
        return self.keys.get(named[position]) if position < len(named) else None

    def needs(self, name: str, *objects: Key) -> Condition:
        """Return the condition, needed by this step."""
        return Condition(Literal(name, objects), self.at)


Abduction = Callable[[StartContext], Iterator[Condition]]


def conditions_for(context: StartContext) -> Iterator[Condition]:
    """Return the conditions that could have prevented a failure."""
    abduced = ABDUCTIONS.get(context.failure.code)
    return abduced(context) if abduced is not None else iter(())


def state(wanted: str) -> Abduction:
    """Yield the object is in a state from the start; none if the program itself has put it in the opposite."""

    def abduced(context: StartContext) -> Iterator[Condition]:
        key = context.key()
        if key is None:
            return
        node = context.failure.objects[0]
        now = context.world.has_state(node, OPPOSITE[wanted])
        then = context.start.has_state(node, OPPOSITE[wanted])
        if now == then:
            yield context.needs(NAME_OF[wanted], key)

    return abduced


def _at_reach(context: StartContext) -> Iterator[Condition]:
    """Near the object that the character has walked to, or near the character if it has not walked."""
    key = context.key()
    if key is None:
        return
    agent = context.agent
    if agent == context.start.agents[context.failure.agent]:
        yield context.needs("nearby", key, CHARACTER)
    yield from _had_not_left(context)
    yield from _beside_anchors(context, "atreach", key)
    if not any(step.action in context.group("goes") for step in context.program.steps[: context.at]):
        yield context.needs("nearby", key, CHARACTER)


def _had_not_left(context: StartContext) -> Iterator[Condition]:
    """Yield an object that the program has put down is only near while the character stays: so the object found next
    was near there, and finding it took no walk.
    """
    index = context.index()
    places = (edge_rows.on(context.world, index) | edge_rows.inside(context.world, index)) & ~context.world.home.rooms
    start = edge_rows.on(context.start, index) | edge_rows.inside(context.start, index)
    keys = [
        context.keys[context.world.home.ids[i]]
        for i in indices(places & ~start)
        if context.world.home.ids[i] in context.keys
    ]
    for step in reversed(context.program.steps[: context.at]):
        if any(ref.key == context.key() for ref in step.objects):
            return
        if step.action == "Find":
            for place in keys:
                yield context.needs("atreach", step.objects[0].key, place)


def anchors(context: StartContext) -> Iterator[Key]:
    """Yield the nodes that the character is CLOSE to at that moment, the last mentioned first.

    Furniture, portable objects, held objects (for the place of their origin), parts of the body, rooms.
    """
    world, agent = context.world, context.agent
    index = world.home.index
    seen: dict[Key, int] = {}
    for step in reversed(context.program.steps[: context.at]):
        for ref in step.objects:
            node = index.get(ref.node) if ref.node is not None else None
            if node is None or ref.key in seen or not agent.close >> node & 1:
                continue
            seen[ref.key] = _rank(context, node)
    yield from sorted(seen, key=lambda key: seen[key])


def _beside_anchors(context: StartContext, name: str, key: Key) -> Iterator[Condition]:
    """Yield an object stands in a relation to each of the anchors but itself."""
    yield from (context.needs(name, key, anchor) for anchor in anchors(context) if anchor != key)


def _rank(context: StartContext, node: int) -> int:
    home = context.world.home
    if home.rooms >> node & 1:
        return 4
    if home.properties["BODY_PART"] >> node & 1:
        return 3
    if context.agent.held >> node & 1:
        return 2
    return 1 if home.properties["GRABBABLE"] >> node & 1 else 0


def _put_back_place(context: StartContext) -> Iterator[Condition]:
    """Yield an object to be put back stood, from the start, on or in the thing where the character is now."""
    step = context.program.steps[context.at]
    if step.action != "PutObjBack" or context.key() is not None:
        return
    yield from _beside_anchors(context, "in", step.objects[0].key)


def _not_close(context: StartContext) -> Iterator[Condition]:
    yield from _put_back_place(context)
    yield from _at_reach(context)


def _facing(context: StartContext) -> Iterator[Condition]:
    """Yield the character's seat, or the thing it has turned to, faces the object."""
    key = context.key()
    if key is None:
        return
    agent = context.agent
    for step in reversed(context.program.steps[: context.at]):
        for ref in step.objects:
            node = context.world.home.index.get(ref.node) if ref.node is not None else None
            if node is None or ref.key == key:
                continue
            seat = agent.on >> node & 1 and step.action in context.group("rests")
            if seat or agent.facing >> node & 1:
                yield context.needs("facing", ref.key, key)


def _same_room(context: StartContext) -> Iterator[Condition]:
    key = context.key()
    room = edge_rows.agent_room(context.world, context.agent)
    named = context.keys.get(context.world.home.ids[room]) if room >= 0 else None
    if key is None:
        return
    if named is not None:
        yield context.needs("location", key, named)
    yield from _beside_anchors(context, "together", key)


def _resting(context: StartContext) -> Iterator[Condition]:
    moved = context.agent != context.start.agents[context.failure.agent]
    action = context.program.steps[context.at].action
    if not moved or context.agent.on == context.start.agents[context.failure.agent].on:
        yield context.needs("lying" if action in context.group("lies") else "sitting", CHARACTER)


def _holding(context: StartContext) -> Iterator[Condition]:
    """In the hand from the start, unless the program let go of it."""
    key = context.key()
    handles = context.group("takes") | context.group("frees_hand")
    if key is not None and not any(
        step.action in handles and step.objects[0].key == key for step in context.program.steps[: context.at]
    ):
        yield context.needs("holds", key, CHARACTER)


def _plainly(name: str, *others: Key) -> Abduction:
    """Yield the condition of that name holds of the object."""

    def abduced(context: StartContext) -> Iterator[Condition]:
        key = context.key()
        if key is not None:
            yield context.needs(name, key, *others)

    return abduced


def _closed_or_open(context: StartContext) -> Iterator[Condition]:
    step = context.program.steps[context.at]
    yield from state("CLOSED" if step.action == "Open" else "OPEN")(context)


ABDUCTIONS: dict[Code, Abduction] = {
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
    Code.NOT_WORN: _plainly("in", CHARACTER),
    Code.OCCUPIED: _plainly("free"),
}
