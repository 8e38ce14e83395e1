"""Sampling environments in which a program runs: e ~ E_Phi(p) (thesis 5.5.2, eq. 5.10)."""

from __future__ import annotations

from dataclasses import dataclass

from hearth.grounding.environments.condition_satisfaction import fulfil
from hearth.grounding.environments.default_state import Base, prepared
from hearth.grounding.environments.environment_draft import PartialEnvironment
from hearth.grounding.environments.object_placement import bind, requirements_of
from hearth.grounding.environments.random_objects import fill
from hearth.grounding.environments.soundness import unsound
from hearth.grounding.preconditions.abduction import StartContext, conditions_for
from hearth.grounding.preconditions.condition_checks import unmet, unmet_failure
from hearth.grounding.preconditions.conditions import Preconditions
from hearth.grounding.preconditions.precondition_inference import infer
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge, Node
from hearth.schemas.literals import CHARACTER, HANDS, Key
from hearth.schemas.program import Program
from hearth.schemas.rng import rng
from hearth.schemas.short_repr import brief
from hearth.simulation.engine import Execution, run
from hearth.simulation.processes import widened
from hearth.simulation.rules import DEFAULT, Rules, suited
from hearth.simulation.world.bits import indices
from hearth.simulation.world.edit import Movable
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

TRIES = 12
"""Environments drawn for one program before it is given up."""


@dataclass(frozen=True, slots=True)
class Environment:
    """A home prepared for a program.

    Attributes:
        base: the home in its default state, which the differences are from.
        left_out: ids of the nodes of it that were left out, for a smaller environment.
        seed: the run's seed.
        world: the start.
        program: the program, bound to the world's nodes.
        conditions: those given, and those abduced while sampling.
        nodes, placed, removed, states: what differs from the base; states are those of the nodes named, all of them.
        movable: the random things among the nodes, and where they are.
        places: nodes of the objects that conditions name and the program does not.
    """

    base: Home
    seed: int
    world: World
    program: Program
    conditions: Preconditions
    nodes: tuple[Node, ...]
    placed: tuple[Edge, ...]
    removed: tuple[Edge, ...]
    states: tuple[tuple[int, tuple[str, ...]], ...]
    movable: tuple[Movable, ...] = ()
    left_out: tuple[int, ...] = ()
    places: tuple[tuple[Key, int], ...] = ()

    __repr__ = brief

    @property
    def added(self) -> tuple[Edge, ...]:
        """The edges that the base does not have."""
        ids = self.world.home.ids
        return (*self.placed, *(edge for one in self.movable for edge in one.edges(ids)))


def of_partial(
    partial: PartialEnvironment, seed: int, program: Program, conditions: Preconditions, rules: Rules = DEFAULT
) -> Environment:
    """Return the environment made of a partial one; by action set 3 its world has the further states of the start."""
    start = World.start(partial.home())
    return Environment(
        partial.base.whole,
        seed,
        widened(start) if rules.consequences else start,
        program,
        conditions,
        (*partial.nodes, *[one.node for one in partial.movable]),
        tuple(partial.added),
        tuple(partial.removed),
        tuple(sorted(partial.states.items())),
        tuple(partial.movable),
        partial.base.removed,
        tuple(
            (key, node) for key, node in partial.binding.items() if key not in {ref.key for ref in program.objects()}
        ),
    )


@dataclass(frozen=True, slots=True)
class Size:
    """The number of nodes of an environment.

    Attributes:
        least, most: the number is drawn from between.
        some: how many random ones are added at most to a home that is larger.
        thin: whether a larger home loses some of its nodes instead.
        sparing: whether things of the home are moved to where they are needed before others are added.
    """

    least: int = 280
    most: int = 300
    some: int = 12
    thin: bool = False
    sparing: bool = False

    @classmethod
    def about(cls, nodes: int) -> Size:
        """`nodes` nodes, ten more or less; larger homes are thinned."""
        return cls(nodes - AROUND, nodes + AROUND, 0, thin=True)

    def base(self, home: Home) -> Base:
        """Return a home prepared for environments of this size, with room for the objects of a program."""
        base = prepared(home)
        return base.thinned(self.least - ROOM_FOR_MORE) if self.thin else base


AROUND, ROOM_FOR_MORE = 10, 10
USUAL = Size()


def sample(
    program: Program,
    home: Home,
    seed: int,
    record_id: str = "",
    conditions: Preconditions | None = None,
    size: Size = USUAL,
    rules: Rules = DEFAULT,
    must_run: bool = True,
) -> tuple[Environment, Execution] | Failure:
    """Draw an environment in which the conditions hold and the program runs (thesis 5.5.2, eq. 5.10).

    Args:
        program: with instances as counters; node ids are ignored.
        home: any home; it is brought to its default state first.
        seed, record_id: all the randomness there is.
        conditions: what must hold; inferred from the program when None.
        size: nodes wanted.
        rules: for the run.
        must_run: draw again, with the abduced precondition of the failed run added, until the program runs.

    Returns:
        The environment and the program's execution in it, or the failure of the last one drawn.

    Examples:
        >>> environment, execution = hearth.sample(program, home, seed=0)
        >>> execution.executable, len(environment.world.graph().nodes)
        (True, 371)
    """
    program, base = program.numbered(), size.base(home)
    rules = suited(program, base.knowledge, rules)
    found = infer(program, base.knowledge, rules) if conditions is None else conditions
    if isinstance(found, Failure):
        return found
    failure = unplaceable(program, base)
    if failure is not None:
        return failure
    for attempt in range(TRIES):
        environment = draw(program, base, found, seed, record_id, attempt, size, rules)
        execution = run(environment.world, environment.program, rules)
        missing = unmet(environment.conditions, environment.world, _nodes(environment))
        fault = unsound(environment.world)
        if not missing and fault is None and (execution.failure is None or not must_run):
            return environment, execution
        failure = unmet_failure(missing[0], program, TRIES) if missing else fault or execution.failure
        if attempt % 2 and execution.failure is not None and not missing:
            found = _with_abduced(found, environment, execution, base)
    assert failure is not None
    return failure


def unplaceable(program: Program, base: Base) -> Failure | None:
    """Return the failure of any sampling where the home lacks a room, or all, or an object has no placement.

    Else None.
    """
    for tick, steps in enumerate(program.ticks()):
        for step in steps:
            for ref in step.objects:
                found = base.homeless(ref.name)
                if found is not None:
                    code, expected, actual = found
                    return Failure(code, tick, step.agent, step.action, (), (ref.name,), expected, actual)
    if not base.home.rooms:
        return Failure(Code.NO_ROOM, expected="a home with a room", actual=f"{base.home.name} has none")
    return None


def _nodes(environment: Environment) -> dict[Key, int]:
    bound = {ref.key: ref.node for ref in environment.program.objects() if ref.node is not None}
    return {**bound, **dict(environment.places)}


def draw(
    program: Program,
    base: Base,
    conditions: Preconditions,
    seed: int,
    record_id: str,
    attempt: int,
    size: Size,
    rules: Rules = DEFAULT,
) -> Environment:
    """One environment in which the conditions hold; the program was not run in it yet."""
    generator = rng(seed, "sample", base.home.name, record_id, attempt)
    partial = PartialEnvironment(base, generator, rules.made_bed, size.sparing)
    bind(partial, requirements_of(program, conditions, base.knowledge))
    fulfil(partial, conditions)
    settle_character(partial, program, conditions)
    fill(partial, size.least, size.most, size.some)
    return of_partial(partial, seed, program.bound(partial.binding), conditions, rules)


def settle_character(partial: PartialEnvironment, program: Program, conditions: Preconditions) -> None:
    """Put the character where its conditions want it, else in another room than the program starts in.

    A sparing environment leaves it in its room.
    """
    base = partial.base
    home = base.home
    me = base.character
    rooms = [home.ids[i] for i in indices(home.rooms)]
    near = [c.objects[0] for c in conditions if c.name in ("nearby", "holds") and c.objects[-1] == CHARACTER]
    if me in partial.room:
        room = partial.room[me]
    elif near:
        room = partial.room_of(partial.binding[near[0]])
    elif partial.sparing and base.start.agents[0].inside & home.rooms:
        room = home.ids[next(indices(base.start.agents[0].inside & home.rooms))]
    else:
        first = next((ref.key for step in program.steps for ref in step.objects), None)
        begin = partial.binding.get(first, -1) if first else -1
        begin = begin if begin in rooms else partial.room_of(begin)
        room = partial.rng.choice([r for r in rooms if r != begin] or rooms)
    partial.removed.extend(Edge(me, "INSIDE", home.ids[i]) for i in indices(base.start.agents[0].inside))
    partial.added.append(Edge(me, "INSIDE", room))
    _bring(partial, me, room)


def _bring(partial: PartialEnvironment, me: int, room: int) -> None:
    """Things held are in the character's room, unless a condition places them in another."""
    held = [edge.target for edge in partial.added if edge.source == me and edge.relation in HANDS]
    for node_id in held:
        if partial.room_of(node_id) < 0:
            partial.settle(node_id, room)


def _with_abduced(
    conditions: Preconditions, environment: Environment, execution: Execution, base: Base
) -> Preconditions:
    """Return the conditions with the abduced precondition of the failed run."""
    failure = execution.failure
    assert failure is not None
    keys = {node: key for key, node in _nodes(environment).items()}
    context = StartContext(
        environment.program, failure.tick, failure, execution.final, base.knowledge, environment.world, keys
    )
    known = {c.literal for c in conditions}
    new = next((c for c in conditions_for(context) if c.literal not in known), None)
    return conditions if new is None else conditions.plus(new)
