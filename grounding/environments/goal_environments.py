"""Sampling environments for goals: the objects that a goal counts are there, and it does not hold yet."""

from collections import Counter
from functools import reduce
from operator import or_

from hearth.grounding.environments.default_state import Base
from hearth.grounding.environments.environment_draft import PartialEnvironment
from hearth.grounding.environments.object_placement import put_where_it_belongs
from hearth.grounding.environments.random_objects import fill
from hearth.grounding.environments.sampling import TRIES, USUAL, Environment, Size, of_partial, settle_character
from hearth.grounding.environments.soundness import unsound
from hearth.grounding.preconditions.conditions import Preconditions
from hearth.schemas.failures import Code, Failure
from hearth.schemas.goals import Goal
from hearth.schemas.literals import AGENT, Literal, Name
from hearth.schemas.program import Program
from hearth.schemas.rng import rng
from hearth.schemas.vocabulary import OPPOSITE
from hearth.simulation.goals import Progress
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

MOST = 9
"""The largest count of one class in a goal (thesis table C.2)."""

_NO_PROGRAM = Program("", "", ())
_NOTHING = Preconditions()


def sample_for_goal(
    goal: Goal, home: Home, seed: int, record_id: str = "", size: Size = USUAL
) -> tuple[Environment, Progress] | Failure:
    """Draw an environment in which a goal can be reached and is not reached yet; an empty goal asks for nothing.

    Args:
        goal: counted literals over classes, nodes of the home or agents; the things of all its parts are provided.
        home: any home; it is brought to its default state first.
        seed, record_id: all the randomness there is.
        size: nodes wanted.

    Returns:
        The environment with the goal's progress at its start, or why none was found: NO_PLACE where more than `MOST`
        are asked for or too few things of a class belong anywhere in the home; CONDITION_UNMET where the goal holds
        whatever is done.

    Raises:
        HearthError: UNKNOWN_OBJECT or SYNTAX: a literal names nothing that there is.
    """
    base = size.base(home)
    every = tuple(goal.literals())
    for literal, wanted in every:
        if wanted > MOST:
            return _failure(Code.NO_PLACE, literal, f"at most {MOST}", str(wanted))
    failure = _failure(Code.CONDITION_UNMET, None, "a goal not met at the start", "none was drawn")
    for attempt in range(TRIES):
        environment = _drawn(goal, base, seed, record_id, attempt, size)
        if isinstance(environment, Failure):
            return environment
        progress = Progress.start(goal, environment.world)
        missing = next((p for p, wanted in every if _candidates(p, environment.world) < wanted), None)
        if missing is not None:
            failure = _failure(Code.NO_PLACE, missing, "enough of them", "fewer than the goal counts")
        elif every and progress.satisfied:
            failure = _failure(Code.CONDITION_UNMET, None, "a goal not met at the start", "it is met already")
        elif (fault := unsound(environment.world)) is not None:
            failure = fault
        else:
            return environment, progress
    return failure


def _failure(code: Code, literal: Literal[Name] | None, expected: str, actual: str) -> Failure:
    return Failure(code, names=(str(literal),) if literal else (), expected=expected, actual=actual)


def _class(literal: Literal[Name]) -> str:
    """Return the class of things that a literal counts, or "" where it names nodes, agents or variables alone."""
    if not literal.terms:
        return ""
    counted = literal.target if _is_agent(literal.subject) else literal.subject
    return counted if isinstance(counted, str) and not _is_agent(counted) else ""


def _is_agent(term: Name | None) -> bool:
    """Return whether a term stands for agents, or is a variable."""
    return isinstance(term, str) and term.startswith((AGENT, "?"))


def _candidates(literal: Literal[Name], world: World) -> int:
    name = _class(literal)
    return world.home.instances(name).bit_count() if name else MOST + 1


def _drawn(goal: Goal, base: Base, seed: int, record_id: str, attempt: int, size: Size) -> Environment | Failure:
    partial = PartialEnvironment(base, rng(seed, "goal", base.home.name, record_id, attempt))
    wanted: Counter[str] = Counter()
    for literal, number in goal.literals():
        if name := _class(literal):
            wanted[name] = max(wanted[name], number)
        holder = literal.target
        if isinstance(holder, str) and holder != name and not _is_agent(holder):
            wanted[holder] = max(wanted[holder], 1)
    for name, number in sorted(wanted.items()):
        if not base.knowledge.is_room(name):
            provide(partial, name, number)
    for literal, number in goal.literals():
        _undo(partial, literal, number)
    settle_character(partial, _NO_PROGRAM, _NOTHING)
    fill(partial, size.least, size.most, size.some)
    return of_partial(partial, seed, _NO_PROGRAM, _NOTHING)


def provide(partial: PartialEnvironment, name: str, number: int) -> None:
    """As many of a class as are wanted, the missing ones where they belong."""
    base = partial.base
    here = len(base.instances(name))
    # A home that calls them by another of their names gets more of those.
    called = base.home.classes[base.instances(name)[0]] if here else name
    usual = base.knowledge.object_class(called)
    rooms = [base.home.ids[i] for room in (usual.rooms if usual else ()) for i in base.rooms(room)]
    every = [base.home.ids[i] for i in indices(base.home.rooms)]
    for _ in range(number - here):
        node_id = partial.add(called, partial.rng.choice(rooms or every))
        put_where_it_belongs(partial, called, node_id, -1, must=False)


def _undo(partial: PartialEnvironment, literal: Literal[Name], number: int) -> None:
    """Violate predicates that the home meets already: swap states, put things on the floor."""
    home = partial.base.home
    try:
        watch = Progress.start(Goal(((literal, number),)), World.start(home)).watches[0]
    except IndexError:
        return
    for i in list(indices(reduce(or_, watch.met, 0)))[: max(0, watch.count - number + 1)]:
        node_id = home.ids[i]
        if literal.target is None:
            partial.set_state(node_id, OPPOSITE[literal.name])
        elif literal.name in ("ON", "INSIDE", "CLOSE") and home.properties["GRABBABLE"] >> i & 1:
            room = partial.room_of(node_id)
            partial.lift(node_id)
            partial.settle(node_id, room)
