"""Repairs for seated characters.

Ways are walked before the seat is taken, and objects used there are brought within reach.
"""

from hearth.repair.handlers.common import Edit, RepairContext, Splice, tick_start
from hearth.repair.step_context import RESTING
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.vocabulary import CHARACTER_CLASS
from hearth.simulation.engine import run
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices
from hearth.simulation.world.world import World


def done_before_seat(context: RepairContext, name: str, last: int, *leading: Step) -> Edit | None:
    """Do some steps and those from the failing one to number `last` before the seat is approached."""
    seat = context.seat_taken()
    if seat is None:
        return None
    number = _approach(context, seat[0])
    again = () if number < seat[0] else (context.does("Walk", seat[2]),)
    moved = context.program.steps[context.at : last + 1]
    start = tick_start(context.program, number)
    return Edit(name, (Splice(start, 0, (*leading, *moved, *again)), Splice(context.at, len(moved))))


def stays(context: RepairContext, last: int) -> bool:
    """Return whether the character is to go on resting after step number `last`."""
    for number, step in enumerate(context.program.steps[last + 1 :], last + 1):
        if step.agent == context.failure.agent and not context.is_inserted(number):
            return step.action not in context.posture and context.rests_at(number) is not False
    return not context.wanted or any(fact.name in RESTING for fact in context.goal)


def brought(context: RepairContext, name: str) -> Edit | None:
    """Bring seat and thing together before the seat is taken: come from its side, fetch it, or move the seat."""
    seat = context.seat_taken()
    if seat is None:
        return None
    number, _, place = seat
    start = tick_start(context.program, number)
    beside = _stands_beside(context, number)
    if beside is not None:
        return Edit(name, (Splice(start, 0, (context.does("Walk", beside),)),))
    world, home, grabbable = context.world, context.world.home, context.world.home.able("Grab")
    bearing = _supports(world, context.index())
    for i in (context.index(), *indices(bearing)):
        if grabbable >> i & 1 and not _is_put(context, context.ref(i), place):
            return _fetched(context, name, context.ref(i), number)
    if place.node is None or not grabbable >> home.index[place.node] & 1 or _is_put(context, place, place):
        return None
    there = context.ref(next(indices(bearing & _tables(world)), context.index()))
    moved = (("Walk", place), ("Grab", place), ("Walk", there), ("Release", place))
    return Edit(name, (Splice(start, 0, tuple(context.does(action, one) for action, one in moved)),))


def _is_put(context: RepairContext, thing: ObjectRef, seat: ObjectRef) -> bool:
    """Return whether a repair has put a thing at the seat, or the original has put it, or something on it.

    What was brought before the seat was moved may be brought again.
    """
    frees = context.group("frees_hand")
    inserted = [step for number, step in enumerate(context.program.steps) if context.is_inserted(number)]
    puts = sum(step.action in frees and step.objects[0] == thing for step in inserted)
    moved = thing != seat and any(step.action == "Grab" and step.objects[0] == seat for step in inserted)
    placed = (f.terms for f in context.wanted[context.at] or () if f.target and f.subject[0] != CHARACTER_CLASS)
    return puts > moved or any(thing.key in terms for terms in placed)


def _supports(world: World, i: int) -> int:
    """Return the supports of a thing, and the supports of these."""
    found = edge_rows.on(world, i)
    for j in indices(found):
        found |= edge_rows.on(world, j)
    return found


def _fetched(context: RepairContext, name: str, thing: ObjectRef, seat: int) -> Edit:
    """Fetch a thing while a hand is free, and put it down where the character comes from when it takes the seat."""
    approach = number = _approach(context, seat)
    back = context.program.steps[approach].objects[0]
    put = _put_down(context, thing, approach + 1)
    fetched = (context.does("Walk", thing), context.does("Grab", thing))
    while number and not _can_fetch(context, number):
        number -= 1
    if number == approach < seat:
        return Edit(name, (Splice(number, 0, fetched), Splice(number + 1, 0, (put,))))
    return Edit(name, (Splice(tick_start(context.program, number), 0, (*fetched, context.does("Walk", back), put)),))


def _can_fetch(context: RepairContext, number: int) -> bool:
    """Return whether a hand is free before a step, and the step does not depend on where the character is."""
    agent = context.world_before(number).agents[context.failure.agent]
    return not (agent.right and agent.left) and (_walks(context, number) or number == context.at)


def _approach(context: RepairContext, seat: int) -> int:
    """Return the number of the step that takes the character to where it then takes its seat.

    The latter's where there is none.
    """
    return next((number for number in range(seat - 1, -1, -1) if _walks(context, number)), seat)


def _walks(context: RepairContext, number: int) -> bool:
    """Return whether the character goes somewhere else in a step: not by a Find of a close object."""
    step, world = context.program.steps[number], context.world_before(number)
    if step.agent != context.failure.agent or step.action not in context.group("goes") or step.joins:
        return False
    node = step.objects[0].node
    if step.action in context.group("walks") or node is None:
        return True
    return not edge_rows.is_close(world, world.agents[step.agent], world.home.index[node])


def _stands_beside(context: RepairContext, taken: int) -> ObjectRef | None:
    """Return the furniture that bears what is not close, if who comes from there is close to all that it uses in
    the seat.
    """
    world, home = context.world, context.world.home
    later = Program(steps=context.program.steps[taken:]).objects()
    used = [home.index[ref.node] for ref in later if ref.node is not None]
    wanted = [i for i in used if context.is_close(i) or i == context.index()]
    for place in indices(_supports(world, context.index()) & _tables(world)):
        beside = context.ref(place)
        walk = Program(steps=(context.does("Walk", beside),))
        there = run(context.world_before(taken), walk, context.rules).final
        me = there.agents[context.failure.agent]
        if all(edge_rows.is_close(there, me, i) for i in wanted):
            return beside
    return None


def _bed_for(context: RepairContext, thing: ObjectRef) -> int:
    """Return the bed that is lain or sat on, where the thing is bedding that may stay on it; else nothing."""
    home, seat = context.world.home, context.seat_taken()
    if not context.rules.made_bed or seat is None or seat[2].node is None or thing.node is None:
        return 0
    bed = 1 << home.index[seat[2].node]
    return bed & home.properties["LIEABLE"] if home.bedding >> home.index[thing.node] & 1 else 0


def _tables(world: World) -> int:
    """Furniture to put things on."""
    home = world.home
    others = home.able("Sit") | home.able("Lie") | home.able("Grab") | home.rooms | home.by_class.get("floor", 0)
    return home.properties["SURFACES"] & ~others


def _put_down(context: RepairContext, thing: ObjectRef, at: int) -> Step:
    """Put a thing on the furniture that is close before a step, what the program names first; else let it go.

    Bedding goes on the bed, if it takes no room there.
    """
    world = context.world_before(at)
    home, agent = world.home, world.agents[context.failure.agent]
    named = {ref.node for ref in context.program.objects()}
    near = [i for i in indices(_bed_for(context, thing) or _tables(world)) if edge_rows.is_close(world, agent, i)]
    place = min(near, key=lambda i: (home.ids[i] not in named, i), default=None)
    return context.does("Release", thing) if place is None else context.does("PutBack", thing, context.ref(place))
